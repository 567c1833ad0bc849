"""Linearised stress: the membrane and bending parts of the stress on a line through a wall, as pressure-vessel codes
(ASME Boiler and Pressure Vessel Code, Section VIII, Division 2, Annex 5-A) take it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.measures.stress import tensors_at
from pneumorph.mechanics import State
from pneumorph.mechanics.fields import von_mises

Array = NDArray[np.float64]

_POINTS = 11  # of Simpson's rule through the wall


@dataclass(frozen=True, eq=False)
class Linearised:
    """Stress on lines through a wall, Cauchy, MPa: membrane and bending (lines, 3, 3), the latter at the second end.

    At the first end of a line the linear stress is membrane - bending, at the second membrane + bending.
    """

    membrane: Array
    bending: Array

    @property
    def equivalent(self) -> Array:
        """Larger equivalent (von Mises) stress of the linear stress at both ends (lines,), MPa."""
        ends = von_mises(self.membrane - self.bending), von_mises(self.membrane + self.bending)
        return np.asarray(np.maximum(*ends))


def linearise(stress: Array) -> Linearised:
    """Return the linear part of stresses (lines, n, 3, 3) at evenly spaced points, n odd, from end to end of each line.

    membrane = 1/t int s dx, bending = 6/t^2 int s (x - t/2) dx by Simpson's rule, exact for cubics. Raises InputError
    for an even number of points or fewer than three.
    """
    count = stress.shape[1]
    if count < 3 or count % 2 == 0:
        raise InputError(f"linearised stress: {count} points on a line, allowed: odd numbers from 3")
    weight = np.ones(count)
    weight[1:-1:2], weight[2:-1:2] = 4.0, 2.0
    weight /= weight.sum()
    place = np.linspace(-0.5, 0.5, count)
    membrane = np.einsum("q,lqij->lij", weight, stress)
    return Linearised(membrane, 6.0 * np.einsum("q,lqij->lij", weight * place, stress))


def linearised_stress(state: State, first: ArrayLike, second: ArrayLike) -> Linearised:
    """Return the linearised stress of a state on lines through a wall.

    first, second: (lines, d), ends of the lines in the reference, mm. Stresses are averaged at the nodes. Raises
    InputError for ends of other shapes, or outside the body.
    """
    low, high = np.atleast_2d(np.asarray(first, dtype=float)), np.atleast_2d(np.asarray(second, dtype=float))
    if low.shape != high.shape or low.shape[1] != state.model.mesh.dimension:
        raise InputError(f"linearised stress: ends of shape {low.shape} and {high.shape}, expected (lines, dimension)")
    share = np.linspace(0.0, 1.0, _POINTS)
    places = low[:, None] + share[:, None] * (high - low)[:, None]
    stress, _ = tensors_at(state, places.reshape(-1, low.shape[1]))
    return linearise(stress.reshape(len(low), _POINTS, 3, 3))
