"""Which triangles of a wheel may touch a grain: cells over the wheel's box, each with the triangles in reach."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

from pneumorph.terrain.granular.contact_kernels import nearest_on_triangle

Array = NDArray[np.float64]

_MOST_CELLS = 200_000


@dataclass(frozen=True, eq=False)
class CellLists:
    """Cells of a side `size` from `origin` (3,) on, `counts` (3,) of them.

    Cell c, numbered along the last axis first, holds triangles[starts[c] : starts[c + 1]]: all that a sphere of the
    reach can touch whose centre lies in it. A centre outside the cells touches nothing. nearest[c]: distance of the
    cell's centre from the nearest triangle, where the cell holds one.
    """

    origin: Array
    size: float
    counts: NDArray[np.int64]
    starts: NDArray[np.int64]
    triangles: NDArray[np.int32]
    nearest: Array


def cell_lists(corners: Array, reach: float) -> CellLists:
    """Return the cells for triangles' corners (k, 3, 3) and spheres of at most a radius `reach`, in one unit."""
    low, high = corners.min(axis=(0, 1)) - reach, corners.max(axis=(0, 1)) + reach
    size = 0.5 * reach
    while prod(np.ceil((high - low) / size)) > _MOST_CELLS:
        size *= 1.25
    counts = np.ceil((high - low) / size).astype(np.int64) + 1
    near = reach + 0.5 * sqrt(3.0) * size  # of a cell's centre: no place of the cell is farther from it
    corners = np.ascontiguousarray(corners)
    starts = np.zeros(prod(counts) + 1, np.int64)
    nearest = np.full(prod(counts), np.inf)
    _fill(corners, near, low, size, counts, starts, np.empty(0, np.int32), nearest)
    starts = np.concatenate([[0], np.cumsum(starts[:-1])]).astype(np.int64)
    triangles = np.empty(starts[-1], np.int32)
    _fill(corners, near, low, size, counts, starts.copy(), triangles, nearest)
    return CellLists(low, float(size), counts, starts, triangles, nearest)


@njit(cache=True, nogil=True, error_model="numpy")
def _fill(
    corners: Array, near: float, low: Array, size: float, counts: NDArray[np.int64], places: NDArray[np.int64],
    triangles: NDArray[np.int32], nearest: Array,
) -> None:  # fmt: skip
    """Write each triangle into the cells whose centres are near it; places: the next free place of each cell.

    Without room in `triangles` only the places are counted up.
    """
    first, last = np.empty(3, np.int64), np.empty(3, np.int64)
    centre, place = np.empty(3), np.empty(3)
    for t in range(len(corners)):
        for i in range(3):
            below = min(corners[t, 0, i], corners[t, 1, i], corners[t, 2, i]) - near
            above = max(corners[t, 0, i], corners[t, 1, i], corners[t, 2, i]) + near
            first[i] = max(0, int((below - low[i]) / size))
            last[i] = min(counts[i] - 1, int((above - low[i]) / size))
        for a in range(first[0], last[0] + 1):
            centre[0] = low[0] + (a + 0.5) * size
            for b in range(first[1], last[1] + 1):
                centre[1] = low[1] + (b + 0.5) * size
                for c in range(first[2], last[2] + 1):
                    centre[2] = low[2] + (c + 0.5) * size
                    squared = nearest_on_triangle(centre, corners[t], place)
                    if squared > near * near:
                        continue
                    cell = (a * counts[1] + b) * counts[2] + c
                    nearest[cell] = min(nearest[cell], sqrt(squared))
                    if len(triangles):
                        triangles[places[cell]] = t
                    places[cell] += 1
