"""Hexagonal prism -> quadratic hexahedra: six equal sectors of the column, each with its row of chambers.

Each sector is one block grid: below, cells between the round core and the flat side; on them the section of a row as
rectangles within rectangles (airway, bridge, chamber, block), in layers from wall to wall.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.geometry.hexagonal_prism import HexagonalPrism
from pneumorph.mesh.assembly import Turn
from pneumorph.mesh.grid import BlockGrid
from pneumorph.mesh.joining import join, placed
from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.quads import lines, nested, tensor

Array = NDArray[np.float64]

_AIR = "air"
_SIDE = "side"
_CUT = "symmetry_x"
_CORE, _BORE = -1.0, -2.0  # v of the wall of the core, and of the hole in an end plate


def mesh_prism(prism: HexagonalPrism, size: float = math.inf) -> Mesh:
    """Return the mesh of a hexagonal prism in hexahedron27, with the faces of the template.

    Walls have one cell through them. size: largest edge, mm, up the end walls of the chambers; without it they have
    one ring of cells from the airway's bridge to the corners of the chamber.
    Raises MeshError where that bridge is wider or higher than a chamber.
    """
    sector = _sector(prism, size)
    # of a half, the sides that nothing joins are its cut
    return join(
        [placed(sector, about_z(60.0 * number), rename={_AIR: name, _SIDE: _CUT}) for number, name in prism.sides]
    )


def _sector(prism: HexagonalPrism, size: float) -> Mesh:
    """Return the sector whose chambers look along x."""
    bridge = (prism.airway_width + 2.0 * prism.airway_side, prism.airway_height + prism.airway_roof)
    chamber = (prism.chamber_width, prism.chamber_height)
    if bridge[0] >= chamber[0] or bridge[1] >= chamber[1]:
        raise MeshError(
            f"hexahedra: the airway's bridge, {bridge[0]:g} x {bridge[1]:g} mm, is as wide or high as a chamber, "
            f"{chamber[0]:g} x {chamber[1]:g} mm: expected less, or a mesh of tetrahedra"
        )
    block = (prism.block_width, prism.block_height)
    rings = (1, max(1, math.ceil((chamber[1] - bridge[1]) / size - 1e-9)), 1)
    row = nested([(prism.airway_width, prism.airway_height), bridge, chamber, block], rings)
    floor = np.unique(np.round(row.points[np.abs(row.points[:, 1]) < 1e-9, 0], 9))
    across = lines([-0.5 * prism.side, *floor, 0.5 * prism.side])
    plate = prism.end_plate > 0.0
    inmost = _BORE if plate else _CORE
    rings_inside = [_BORE, 0.5 * (_BORE + _CORE)] if plate else []
    grid = BlockGrid(tensor(across, [*rings_inside, _CORE, 0.0]) + row, _planes(prism))
    grid = grid.fill("body", v=(_CORE, 0.0))
    within = (prism.length - prism.end_plate, prism.length)
    if plate:
        grid = grid.fill("plate", v=(_BORE, 0.0), w=within)
    for low, ends in zip(prism.chamber_starts, prism.blocks, strict=True):
        grid = grid.fill("body", u=_about(block), v=(0.0, block[1]), w=ends)
        grid = grid.hollow(_AIR, u=_about(chamber), v=(0.0, chamber[1]), w=(low, low + prism.chamber_length))
    for (_, low), (high, _) in pairwise(prism.blocks):
        wall = prism.expansion_wall
        airway = (prism.airway_width, prism.airway_height)
        grid = grid.fill("body", u=_about(bridge), v=(0.0, bridge[1]), w=(low, high))
        grid = grid.hollow(_AIR, u=_about(airway), v=(0.0, airway[1]), w=(low - wall, high + wall))
    # rows that begin at the clamped end are clamped with it; the free end's face is the column's alone
    patches = [("clamp", {"w": (0.0, 0.0)}), ("tip", {"w": (prism.length, prism.length), "v": (inmost, 0.0)})]
    if plate:
        patches += [("plate", {"v": (_BORE, _BORE)}), ("plate", {"v": (_BORE, _CORE), "w": (within[0], within[0])})]
    return grid.mesh(
        lambda points: _with_plate(points, prism),
        patches=[
            *patches,
            ("core", {"v": (_CORE, _CORE)}),
            *((_SIDE, {"u": (u, u), "v": (inmost, 0.0)}) for u in (-0.5 * prism.side, 0.5 * prism.side)),
        ],
        bending_walls=prism.bending_walls,
    )


def _planes(prism: HexagonalPrism) -> Array:
    """Return z of the planes between the layers."""
    stops = [0.0]
    for low, (bottom, top) in zip(prism.chamber_starts, prism.blocks, strict=True):
        stops += [bottom, low, low + prism.chamber_length, top]
    return lines(sorted([*stops, prism.length - prism.end_plate, prism.length]))


def _about(size: tuple[float, float]) -> tuple[float, float]:
    return -0.5 * size[0], 0.5 * size[0]


def around_core(points: Array, prism: HexagonalPrism) -> Array:
    """Return places (n, 3) of points (u, v, w): v is the height above the flat side; from -1 to 0 it is the column."""
    u, v, w = points.T
    x, y = np.full_like(u, prism.apothem), -u
    far = np.hypot(x, y)
    share = np.clip(v - _CORE, 0.0, 1.0)
    shrunk = prism.core_radius / far
    column = shrunk + share * (1.0 - shrunk)
    return np.column_stack([x * column + np.maximum(v, 0.0), y * column, w])


def _with_plate(points: Array, prism: HexagonalPrism) -> Array:
    """Return places as `around_core` does; v from -2 to -1 leads from the hole in an end plate to the core's wall."""
    u, v, w = points.T
    places = around_core(np.column_stack([u, np.maximum(v, _CORE), w]), prism)
    bore = prism.end_plate_bore / prism.core_radius
    places[:, :2] *= (bore + np.clip(v - _BORE, 0.0, 1.0) * (1.0 - bore))[:, None]
    return places


def about_z(degrees: float) -> Turn:
    """Return the turn about the axis of the column."""
    return Turn((0.0, 0.0, 1.0), math.radians(degrees))
