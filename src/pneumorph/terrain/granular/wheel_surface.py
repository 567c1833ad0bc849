"""The surface of a wheel as triangles: from an STL file or a parametric outline; its mass properties and checks."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from pneumorph.errors import InputError, StorageError
from pneumorph.geometry.stl import stl_bytes
from pneumorph.geometry.stl_import import read_stl
from pneumorph.terrain.granular.bed import Bed
from pneumorph.units import show

Array = NDArray[np.float64]
Index = NDArray[np.int64]

LIMBS = 4
_STATIONS = 64  # along a limb
_HUB_SIDES = 24
_OFF_HUB = 0.5  # mm between hub and limbs


@dataclass(frozen=True, eq=False)
class WheelSurface:
    """A closed surface that turns about the axis y through the origin, its top towards +x.

    points (n, 3), mm; triangles (k, 3), anticlockwise seen from outside. It is rigid: grains touch it, it does not
    yield. Raises InputError for an empty surface or one whose triangles do not enclose the axle's middle plane.
    """

    name: str
    points: Array
    triangles: Index

    def __post_init__(self) -> None:
        if not len(self.triangles) or self.volume <= 0.0:
            raise InputError(f"wheel '{self.name}': its triangles enclose no volume")

    @property
    def radius(self) -> float:
        """Largest distance from the axle, mm."""
        return float(np.hypot(self.points[:, 0], self.points[:, 2]).max())

    @property
    def width(self) -> float:
        """Twice the largest distance from the middle plane, mm."""
        return float(2.0 * np.abs(self.points[:, 1]).max())

    @property
    def volume(self) -> float:
        """Enclosed volume, mm3."""
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0

    def mass_properties(self, mass: float) -> tuple[Array, Array]:
        """Return the centre (3,), mm, and the inertia tensor about it (3, 3), tonne mm2, if it were solid and uniform.

        Sums over the tetrahedra between the origin and the triangles: int x x' dV of one is det / 120 (sum of its
        corners' squares plus the square of their sum).
        """
        corners = self.points[self.triangles]
        det = np.linalg.det(corners)
        volume = det.sum() / 6.0
        total = corners.sum(axis=1)
        centre = np.einsum("k,ki->i", det, total) / 24.0 / volume
        second = np.einsum("k,kai,kaj->ij", det, corners, corners) + np.einsum("k,ki,kj->ij", det, total, total)
        second = second / 120.0 / volume - np.outer(centre, centre)
        return centre, mass * (np.trace(second) * np.eye(3) - second)

    def stl(self) -> bytes:
        """Return the surface as a binary STL file."""
        return stl_bytes(self.points, self.triangles, self.name)

    def check_grains(self, bed: Bed) -> None:
        """Raise InputError for grains whose diameter is over a third of the wheel's height."""
        largest, height = 2.0 * bed.largest_radius, 2.0 * self.radius
        if largest > height / 3.0:
            raise InputError(
                f"grains of up to {show(largest, 'length')} under wheel '{self.name}' of height "
                f"{show(height, 'length')}: expected at most a third of it, {show(height / 3.0, 'length')}"
            )


def from_stl(path: Path, name: str = "") -> WheelSurface:
    """Return the wheel of an STL file, in mm, whose axle is the axis y.

    Raises StorageError for a file that cannot be read, GeometryError for a surface that is not watertight.
    """
    try:
        points, triangles = read_stl([path])
    except OSError as error:
        raise StorageError(f"wheel '{path}' cannot be read: {error.strerror or error}") from error
    return WheelSurface(name or path.stem, points, triangles)


def limbed(
    name: str,
    height: float,
    *,
    longest: float = 280.0,
    width: float = 42.0,
    base: float = 14.0,
    pleat: float = 12.0,
    pleats: int = 7,
    hub_radius: float = 25.0,
) -> WheelSurface:
    """Return a wheel of four equal curved limbs with pleats, `height` mm over two opposite tips.

    A limb is a strip around an arc of fixed length; the less it is curved the higher is the wheel, and straight limbs
    would make it a few mm higher than `longest`. The convex side, a smooth base, goes ahead; pleats stand on the other
    side. base, pleat: thickness of the strip and height of the pleats on it; width: along the axle.

    Raises InputError for a height over the longest or under half of it, other lengths that are not positive, a hub that
    the limbs do not reach out of.
    """
    for key, value in {"width": width, "base": base, "pleat": pleat, "hub_radius": hub_radius}.items():
        if not 0.0 < value < float("inf"):
            raise InputError(f"wheel '{name}': {key} = {show(value, 'length')}, expected more than 0")
    if pleats < 1:
        raise InputError(f"wheel '{name}': pleats = {pleats}, expected at least 1")
    if not 0.5 * longest <= height <= longest:
        raise InputError(
            f"wheel '{name}': height = {show(height, 'length')}, expected {show(0.5 * longest, 'length')} to "
            f"{show(longest, 'length')}"
        )
    if 4.0 * hub_radius >= height:
        raise InputError(
            f"wheel '{name}': hub_radius = {show(hub_radius, 'length')}, expected less than a quarter of the height"
        )
    length = 0.5 * longest * 1.03 - hub_radius

    def reach(arc: float) -> float:
        profile = _limb(length, arc, base, pleat, pleats, hub_radius)
        return float(np.hypot(*np.concatenate(profile).T).max()) - 0.5 * height

    arc = float(brentq(reach, 1e-3, 1.9 * pi))
    inner, outer = _limb(length, arc, base, pleat, pleats, hub_radius)
    shells = [_strip(inner, outer, width)]
    for i in range(1, LIMBS):
        angle = 2.0 * pi * i / LIMBS
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        shells.append(_strip(inner @ turn.T, outer @ turn.T, width))
    shells.append(disc("hub", hub_radius, width + 2.0, _HUB_SIDES).shell)
    return WheelSurface(name, *_joined(shells))


@dataclass(frozen=True, eq=False)
class _Disc(WheelSurface):
    @property
    def shell(self) -> tuple[Array, Index]:
        return self.points, self.triangles


def disc(name: str, radius: float, width: float, sides: int = 96) -> _Disc:
    """Return a plain wheel: a prism whose corners run on the circle of `radius` (mm)."""
    angle = 2.0 * pi * np.arange(sides + 1) / sides
    rim = radius * np.column_stack([np.sin(angle), np.cos(angle)])
    rim[-1] = rim[0]
    return _Disc(name, *_strip(np.zeros_like(rim), rim, width))


def _limb(length: float, arc: float, base: float, pleat: float, pleats: int, hub_radius: float) -> tuple[Array, Array]:
    """Return the lines (n, 2), in x and z, of the pleated side and of the smooth one; the limb's tip points up.

    Its root stands a little off the hub: closed surfaces that overlap would be no body.
    """
    s = np.linspace(0.0, 1.0, _STATIONS + 1)
    heading = 0.5 * arc - arc * s  # from z towards x
    middle = 0.5 * (heading[1:] + heading[:-1])
    pieces = length / _STATIONS * np.column_stack([np.sin(middle), np.cos(middle)])
    line = np.vstack([np.zeros(2), np.cumsum(pieces, axis=0)])
    ahead = np.column_stack([np.cos(heading), -np.sin(heading)])
    # trapezoids: up, flat, down, gap
    phase = (s * pleats) % 1.0
    rise = np.clip(np.minimum(phase, 0.75 - phase) / 0.15, 0.0, 1.0)
    rise[0] = rise[-1] = 0.0
    inner, outer = line - ahead * (0.5 * base + pleat * rise)[:, None], line + 0.5 * base * ahead
    both = np.concatenate([inner, outer])
    # the least shift along z after which every point is outside of the hub
    outside = np.maximum((hub_radius + _OFF_HUB) ** 2 - both[:, 0] ** 2, 0.0) ** 0.5 - both[:, 1]
    shift = np.array([0.0, outside.max()])
    return inner + shift, outer + shift


def _strip(inner: Array, outer: Array, width: float) -> tuple[Array, Index]:
    """Return the closed shell between two lines (n, 2) in the plane x, z, extruded over a width; a ring if they close.

    Looking along +y, outer lies to the left of inner on the way from the first to the last point.
    """
    closed = bool(np.array_equal(outer[0], outer[-1]))
    n = len(inner)
    flat = np.concatenate([inner, outer])
    low = np.column_stack([flat[:, 0], np.full(2 * n, -0.5 * width), flat[:, 1]])
    points = np.concatenate([low, low + np.array([0.0, width, 0.0])])
    i = np.arange(n - 1)
    a, b, c, d = i, i + 1, n + i + 1, n + i  # inner, inner next, outer next, outer
    up = 2 * n
    faces = [_quads(a, b, c, d), _quads(a + up, d + up, c + up, b + up), _quads(d, c, c + up, d + up)]
    faces.append(_quads(b, a, a + up, b + up))
    if not closed:
        first, last = np.array([0]), np.array([n - 1])
        faces += [
            _quads(first, first + n, first + n + up, first + up),
            _quads(last + n, last, last + up, last + n + up),
        ]
    triangles = np.concatenate(faces)
    # points that coincide become one, and the triangles between them vanish
    points, number = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    triangles = number.ravel()[triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    corners = points[triangles]
    volume = np.linalg.det(corners).sum()
    return points, triangles if volume > 0.0 else triangles[:, ::-1]


def _quads(a: Index, b: Index, c: Index, d: Index) -> Index:
    return np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def _joined(shells: list[tuple[Array, Index]]) -> tuple[Array, Index]:
    starts = np.cumsum([0, *(len(points) for points, _ in shells)])
    points = np.concatenate([points for points, _ in shells])
    return points, np.concatenate([triangles + start for (_, triangles), start in zip(shells, starts, strict=False)])
