"""Gaits: programmes of named phases that repeat, and what a run of one tells about the motion."""

from pneumorph.gaits.gait import Gait
from pneumorph.gaits.locomotion import Foot, Locomotion, locomotion
from pneumorph.gaits.patterns import crawling, earthworm, inchworm, undulation

__all__ = ["Foot", "Gait", "Locomotion", "crawling", "earthworm", "inchworm", "locomotion", "undulation"]
