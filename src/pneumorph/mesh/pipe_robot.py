"""Pipe robot -> quadratic hexahedra, with wedges in the discs that close the bellows.

Each flat side of the column is one block grid for a prism and one for the bellows, with the same lines across, so that
they meet node to node. A cut through a side leaves half of its grid.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry.pipe_robot import PipeRobot
from pneumorph.mesh.grid import BlockGrid
from pneumorph.mesh.hexagonal_prism import about_z, around_core
from pneumorph.mesh.joining import join, placed
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.quads import lines, tensor
from pneumorph.mesh.structured import quadratic
from pneumorph.mesh.topology import boundary

Array = NDArray[np.float64]

_AIR, _SIDE, _MIDDLE = "air", "side", "middle"


def mesh_pipe_robot(robot: PipeRobot, size: float) -> Mesh:
    """Return the mesh of a pipe robot, hexahedron27 and wedge18; size: largest edge across and up the chambers, mm.

    Walls have one cell through them. Raises MeshError for a size out of range.
    """
    ahead = np.array([0.0, 0.0, robot.length + robot.bellows_length])
    parts = []
    for side, _ in robot.sides:
        # y >= 0 is u <= 0 on the side that looks along x, the only one that a cut goes through
        halved = side == 0 and (robot.quarter or robot.eighth)
        across = _across(robot, size)[: None if not halved else 1 + len(_across(robot, size)) // 2]
        turn = about_z(60.0 * side)
        prism = _prism(robot, across, size)
        if robot.modules == 1:
            parts.append(_named(robot, prism, "", side, turn))
            continue
        bellows = [_bellows(robot, across, size)]
        begin = robot.length
        bellows += [_disc(robot, across, begin)]
        if not robot.eighth:
            bellows += [_disc(robot, across, begin + robot.bellows_length - robot.end_disc)]
        parts += [_named(robot, prism, "rear", side, turn)]
        parts += [placed(mesh, turn, rename=_kept(mesh, {_SIDE: "symmetry_x"})) for mesh in bellows]
        if not robot.eighth:
            lifted = placed(prism, lambda x: x + ahead)
            parts.append(_named(robot, lifted, "front", side, turn))
    return join(parts)


def _across(robot: PipeRobot, size: float) -> Array:
    """Return u of the lines across a flat side, from one edge of the column to the next."""
    stops = [0.0, robot.chamber_width / 2.0, robot.block_width / 2.0, robot.side / 2.0]
    if robot.airways:
        stops += [robot.airway_width / 2.0, robot.airway_width / 2.0 + robot.airway_side]
    half = lines(_sorted(stops), size)
    return np.concatenate([-half[:0:-1], half])


def _prism(robot: PipeRobot, across: Array, size: float) -> Mesh:
    """Return one side of a prism that stands on z = 0, chambers along x; of an eighth of a prism alone the lower half.

    The side's faces: clamp, tip, core, air, outer, side (to its neighbours), symmetry_y, symmetry_z.
    """
    length = robot.length
    heights = [0.0, robot.chamber_height, robot.block_height]
    if robot.airways:
        heights += [robot.airway_height, robot.airway_height + robot.airway_roof]
    planes = [0.0, length]
    for low, (bottom, top) in zip(robot.chamber_starts, robot.blocks, strict=True):
        planes += [bottom, low, low + robot.chamber_length, top]
    cut = robot.eighth and robot.modules == 1
    up = [-1.0, *lines(_sorted(heights), size)]
    grid = BlockGrid(tensor(across, up), _sorted([*planes, *([length / 2.0] if cut else [])]))

    def box(width: float, low: float, high: float, height: float) -> dict[str, tuple[float, float]]:
        half = width / 2.0
        return {"u": (-half, min(half, float(across[-1]))), "v": (0.0, height), "w": (round(low, 9), round(high, 9))}

    grid = grid.fill("body", v=(-1.0, 0.0))
    wall = robot.expansion_wall
    for low, (bottom, top) in zip(robot.chamber_starts, robot.blocks, strict=True):
        grid = grid.fill("body", **box(robot.block_width, bottom, top, robot.block_height))
        grid = grid.hollow(_AIR, **box(robot.chamber_width, low, low + robot.chamber_length, robot.chamber_height))
    if robot.airways:
        bridge = robot.airway_width + 2.0 * robot.airway_side, robot.airway_height + robot.airway_roof
        for (_, low), (high, _) in pairwise(robot.blocks):
            grid = grid.fill("body", **box(bridge[0], low, high, bridge[1]))
            grid = grid.hollow(_AIR, **box(robot.airway_width, low - wall, high + wall, robot.airway_height))
    if cut:
        grid = grid.hollow(w=(round(length / 2.0, 9), round(length, 9)))
    patches = _borders(across, v=(-1.0, 0.0))
    if cut:
        patches.append(("symmetry_z", {"w": (round(length / 2.0, 9),) * 2}))
    else:
        patches.append(("tip", {"w": (round(length, 9),) * 2, "v": (-1.0, 0.0)}))
    patches += [("clamp", {"w": (0.0, 0.0), "v": (-1.0, 0.0)}), ("core", {"v": (-1.0, -1.0)})]
    return grid.mesh(lambda points: around_core(points, robot), patches=patches, bending_walls=robot.bending_walls)


def _bellows(robot: PipeRobot, across: Array, size: float) -> Mesh:
    """Return one side of the bellows where it stands: neck and end discs like the column, rings around them.

    v is -1 at the core, 0 at the column's flat side, and beyond it the height above the middle of the flat side.
    """
    bottom, top = robot.length, robot.length + robot.bellows_length
    wall, air = robot.ring_wall, robot.ring_air
    height = robot.ring_radius - robot.apothem
    inside = round(height - wall, 9)
    planes = [bottom, bottom + robot.end_disc, top - robot.end_disc, top, *([(bottom + top) / 2.0] * robot.eighth)]
    starts = [
        bottom + robot.end_disc + robot.ring_gap + i * (air + 2.0 * wall + robot.ring_gap) for i in range(robot.rings)
    ]
    for low in starts:
        planes += [low, low + wall, low + wall + air, low + 2.0 * wall + air]
    grid = BlockGrid(tensor(across, [-1.0, *lines([0.0, inside, round(height, 9)], size)]), _sorted(planes))
    grid = grid.fill("body", v=(-1.0, 0.0))
    for low in starts:
        grid = grid.fill("body", v=(0.0, round(height, 9)), w=(round(low, 9), round(low + 2.0 * wall + air, 9)))
        grid = grid.hollow(_MIDDLE, v=(-1.0, inside), w=(round(low + wall, 9), round(low + wall + air, 9)))
    patches = _borders(across)
    if robot.eighth:
        middle = round((bottom + top) / 2.0, 9)
        grid = grid.hollow(w=(middle, round(top, 9)))
        patches.append(("symmetry_z", {"w": (middle, middle)}))
    patches.append((_MIDDLE, {"v": (-1.0, -1.0)}))
    return grid.mesh(lambda points: _around_bellows(points, robot), patches=patches)


def _around_bellows(points: Array, robot: PipeRobot) -> Array:
    """Return places (n, 3) of points (u, v, w): the column up to v = 0, then to the rings' round inside and wall."""
    u, v, w = points.T
    column = around_core(np.column_stack([u, np.minimum(v, 0.0), w]), robot)
    far = np.hypot(column[:, 0], column[:, 1])
    inside = robot.ring_radius - robot.ring_wall
    height = inside - robot.apothem
    radius = np.where(v < 0.0, far, far + (inside - far) * np.clip(v / height, 0.0, 1.0))
    radius = np.where(v > height, inside + (v - height), radius)
    column[:, :2] *= (radius / far)[:, None]
    return column


def _disc(robot: PipeRobot, across: Array, low: float) -> Mesh:
    """Return the sector of a disc within the core: a wedge for each cell of the ring around it."""
    planes = np.array([low, low + robot.end_disc])
    rim = around_core(np.column_stack([across, np.full_like(across, -1.0), np.zeros_like(across)]), robot)[:, :2]
    flat = np.vstack([np.zeros(2), rim])
    corners = np.vstack([np.column_stack([flat, np.full(len(flat), z)]) for z in planes])
    # u falls anticlockwise
    ring = np.array([(0, j + 1, j) for j in range(1, len(rim))])
    points, nodes = quadratic(corners, "wedge18", np.hstack([ring, ring + len(flat)]))
    for local in (7, 10, 16):  # on the chord between two corners of the rim
        middle = (across[1:] + across[:-1]) / 2.0
        points[nodes[:, local], :2] = around_core(
            np.column_stack([middle, np.full_like(middle, -1.0), np.zeros_like(middle)]), robot
        )[:, :2]
    block = CellBlock("wedge18", "body", nodes)
    faces: dict[str, list[FaceBlock]] = {}
    outside, inside = ("core", _MIDDLE) if low == robot.length else (_MIDDLE, "core")
    halved = abs(across[-1]) < 1e-9
    for skin in boundary([block]):
        place = points[skin.nodes]
        labels = np.full(len(place), _SIDE, dtype=object)
        labels[np.abs(place[:, :, 2] - planes[0]).max(axis=1) < 1e-9] = outside
        labels[np.abs(place[:, :, 2] - planes[1]).max(axis=1) < 1e-9] = inside
        if halved:
            labels[np.abs(place[:, :, 1]).max(axis=1) < 1e-9] = "symmetry_y"
        for name in sorted(set(labels)):
            faces.setdefault(name, []).append(FaceBlock(skin.kind, skin.nodes[labels == name]))
    return Mesh(points, (block,), MappingProxyType({name: tuple(blocks) for name, blocks in faces.items()}))


def _borders(across: Array, v: tuple[float, float] | None = None) -> list[tuple[str, dict[str, tuple[float, float]]]]:
    """Return the patches at the two ends of the lines across: to the next side, or in the cut."""
    box = {} if v is None else {"v": v}
    first, last = float(across[0]), float(across[-1])
    if abs(last) < 1e-9:
        return [("symmetry_y", {"u": (last, last)}), (_SIDE, {"u": (first, first), **box})]
    return [(_SIDE, {"u": (end, end), **box}) for end in (first, last)]


def _named(robot: PipeRobot, mesh: Mesh, prism: str, side: int, turn: Callable[[Array], Array]) -> Mesh:
    """Return a side of a prism in its place, its faces called as the robot's are."""
    names = {_AIR: robot.row(prism, side), _SIDE: "symmetry_x", "outer": prism or "outer"}
    return placed(mesh, turn, rename=_kept(mesh, names))


def _sorted(stops: list[float]) -> list[float]:
    """Return stops in order, each once."""
    return sorted({round(stop, 9) for stop in stops})


def _kept(mesh: Mesh, names: dict[str, str]) -> dict[str, str]:
    return {old: new for old, new in names.items() if old in mesh.faces}
