"""Plane crawler -> triangles: a polar grid about each channel, a strip for the layer, mirrored about its middle."""

from __future__ import annotations

import math
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry.crawler import PlaneCrawler
from pneumorph.mesh.memory import check_cells
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.structured import quadratic
from pneumorph.mesh.topology import boundary

Array = NDArray[np.float64]


def mesh_crawler(crawler: PlaneCrawler, size: float) -> Mesh:
    """Return the mesh of a plane crawler in triangle6, plane strain; size: largest edge along its outline, mm.

    The mesh is its own mirror image about the middle of each channel. Raises MeshError where it would be too large.
    """
    side, count = 2.0 * crawler.outer_radius, crawler.segments * crawler.channels
    along = 2 * max(2, math.ceil(0.5 * side / size))  # even: a node in the middle of each side
    wall = max(2, math.ceil((crawler.outer_radius - crawler.inner_radius) / size))
    strip = max(1, math.ceil(crawler.layer / size))
    check_cells(2.0 * along * (4 * wall + strip) * count, f"the crawler at size {size:.3g} mm")
    steps = _steps(along)
    heels = [(i == 0, i == count - 1) for i in range(count)]
    middle = side * (np.arange(count) + 0.5)
    soft = np.stack([_channel(crawler, steps, wall, heel) for heel in heels])
    soft[..., 0] += middle[:, None, None]
    soft[..., 1] += crawler.layer + crawler.outer_radius
    stiff = np.stack([_strip(_below(crawler, steps, heel), crawler.layer, strip) for heel in heels])
    stiff[..., 0] += middle[:, None, None]
    corners = np.concatenate([soft.reshape(-1, 2), stiff.reshape(-1, 2)])
    # neighbours computed the same corner from their own middles: merge to a millionth of an edge
    keys = np.round(corners / (1e-6 * size)).astype(np.int64)
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    points, nodes = quadratic(corners[first], "triangle6", number.reshape(-1, 3))
    split = soft.size // 6  # triangles of two coordinates at three corners
    blocks = (CellBlock("triangle6", "body", nodes[:split]), CellBlock("triangle6", "base", nodes[split:]))
    (skin,) = boundary(blocks)
    points, labels = _rounded(points, skin, crawler)
    faces = {name: (FaceBlock("line3", skin.nodes[labels == name]),) for name in crawler.face_names}
    return Mesh(points, blocks, MappingProxyType(faces), "plane_strain", MappingProxyType(dict(crawler.bending_walls)))


def _steps(along: int) -> Array:
    """Return where the nodes of a side stand (along + 1,), from -1 to 1."""
    return np.linspace(-1.0, 1.0, along + 1)


def _flat(crawler: PlaneCrawler, steps: Array) -> tuple[float, float]:
    """Return half the length of a flat side, mm, and the share of the steps on it: its ends are nodes."""
    flat = crawler.outer_radius - crawler.rounding
    many = (len(steps) - 1) // 2
    return flat, max(1, round(many * flat / crawler.outer_radius)) / many


def _outline(crawler: PlaneCrawler, steps: Array) -> Array:
    """Return points (n, 2) of the right side of the rounded square about the origin."""
    flat, share = _flat(crawler, steps)
    turn = np.clip((np.abs(steps) - share) / max(1.0 - share, 1e-12), 0.0, 1.0) * 0.25 * np.pi
    x = flat + crawler.rounding * np.cos(turn)
    y = np.sign(steps) * (flat * np.minimum(np.abs(steps) / share, 1.0) + crawler.rounding * np.sin(turn))
    return np.column_stack([x, y])


def _below(crawler: PlaneCrawler, steps: Array, heel: tuple[bool, bool]) -> Array:
    """Return where the nodes of the layer stand (n,) along a channel, about its middle: those of its flat side, too.

    heel: whether the corner above is a square one, behind and before.
    """
    flat, share = _flat(crawler, steps)
    beside = np.clip((np.abs(steps) - share) / max(1.0 - share, 1e-12), 0.0, 1.0) * crawler.rounding
    x = np.sign(steps) * (flat * np.minimum(np.abs(steps) / share, 1.0) + beside)
    square = (heel[0] & (steps < 0.0)) | (heel[1] & (steps > 0.0))
    return np.where(square, crawler.outer_radius * steps, x)


def _channel(crawler: PlaneCrawler, steps: Array, wall: int, heel: tuple[bool, bool]) -> Array:
    """Return triangles (t, 3, 2) between a rounded square and the circle in it, about the origin.

    heel: whether the lower corner is a square one, behind (x < 0) and before.
    """
    side, sharp = _outline(crawler, steps), _outline(replace(crawler, rounding=0.0), steps)
    quarters = [np.array([[c, s], [-s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))]  # anticlockwise from x > 0
    low, high = (steps < 0.0)[:, None], (steps > 0.0)[:, None]
    kept = [low & heel[1], np.zeros_like(low), high & heel[0], (low & heel[0]) | (high & heel[1])]
    parts = [np.where(keep, sharp, side) @ quarter for keep, quarter in zip(kept, quarters, strict=True)]
    square = np.concatenate([part[:-1] for part in parts])  # a side ends where the next begins
    steps = steps[:-1]
    angle = np.repeat(np.arange(4), len(steps)) * 0.5 * np.pi + np.tile(steps, 4) * 0.25 * np.pi
    circle = crawler.inner_radius * np.column_stack([np.cos(angle), np.sin(angle)])
    share = np.linspace(0.0, 1.0, wall + 1)[:, None, None]
    grid = (1.0 - share) * circle + share * square  # (wall + 1, around, 2)
    after = np.roll(grid, -1, axis=1)
    return _halved(np.stack([grid[:-1], grid[1:], after[1:], after[:-1]], axis=2).reshape(-1, 4, 2))


def _strip(places: Array, height: float, across: int) -> Array:
    """Return triangles (t, 3, 2) of a rectangle on y = 0, its nodes at these places along x."""
    x, y = np.meshgrid(places, np.linspace(0.0, height, across + 1))
    grid = np.stack([x, y], axis=2)
    quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)
    return _halved(quads.reshape(-1, 4, 2))


def _halved(quads: Array) -> Array:
    """Return triangles (2 q, 3, 2) of quadrilaterals; those at x > 0 mirror the others."""
    right = quads[:, :, 0].mean(axis=1) > 0.0
    left = np.concatenate([quads[~right][:, [0, 1, 2]], quads[~right][:, [0, 2, 3]]])
    return np.concatenate([left, quads[right][:, [0, 1, 3]], quads[right][:, [1, 2, 3]]])


def _rounded(points: Array, skin: FaceBlock, crawler: PlaneCrawler) -> tuple[Array, NDArray[np.str_]]:
    """Return the points with middles of edges on the circles of the channels, and the name of each boundary edge."""
    side, radius = 2.0 * crawler.outer_radius, crawler.inner_radius
    ends = points[skin.nodes[:, :2]]
    middle = ends.mean(axis=1)
    number = np.clip(middle[:, 0] // side, 0, crawler.segments * crawler.channels - 1)
    centre = np.column_stack([side * (number + 0.5), np.full(len(middle), crawler.layer + 0.5 * side)])
    channel = (np.abs(np.linalg.norm(ends - centre[:, None], axis=2) - radius) < 1e-6 * radius).all(axis=1)
    points = points.copy()
    arm = middle[channel] - centre[channel]
    arm *= radius / np.linalg.norm(arm, axis=1)[:, None]
    points[skin.nodes[channel, 2]] = centre[channel] + arm
    low = middle[:, 1] < 1e-6 * side
    end = (middle[:, 1] < crawler.layer + 0.5 * side) & (np.abs(middle[:, 0] - centre[:, 0]) > 0.25 * side)
    behind, before = middle[:, 0] < 0.25 * side, middle[:, 0] > crawler.length - 0.25 * side
    labels = np.full(len(middle), "outer", dtype="<U16")
    labels[(low & (middle[:, 0] < 0.5 * crawler.length)) | (end & behind)] = "rear_foot"
    labels[(low & (middle[:, 0] > 0.5 * crawler.length)) | (end & before)] = "front_foot"
    labels[channel] = np.array(crawler.cavities)[(number[channel] // crawler.channels).astype(int)]
    return points, labels
