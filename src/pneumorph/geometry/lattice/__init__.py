"""Lattices: unit cells as data, maps of cells, and flat sheets of holes and beams that can be rolled to skins."""

from pneumorph.geometry.lattice.cell_map import Cell, Segment, cell_map, halves
from pneumorph.geometry.lattice.sheet import Hole, Lattice
from pneumorph.geometry.lattice.skinned_tube import SkinnedTube, skinned_tube
from pneumorph.geometry.lattice.unit_cell import KINDS, Polygon, Profile

__all__ = [
    "KINDS",
    "Cell",
    "Hole",
    "Lattice",
    "Polygon",
    "Profile",
    "Segment",
    "SkinnedTube",
    "cell_map",
    "halves",
    "skinned_tube",
]
