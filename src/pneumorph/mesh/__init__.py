"""Meshes of quadratic cells: from an actuator, structured or layered, with named faces."""

from pneumorph.mesh.generate import generate
from pneumorph.mesh.layered import extrude, rolled
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.quality import Quality, inspect
from pneumorph.mesh.structured import box, rectangle

__all__ = ["CellBlock", "FaceBlock", "Mesh", "Quality", "box", "extrude", "generate", "inspect", "rectangle", "rolled"]
