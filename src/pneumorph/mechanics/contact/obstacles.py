"""Rigid bodies that a soft one can meet: smooth ones (half-space, pipe) and closed triangle surfaces.

In the plane models they are a half-plane, a circular hole and closed polygons.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def vector(value: Sequence[float], dimension: int, owner: str, what: str) -> Array:
    """Return numbers as an array (dimension,); raises InputError for another length or numbers that are not finite."""
    result = np.asarray(value, dtype=float)
    if result.shape != (dimension,) or not np.isfinite(result).all():
        raise InputError(f"{owner}: {what} = {tuple(value)}, expected {dimension} finite numbers")
    return result


def direction(value: Sequence[float], dimension: int, owner: str, what: str) -> Array:
    """Return a vector of length 1; raises InputError for one of length 0."""
    result = vector(value, dimension, owner, what)
    if not result.any():
        raise InputError(f"{owner}: {what} = {tuple(value)}, expected a vector that is not zero")
    return result / np.linalg.norm(result)


def _positive(value: float, owner: str, what: str) -> None:
    if not 0.0 < value < float("inf"):
        raise InputError(f"{owner}: {what} = {value} mm, allowed: more than 0")


@dataclass(frozen=True)
class Motion:
    """A translation along `direction` by the distance (mm) that the programme sets under `name`."""

    name: str
    direction: tuple[float, ...]
    kind: ClassVar[str] = "length"


@dataclass(frozen=True)
class HalfSpace:
    """All space behind the plane through `point` (mm) whose `normal` shows to where the soft body is."""

    point: tuple[float, ...]
    normal: tuple[float, ...]
    motion: Motion | None = field(default=None, kw_only=True)

    def gap(self, points: Array) -> tuple[Array, Array, Array]:
        """Return gap (n,), its gradient (n, d) and second derivative (n, d, d) at points (n, d)."""
        d = points.shape[1]
        normal = direction(self.normal, d, "half-space", "normal")
        gap = (points - vector(self.point, d, "half-space", "point")) @ normal
        return gap, np.broadcast_to(normal, points.shape), np.zeros((len(points), d, d))


@dataclass(frozen=True)
class Pipe:
    """All space outside a round bore of `radius` (mm) about the line through `point` along `axis`.

    In the plane, where the axis is normal to it, `axis` is left out.
    """

    point: tuple[float, ...]
    radius: float
    axis: tuple[float, ...] = ()
    motion: Motion | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        _positive(self.radius, "pipe", "radius")

    def gap(self, points: Array) -> tuple[Array, Array, Array]:
        """Return gap (n,), its gradient (n, d) and second derivative (n, d, d) at points (n, d)."""
        d = points.shape[1]
        across = np.eye(d)
        if d == 3:
            axis = direction(self.axis, d, "pipe", "axis")
            across -= np.outer(axis, axis)
        arm = (points - vector(self.point, d, "pipe", "point")) @ across
        radius = np.maximum(np.linalg.norm(arm, axis=1), 1e-12 * self.radius)
        inward = -arm / radius[:, None]
        bend = -(across - inward[:, :, None] * inward[:, None, :]) / radius[:, None, None]
        return self.radius - radius, inward, bend


@dataclass(frozen=True)
class Block:
    """A box between two corners (mm); in the plane a rectangle."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]
    motion: Motion | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if len(self.lower) != len(self.upper) or not all(a < b for a, b in zip(self.lower, self.upper, strict=True)):
            raise InputError(f"block: lower = {self.lower}, upper = {self.upper}, allowed: lower < upper in each axis")

    def facets(self, dimension: int) -> tuple[Array, Integers]:
        """Return points (n, d) and facets (m, d): triangles, or edges in the plane."""
        low = vector(self.lower, dimension, "block", "lower")
        high = vector(self.upper, dimension, "block", "upper")
        if dimension == 2:
            return np.array([low, (high[0], low[1]), high, (low[0], high[1])]), _ring(4)
        corners = np.array([[(i & 1, i >> 1 & 1, i >> 2 & 1)] for i in range(8)]).reshape(8, 3)
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        triangles = [t for a, b, c, e in quads for t in ((a, b, c), (a, c, e))]
        return low + corners * (high - low), np.array(triangles, dtype=np.int64)


@dataclass(frozen=True)
class Cylinder:
    """A round bar from `start` to `end` (mm), as a prism of `segments` flats; in the plane a disc about `start`."""

    start: tuple[float, ...]
    end: tuple[float, ...]
    radius: float
    segments: int = 64
    motion: Motion | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        _positive(self.radius, "cylinder", "radius")
        if self.segments < 8:
            raise InputError(f"cylinder: segments = {self.segments}, allowed: 8 or more")

    def facets(self, dimension: int) -> tuple[Array, Integers]:
        """Return points (n, d) and facets (m, d): triangles, or edges in the plane."""
        start = vector(self.start, dimension, "cylinder", "start")
        angle = 2.0 * np.pi * np.arange(self.segments) / self.segments
        if dimension == 2:
            return start + self.radius * np.column_stack([np.cos(angle), np.sin(angle)]), _ring(self.segments)
        end = vector(self.end, 3, "cylinder", "end")
        axis = direction(tuple(end - start), 3, "cylinder", "end - start")
        first = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
        first /= np.linalg.norm(first)
        circle = self.radius * (np.outer(np.cos(angle), first) + np.outer(np.sin(angle), np.cross(axis, first)))
        n = self.segments
        here, after = np.arange(n), (np.arange(n) + 1) % n
        low, high = np.full(n, 2 * n), np.full(n, 2 * n + 1)
        sides = [(here, after, n + after), (here, n + after, n + here), (low, after, here), (high, n + here, n + after)]
        points = np.concatenate([start + circle, end + circle, [start], [end]])
        return points, np.concatenate([np.column_stack(side) for side in sides]).astype(np.int64)


@dataclass(frozen=True)
class Revolved:
    """What a line makes that is turned about an axis: a cup, a bottle, a ball.

    profile: its points, each with its distance from the axis and its height along it (mm), from the axis to the axis:
        ends that do not lie on it are joined to it at their height. The line does not cross itself.
    point:   where on the axis the height is 0; axis: direction of growing height.
    segments: flats that stand for its round.

    Raises InputError for fewer than two points or distances below 0.
    """

    profile: tuple[tuple[float, float], ...]
    point: tuple[float, ...] = (0.0, 0.0, 0.0)
    axis: tuple[float, ...] = (0.0, 0.0, 1.0)
    segments: int = 48
    motion: Motion | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if len(self.profile) < 2:
            raise InputError(f"revolved body: {len(self.profile)} points of its profile, allowed: 2 or more")
        for item in self.profile:
            radius, _ = vector(item, 2, "revolved body", "point of its profile")
            if radius < 0.0:
                raise InputError(f"revolved body: distance from the axis = {radius:g} mm, allowed: 0 or more")
        if self.segments < 8:
            raise InputError(f"revolved body: segments = {self.segments}, allowed: 8 or more")

    def facets(self, dimension: int) -> tuple[Array, Integers]:
        """Return points (n, 3) and triangles (m, 3), outward; raises InputError in the plane, or without a volume."""
        if dimension != 3:
            raise InputError("revolved body: a plane model meets blocks, cylinders and half-spaces only")
        axis = direction(self.axis, 3, "revolved body", "axis")
        first = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
        first /= np.linalg.norm(first)
        angle = 2.0 * np.pi * (np.arange(self.segments) + 0.5) / self.segments
        circle = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), np.cross(axis, first))
        line = np.asarray(self.profile, dtype=float)
        ends = [(0.0, height) for radius, height in (line[0], line[-1]) if radius > 0.0]
        if line[0, 0] > 0.0:
            line = np.vstack([ends[:1], line])
        if line[-1, 0] > 0.0:
            line = np.vstack([line, ends[-1:]])
        rings = [circle * radius + axis * height for radius, height in line]
        points = vector(self.point, 3, "revolved body", "point") + np.concatenate(rings)
        low = self.segments * np.arange(len(line) - 1)[:, None] + np.arange(self.segments)
        after = low - np.arange(self.segments) + (np.arange(self.segments) + 1) % self.segments
        high, beyond = low + self.segments, after + self.segments
        corners = np.concatenate(
            [np.stack(t, axis=-1).reshape(-1, 3) for t in ((low, after, beyond), (low, beyond, high))]
        )
        # points of a ring on the axis are one
        _, kept, where = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
        points, corners = points[kept], where.ravel()[corners]
        corners = corners[[len(set(corner)) == 3 for corner in corners.tolist()]]
        volume = float(np.linalg.det(points[corners] - points.mean(axis=0)).sum())
        if abs(volume) <= 1e-9 * float(np.ptp(points, axis=0).max()) ** 3:
            raise InputError("revolved body: its profile encloses no volume")
        return points, np.ascontiguousarray(corners if volume > 0.0 else corners[:, ::-1])


@dataclass(frozen=True)
class SurfaceFile:
    """The triangles of an STL file (or another surface file that meshio reads), its lengths in mm.

    shift: how far (mm) it is moved from where the file has it; left out, not at all.
    """

    path: str
    shift: tuple[float, ...] = ()
    motion: Motion | None = field(default=None, kw_only=True)

    def facets(self, dimension: int) -> tuple[Array, Integers]:
        """Return points (n, 3) and triangles (m, 3); raises InputError for a file without any, or in the plane."""
        import meshio

        if dimension != 3:
            raise InputError(f"surface file '{self.path}': a plane model meets blocks, cylinders and half-spaces only")
        try:
            mesh = meshio.read(self.path)
        except (OSError, meshio.ReadError, SystemExit, ValueError) as error:
            raise InputError(f"surface file '{self.path}' cannot be read: {error}") from error
        triangles = [block.data for block in mesh.cells if block.type == "triangle"]
        if not triangles:
            raise InputError(f"surface file '{self.path}': no triangles in it")
        # STL repeats each corner in each triangle
        points, where = np.unique(np.asarray(mesh.points, dtype=float), axis=0, return_inverse=True)
        corners = where.ravel()[np.concatenate(triangles)]
        flat = (corners[:, 0] == corners[:, 1]) | (corners[:, 1] == corners[:, 2]) | (corners[:, 2] == corners[:, 0])
        if flat.all():
            raise InputError(f"surface file '{self.path}': all its triangles are without area")
        shift = vector(self.shift or (0.0, 0.0, 0.0), 3, f"surface file '{self.path}'", "shift")
        return points + shift, corners[~flat].astype(np.int64)


Smooth = HalfSpace | Pipe
Faceted = Block | Cylinder | Revolved | SurfaceFile
Obstacle = HalfSpace | Pipe | Block | Cylinder | Revolved | SurfaceFile


def encloses(points: Array, facets: Integers, query: Array) -> bool:
    """Return whether closed facets (m, d) wind about a point (d,): by angles in the plane, else by solid angles.

    Solid angle of a triangle: Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125.
    """
    arm = points[facets] - query
    a, b = arm[:, 0], arm[:, 1]
    if arm.shape[2] == 2:
        turned = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.einsum("mi,mi->m", a, b))
        return bool(abs(turned.sum()) > np.pi)
    c = arm[:, 2]
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    dot = [np.einsum("mi,mi->m", x, y) for x, y in ((a, b), (b, c), (c, a))]
    volume = np.einsum("mi,mi->m", a, np.cross(b, c))
    turned = 2.0 * np.arctan2(volume, la * lb * lc + dot[0] * lc + dot[1] * la + dot[2] * lb)
    return bool(abs(turned.sum()) > 2.0 * np.pi)


def _ring(count: int) -> Integers:
    here = np.arange(count, dtype=np.int64)
    return np.column_stack([here, (here + 1) % count])
