"""The middle of a round disc whose rim is a strip of triangles: tetrahedra to the centre, which need no mesher."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]

_MIDS = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # of tetra10, behind its four corners


def plug(points: Array, rim: Nodes, z: tuple[float, float]) -> tuple[Array, Nodes]:
    """Return the points (n + more, 3) and tetra10 cells (k, 10) that fill a disc, or half a disc, about the z axis.

    points (n, 3), mm. rim: triangle6 (m, 6) that make up its curved surface from z[0] to z[1], seen from outside
    anticlockwise; the cells take over its nodes. Each triangle is joined to the centre of the disc, each edge at an end
    to the centre and the middle of that end.
    """
    centre = len(points)
    points = np.vstack([points, [(0.0, 0.0, sum(z) / 2.0), (0.0, 0.0, z[0]), (0.0, 0.0, z[1])]])
    known = {
        tuple(sorted((int(row[i]), int(row[j])))): int(row[3 + side])
        for row in rim
        for side, (i, j) in enumerate([(0, 1), (1, 2), (2, 0)])
    }
    corners = [(centre, *map(int, row[:3])) for row in rim]
    small = 1e-9 * (z[1] - z[0])
    for row in rim:
        for i, j in [(0, 1), (1, 2), (2, 0)]:
            for end, middle in ((0, centre + 1), (1, centre + 2)):
                if np.abs(points[row[[i, j]], 2] - z[end]).max() < small:
                    corners.append((centre, int(row[j]), int(row[i]), middle))
    cells: list[list[int]] = []
    more: list[Array] = []
    for cell in corners:
        mids = []
        for i, j in _MIDS:
            key = tuple(sorted((cell[i], cell[j])))
            if key not in known:
                known[key] = len(points) + len(more)
                more.append(points[list(key)].mean(axis=0))
            mids.append(known[key])
        cells.append([*cell, *mids])
    return np.vstack([points, more]), np.array(cells, dtype=np.int64)
