"""Finger -> block grid of hexahedra: one quadratic cell through each wall, along the lines that its walls draw."""

from __future__ import annotations

import math

from pneumorph.geometry.finger import Finger
from pneumorph.mesh.grid import BlockGrid
from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.quads import lines, tensor

SYMMETRY = "symmetry_y"


def mesh_finger(finger: Finger, size: float = math.inf, *, half: bool = False) -> Mesh:
    """Return a finger along x in hexahedra, with the faces clamp, tip, outer and cavity.

    size: largest edge, mm; without it cells reach from wall to wall.
    half: the part with y >= 0, whose cut face is symmetry_y.

    Raises MeshError where it would be too large.
    """
    wall, block, pitch = finger.wall, finger.block_length, finger.block_length + finger.gap
    starts = [i * pitch for i in range(finger.chambers)]
    ends = [finger.length if i == finger.chambers - 1 else start + block for i, start in enumerate(starts)]
    x = lines([stop for a, b in zip(starts, ends, strict=True) for stop in (a, a + wall, b - wall, b)], size)
    inside, airway = 0.5 * finger.width - wall, 0.5 * finger.passage_width
    right = [0.0, airway, inside, 0.5 * finger.width]
    y = lines(right if half else [*(-stop for stop in reversed(right[1:])), *right], size)
    passage, roof = finger.base + finger.passage_height, finger.height - wall
    low = passage + finger.passage_roof
    z = lines(sorted([0.0, finger.base, passage, low, roof, finger.height]), size)
    grid = BlockGrid(tensor(x, y), z).fill("body")
    across = (0.0 if half else -inside, inside)
    for a, b in zip(starts, ends, strict=True):
        grid = grid.hollow("cavity", u=(a + wall, b - wall), v=across, w=(finger.base, roof))
    across = (0.0 if half else -airway, airway)
    for end, start in zip(ends[:-1], starts[1:], strict=True):
        grid = grid.hollow("cavity", u=(end - wall, start + wall), v=across, w=(finger.base, passage))
        if low < finger.height:
            grid = grid.hollow(u=(end, start), w=(low, finger.height))
    patches = [("clamp", {"u": (0.0, 0.0)}), ("tip", {"u": (finger.length, finger.length)})]
    cut = [(SYMMETRY, {"v": (0.0, 0.0)})] if half else []
    return grid.mesh(patches=[*patches, *cut])
