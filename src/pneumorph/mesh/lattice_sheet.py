"""Flat lattice sheet -> quadratic triangles and quadrilaterals whose edges lie on all outlines of holes.

The edges of the rows of holes, and upright lines through all their corners, cut the sheet into quadrilaterals, which
shrink to triangles where two edges meet.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry.lattice import Lattice

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]
Mask = NDArray[np.bool_]

_SAME = 1e-9  # of the length of the sheet
_EDGES = {3: [(0, 1), (1, 2), (2, 0)], 4: [(0, 1), (1, 2), (2, 3), (3, 0)]}


@dataclass(frozen=True, eq=False)
class SheetMesh:
    """Planar mesh; nodes in the order of triangle6 and quad9, anticlockwise.

    points (n, 2): x from the lattice's mirror, or its seam without one, and y along, mm; some belong to no cell.
    cells: kind -> nodes (k, nodes a cell). A sheet that goes all the way around has its nodes at x = 0 for both ends.
    beam, below, above: kind -> mask (k,) of cells in a beam; in the strips at y = 0 and at the other end, which are
    triangles only. low, high (n,): y of the inner edge of these strips at the x of each point, mm.
    """

    points: Array
    cells: dict[str, Nodes]
    beam: dict[str, Mask]
    below: dict[str, Mask]
    above: dict[str, Mask]
    low: Array
    high: Array


def mesh_sheet(lattice: Lattice, size: float, strip: float | None, *, half: bool = False) -> SheetMesh:
    """Return the planar mesh of a lattice, holes included (cells that are not `beam`).

    size: largest edge, mm, along and around. strip: wanted height of the strips at both ends, mm; they end at the lines
    of the mesh that are nearest; None: no strips, so that all rows are meshed alike. half: from one line of symmetry to
    the other (`Lattice.mirror` must exist).
    """
    start = 0.0 if lattice.mirror is None else lattice.mirror
    extent = lattice.around / (2.0 if half else 1.0)
    x = np.sort((lattice.lines - start) % lattice.around)
    x[lattice.around - x < _SAME * lattice.around] = 0.0
    x = np.unique(x)
    x = np.append(x[x < extent * (1.0 - _SAME)], extent)
    bands, y = _levels(lattice, x + start, size, 1 if strip is None else 2)
    low, high = 0, len(bands)
    if strip is not None:
        middle = lattice.length / 2.0
        low, high = _nearest(y, strip, middle), _nearest(y, lattice.length - strip, middle)
    empty = np.array([_in_holes(lattice, row, (x[:-1] + x[1:]) / 2.0 + start) for row in range(lattice.rows)])
    polygons: list[Array] = []
    marks: list[tuple[bool, bool, bool]] = []
    for column, (left, right) in enumerate(itertools.pairwise(x)):
        parts = max(1, math.ceil((right - left) / size - _SAME))
        for part in range(parts):
            shares = part / parts, (part + 1) / parts
            ends = left + shares[0] * (right - left), left + shares[1] * (right - left)
            ends = (ends[0], right) if part + 1 == parts else ends
            first, last = ((1.0 - s) * y[:, column] + s * y[:, column + 1] for s in shares)
            first, last = _snapped(first, lattice.length), _snapped(last, lattice.length)
            for band, row in enumerate(bands):
                corners = [(ends[0], first[band]), (ends[1], last[band])]
                corners += [(ends[1], last[band + 1]), (ends[0], first[band + 1])]
                mark = row < 0 or not empty[row, column], band < low, band >= high
                pieces = _pieces(np.array(corners), split=mark[1] or mark[2])
                polygons += pieces
                marks += [mark] * len(pieces)
    points, cells, order = _numbered(polygons, None if half else extent)
    beam, below, above = (
        {kind: np.array([marks[i][n] for i in order[kind]], dtype=bool) for kind in cells} for n in range(3)
    )
    return SheetMesh(
        points, cells, beam, below, above, np.interp(points[:, 0], x, y[low]), np.interp(points[:, 0], x, y[high])
    )


def plain_sheet(x: Array, y: Array, *, closed: bool) -> SheetMesh:
    """Return a sheet without holes, cut by lines at x (from 0) and y (from 0), mm; all cells are `beam`.

    The first and the last row are the strips at the ends. closed: the last x is where the sheet meets x = 0 again.
    """
    polygons: list[Array] = []
    bands: list[int] = []
    for (left, right), (band, (low, high)) in itertools.product(
        itertools.pairwise(x), enumerate(itertools.pairwise(y))
    ):
        corners = np.array([(left, low), (right, low), (right, high), (left, high)])
        pieces = _pieces(corners, split=band in (0, len(y) - 2))
        polygons += pieces
        bands += [band] * len(pieces)
    points, cells, order = _numbered(polygons, float(x[-1]) if closed else None)
    band_of = {kind: np.array(bands)[order[kind]] for kind in cells}
    beam, below, above = (
        {kind: test(found) for kind, found in band_of.items()}
        for test in (lambda found: found >= 0, lambda found: found == 0, lambda found: found == len(y) - 2)
    )
    ends = np.full(len(points), y[1]), np.full(len(points), y[-2])
    return SheetMesh(points, cells, beam, below, above, *ends)


def _levels(lattice: Lattice, x: Array, size: float, ends: int) -> tuple[list[int], Array]:
    """Return for each band between two levels the row of holes in it, or -1; and the levels (bands + 1, n).

    ends: least number of bands in the first and the last row of holes.
    """
    edges = lattice.levels(x % lattice.around)
    edges = np.vstack([np.zeros(len(x)), edges, np.full(len(x), lattice.length)])
    bands: list[int] = []
    levels = [edges[0]]
    for number, (low, high) in enumerate(itertools.pairwise(edges)):
        # the strips at the ends need a line that meets neither end: the middle of a row of holes at the latest
        least = ends if number in (1, len(edges) - 3) else 1
        parts = max(least, math.ceil(float((high - low).max()) / size - _SAME))
        bands += [number // 2 if number % 2 else -1] * parts
        levels += [low + (high - low) * (i + 1) / parts for i in range(parts)]
    return bands, np.array(levels)


def _nearest(y: Array, wanted: float, middle: float) -> int:
    """Return the level nearest to a height, of those on its side of the middle that keep away from both."""
    side = y if wanted < middle else 2.0 * middle - y
    aim = min(wanted, 2.0 * middle - wanted)
    free = (side.min(axis=1) > 0.05 * side.max(axis=1)) & (side.max(axis=1) < 0.95 * middle)
    return int(np.argmin(np.where(free, np.abs(side - aim).max(axis=1), np.inf)))


def _in_holes(lattice: Lattice, row: int, x: Array) -> NDArray[np.bool_]:
    """Return whether x (n,) lies in a hole of a row."""
    inside = np.zeros(len(x), dtype=bool)
    for hole in lattice.in_row(row):
        for shift in (-lattice.around, 0.0, lattice.around):
            inside |= (x % lattice.around > hole.upper[0, 0] + shift) & (x % lattice.around < hole.upper[-1, 0] + shift)
    return inside


def _snapped(y: Array, length: float) -> Array:
    """Return levels of which nearly equal neighbours are equal, within 0 and the length."""
    y = y.copy()
    for end in (0.0, length):
        y[np.abs(y - end) < _SAME * length] = end
    for i in range(1, len(y)):
        if y[i] - y[i - 1] < _SAME * length:
            y[i] = y[i - 1]
    return y


def _pieces(corners: Array, split: bool) -> list[Array]:
    """Return the polygon that a quadrilateral with merged corners is, if any; `split` makes triangles of it."""
    corners = corners[(corners != np.roll(corners, 1, axis=0)).any(axis=1)]
    if len(corners) < 3:
        return []
    if len(corners) == 3 or not split:
        return [corners]
    diagonal = np.linalg.norm(corners[2:] - corners[:2], axis=1)
    return (
        [corners[[0, 1, 2]], corners[[0, 2, 3]]]
        if diagonal[0] <= diagonal[1]
        else [corners[[0, 1, 3]], corners[[1, 2, 3]]]
    )


def _numbered(polygons: list[Array], seam: float | None) -> tuple[Array, dict[str, Nodes], dict[str, Nodes]]:
    """Return points, cells by kind, and the numbers of their polygons, which share equal corners.

    seam: x whose nodes become those at x = 0; None for a sheet that stays open.
    """
    counts = np.array([len(polygon) for polygon in polygons])
    places = np.concatenate(polygons)
    # neighbours find their common corners by the same arithmetic: rounding only absorbs the last digits
    _, unique, number = np.unique(np.round(places, 9), axis=0, return_index=True, return_inverse=True)
    corners, number = places[unique], number.ravel()
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    parts = {size: number[first[counts == size][:, None] + np.arange(size)] for size in (3, 4)}
    edges = np.concatenate([np.sort(part[:, pair], axis=1) for size, part in parts.items() for pair in _EDGES[size]])
    edges, found = np.unique(edges, axis=0, return_inverse=True)
    points = np.vstack([corners, corners[edges].mean(axis=1), corners[parts[4]].mean(axis=1)])
    mids = np.split(found.ravel() + len(corners), np.cumsum([len(parts[3])] * 3 + [len(parts[4])] * 4)[:-1])
    centres = len(corners) + len(edges) + np.arange(len(parts[4]))
    cells = {
        "triangle6": np.column_stack([parts[3], *mids[:3]]),
        "quad9": np.column_stack([parts[4], *mids[3:], centres]),
    }
    if seam is not None:
        right, left = np.flatnonzero(points[:, 0] == seam), np.flatnonzero(points[:, 0] == 0.0)
        same = np.arange(len(points))
        same[right[np.argsort(points[right, 1])]] = left[np.argsort(points[left, 1])]
        cells = {kind: same[nodes] for kind, nodes in cells.items()}
    order = {"triangle6": np.flatnonzero(counts == 3), "quad9": np.flatnonzero(counts == 4)}
    return points, {kind: nodes for kind, nodes in cells.items() if len(nodes)}, order
