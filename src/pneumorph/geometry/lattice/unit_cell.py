"""Unit cells as data: the outline of the hole that each cell leaves in a sheet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import GeometryError, unknown_name

Array = NDArray[np.float64]

# cg at which the re-entrant and the honeycomb hole are the same rectangle
BRICK = 0.5
_SMALL = 1e-9


@dataclass(frozen=True)
class Profile:
    """A hole that is symmetric about both its axes, given by its half height from the middle to its straight side.

    half: (x, p, q) with x from 0 (middle) to 1 (side, at half the clear width w - b); the half height there is
    p h + q g, with the height h of the cell and the gap g = cg h.
    """

    name: str
    half: tuple[tuple[float, float, float], ...]

    @property
    def symmetric(self) -> bool:
        """Always True."""
        return True

    def outline(self, width: float, height: float, beam: float, cg: float, least: float = 0.0) -> tuple[Array, Array]:
        """Return the upper and the lower chain (k, 2) of corners about the centre of the hole, from left to right, mm.

        least: width below which the beam between two rows of such holes does not go, mm: both chains are moved inwards
            by what it lacks; 0 leaves them as they are.

        Raises GeometryError for a gap beyond the cell, or a beam that leaves no hole.
        """
        if not 0.0 < cg <= BRICK:
            raise GeometryError(
                f"lattice: cg = {cg!r} of a {self.name} cell: the gap g = cg h = {cg * height:.4g} mm, expected cg "
                f"more than 0 and at most {BRICK} (g at most h / 2 = {height / 2.0:.4g} mm)"
            )
        right = np.array(
            [[0.5 * x * (width - beam), p * height + q * cg * height] for x, p, q in self.half], dtype=np.float64
        )
        right[:, 1] -= self._missing(right, width, height, least) / 2.0
        if right[:, 1].min() <= 0.0:
            raise GeometryError(
                f"lattice: least_beam = {least:g} mm leaves no hole in a {self.name} cell of height {height:.4g} mm, "
                f"cg = {cg:g}: expected less"
            )
        upper = np.vstack([right[:0:-1] * [-1.0, 1.0], right])
        return upper, upper * [1.0, -1.0]

    @staticmethod
    def _missing(right: Array, width: float, height: float, least: float) -> float:
        """Return the height along y that the beam between two rows lacks, mm, 0 where it is wide enough.

        right (k, 2): half height over x, one straight side; its line and that of the next row, h / 2 above and shifted
        by w / 2, are parallel.
        """
        (x, middle), (end, side) = right[0], right[-1]
        slope = (side - middle) / (end - x)
        tall = height / 2.0 - 2.0 * middle - slope * width / 2.0
        return float(max(0.0, least * math.hypot(1.0, slope) - tall)) if least > 0.0 else 0.0


@dataclass(frozen=True)
class Polygon:
    """A hole of one's own: corners as fractions (x / w, y / h) of the cell about its centre, in either sense.

    Every vertical line may cross the outline twice only, and the middle line x = 0 must do so; vertical sides are
    allowed at the two ends. The beam width and cg of the lattice do not change it. Raises GeometryError.
    """

    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        corners = np.array(self.points, dtype=np.float64) if len(self.points) >= 3 else np.zeros((0, 2))
        if corners.ndim != 2 or corners.shape[1:] != (2,) or len(corners) < 3 or not np.isfinite(corners).all():
            raise GeometryError(
                f"lattice: polygon of {len(self.points)} corners: expected at least 3 finite pairs (x / w, y / h)"
            )
        if not corners[:, 0].min() < -_SMALL < _SMALL < corners[:, 0].max():
            raise GeometryError("lattice: polygon: expected corners on both sides of the middle line x = 0")
        upper, lower = self._chains
        if (np.diff(upper[:, 0]) <= _SMALL).any() or (np.diff(lower[:, 0]) <= _SMALL).any():
            raise GeometryError("lattice: polygon: a vertical line crosses the outline more than twice")
        inner = np.unique(np.concatenate([upper[:, 0], lower[:, 0]]))[1:-1]
        if (np.interp(inner, *upper.T) <= np.interp(inner, *lower.T) + _SMALL).any():
            raise GeometryError("lattice: polygon: its outline crosses or touches itself")

    @property
    def name(self) -> str:
        """How pictures call it."""
        return "polygon"

    @cached_property
    def _chains(self) -> tuple[Array, Array]:
        corners = np.array(self.points, dtype=np.float64)
        x, y = corners.T
        if float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) < 0.0:
            corners = corners[::-1]
        start = int(np.lexsort((corners[:, 1], corners[:, 0]))[0])
        corners = np.roll(corners, -start, axis=0)  # anticlockwise from the lower left corner
        turn = int(np.flatnonzero(corners[:, 0] >= corners[:, 0].max() - _SMALL)[0])
        lower, upper = corners[: turn + 1], np.vstack([corners[turn:], corners[:1]])[::-1]
        # ends: a vertical side belongs to both chains by one corner each
        if abs(upper[-1, 0] - upper[-2, 0]) < _SMALL:
            upper = upper[:-1]
        if abs(upper[0, 0] - upper[1, 0]) < _SMALL:
            upper = upper[1:]
        return upper, lower

    @cached_property
    def symmetric(self) -> bool:
        """True if the mirror image about x = 0 is the same hole."""
        return all(
            len(chain) == len(chain[::-1]) and np.allclose(chain[::-1] * [-1.0, 1.0], chain, rtol=0.0, atol=_SMALL)
            for chain in self._chains
        )

    def outline(self, width: float, height: float, beam: float, cg: float, least: float = 0.0) -> tuple[Array, Array]:
        """Return the upper and the lower chain (k, 2) about the centre, from left to right, mm; no beam, no cg."""
        upper, lower = self._chains
        return upper * [width, height], lower * [width, height]


# Pu et al., Materials & Design 246 (2024) 113334, figure 1: half heights from the middle to the side
KINDS: dict[str, Profile] = {
    "re-entrant": Profile("re-entrant", ((0.0, 0.0, 0.5), (1.0, 0.25, 0.0))),
    "honeycomb": Profile("honeycomb", ((0.0, 0.25, 0.0), (1.0, 0.0, 0.5))),
    "brick": Profile("brick", ((0.0, 0.0, 0.5), (1.0, 0.0, 0.5))),
}


def kind_of(kind: str | Polygon) -> Profile | Polygon:
    """Return the unit cell of a name, or the polygon itself; raises GeometryError for an unknown name."""
    if isinstance(kind, Polygon):
        return kind
    if kind not in KINDS:
        raise GeometryError(f"lattice: {unknown_name('kind of cell', str(kind), KINDS)}")
    return KINDS[kind]


def halved(chain: Array) -> tuple[Array, Array]:
    """Return the left and right half of a chain (k, 2); both hold the point on the middle line x = 0."""
    middle = np.array([[0.0, float(np.interp(0.0, *chain.T))]])
    scale = float(np.ptp(chain[:, 0]))
    left, right = chain[chain[:, 0] < -_SMALL * scale], chain[chain[:, 0] > _SMALL * scale]
    return np.vstack([left, middle]), np.vstack([middle, right])


def finite_length(name: str, value: float) -> None:
    """Raise GeometryError for a length that is not a positive finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value <= 0.0:
        raise GeometryError(f"lattice: {name} = {value!r}: expected a finite length in mm greater than 0")
