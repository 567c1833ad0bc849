"""The centre line that is wanted: a named curve, or points of a CSV file."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from pneumorph.errors import InputError, NameNotFoundError, StudyError, UnitError, unknown_name
from pneumorph.studies.design.rod import Piece, rod_line
from pneumorph.units import parse

Array = NDArray[np.float64]

_FINE = 401  # points that stand for a curve
_FLAT = 1e-3  # of its length: a curve that leaves its plane by less is a plane one
_HEADER = re.compile(r"^\s*([xyz])\s*[\[(]\s*([^\])]+?)\s*[\])]\s*$")


@dataclass(frozen=True, eq=False)
class Target:
    """A wanted centre line; points (n, 3), mm, from the clamp to the tip.

    It is moved to start at 0, and turned to start along z and to bend in the plane of x and z, away from x, where it
    first leaves its straight line: an actuator may stand as it likes. Raises InputError for fewer than three points,
    points that are not finite, or neighbours that coincide.
    """

    name: str
    points: Array

    def __post_init__(self) -> None:
        points = np.asarray(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 3 or not np.isfinite(points).all():
            raise InputError(
                f"target '{self.name}': {points.shape} numbers: expected at least 3 finite points in space"
            )
        if (np.linalg.norm(np.diff(points, axis=0), axis=1) <= 0.0).any():
            raise InputError(f"target '{self.name}': neighbouring points coincide, expected different ones")
        object.__setattr__(self, "points", _placed(points))

    @cached_property
    def _spline(self) -> CubicSpline:
        return _spline(self.points)

    @cached_property
    def _arc(self) -> tuple[Array, Array]:
        """Parameters of the spline and the arc length up to them."""
        u = np.linspace(0.0, float(self._spline.x[-1]), 20 * _FINE)
        steps = np.linalg.norm(np.diff(self._spline(u), axis=0), axis=1)
        return u, np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Of the curve, mm."""
        return float(self._arc[1][-1])

    @property
    def planar(self) -> bool:
        """Whether it lies in the plane of x and z."""
        return float(np.abs(self.at(np.linspace(0.0, 1.0, _FINE))[:, 1]).max()) < _FLAT * self.length

    def at(self, fractions: ArrayLike) -> Array:
        """Return the points (n, 3) at fractions (n,) of the length, mm."""
        u, arc = self._arc
        return np.asarray(self._spline(np.interp(np.asarray(fractions, dtype=float) * arc[-1], arc, u)))


def _spline(points: Array) -> CubicSpline:
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return CubicSpline(np.concatenate([[0.0], np.cumsum(chords)]), points)


def _placed(points: Array) -> Array:
    """Return the points moved to 0 and turned: start along z, first bend away from x in the plane of x and z."""
    moved = points - points[0]
    spline = _spline(moved)
    start = spline(0.0, 1)
    start = start / np.linalg.norm(start)
    along = np.array([0.0, 0.0, 1.0])
    cross, cosine = np.cross(start, along), float(start @ along)
    sine = float(np.linalg.norm(cross))
    axis = cross / sine if sine > 1e-12 else np.array([1.0, 0.0, 0.0])
    moved = moved @ Rotation.from_rotvec(math.atan2(sine, cosine) * axis).as_matrix().T
    length = float(spline.x[-1])
    aside = moved[:, :2]
    far = np.linalg.norm(aside, axis=1)
    left = np.flatnonzero(far > 0.02 * length)  # its direction is well-defined there
    if len(left) == 0:
        return moved
    x, y = aside[left[0]] / far[left[0]]
    # (x, y) goes to (-1, 0)
    turn = np.array([[-x, -y, 0.0], [y, -x, 0.0], [0.0, 0.0, 1.0]])
    return moved @ turn.T


def named_curve(name: str, length: float, angle: float, twist: float = 0.0) -> Target:
    """Return a curve of constant curvature, or of arcs, by its name.

    arc, c: one arc that turns by the angle; s: two arcs to either side, of the angle each; u: a straight third, an arc
    that turns by the angle, a straight third; helix: turns by the angle and twists by `twist` about itself, both in
    all; line: straight. length: mm; angle, twist: rad. Raises NameNotFoundError for another name, InputError for a
    length of 0 or less, or a twist of a curve that has none.
    """
    if name not in CURVES:
        raise NameNotFoundError(unknown_name("curve", name, CURVES))
    if not 0.0 < length < math.inf:
        raise InputError(f"target: length = {length:g} mm: expected more than 0")
    if twist and name != "helix":
        raise InputError(f"target: twist = {twist:g} rad of the curve '{name}': only a helix has one")
    pieces = [Piece(share * length, 1.0, np.array([0.0, -a / (share * length), t / (share * length)]))
              for share, a, t in CURVES[name](angle, twist)]  # fmt: skip
    return Target(name, rod_line(pieces, np.linspace(0.0, 1.0, _FINE)))


# name -> (share of the length, turning, twist) of its pieces
CURVES: Mapping[str, Callable[[float, float], list[tuple[float, float, float]]]] = {
    "arc": lambda angle, _: [(1.0, angle, 0.0)],
    "c": lambda angle, _: [(1.0, angle, 0.0)],
    "s": lambda angle, _: [(0.5, angle, 0.0), (0.5, -angle, 0.0)],
    "u": lambda angle, _: [(1 / 3, 0.0, 0.0), (1 / 3, angle, 0.0), (1 / 3, 0.0, 0.0)],
    "helix": lambda angle, twist: [(1.0, angle, twist)],
    "line": lambda angle, _: [(1.0, 0.0, 0.0)],
}


def read_curve(path: Path) -> Target:
    """Return the curve through the points of a CSV file with the columns 'x [mm]', 'y [mm]', 'z [mm]', or two of them.

    Lines are points from the clamp to the tip; any unit of length; a missing column is 0. Raises StudyError for a file
    that cannot be read or holds other columns or no numbers, UnitError for a column without a unit, InputError as
    `Target`.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            header, *lines = [line for line in csv.reader(file) if any(map(str.strip, line))] or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise StudyError(f"target: cannot read '{path}': {error}") from error
    factors: dict[str, tuple[int, float]] = {}
    for index, title in enumerate(header):
        if title.strip().lower() in ("x", "y", "z"):
            raise UnitError(
                f"target '{path}': the column '{title.strip()}' has no unit, expected '{title.strip()} [mm]'"
            )
        found = _HEADER.match(title.lower())
        if found is None or found[1] in factors:
            raise StudyError(f"target '{path}': column '{title.strip()}': expected x, y, z with a unit, as 'x [mm]'")
        factors[found[1]] = index, parse(f"1 {title[found.start(2) : found.end(2)]}", "length", f"target '{path}'")
    if len(factors) < 2:
        raise StudyError(
            f"target '{path}' has the columns {header}: expected two or three of 'x [mm]', 'y [mm]', 'z [mm]'"
        )
    points = np.zeros((len(lines), 3))
    for row, line in enumerate(lines):
        for axis, (index, factor) in factors.items():
            try:
                points[row, "xyz".index(axis)] = factor * float(line[index])
            except (ValueError, IndexError):
                raise StudyError(f"target '{path}': point {row + 1} has no number for {axis}") from None
    return Target(path.stem, points)
