"""Measures: numbers taken from a state, one file for each kind; and stress along paths."""

from pneumorph.measures.cavity_volume import CavityVolume
from pneumorph.measures.centre_line import CentreLine, centre_line
from pneumorph.measures.centre_of_mass import CentreOfMass
from pneumorph.measures.chambers import ChamberSpread
from pneumorph.measures.chord_angle import ChordAngle
from pneumorph.measures.circle import Circle, fit_circle
from pneumorph.measures.circumscribed import CircumscribedDiameter
from pneumorph.measures.contact_pressure import MeanContactPressure, contact_pressure
from pneumorph.measures.curvature import Curvature, CurvatureResidual
from pneumorph.measures.diameter import Diameter
from pneumorph.measures.displacement import LargestDisplacement
from pneumorph.measures.energy import EnergyImbalance, energy_check
from pneumorph.measures.linearised import Linearised, linearise, linearised_stress
from pneumorph.measures.locate import locate
from pneumorph.measures.normal_force import NormalForce
from pneumorph.measures.reactions import ReactionForce, ReactionMoment
from pneumorph.measures.slip import slip
from pneumorph.measures.stress import (
    LargestStress,
    MeanStress,
    PathValues,
    StressAt,
    StressQuantile,
    along_path,
    at_points,
)
from pneumorph.measures.tip_rotation import TipRotation
from pneumorph.measures.turn_rate import LineLength, TurnRate

__all__ = [
    "CavityVolume", "CentreLine", "CentreOfMass", "ChamberSpread", "ChordAngle", "Circle", "CircumscribedDiameter",
    "Curvature", "CurvatureResidual", "Diameter", "EnergyImbalance", "LargestDisplacement", "LargestStress",
    "LineLength", "Linearised", "MeanContactPressure", "MeanStress", "NormalForce", "PathValues", "ReactionForce",
    "ReactionMoment", "StressAt", "StressQuantile", "TipRotation", "TurnRate", "along_path", "at_points", "centre_line",
    "contact_pressure", "energy_check", "fit_circle", "linearise", "linearised_stress", "locate", "slip",
]  # fmt: skip
