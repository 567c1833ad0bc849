"""A rod of pieces with constant curvature: its centre line in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
_SMALL = 1e-6  # rad: below it the series of the integral is exact to rounding


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of the rod, of uniform turn and stretch.

    length: of the piece at rest, mm. stretch: of its centre line. turn (3,): rotation vector per length at rest in the
    axes of the section, whose third one points along the rod, rad/mm.
    """

    length: float
    stretch: float
    turn: Array


def rod_line(pieces: Sequence[Piece], fractions: ArrayLike) -> Array:
    """Return points (n, 3) of the deformed centre line at fractions of its length, mm; it starts at 0 along z.

    In a piece r' = stretch R e3 and R' = R [turn]x, so that R = R0 exp(s [turn]x) and r is its integral
    (exponential map, Rodrigues' formula). fractions (n,) from 0 to 1.
    """
    wanted = np.asarray(fractions, dtype=float)
    ends = np.concatenate([[0.0], np.cumsum([piece.length * piece.stretch for piece in pieces])])
    arc = wanted * ends[-1]
    number = np.clip(np.searchsorted(ends, arc, side="right") - 1, 0, len(pieces) - 1)
    result = np.empty((len(wanted), 3))
    place, frame = np.zeros(3), np.eye(3)
    for index, piece in enumerate(pieces):
        here = number == index
        s = (arc[here] - ends[index]) / piece.stretch
        result[here] = place + piece.stretch * _integral(piece.turn, s) @ frame.T
        place = place + piece.stretch * frame @ _integral(piece.turn, np.array([piece.length]))[0]
        frame = frame @ Rotation.from_rotvec(piece.turn * piece.length).as_matrix()
    return result


def _integral(turn: Array, s: Array) -> Array:
    """Return the integral of exp(t [turn]x) e3 over t from 0 to each s (n,), as rows (n, 3)."""
    rate = float(np.linalg.norm(turn))
    along = np.array([0.0, 0.0, 1.0])
    if rate * float(np.max(s, initial=0.0)) < _SMALL:
        return s[:, None] * along + 0.5 * s[:, None] ** 2 * np.cross(turn, along)
    axis = turn / rate
    sine, versine = np.sin(rate * s), 2.0 * np.sin(0.5 * rate * s) ** 2  # 1 - cos, without its cancellation
    first, second = np.cross(axis, along), np.cross(axis, np.cross(axis, along))
    return (
        s[:, None] * along + (versine / rate)[:, None] * first + (s - sine / rate)[:, None] * second
    )  # fmt: skip
