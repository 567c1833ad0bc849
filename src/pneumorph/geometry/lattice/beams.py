"""Distances between polygons, which are the widths of the beams between holes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def distance(first: Array, second: Array) -> float:
    """Return the least distance between the outlines of two polygons (n, 2) that do not overlap, mm."""
    return min(_from_corners(first, second), _from_corners(second, first))


def _from_corners(corners: Array, polygon: Array) -> float:
    """Return the least distance from corners to the sides of a polygon."""
    start, side = polygon, np.roll(polygon, -1, axis=0) - polygon
    offset = corners[:, None] - start  # (corners, sides, 2)
    along = np.clip(np.einsum("csi,si->cs", offset, side) / np.einsum("si,si->s", side, side), 0.0, 1.0)
    return float(np.linalg.norm(offset - along[..., None] * side, axis=2).min())
