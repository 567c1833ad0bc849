"""A vehicle on its bed of grains as a picture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pneumorph.report import style
from pneumorph.report.render import Layer, Picture, Scene
from pneumorph.report.view import View
from pneumorph.terrain.granular import Vehicle

Array = NDArray[np.float64]

_SAND, _WHEEL, _BODY = style.rgb("#c2a878"), style.rgb("#d55e00"), style.rgb("#33547d")
_DEEP = 120.0  # mm below the surface down to which grains are drawn: those further down are hidden
_AROUND = np.array([650.0, 330.0, 100.0])  # mm of bed on each side of the vehicle


def bed_picture(vehicle: Vehicle, way: Mapping[str, Array], height: int = 620) -> Picture:
    """Return the vehicle and the bed after a run (a trajectory's arrays), seen from the side and above.

    Raises EngineError where pictures cannot be drawn.
    """
    places, radii, level = way["places"].astype(float), way["radii"].astype(float), float(way["level"])
    middle = way["centre"][-1]
    near = (np.abs(places - middle)[:, :2] < 1.6 * _AROUND[:2]).all(axis=1)
    seen = near & (places[:, 2] > level - _DEEP)
    sand = _grains(places[seen], radii[seen])
    view = View((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)).turned(-30.0, 32.0)
    layers = [sand, *_vehicle(vehicle, way)]
    view = view.fitted(
        [middle + _AROUND * sign for sign in np.array([[-1, -1, -1], [1, 1, 1], [1, -1, 0], [-1, 1, 0]])[:, None]]
    )
    with Scene(view, height) as scene:
        return scene.draw(layers)


def _grains(places: Array, radii: Array) -> Layer:
    """Return spheres of 80 triangles; their browns differ a little, so that grains can be told apart."""
    points, triangles = _sphere()
    n = len(places)
    corners = (places[:, None] + radii[:, None, None] * points).reshape(-1, 3)
    faces = (triangles + len(points) * np.arange(n)[:, None, None]).reshape(-1, 3)
    shade = np.random.default_rng(0).uniform(0.85, 1.1, n)
    colour = np.repeat(np.clip(shade[:, None] * _SAND, 0.0, 1.0), len(points), axis=0)
    return Layer(corners, faces, colour=colour)


def _sphere() -> tuple[Array, NDArray[np.int64]]:
    """Return an icosahedron whose edges are halved once, on the unit sphere."""
    g = 0.5 * (1.0 + 5.0**0.5)
    corners = [(s * a, t * b, 0.0) for a, b in ((1.0, g),) for s in (-1, 1) for t in (-1, 1)]
    points = np.array([np.roll(c, k) for k in range(3) for c in corners])
    edge = np.linalg.norm(points[:, None] - points[None], axis=2)
    near = np.isclose(edge, 2.0)
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    triangles = []
    for i, j, k in faces:
        a, b, c = points[i], points[j], points[k]
        if np.dot(np.cross(b - a, c - a), a) < 0.0:
            b, c = c, b
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        triangles += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    soup = np.array(triangles).reshape(-1, 3)
    soup /= np.linalg.norm(soup, axis=1, keepdims=True)
    unique, number = np.unique(np.round(soup, 9), axis=0, return_inverse=True)
    return np.asarray(unique, dtype=float), np.asarray(number.reshape(-1, 3), dtype=np.int64)


def _vehicle(vehicle: Vehicle, way: Mapping[str, Array]) -> list[Layer]:
    """Return body and wheels as they are at the end."""
    centre = way["centre"][-1]
    body = np.eye(3) if vehicle.single else _rotation(way["pose"][-1][3:7])
    rover, layers = vehicle.rover, []
    for (x, y), angle in zip(vehicle.axles, way["turn"][-1], strict=True):
        cos, sin = np.cos(angle), np.sin(angle)
        spin = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
        points = (vehicle.surface.points @ spin.T + [x, y, 0.0]) @ body.T + centre
        triangles = vehicle.surface.triangles
        # triangles of their own keep edges sharp
        layers.append(Layer(points[triangles].reshape(-1, 3), np.arange(triangles.size).reshape(-1, 3), colour=_WHEEL))
    if not vehicle.single:
        half = 0.5 * np.array([rover.length, rover.width, rover.height])
        box = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) * half
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        faces = np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])
        points = box @ body.T + centre
        layers.append(Layer(points[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3), colour=_BODY))
    return layers


def _rotation(q: Array) -> Array:
    """Return the matrix of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
