"""Measures: numbers taken from a state, one file for each kind; and stress along paths."""

from pneumorph.measures.cavity_volume import CavityVolume
from pneumorph.measures.centre_line import CentreLine, centre_line
from pneumorph.measures.chord_angle import ChordAngle
from pneumorph.measures.circle import Circle, fit_circle
from pneumorph.measures.curvature import Curvature, CurvatureResidual
from pneumorph.measures.diameter import Diameter
from pneumorph.measures.energy import EnergyImbalance, energy_check
from pneumorph.measures.locate import locate
from pneumorph.measures.reactions import ReactionForce, ReactionMoment
from pneumorph.measures.stress import LargestStress, MeanStress, PathValues, StressAt, along_path, at_points
from pneumorph.measures.tip_rotation import TipRotation

__all__ = [
    "CavityVolume", "CentreLine", "ChordAngle", "Circle", "Curvature", "CurvatureResidual", "Diameter",
    "EnergyImbalance", "LargestStress", "MeanStress", "PathValues", "ReactionForce", "ReactionMoment", "StressAt",
    "TipRotation", "along_path", "at_points", "centre_line", "energy_check", "fit_circle", "locate",
]  # fmt: skip
