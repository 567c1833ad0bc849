"""Convex functions of few variables: sums of convex cubic splines of linear combinations, fitted to gradients.

    W(e) = sum_k f_k(l_k . e),   f_k(0) = f_k'(0) = 0,   f_k'' = piecewise linear, never negative,
with fixed directions l_k and knots common to all. Second derivatives at the knots are the coefficients: the sum is
linear in them, so values, slopes and curvatures are fitted together by non-negative least squares, and whatever comes
out is convex. Beyond the knots f'' stays as it is at the last one.

With e the entries of the Green strain, l . e is the first invariant of a generalised structural tensor (Itskov and
Aksel, Int. J. Solids Struct. 41 (2004) 3833, whose tensors are positive; lattices that narrow when pulled need both
signs).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Ridges:
    """Directions (m, d), knots (k,) and curvatures (m, k), not negative, at the knots; one knot is 0."""

    directions: Array
    knots: Array
    curvature: Array

    def __post_init__(self) -> None:
        for name in ("directions", "knots", "curvature"):  # a stored model gives tuples
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=np.float64))

    def value(self, e: Array) -> Array:
        """Return W (n,) at points (n, d)."""
        return np.einsum("nmk,mk->n", basis(self.knots, e @ self.directions.T)[0], self.curvature)

    def derivatives(self, e: Array) -> tuple[Array, Array]:
        """Return the gradient (n, d) and the second derivatives (n, d, d) at points (n, d)."""
        first, second = self._along(e @ self.directions.T)
        l = self.directions
        return first @ l, np.einsum("nm,mi,mj->nij", second, l, l, optimize=True)

    def _along(self, x: Array) -> tuple[Array, Array]:
        """Return f' and f'' (n, m) of the ridges at x (n, m), one of each."""
        t, c = self.knots, self.curvature
        slope = self._slopes
        i = np.clip(np.searchsorted(t, x, side="right") - 1, 0, len(t) - 2)
        row = np.arange(len(c))
        left = x - t[i]
        width = t[i + 1] - t[i]
        rate = (c[row, i + 1] - c[row, i]) / width
        within = np.clip(left, 0.0, width)
        second = c[row, i] + rate * within
        first = slope[row, i] + c[row, i] * within + 0.5 * rate * within**2 + second * (left - within)
        return first, second

    @property
    def _slopes(self) -> Array:
        """f' (m, k) at the knots, 0 at the knot 0."""
        t, c = self.knots, self.curvature
        steps = 0.5 * (c[:, 1:] + c[:, :-1]) * np.diff(t)
        total = np.concatenate([np.zeros((len(c), 1)), np.cumsum(steps, axis=1)], axis=1)
        zero = int(np.flatnonzero(t == 0.0)[0])
        return np.asarray(total - total[:, zero : zero + 1])


def basis(knots: Array, x: Array) -> tuple[Array, Array, Array]:
    """Return f, f' and f'' (..., k) at x (...) of the splines whose f'' is 1 at one knot and 0 at the others."""
    t = knots
    second = np.stack([np.interp(x, t, row) for row in np.eye(len(t))], axis=-1)
    at = np.stack([_integrals(t, row, np.append(np.ravel(x), 0.0)) for row in np.eye(len(t))], axis=-1)  # (2, n + 1, k)
    slope = at[1, :-1] - at[1, -1]
    value = at[0, :-1] - at[0, -1] - at[1, -1] * np.ravel(x)[:, None]
    return value.reshape(second.shape), slope.reshape(second.shape), second


def _integrals(t: Array, c: Array, x: Array) -> Array:
    """Return the second and the first integral (2, n) from the first knot to x (n,) of c, linear between the knots."""
    width = np.diff(t)
    rate = np.diff(c) / width
    slope = np.append(0.0, np.cumsum(0.5 * (c[1:] + c[:-1]) * width))
    value = np.append(0.0, np.cumsum(slope[:-1] * width + c[:-1] * width**2 / 2.0 + rate * width**3 / 6.0))
    i = np.clip(np.searchsorted(t, x, side="right") - 1, 0, len(t) - 2)
    left = x - t[i]
    s = np.clip(left, 0.0, width[i])
    out = left - s
    end = c[i] + rate[i] * s
    first = slope[i] + c[i] * s + rate[i] * s**2 / 2.0
    second = value[i] + slope[i] * s + c[i] * s**2 / 2.0 + rate[i] * s**3 / 6.0
    return np.stack([second + first * out + end * out**2 / 2.0, first + end * out])


def fit(
    directions: Array, groups: NDArray[np.int64], knots: Array, e: Array, slopes: Array, weight: Array,
    curvatures: tuple[int, Array] | None = None, smooth: float = 1e-3,
) -> Ridges:  # fmt: skip
    """Return the ridges nearest to given gradients, by least squares.

    groups (m,): directions with one number have one spline. e (n, d): points. slopes (n, d): gradient there, weighted
    by `weight` (n, d). curvatures: an axis, and the second derivative (n,) along it; it weighs what slopes do at a
    distance of the widest knot interval. smooth: weight of the second differences of f''
    from knot to knot, of the largest entry.
    """
    count, k = int(groups.max()) + 1, len(knots)
    x = e @ directions.T
    _, first, second = basis(knots, x)  # (n, m, k)
    rows = np.zeros((e.shape[0], e.shape[1], count, k))
    for ridge, group in enumerate(groups):
        rows[:, :, group] += first[:, ridge, None, :] * directions[ridge][None, :, None]
    matrix = (rows * weight[:, :, None, None]).reshape(-1, count * k)
    right = (slopes * weight).ravel()
    if curvatures is not None:
        axis, wanted = curvatures
        scale = float(np.diff(knots).max())
        bent = np.zeros((len(e), count, k))
        for ridge, group in enumerate(groups):
            bent[:, group] += second[:, ridge] * directions[ridge, axis] ** 2
        share = scale * weight[:, axis]
        matrix = np.vstack([matrix, bent.reshape(len(e), -1) * share[:, None]])
        right = np.append(right, wanted * share)
    rough = np.kron(np.eye(count), np.diff(np.eye(k), n=2, axis=0)) * smooth * float(np.abs(matrix).max())
    small = np.eye(count * k) * 0.01 * smooth * float(np.abs(matrix).max())
    system = np.vstack([matrix, rough, small])
    solution, _ = nnls(system, np.append(right, np.zeros(len(system) - len(right))), maxiter=50 * count * k)
    return Ridges(directions, knots, solution.reshape(count, k)[groups])
