"""Cuts of a drawing along a plane of the undeformed body: the same material cut in every state."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.reference import NODES
from pneumorph.report.surface import Lines, Surface, combine

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# linear tetrahedra that fill a quadratic cell, by local nodes
_CORNERS = [(0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3)]
_MIDDLE = [(4, 6, 7, 8), (4, 5, 6, 8), (6, 7, 8, 9), (5, 6, 8, 9)]
_WEDGE_PARTS = [(0, 6, 8), (6, 1, 7), (8, 7, 2), (6, 7, 8)]
_LAYERS = [(0, 1, 2, 6, 7, 8), (12, 13, 14, 15, 16, 17), (3, 4, 5, 9, 10, 11)]


@dataclass(frozen=True)
class Plane:
    """A plane in the undeformed body; the half with (x - point) . normal < 0 stays."""

    point: tuple[float, float, float]
    normal: tuple[float, float, float]

    def distance(self, points: Array) -> Array:
        """Return the signed distance (n,), never exactly zero."""
        distance: Array = (points - np.array(self.point)) @ np.array(self.normal)
        # a node in the plane would make empty triangles: shift it by what no picture shows
        tiny = 1e-7 * max(float(np.ptp(points)), 1e-300)
        return np.where(np.abs(distance) < tiny, -tiny, distance)


def cut_surface(surface: Surface, mesh: Mesh, plane: Plane) -> Surface:
    """Return what stays of a surface."""
    distance = plane.distance(surface.weights @ mesh.points)
    inside = distance[surface.triangles] < 0.0
    count = inside.sum(axis=1)
    triangles, label = [surface.triangles[count == 3]], [surface.label[count == 3]]
    new = _Crossings(distance, len(surface.weights.indptr) - 1)
    for alone in (1, 2):  # one corner stays: a triangle; two stay: a quadrilateral
        chosen = surface.triangles[count == alone]
        odd = np.argmax(inside[count == alone] == (alone == 1), axis=1)
        rows = np.arange(len(chosen))
        a, b, c = (chosen[rows, (odd + i) % 3] for i in range(3))
        ab, ac = new(a, b), new(a, c)
        parts = [(a, ab, ac)] if alone == 1 else [(ab, b, c), (ab, c, ac)]
        for part in parts:
            triangles.append(np.column_stack(part))
            label.append(surface.label[count == alone])
    weights = sparse.vstack([surface.weights, new.weights() @ surface.weights], format="csr")
    return Surface(weights, np.concatenate(triangles), surface.names, np.concatenate(label))


def cut_lines(lines: Lines, mesh: Mesh, plane: Plane) -> Lines:
    """Return the segments that lie in the half that stays."""
    distance = plane.distance(lines.weights @ mesh.points)
    return Lines(lines.weights, lines.segments[(distance[lines.segments] < 0.0).all(axis=1)])


def rim(surface: Surface, mesh: Mesh, plane: Plane) -> Lines:
    """Return the lines in which a surface meets the plane."""
    distance = plane.distance(surface.weights @ mesh.points)
    inside = distance[surface.triangles] < 0.0
    crossed = np.isin(inside.sum(axis=1), (1, 2))
    chosen, inside = surface.triangles[crossed], inside[crossed]
    odd = np.argmax(inside == (inside.sum(axis=1) == 1)[:, None], axis=1)
    a, b, c = (chosen[np.arange(len(chosen)), (odd + i) % 3] for i in range(3))
    new = _Crossings(distance, 0)
    segments = np.column_stack([new(a, b), new(a, c)])
    return Lines((new.weights() @ surface.weights).tocsr(), segments)


def cap(mesh: Mesh, plane: Plane) -> Surface:
    """Return the section through the cells of a solid, labelled by material domain.

    Each quadratic cell is taken as the eight linear ones (wedges: 8 times 3 tetrahedra) on its nodes.
    """
    distance = plane.distance(mesh.points)
    new = _Crossings(distance, 0)
    names = mesh.domains
    triangles, label = [np.empty((0, 3), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for block in mesh.blocks:
        below = distance[block.nodes] < 0.0
        near = block.nodes[below.any(axis=1) & ~below.all(axis=1)]
        tetra = near[:, _tetrahedra(block.kind)].reshape(-1, 4)
        inside = distance[tetra] < 0.0
        count = inside.sum(axis=1)
        before = sum(map(len, triangles))
        for alone in (1, 3):
            chosen, rows = tetra[count == alone], np.arange(int((count == alone).sum()))
            odd = np.argmax(inside[count == alone] == (alone == 1), axis=1)
            a, b, c, d = (chosen[rows, (odd + i) % 4] for i in range(4))
            triangles.append(np.column_stack([new(a, b), new(a, c), new(a, d)]))
        order = np.argsort(~inside[count == 2], axis=1, kind="stable")
        a, b, c, d = np.take_along_axis(tetra[count == 2], order, axis=1).T
        ac, ad, bc, bd = new(a, c), new(a, d), new(b, c), new(b, d)
        triangles += [np.column_stack([ac, ad, bd]), np.column_stack([ac, bd, bc])]
        label.append(np.full(sum(map(len, triangles)) - before, names.index(block.domain)))
    return Surface(new.weights(len(mesh.points)), np.concatenate(triangles), names, np.concatenate(label))


class _Crossings:
    """Collects points on edges where the distance is zero, as weights of the edges' ends."""

    def __init__(self, distance: Array, first: int):
        self._distance = distance
        self._count = first
        self._ends: list[tuple[Index, Index]] = []

    def __call__(self, a: Index, b: Index) -> Index:
        """Return the numbers of the new points on the edges a-b."""
        self._ends.append((a, b))
        numbers = np.arange(self._count, self._count + len(a))
        self._count += len(a)
        return numbers

    def weights(self, columns: int | None = None) -> sparse.csr_matrix:
        """Return the weights (new points, old points)."""
        a = np.concatenate([ends[0] for ends in self._ends])
        b = np.concatenate([ends[1] for ends in self._ends])
        share = self._distance[a] / (self._distance[a] - self._distance[b])
        rows = np.arange(len(a))
        shape = (len(a), columns or len(self._distance))
        return combine(np.repeat(rows, 2), np.column_stack([a, b]), np.column_stack([1.0 - share, share]), shape)


def _tetrahedra(kind: str) -> Index:
    """Return the linear tetrahedra (t, 4), by local nodes, that fill a cell."""
    if kind == "tetra10":
        return np.array(_CORNERS + _MIDDLE)
    result: list[Sequence[int]] = []
    if kind == "hexahedron27":
        number = {tuple(place): n for n, place in enumerate(np.rint(2.0 * NODES[kind]).astype(int).tolist())}
        for corner in itertools.product((0, 1), repeat=3):
            # six tetrahedra about the diagonal, one for each order in which its three steps are taken
            for steps in itertools.permutations(range(3)):
                path = [list(corner)]
                for axis in steps:
                    path.append([c + (i == axis) for i, c in enumerate(path[-1])])
                result.append([number[tuple(place)] for place in path])
        return np.array(result)
    for low, high in pairwise(_LAYERS):
        for part in _WEDGE_PARTS:
            place = [(0, 1, 2, 6, 7, 8).index(i) for i in part]
            (a, b, c), (d, e, f) = ([layer[i] for i in place] for layer in (low, high))
            result += [(a, b, c, d), (b, c, d, e), (c, d, e, f)]
    return np.array(result)
