"""Flat sheets of quadrilaterals that block grids stand on: grids of lines, rectangles within rectangles, finer ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import MeshError
from pneumorph.mesh.structured import quadratic

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_CLOSE = 1e-7  # of the size of a sheet: corners nearer to each other are one


@dataclass(frozen=True, eq=False)
class Quads:
    """Quadrilaterals in a plane: points (n, 2), mm, and corners (m, 4), anticlockwise.

    Corners that lie on each other are made one. Raises MeshError for quadrilaterals that are not convex, run clockwise
    or lie on each other.
    """

    points: Array
    corners: Integers

    def __post_init__(self) -> None:
        points, corners = np.asarray(self.points, dtype=float), np.asarray(self.corners, dtype=np.int64)
        if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
            raise MeshError(f"quads: points of shape {points.shape}, expected finite (n, 2)")
        if corners.ndim != 2 or corners.shape[1] != 4 or len(corners) == 0:
            raise MeshError(f"quads: corners of shape {corners.shape}, expected (at least 1, 4)")
        if corners.min() < 0 or corners.max() >= len(points):
            raise MeshError(f"quads: corner numbers must lie in 0..{len(points) - 1}")
        keys = np.round(points / (_CLOSE * np.ptp(points, axis=0).max())).astype(np.int64)
        _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        points, corners = points[first], number.ravel()[corners]
        ahead, back = np.roll(corners, -1, axis=1), np.roll(corners, 1, axis=1)
        a, b = points[ahead] - points[corners], points[back] - points[corners]
        if (a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0] <= 0.0).any():
            raise MeshError("quads: expected convex quadrilaterals with their corners anticlockwise")
        sides = np.stack([corners, ahead], axis=2).reshape(-1, 2)
        if len(np.unique(sides, axis=0)) < len(sides):
            raise MeshError("quads: two quadrilaterals lie on the same side of an edge")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "corners", corners)

    @cached_property
    def quadratic(self) -> tuple[Array, Integers]:
        """Points and nodes (m, 9) of the same quadrilaterals with mid nodes."""
        return quadratic(self.points, "quad9", self.corners)

    def inside(
        self, low: tuple[float, float], high: tuple[float, float], tolerance: float
    ) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return which quadrilaterals (m,) lie in a rectangle, and which share more than a border with it."""
        corner = self.points[self.corners]
        least, most = np.maximum(low, self.points.min(axis=0)), np.minimum(high, self.points.max(axis=0))
        whole = ((corner > least - tolerance) & (corner < most + tolerance)).all(axis=(1, 2))
        overlap = (corner.max(axis=1) > least + tolerance).all(axis=1)
        overlap &= (corner.min(axis=1) < most - tolerance).all(axis=1)
        # convex shapes are apart if a side of one has all of the other behind it
        along = np.roll(corner, -1, axis=1) - corner
        normal = np.stack([along[..., 1], -along[..., 0]], axis=2) / np.linalg.norm(along, axis=2, keepdims=True)
        box = np.array([least, (most[0], least[1]), most, (least[0], most[1])])
        distance = np.einsum("msi,msbi->msb", normal, box[None, None] - corner[:, :, None])
        overlap &= (distance.min(axis=2) < -tolerance).all(axis=1)
        return whole, overlap

    def split(self, count: int) -> Quads:
        """Return the sheet with each quadrilateral cut into count x count."""
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise MeshError(f"quads: split({count!r}): expected a whole number of at least 1")
        corner = self.points[self.corners]
        step = np.linspace(0.0, 1.0, count + 1)
        v, u = (part[..., None] for part in np.meshgrid(step, step, indexing="ij"))
        low = corner[:, None, None, 0] * (1 - u) + corner[:, None, None, 1] * u
        high = corner[:, None, None, 3] * (1 - u) + corner[:, None, None, 2] * u
        place = low * (1 - v) + high * v
        parts = [place[:, :-1, :-1], place[:, :-1, 1:], place[:, 1:, 1:], place[:, 1:, :-1]]
        return _from_places(np.stack(parts, axis=3).reshape(-1, 4, 2))

    def __add__(self, other: Quads) -> Quads:
        """Return both sheets as one; they meet where their corners coincide."""
        return _from_places(np.concatenate([sheet.points[sheet.corners] for sheet in (self, other)]))


def tensor(u: ArrayLike, v: ArrayLike) -> Quads:
    """Return the grid of lines at u and v, mm, growing; raises MeshError where they do not."""
    x, y = checked_lines("u", u), checked_lines("v", v)
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=2)
    cells = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2)
    return _from_places(cells.reshape(-1, 4, 2))


def nested(rectangles: Sequence[tuple[float, float]], rings: Sequence[int] | None = None) -> Quads:
    """Return rectangles within rectangles that stand on the line v = 0 with their middles at u = 0.

    The innermost is one quadrilateral; each further one is three: left, above and right of what it holds, with a corner
    from each corner to the next. Fewer than a grid of the same lines.

    rectangles: (width, height) in mm, from the inside out, both growing.
    rings: how many rings of three lie between a rectangle and the next; left out, one.
    Raises MeshError for rectangles that are not within the next or counts out of range.
    """
    size = np.asarray(rectangles, dtype=float)
    if size.ndim != 2 or size.shape[1] != 2 or not np.isfinite(size).all() or size.shape[0] == 0:
        raise MeshError(f"nested: rectangles = {rectangles!r}: expected pairs (width, height) in mm")
    if (size[0] <= 0.0).any() or (np.diff(size, axis=0) <= 0.0).any():
        listed = ", ".join(f"{w:g} x {h:g}" for w, h in size)
        raise MeshError(f"nested: {listed} mm: expected each rectangle wider and higher than the one before")
    counts = [1] * (len(size) - 1) if rings is None else list(rings)
    if len(counts) != len(size) - 1 or any(isinstance(n, bool) or not isinstance(n, int) or n < 1 for n in counts):
        raise MeshError(f"nested: rings = {rings!r}: expected {len(size) - 1} whole numbers of at least 1")
    steps = [size[:1]] + [
        inner + (outer - inner) * np.arange(1, n + 1)[:, None] / n
        for inner, outer, n in zip(size[:-1], size[1:], counts, strict=True)
    ]
    outline = np.array([[(-w / 2, 0.0), (-w / 2, h), (w / 2, h), (w / 2, 0.0)] for w, h in np.concatenate(steps)])
    middle = outline[:1, [0, 3, 2, 1]]
    inner, outer = outline[:-1], outline[1:]
    sides = np.stack([inner[:, :-1], inner[:, 1:], outer[:, 1:], outer[:, :-1]], axis=2)
    return _from_places(np.concatenate([middle, sides.reshape(-1, 4, 2)]))


def lines(stops: Sequence[float], size: float = math.inf) -> Array:
    """Return the stops, mm, and between them evenly what it takes for no step to be longer than `size`.

    Stops that coincide count once. Raises MeshError for stops that fall, or a size that is not positive.
    """
    if not size > 0.0:
        raise MeshError(f"lines: size = {size!r}: expected a length in mm greater than 0")
    all_stops = np.asarray(stops, dtype=float)
    if all_stops.ndim != 1 or len(all_stops) < 2 or not np.isfinite(all_stops).all() or (np.diff(all_stops) < 0).any():
        raise MeshError(f"lines: stops = {list(stops)!r}: expected at least two finite numbers that do not fall")
    keep = np.concatenate([[True], np.diff(all_stops) > _CLOSE * np.ptp(all_stops)])
    kept = all_stops[keep]
    parts = [np.linspace(a, b, max(1, math.ceil((b - a) / size - 1e-9)) + 1)[:-1] for a, b in pairwise(kept)]
    return np.concatenate([*parts, kept[-1:]])


def checked_lines(name: str, values: ArrayLike) -> Array:
    """Return lines as an array (k,); raises MeshError unless they are two or more finite numbers that grow."""
    result = np.asarray(values, dtype=float)
    if result.ndim != 1 or len(result) < 2 or not np.isfinite(result).all() or (np.diff(result) <= 0.0).any():
        raise MeshError(f"lines {name} = {result.tolist()}: expected at least two finite numbers that grow")
    return result


def _from_places(places: Array) -> Quads:
    """Return the sheet of quadrilaterals (m, 4, 2)."""
    return Quads(places.reshape(-1, 2), np.arange(4 * len(places)).reshape(-1, 4))
