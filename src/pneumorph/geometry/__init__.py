"""Actuator templates: frozen, checked dimensions that make a solid with named faces and cavities."""

from pneumorph.geometry.actuator import Actuator, Dimension
from pneumorph.geometry.bending_skin import BendingSkin
from pneumorph.geometry.cad import export
from pneumorph.geometry.crawler import PlaneCrawler
from pneumorph.geometry.finger import Finger
from pneumorph.geometry.forearm import Forearm
from pneumorph.geometry.gripper import Gripper
from pneumorph.geometry.hexagonal_prism import HexagonalPrism
from pneumorph.geometry.pipe_robot import PipeRobot
from pneumorph.geometry.pneunet import PneuNet
from pneumorph.geometry.quadruped import Quadruped
from pneumorph.geometry.soft_limb import SoftLimb
from pneumorph.geometry.thick_sphere import ThickSphere
from pneumorph.geometry.thick_tube import ThickTube

__all__ = [
    "Actuator",
    "BendingSkin",
    "Dimension",
    "Finger",
    "Forearm",
    "Gripper",
    "HexagonalPrism",
    "PipeRobot",
    "PlaneCrawler",
    "PneuNet",
    "Quadruped",
    "SoftLimb",
    "ThickSphere",
    "ThickTube",
    "export",
]
