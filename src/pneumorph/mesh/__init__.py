"""Meshes of quadratic cells: from an actuator or a file, structured or layered, with named faces."""

from pneumorph.mesh.body import MeshSize
from pneumorph.mesh.generate import generate
from pneumorph.mesh.imported import Imported
from pneumorph.mesh.layered import extrude, rolled
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.quality import Quality, inspect
from pneumorph.mesh.selectors import Selector
from pneumorph.mesh.structured import box, rectangle

__all__ = [
    "CellBlock",
    "FaceBlock",
    "Imported",
    "Mesh",
    "MeshSize",
    "Quality",
    "Selector",
    "box",
    "extrude",
    "generate",
    "inspect",
    "rectangle",
    "rolled",
]
