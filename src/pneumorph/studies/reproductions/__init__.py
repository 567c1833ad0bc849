"""Reproductions of published systems: one file each, imported here so that they are known by name."""

from pneumorph.studies.reproductions import (
    auxetic_skin,
    finger,
    finger_gripper,
    finger_massage,
    hexagonal_anchoring,
    hexagonal_earthworm,
    hexagonal_expansion,
    hexagonal_inchworm,
    hexagonal_moment,
    hexagonal_prism,
    pneunet_2d,
    pneunet_quadruped,
    soft_wheel,
)
from pneumorph.studies.reproductions.reproduction import (
    Reproduction,
    SystemBySweep,
    SystemInParts,
    names,
    reproduction,
)

__all__ = [
    "Reproduction", "SystemBySweep", "SystemInParts", "auxetic_skin", "finger", "finger_gripper", "finger_massage",
    "hexagonal_anchoring", "hexagonal_expansion", "hexagonal_earthworm", "hexagonal_inchworm", "hexagonal_moment",
    "hexagonal_prism", "names", "pneunet_2d", "pneunet_quadruped", "reproduction", "soft_wheel",
]  # fmt: skip
