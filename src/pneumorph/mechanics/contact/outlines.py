"""Rigid bodies as triangles, for pictures and files: planes and pipes as far as the soft body goes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.obstacles import HalfSpace, Obstacle, Pipe, direction

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_AROUND = 64  # flats of a pipe


def rigid_bodies(contacts: Sequence[Contact]) -> dict[str, Obstacle]:
    """Return name -> rigid body, each once: its own name, or that of the contact where it has none."""
    found: dict[str, Obstacle] = {}
    for contact in contacts:
        body = contact.against
        if body is not None and not isinstance(body, tuple) and body not in found.values():
            found[contact.body or contact.name] = body
    return found


def way_of(body: Obstacle, values: Mapping[str, float]) -> float:
    """Return how far (mm) a body has moved at the values of a programme."""
    return values.get(body.motion.name, 0.0) if body.motion else 0.0


def outline(body: Obstacle, low: Array, high: Array, way: float = 0.0) -> tuple[Array, Integers]:
    """Return points (n, d) and facets (m, d) of a rigid body: triangles, in the plane edges.

    low, high (d,): corners of a box, mm, that bodies without an end are shown in; way: how far (mm) the body has moved.
    """
    d = len(low)
    shift = np.zeros(d)
    if body.motion is not None:
        shift = way * direction(body.motion.direction, d, "motion", "direction")
    if isinstance(body, HalfSpace):
        points, facets = _plane(body, low - shift, high - shift)
    elif isinstance(body, Pipe):
        points, facets = _bore(body, low - shift, high - shift)
    else:
        points, facets = body.facets(d)
    return points + shift, facets


def _plane(body: HalfSpace, low: Array, high: Array) -> tuple[Array, Integers]:
    """Return the patch of the plane below the box: its corners dropped onto the plane, and their bounding rectangle."""
    d = len(low)
    normal = direction(body.normal, d, "half-space", "normal")
    middle = 0.5 * (low + high)
    foot = middle - ((middle - np.asarray(body.point)) @ normal) * normal
    corners = np.stack(np.meshgrid(*np.column_stack([low, high]), indexing="ij"), axis=-1).reshape(-1, d) - foot
    along = _across(normal)
    ends = [(float((corners @ a).min()), float((corners @ a).max())) for a in along]
    if d == 2:
        return foot + np.array(ends[0])[:, None] * along[0], np.array([[0, 1]])
    (a0, a1), (b0, b1) = ends
    places = np.array([(a0, b0), (a1, b0), (a1, b1), (a0, b1)])
    return foot + places @ np.array(along), np.array([[0, 1, 2], [0, 2, 3]])


def _bore(body: Pipe, low: Array, high: Array) -> tuple[Array, Integers]:
    """Return the bore as a tube as long as the box; in the plane a circle."""
    angle = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
    here, after = np.arange(_AROUND), (np.arange(_AROUND) + 1) % _AROUND
    if len(low) == 2:
        circle = body.radius * np.column_stack([np.cos(angle), np.sin(angle)])
        return np.asarray(body.point) + circle, np.column_stack([here, after])
    axis = direction(body.axis, 3, "pipe", "axis")
    first, second = _across(axis)
    circle = body.radius * (np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second))
    corners = np.stack(np.meshgrid(*np.column_stack([low, high]), indexing="ij"), axis=-1).reshape(-1, 3)
    reach = (corners - np.asarray(body.point)) @ axis
    points = np.concatenate([np.asarray(body.point) + circle + end * axis for end in (reach.min(), reach.max())])
    sides = [(here, after, _AROUND + after), (here, _AROUND + after, _AROUND + here)]
    return points, np.concatenate([np.column_stack(side) for side in sides])


def _across(normal: Array) -> list[Array]:
    """Return the directions of length 1 across a direction (d,): one in the plane, two in space."""
    if len(normal) == 2:
        return [np.array([-normal[1], normal[0]])]
    first = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    first /= np.linalg.norm(first)
    return [first, np.cross(normal, first)]
