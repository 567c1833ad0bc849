"""Fit of one hinge: a spring whose rest angle and compliance depend on the pressure, and a stop if the data show it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from pneumorph.errors import InputError
from pneumorph.terrain.limb import Springs

Array = NDArray[np.float64]

_STOPS = (0.1, 0.25, 0.5, 0.75)  # quantiles of the angles from which the search for a stop begins
_EXACT = 1e-6  # rad: a spring that fits as well needs no stop
_GAIN = 0.5  # a stop must bring the sum of squares below this share


@dataclass(frozen=True, eq=False)
class HingeLaw:
    """Coefficients for a pressure as share of the largest: rest (a,) of p, p^2, ..., compliance (b,) and stop (2,) of
    1, p, ...; see `ReducedLimb`."""

    rest: Array
    compliance: Array
    stop: Array
    stop_stiffness: float

    def angles(self, shares: Array, moments: Array) -> Array:
        """Return the angles (m,) at shares of the pressure and moments (m,)."""
        rest = shares[:, None] ** np.arange(1, len(self.rest) + 1) @ self.rest
        compliance = shares[:, None] ** np.arange(len(self.compliance)) @ self.compliance
        stop = self.stop[0] + self.stop[1] * shares
        return Springs(1.0 / compliance, rest, np.asarray(self.stop_stiffness), stop).angles(moments)


def fit_hinge(
    name: str, shares: Array, moments: Array, angles: Array, rest_degree: int, compliance_degree: int
) -> HingeLaw:
    """Return the law of a hinge that fits m cases best in angle: shares of the largest pressure, moments, angles (m,).

    Raises InputError, naming the hinge, where the cases do not determine it, or its compliance is not positive.
    """
    size = float(np.abs(moments).max()) or 1.0
    of_rest = shares[:, None] ** np.arange(1, rest_degree + 1)
    of_compliance = shares[:, None] ** np.arange(compliance_degree + 1)
    matrix = np.hstack([of_rest, of_compliance * (moments / size)[:, None]])
    solution, _, rank, _ = np.linalg.lstsq(matrix, angles, rcond=None)
    start = np.asarray(solution, dtype=float)
    if rank < matrix.shape[1]:
        raise InputError(
            f"limb fit: {name} has data for {rank} of {matrix.shape[1]} coefficients: more pressures or tip forces are "
            "needed"
        )
    softest = float((of_compliance @ start[rest_degree:]).min()) / size
    if softest <= 0.0:
        raise InputError(
            f"limb fit: {name} has a compliance of {softest:.3g} rad/(N mm), expected more than 0: too few or "
            "contradictory tip forces"
        )
    none = HingeLaw(start[:rest_degree], start[rest_degree:] / size, np.zeros(2), 0.0)
    stiff = size / float(np.mean(of_compliance @ start[rest_degree:]))

    def law(x: Array) -> HingeLaw:
        return HingeLaw(x[:rest_degree], x[rest_degree:-3] / size, x[-3:-1], float(x[-1]) * stiff)

    def misfit(x: Array) -> Array:
        # a compliance that is not positive is no law: far away, so that the search turns back
        if (of_compliance @ x[rest_degree:-3]).min() <= 0.0:
            return np.full_like(angles, 1e3)
        return law(x).angles(shares, moments) - angles

    best, least = none, float(np.sum((none.angles(shares, moments) - angles) ** 2))
    bar = _GAIN * least if least > len(angles) * _EXACT**2 else 0.0
    lower = np.concatenate([np.full(len(start) + 2, -np.inf), [0.0]])
    for quantile in _STOPS:
        guess = np.concatenate([start, [np.quantile(angles, quantile), 0.0, 3.0]])
        found = least_squares(misfit, guess, bounds=(lower, np.inf), x_scale="jac")
        squares = float(np.sum(found.fun**2))
        if squares < min(bar, least):
            best, least = law(found.x), squares
    return best
