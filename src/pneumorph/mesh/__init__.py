"""Meshes of quadratic cells: from an actuator or a file, structured or layered, with named faces."""

from pneumorph.mesh.body import MeshSize
from pneumorph.mesh.generate import generate
from pneumorph.mesh.grid import BlockGrid
from pneumorph.mesh.imported import Imported
from pneumorph.mesh.joining import join, placed
from pneumorph.mesh.layered import extrude, rolled
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.quads import Quads, lines, nested, tensor
from pneumorph.mesh.quality import Quality, inspect
from pneumorph.mesh.selectors import Selector
from pneumorph.mesh.structured import box, rectangle

__all__ = [
    "BlockGrid",
    "CellBlock",
    "FaceBlock",
    "Imported",
    "Mesh",
    "MeshSize",
    "Quads",
    "Quality",
    "Selector",
    "box",
    "extrude",
    "generate",
    "inspect",
    "join",
    "lines",
    "nested",
    "placed",
    "rectangle",
    "rolled",
    "tensor",
]
