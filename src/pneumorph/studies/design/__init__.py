"""Inverse search: the skin and the pressure that bend a tube into a wanted centre line."""

from pneumorph.studies.design.law import Bend, SegmentLaw, TableLaw
from pneumorph.studies.design.search import SearchProgress, found_in, search
from pneumorph.studies.design.skin import SkinDesign
from pneumorph.studies.design.target import Target, named_curve, read_curve
from pneumorph.studies.design.task import DesignTask, load_design
from pneumorph.studies.design.verify import Verified, verified_by, verify

__all__ = [
    "Bend", "DesignTask", "SearchProgress", "SegmentLaw", "SkinDesign", "TableLaw", "Target", "Verified", "found_in",
    "load_design", "named_curve", "read_curve", "search", "verified_by", "verify",
]  # fmt: skip
