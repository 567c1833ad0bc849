"""Reference cells of the quadratic kinds: node places, shape functions, sample points, and the Jacobian there.

The shape functions come from a Vandermonde matrix in the nodes, independent of the tables that mechanics uses.
"""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_TRIANGLE = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.5, 0.5), (0.0, 0.5)]
_TETRA = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
_TETRA += [(0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0), (0, 0, 0.5), (0.5, 0, 0.5), (0, 0.5, 0.5)]
# corners below, corners above, mids below, mids above, mids between, centres of the quadrilaterals
_WEDGE = [(*_TRIANGLE[i], z) for half, z in [((0, 1, 2), 0.0), ((0, 1, 2), 1.0), ((3, 4, 5), 0.0)] for i in half]
_WEDGE += [(*_TRIANGLE[i], z) for half, z in [((3, 4, 5), 1.0), ((0, 1, 2), 0.5), ((3, 4, 5), 0.5)] for i in half]

_QUAD = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5), (0.5, 0.5)]
# corners below and above, mids below, above and between, centres of the faces -x +x -y +y -z +z, centre
_HEXAHEDRON = [(x, y, z) for half, z in [(_QUAD[:4], 0.0), (_QUAD[:4], 1.0)] for x, y in half]
_HEXAHEDRON += [(x, y, z) for z in (0.0, 1.0) for x, y in _QUAD[4:8]] + [(x, y, 0.5) for x, y in _QUAD[:4]]
_HEXAHEDRON += [(0, 0.5, 0.5), (1, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 1, 0.5), (0.5, 0.5, 0), (0.5, 0.5, 1), (0.5,) * 3]

NODES: dict[str, Array] = {
    "triangle6": np.array(_TRIANGLE, dtype=float),
    "quad9": np.array(_QUAD, dtype=float),
    "tetra10": np.array(_TETRA, dtype=float),
    "wedge18": np.array(_WEDGE, dtype=float),
    "hexahedron27": np.array(_HEXAHEDRON, dtype=float),
}
_FLAT = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
_POWERS = {
    "triangle6": _FLAT,
    "quad9": [(i, j) for i in range(3) for j in range(3)],
    "tetra10": [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i + j + k <= 2],
    "wedge18": [(i, j, k) for i, j in _FLAT for k in range(3)],
    "hexahedron27": [(i, j, k) for i in range(3) for j in range(3) for k in range(3)],
}

# mid-edge nodes with the corners that they lie between, and centres of quadrilaterals with their four corners
MIDS: dict[str, dict[int, tuple[int, ...]]] = {
    "triangle6": {3: (0, 1), 4: (1, 2), 5: (2, 0)},
    "quad9": {4: (0, 1), 5: (1, 2), 6: (2, 3), 7: (3, 0), 8: (0, 1, 2, 3)},
    "tetra10": {4: (0, 1), 5: (1, 2), 6: (2, 0), 7: (0, 3), 8: (1, 3), 9: (2, 3)},
    "wedge18": {6: (0, 1), 7: (1, 2), 8: (2, 0), 9: (3, 4), 10: (4, 5), 11: (5, 3), 12: (0, 3), 13: (1, 4), 14: (2, 5)}
    | {15: (0, 1, 4, 3), 16: (1, 2, 5, 4), 17: (2, 0, 3, 5)},
    "hexahedron27": {8: (0, 1), 9: (1, 2), 10: (2, 3), 11: (3, 0), 12: (4, 5), 13: (5, 6), 14: (6, 7), 15: (7, 4)}
    | {16: (0, 4), 17: (1, 5), 18: (2, 6), 19: (3, 7), 20: (0, 4, 7, 3), 21: (1, 2, 6, 5), 22: (0, 1, 5, 4)}
    | {23: (2, 3, 7, 6), 24: (0, 3, 2, 1), 25: (4, 5, 6, 7), 26: (0, 1, 2, 3, 4, 5, 6, 7)},
}


@cache
def quadrature(kind: str) -> tuple[Array, Array]:
    """Return points (q, dim) and weights (q,) on the reference cell, exact for polynomials of degree 5 or more."""
    # collapsed Gauss rule: (x, y, z) = (u, v (1 - u), w (1 - u) (1 - v))
    line, weight = np.polynomial.legendre.leggauss(4)
    line, weight = (line + 1.0) / 2.0, weight / 2.0
    if kind == "triangle6":
        u, v = (g.ravel() for g in np.meshgrid(line, line, indexing="ij"))
        return np.column_stack([u, v * (1 - u)]), np.outer(weight, weight).ravel() * (1 - u)
    if kind == "quad9":
        return np.array([(x, y) for x in line for y in line]), np.outer(weight, weight).ravel()
    u, v, w = (g.ravel() for g in np.meshgrid(line, line, line, indexing="ij"))
    weights = np.einsum("i,j,k->ijk", weight, weight, weight).ravel()
    if kind == "hexahedron27":
        return np.column_stack([u, v, w]), weights
    if kind == "wedge18":
        return np.column_stack([u, v * (1 - u), w]), weights * (1 - u)
    return np.column_stack([u, v * (1 - u), w * (1 - u) * (1 - v)]), weights * (1 - u) ** 2 * (1 - v)


def shape(kind: str, points: Array) -> Array:
    """Return the shape functions (points, nodes) at reference points (points, dim)."""
    return _monomials(kind, points) @ _inverse(kind)


def shape_gradient(kind: str, points: Array) -> Array:
    """Return the gradients (points, nodes, dim) of the shape functions at reference points (points, dim)."""
    powers = np.array(_POWERS[kind])
    parts = []
    for axis in range(powers.shape[1]):
        lower = powers.copy()
        lower[:, axis] = np.maximum(lower[:, axis] - 1, 0)
        parts.append(powers[:, axis] * np.prod(points[:, None, :] ** lower, axis=2) @ _inverse(kind))
    return np.stack(parts, axis=-1)


def jacobians(points: Array, kind: str, nodes: NDArray[np.int64], at: Array | None = None) -> Array:
    """Return det J (cells, q) of the cells at reference points `at` (default: the quadrature points)."""
    places = quadrature(kind)[0] if at is None else at
    matrix = np.einsum("cni,qnj->cqij", points[nodes], shape_gradient(kind, places), optimize=True)
    return np.asarray(np.linalg.det(matrix))


def straightened(points: Array, kind: str, nodes: NDArray[np.int64]) -> Array:
    """Return the points with the mid nodes of inverted cells moved towards the middle of their corners.

    A cell counts as inverted if det J falls under a twentieth of its mean at a quadrature point or a node. The way to
    the middle is halved up to five times, then gone in full. Moving a shared node may spoil a neighbour, so this is
    repeated; it ends because straight cells are never inverted.
    """
    points = points.copy()
    places = np.vstack([quadrature(kind)[0], NODES[kind]])
    for share in itertools.chain([0.5] * 5, itertools.repeat(1.0)):
        det = jacobians(points, kind, nodes, places)
        bad = nodes[det.min(axis=1) < 0.05 * det.mean(axis=1)]
        target = points.copy()
        for mid, corners in MIDS[kind].items():
            target[bad[:, mid]] = points[bad[:, list(corners)]].mean(axis=1)
        if np.allclose(target, points, rtol=0.0, atol=1e-12):
            break
        points += share * (target - points)
    return points


@cache
def _inverse(kind: str) -> Array:
    return np.asarray(np.linalg.inv(_monomials(kind, NODES[kind])))


def _monomials(kind: str, points: Array) -> Array:
    return np.asarray(np.prod(np.asarray(points)[:, None, :] ** np.array(_POWERS[kind]), axis=2))
