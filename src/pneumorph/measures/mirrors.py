"""The other halves of a body that is cut in planes of symmetry: what its sections are measured on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics import State, Symmetry

Array = NDArray[np.float64]

_ALONG = 1e-2  # of a line that lies along a plane: its ends are means over faces, on meshes that differ a little


def planes(state: State, along: Array) -> list[tuple[int, float]]:
    """Return the axis and the place, mm, of each plane of symmetry that a line with a direction (d,) can lie in."""
    mesh = state.model.mesh
    found = []
    for support in state.model.supports:
        if isinstance(support, Symmetry):
            nodes = mesh.points[mesh.face_nodes(support.face)]
            axis = int(np.argmin(np.ptp(nodes, axis=0)))
            if abs(along[axis]) < _ALONG * np.linalg.norm(along):
                found.append((axis, float(nodes[:, axis].mean())))
    return found


def completed(points: Array, mirrors: list[tuple[int, float]]) -> Array:
    """Return points (n, d) and, behind them, their images in one plane after the other (2^planes n, d)."""
    for axis, place in mirrors:
        image = points.copy()
        image[:, axis] = 2.0 * place - image[:, axis]
        points = np.concatenate([points, image])
    return points
