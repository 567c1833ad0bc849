"""Forearm -> hexahedra in layers along it, finest where it is pressed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry.forearm import Forearm
from pneumorph.mesh.grid import BlockGrid
from pneumorph.mesh.joining import placed
from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.quads import Quads, tensor

Array = NDArray[np.float64]

_CORE = 0.5  # half side of the square in the middle of the sheet, whose own is 1
_SQUARE = 0.55  # half side of that square as a share of the section's half-axes: no cell is much longer than wide
_FINE = 12.0  # mm on either side of the pressed place that have layers of the smallest thickness
_GROWTH, _THICKEST = 1.5, 4.0  # from layer to layer beyond, up to so many times the smallest


def mesh_forearm(arm: Forearm, size: float) -> Mesh:
    """Return the forearm in hexahedra with the faces wrist, elbow and skin.

    size: about the largest edge across the arm, and of the layers near the pressed place, mm. Raises MeshError where
    the mesh would be too large.
    """
    a, b = arm.half_axes(arm.pressed)
    around = max(2, round(np.pi * np.sqrt(0.5 * (a * a + b * b)) / (2.0 * size)))  # cells in a quarter of its girth
    rings = max(1, round((1.0 - _SQUARE) * b / size))

    def mapping(points: Array) -> Array:
        y, z = _disc(points[:, :2]).T
        half = np.array(arm.half_axes(points[:, 2]))
        return np.column_stack([points[:, 2], half[0] * y, half[1] * z])

    grid = BlockGrid(_sheet(around, rings), _layers(arm, size)).fill("body")
    ends = [("wrist", {"w": (0.0, 0.0)}), ("elbow", {"w": (arm.length, arm.length)})]
    return placed(grid.mesh(mapping, patches=ends), rename={"outer": "skin"})


def _sheet(around: int, rings: int) -> Quads:
    """Return a square of half side 1: a square grid in its middle, and rings of quadrilaterals around that."""
    along = np.linspace(-1.0, 1.0, around + 1)
    out = np.linspace(_CORE, 1.0, rings + 1)
    side = np.stack([np.repeat(out[:, None], around + 1, axis=1), out[:, None] * along], axis=2)  # to the right
    cells = np.stack([side[:-1, :-1], side[1:, :-1], side[1:, 1:], side[:-1, 1:]], axis=2).reshape(-1, 4, 2)
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])  # by a quarter, applied to rows
    sides = [cells @ np.linalg.matrix_power(turn, k) for k in range(4)]
    places = np.concatenate(sides).reshape(-1, 2)
    frame = Quads(places, np.arange(len(places)).reshape(-1, 4))
    return tensor(_CORE * along, _CORE * along) + frame


def _disc(points: Array) -> Array:
    """Return where points (n, 2) of the sheet lie in the unit disc: its outline goes to the circle."""
    far = np.abs(points).max(axis=1)
    out = np.maximum(far, _CORE)
    # the nearest side of the square, and how far along it from its middle, -1 to 1
    upright = np.abs(points[:, 0]) >= np.abs(points[:, 1])
    level = np.where(upright, points[:, 1], points[:, 0]) / out
    sign = np.sign(np.where(upright, points[:, 0], points[:, 1]))
    angle = 0.25 * np.pi * level
    circle = np.column_stack([np.cos(angle), np.sin(angle)]) * sign[:, None] ** [1, 0]
    square = _SQUARE * np.column_stack([sign, level])
    share = ((out - _CORE) / (1.0 - _CORE))[:, None]
    ring = (1.0 - share) * square + share * circle
    ring[~upright] = ring[~upright][:, ::-1]
    inside = far <= _CORE
    ring[inside] = points[inside] * (_SQUARE / _CORE)
    return np.asarray(ring)


def _layers(arm: Forearm, size: float) -> Array:
    """Return the planes between the layers, x in mm: evenly near the pressed place, growing away from it."""
    low, high = arm.pressed - _FINE, arm.pressed + _FINE
    low, high = (0.0 if low < size else low), (arm.length if high > arm.length - size else high)
    fine = np.linspace(low, high, max(1, round((high - low) / size)) + 1)
    return np.concatenate([low - _growing(low, size)[::-1], fine, high + _growing(arm.length - high, size)])


def _growing(length: float, size: float) -> Array:
    """Return the ends (n,) of steps from 0 to a length, mm, that grow from a size; none for no length."""
    steps: list[float] = []
    while sum(steps) < length - 0.5 * size:
        steps.append(size * min(_GROWTH ** (len(steps) + 1), _THICKEST))
    total = sum(steps)
    return np.cumsum(steps) * (length / total) if steps else np.empty(0)
