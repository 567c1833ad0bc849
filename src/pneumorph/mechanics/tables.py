"""Shape functions, quadrature and pressure modes of the nodal elements, tabulated by basix in VTK's node order."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import basix
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CELLS = {
    "tetra10": basix.CellType.tetrahedron,
    "wedge18": basix.CellType.prism,
    "hexahedron27": basix.CellType.hexahedron,
    "triangle6": basix.CellType.triangle,
    "quad9": basix.CellType.quadrilateral,
    "line3": basix.CellType.interval,
    "triangle3": basix.CellType.triangle,
    "lens3": basix.CellType.triangle,
}

# position of each VTK node in basix's order
_FROM_BASIX = {
    "tetra10": [0, 1, 2, 3, 9, 6, 8, 7, 5, 4],
    "wedge18": [0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16],
    "hexahedron27": [
        0, 1, 3, 2, 4, 5, 7, 6, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 15, 14, 22, 23, 21, 24, 20, 25, 26,
    ],
    "triangle6": [0, 1, 2, 5, 3, 4],
    "quad9": [0, 1, 3, 2, 4, 6, 7, 5, 8],
    "line3": [0, 1, 2],
}  # fmt: skip

# virtual faces of caps are 6-node triangles (rows) whose nodes are means of three real ones (columns)
_CAPS = {
    "triangle3": np.array([[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]]) / 2.0,
    "lens3": np.array([[4, 0, 0], [0, 4, 0], [2, 2, 0], [0, 0, 4], [1, 3, 0], [3, 1, 0]]) / 4.0,
}


@dataclass(frozen=True, eq=False)
class CellTable:
    """Tabulated element: q points, n nodes, d reference directions, k pressure modes.

    shape (q, n), gradient (q, n, d) with respect to reference coordinates, weight (q,), modes (q, k);
    check_shape and check_gradient: the same at the points of a finer rule, for the smallest det F of a state.
    """

    kind: str
    shape: Array
    gradient: Array
    weight: Array
    modes: Array
    check_shape: Array
    check_gradient: Array


def reference_nodes(kind: str) -> Array:
    """Return the reference coordinates (n, d) of the nodes in VTK's order."""
    points: Array = np.asarray(_element(kind).points, dtype=float)[_FROM_BASIX[kind]]
    return points


def tabulate(kind: str, points: Array) -> tuple[Array, Array]:
    """Return shape functions (q, n) and their reference gradients (q, n, d) at reference points (q, d)."""
    if kind in _CAPS:
        shape, gradient = tabulate("triangle6", points)
        return shape @ _CAPS[kind], np.einsum("qmj,mn->qnj", gradient, _CAPS[kind])
    order = _FROM_BASIX[kind]
    table: Array = np.asarray(_element(kind).tabulate(1, points), dtype=float)[:, :, :, 0][:, :, order]
    return np.ascontiguousarray(table[0]), np.ascontiguousarray(np.moveaxis(table[1:], 0, -1))


@cache
def cell_table(kind: str, pressure: str = "constant") -> CellTable:
    """Return the table of a cell; `pressure` modes are 'linear' and discontinuous, or 'constant' in each cell."""
    points, weight = _rule(kind)
    shape, gradient = tabulate(kind, points)
    centred = points - points.mean(axis=0)
    ones = np.ones((len(points), 1))
    modes = np.hstack([ones, centred]) if pressure == "linear" else ones
    finer, _ = _quadrature(_CELLS[kind], 4)
    check_shape, check_gradient = tabulate(kind, finer)
    return CellTable(kind, shape, gradient, weight, modes, check_shape, check_gradient)


@cache
def face_table(kind: str) -> tuple[Array, Array, Array]:
    """Return shape (q, n), gradient (q, n, d) and weight (q,) that integrate the volume under a face exactly."""
    points, weight = _quadrature(_CELLS[kind], {"quad9": 6, "line3": 6}.get(kind, 4))
    shape, gradient = tabulate(kind, points)
    return shape, gradient, weight


def face_sizes(x: Array, gradient: Array) -> Array:
    """Return area or length over that of the reference face (m, q) at faces with nodes x (m, n, d), of one shape."""
    tangent = np.einsum("qmj,emi->eqij", gradient, x)
    if x.shape[2] == 3:
        return np.asarray(np.linalg.norm(np.cross(tangent[..., 0], tangent[..., 1]), axis=-1))
    return np.asarray(np.linalg.norm(tangent[..., 0], axis=-1))


@cache
def mass_rule(kind: str) -> tuple[Array, Array, Array]:
    """Return shape (q, n), gradient (q, n, d) and weight (q,) of a rule for products of two shape functions."""
    points, weight = _quadrature(_CELLS[kind], 5)
    shape, gradient = tabulate(kind, points)
    return shape, gradient, weight


@cache
def _element(kind: str) -> basix.finite_element.FiniteElement:
    return basix.create_element(basix.ElementFamily.P, _CELLS[kind], 2, basix.LagrangeVariant.gll_warped)


def _rule(kind: str) -> tuple[Array, Array]:
    """Return the quadrature points and weights in which stiffness and stress live."""
    if kind == "wedge18":  # 6 points in the triangle times 3 across: basix's own rule of that degree takes 27
        plane, plane_weight = _quadrature(basix.CellType.triangle, 4)
        line, line_weight = _quadrature(basix.CellType.interval, 4)
        points = np.array([[*p, z[0]] for z in line for p in plane])
        return points, np.array([a * b for b in line_weight for a in plane_weight])
    return _quadrature(_CELLS[kind], 4 if kind == "hexahedron27" else 2)


def _quadrature(cell: basix.CellType, degree: int) -> tuple[Array, Array]:
    points, weight = basix.make_quadrature(cell, degree)
    return np.asarray(points, dtype=float), np.asarray(weight, dtype=float)
