"""Gradient noise after Perlin: smooth random relief of one wavelength, the same on every machine for a seed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def perlin(x: Array, y: Array, seed: int) -> Array:
    """Return gradient noise at places x (columns,), y (rows,) in wavelengths, shape (rows, columns).

    A unit gradient of random direction stands at each whole place; between them their planes are blended with the
    quintic 6 t^5 - 15 t^4 + 10 t^3 (K. Perlin, Improving noise, SIGGRAPH 2002). Zero at whole places, within
    +-sqrt(1/2) everywhere.
    """
    left, low = np.floor(x).astype(int), np.floor(y).astype(int)
    columns, rows = left.max() - left.min() + 2, low.max() - low.min() + 2
    direction = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (rows, columns))
    column, row = (left - left.min())[None, :], (low - low.min())[:, None]
    u, v = (x - left)[None, :], (y - low)[:, None]

    def plane(right: int, up: int) -> Array:
        angle = direction[row + up, column + right]
        return np.cos(angle) * (u - right) + np.sin(angle) * (v - up)

    across, along = _fade(u), _fade(v)
    below = plane(0, 0) * (1.0 - across) + plane(1, 0) * across
    above = plane(0, 1) * (1.0 - across) + plane(1, 1) * across
    return np.asarray(below * (1.0 - along) + above * along)


def _fade(t: Array) -> Array:
    return np.asarray(t**3 * (t * (6.0 * t - 15.0) + 10.0))
