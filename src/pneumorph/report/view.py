"""From where to look: one camera for all states of a run, and the plane of the cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics import State
from pneumorph.mechanics.contact.apart import body_of_nodes
from pneumorph.mesh.mesh import Mesh
from pneumorph.report.cut import Plane
from pneumorph.report.surface import spatial

Array = NDArray[np.float64]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class View:
    """A parallel projection: `direction` points to the camera, `up` upwards, both of length 1.

    centre: the point (mm) in the middle of the picture; width, height: what the picture shows, mm.
    """

    direction: Vector
    up: Vector
    centre: Vector = (0.0, 0.0, 0.0)
    width: float = 1.0
    height: float = 1.0

    @property
    def right(self) -> Array:
        """The direction to the right in the picture."""
        return np.cross(self.up, self.direction)

    @property
    def aspect(self) -> float:
        """Width over height."""
        return self.width / self.height

    def fitted(self, clouds: Iterable[Array], margin: float = 0.025, narrowest: float = 0.15) -> View:
        """Return the view that shows all points (n, 2 or 3) of all clouds, not narrower or flatter than `narrowest`."""
        axes = np.column_stack([self.right, self.up, self.direction])
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for cloud in clouds:
            seen = spatial(cloud) @ axes
            low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
        width, height = (high - low)[:2] + 2.0 * margin * float((high - low)[:2].max())
        width, height = max(width, narrowest * height), max(height, narrowest * width)
        return replace(self, centre=_vector(axes @ (0.5 * (low + high))), width=float(width), height=float(height))

    def turned(self, aside: float = 35.0, above: float = 25.0) -> View:
        """Return the view from the side and above, by angles in degrees; fit it again."""
        a, b = np.radians([aside, above])
        away, up, right = np.array(self.direction), np.array(self.up), self.right
        flat = np.cos(a) * away + np.sin(a) * right
        return replace(
            self,
            direction=_vector(np.cos(b) * flat + np.sin(b) * up),
            up=_vector(np.cos(b) * up - np.sin(b) * flat),
        )


def face_on(states: Sequence[State]) -> View:
    """Return the view onto the plane in which the body bends, fitted to all states.

    The plane holds the longest side of the body at rest and the mean motion, across it, of the nodes that move most.
    A body that does not bend is seen along the shortest side of its box. Of several bodies that one counts that moves
    most.
    """
    mesh = states[0].model.mesh
    clouds = [mesh.points, *(state.positions for state in states)]
    if mesh.dimension == 2:
        return View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)).fitted(clouds)
    own = mesh.points[_moving_most(states)]
    along = _longest(own)
    across = max((_sideways(state, along) for state in states), key=lambda motion: float(np.linalg.norm(motion)))
    if np.linalg.norm(across) < 0.01 * mesh.size:
        beside = np.eye(3) - np.outer(along, along)  # rows: the axes without their part along the body
        extents = np.ptp(own, axis=0) * np.linalg.norm(beside, axis=1)
        across = beside[int(np.argmax(extents))]
    direction = _snapped(np.cross(along, across))
    # z stands upright unless it points at the camera; of the two sides, the one from which x or y runs to the right
    up = np.array([0.0, 0.0, 1.0]) if abs(direction[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    up -= direction * (direction @ up)
    up /= np.linalg.norm(up)
    lead = across if abs(along @ up) > 0.7 else along
    if np.cross(up, direction) @ lead < 0.0:
        direction = -direction
    return View(_vector(direction), _vector(up)).fitted(clouds)


def cut_plane(states: Sequence[State], view: View) -> tuple[Plane, View]:
    """Return a plane along the body through its largest pressurised cavity, and the view onto it.

    The plane holds the longest side of the body at rest, its middle, and the middle of the cavity with the highest
    pressure of all states; where these lie in line, it is the bending plane. Of several bodies that one counts that
    moves most.
    """
    mesh = states[0].model.mesh
    own = mesh.points[_moving_most(states)]
    middle = 0.5 * (own.min(axis=0) + own.max(axis=0))
    normal = np.array(view.direction)
    surfaces = states[0].model.surfaces
    if surfaces:
        name = max(surfaces, key=lambda one: max(abs(state.pressure[one]) for state in states))
        nodes = np.unique(np.concatenate([block.nodes.ravel() for block in surfaces[name].blocks]))
        box = mesh.points[nodes]
        along = _longest(own)
        offset = 0.5 * (box.min(axis=0) + box.max(axis=0)) - middle
        offset -= along * (along @ offset)
        if np.linalg.norm(offset) > 0.02 * mesh.size:
            normal = _snapped(np.cross(along, offset))
            normal *= -1.0 if normal @ view.direction < 0.0 else 1.0
    up = np.array(view.up) - normal * (normal @ np.array(view.up))
    if np.linalg.norm(up) < 0.1:  # seen from above: what lay behind is up
        up = -np.array(view.direction) + normal * (normal @ np.array(view.direction))
    towards = View(_vector(normal), _vector(up / np.linalg.norm(up)))
    return Plane(_vector(middle), _vector(normal)), towards.fitted(
        [mesh.points, *(state.positions for state in states)]
    )


def long_axis(mesh: Mesh) -> Array:
    """Return the coordinate direction in which a solid is longest."""
    return _longest(mesh.points[: mesh.solid])


def _longest(points: Array) -> Array:
    return np.eye(3)[int(np.argmax(np.ptp(points, axis=0)))]


def _moving_most(states: Sequence[State]) -> NDArray[np.int64]:
    """Return the nodes of the connected body that moves most, by the mean over its nodes; of all in a single one."""
    mesh = states[0].model.mesh
    label = body_of_nodes(mesh)[: mesh.solid]
    moved = np.max([np.linalg.norm(state.displacement[: mesh.solid], axis=1) for state in states], axis=0)
    mean = np.bincount(label, moved) / np.bincount(label)
    return np.flatnonzero(label == int(np.argmax(mean)))


def _sideways(state: State, along: Array) -> Array:
    """Return the mean displacement, across the axis, of the hundredth part of the nodes that moves most, mm."""
    moved = state.displacement[: state.model.mesh.solid]
    size = np.linalg.norm(moved, axis=1)
    mean = moved[size >= np.quantile(size, 0.99)].mean(axis=0)
    return np.asarray(mean - along * (along @ mean))


def _snapped(direction: Array) -> Array:
    """Return a direction of length 1, along a coordinate axis if it is within five degrees of it."""
    unit = direction / np.linalg.norm(direction)
    nearest = np.round(unit)
    return np.asarray(nearest if np.abs(unit).max() > np.cos(np.radians(5.0)) else unit)


def _vector(values: Array) -> Vector:
    x, y, z = (float(v) for v in values)
    return x, y, z
