"""Quadruped -> hexahedra: its plan as quadrilaterals, a column of cells on each, without those of the channels."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry.quadruped import CENTRE, Quadruped
from pneumorph.mesh.grid import BlockGrid
from pneumorph.mesh.memory import check_cells
from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.mesh.quads import Quads, lines

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Labels = NDArray[np.object_]

_ACROSS = 3.0  # edges across a leg over those along it: it bends along itself
_OTHER_SIDE = {"PN1": "PN2", "PN3": "PN4"}


@dataclass(frozen=True, eq=False)
class _Part:
    """Quadrilaterals of the plan (q, 4, 2), and in which of them there is air (q,), called by its cavity."""

    quads: Array
    air: Mask
    cavity: str

    def mirrored(self, axis: int, cavity: str) -> _Part:
        """Return the image across x = 0 (axis 0) or y = 0 (axis 1)."""
        sign = np.where(np.arange(2) == axis, -1.0, 1.0)
        return _Part(sign * self.quads[:, ::-1], self.air, cavity)


def mesh_quadruped(robot: Quadruped, size: float) -> Mesh:
    """Return the mesh of a quadruped in hexahedron27, its own mirror image about both planes of symmetry.

    size: largest edge along legs and centre, mm; edges across them and through the height are up to three times as
    long. Raises MeshError where it would be too large.
    """
    across = _ACROSS * size
    check_cells(robot.plan_area / (size * across) * max(3.0, robot.height / across), f"the quadruped at {size:.3g} mm")
    floor, roof = robot.layer, robot.layer + robot.channel_depth
    heights = lines([0.0, floor, roof, robot.height], across)
    middle = 0.5 * (heights[1:] + heights[:-1])
    parts = _plan(robot, size)
    quads = np.concatenate([part.quads for part in parts])
    cavity = np.concatenate([np.full(len(part.quads), part.cavity, dtype=object) for part in parts])
    hollow = np.concatenate([part.air for part in parts])[:, None] & (middle > floor) & (middle < roof)
    solid = np.where(middle < floor, *np.array(["base", "body"], dtype=object))
    mesh = BlockGrid(
        Quads(quads.reshape(-1, 2), np.arange(4 * len(quads)).reshape(-1, 4)),
        heights,
        domain=np.where(hollow, "", solid),
        air=np.where(hollow, cavity[:, None], ""),
    ).mesh(bending_walls=robot.bending_walls)
    (outer,) = mesh.faces["outer"]
    labels = _outside(robot, mesh.points[outer.nodes[:, :4]])
    faces = dict(mesh.faces)
    faces |= {name: (FaceBlock(outer.kind, outer.nodes[labels == name]),) for name in set(labels)}
    return replace(mesh, faces=MappingProxyType({name: faces[name] for name in robot.face_names}))


def _plan(robot: Quadruped, size: float) -> list[_Part]:
    """Return the left half of the plan, and its image on the right unless the robot is a half."""
    half, ahead, aside = 0.5 * robot.centre_length, *_directions(robot)
    leg, inside = _columns(robot, _ACROSS * size)
    along, channel = _rows(robot.leg_length, robot.leg_channels, robot, size)
    grid = _crotch(robot) + along[:, None, None] * ahead + leg[None, :, None] * aside
    front = _Part(_quads(grid), np.outer(channel, inside).ravel(), "PN3")
    centre = robot.narrowing * leg
    end = np.column_stack([np.full(len(centre), half), centre])
    steps = math.ceil(float(np.linalg.norm(grid[0] - end, axis=1).max()) / (_ACROSS * size))
    share = np.linspace(0.0, 1.0, steps + 1)[:, None, None]
    turn = _quads((1.0 - share) * end + share * grid[0])
    joint = _Part(turn, np.zeros(len(turn), dtype=bool), "")
    along, channel = _rows(robot.centre_length, robot.centre_channels, robot, size, half)
    block = np.stack(np.broadcast_arrays((along - half)[:, None], centre[None, :]), axis=2)
    body = _Part(_quads(block), np.outer(channel, inside).ravel(), CENTRE)
    left = [front, joint, body, front.mirrored(0, "PN1"), joint.mirrored(0, "")]
    return left if robot.half else left + [p.mirrored(1, _OTHER_SIDE.get(p.cavity, p.cavity)) for p in left]


def _directions(robot: Quadruped) -> tuple[Array, Array]:
    """Return the directions (2,) along the left front leg, to its tip, and across it, outward."""
    cosine, sine = math.cos(robot.leg_angle), math.sin(robot.leg_angle)
    return np.array([cosine, sine]), np.array([-sine, cosine])


def _crotch(robot: Quadruped) -> Array:
    """Return where the front legs part (2,)."""
    return np.array([0.5 * robot.centre_length + robot.junction + robot.leg_width * math.sin(robot.leg_angle), 0.0])


def _columns(robot: Quadruped, across: float) -> tuple[Array, Mask]:
    """Return lines across a leg from its inner side, mm, and which columns have channels.

    The centre's left half has as many lines, closer to each other.
    """
    return _alternating(np.full(1, robot.side_wall), robot.channel_width, robot.leg_width, across)


def _rows(length: float, channels: int, robot: Quadruped, size: float, *more: float) -> tuple[Array, Mask]:
    """Return lines along a leg or the centre, also at `more`, mm, and which rows are channels."""
    pitch = robot.channel + robot.gap
    starts = 0.5 * (length - channels * pitch + robot.gap) + pitch * np.arange(channels, dtype=np.float64)
    return _alternating(starts, robot.channel, length, size, *more)


def _alternating(starts: Array, width: float, length: float, size: float, *more: float) -> tuple[Array, Mask]:
    """Return lines from 0 to length, also at `more`, mm, and which gaps between them lie within `width` of a start."""
    places = lines(sorted([0.0, *starts, *(starts + width), *more, length]), size)
    middle = 0.5 * (places[1:] + places[:-1])
    within: Mask = np.any((middle[:, None] > starts) & (middle[:, None] < starts + width), axis=1)
    return places, within


def _quads(grid: Array) -> Array:
    """Return the quadrilaterals (rows * columns, 4, 2) of a grid of corners, anticlockwise."""
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 2)


def _outside(robot: Quadruped, corners: Array) -> Labels:
    """Return the name of each face of the outside, by its corners (faces, 4, 3)."""
    small = 1e-6 * robot.height
    low = corners[..., 2].max(axis=1) < small
    middle = corners.mean(axis=1)
    ahead, _ = _directions(robot)
    along = (np.abs(corners[..., :2]) - _crotch(robot)) @ ahead  # from the root of its leg
    tip = (np.abs(along - robot.leg_length) < small).all(axis=1)
    rear, left = middle[:, 0] < 0.0, middle[:, 1] > 0.0
    leg = np.where(rear, np.where(left, "PN1", "PN2"), np.where(left, "PN3", "PN4")).astype(object)
    belly = np.where(rear, "belly_rear", "belly_front").astype(object)
    labels = np.where(low & (along.mean(axis=1) < 0.0), belly, "outer").astype(object)
    labels = np.where(tip | (low & (along.mean(axis=1) > 0.0)), "foot_" + leg, labels)
    cut = robot.half & (np.abs(corners[..., 1]).max(axis=1) < small)
    return np.where(cut, "symmetry_y", labels)
