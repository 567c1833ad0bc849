"""The boundary of a solid mesh, facet by facet: normals, areas, neighbours, smooth patches, and volumes enclosed."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pneumorph.mesh.mesh import CellBlock, FaceBlock
from pneumorph.mesh.reference import NODES, quadrature, shape, shape_gradient
from pneumorph.mesh.topology import CORNERS, boundary

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

# edges (end, end, middle) of a facet, in the sense in which its normal leaves the solid
EDGES = {"triangle6": ((0, 1, 3), (1, 2, 4), (2, 0, 5)), "quad9": ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))}


class Skin:
    """The facets of the boundary, numbered through its blocks.

    points (n, 3), mm; blocks: boundary faces, oriented outward; count: how many facets; corners (count, 4), -1 in the
    fourth place of a triangle; edge (e, 3): directed edges (end, end, middle), owner (e,): their facets.
    """

    def __init__(self, points: Array, cells: Iterable[CellBlock]):
        self.points = points
        self.blocks: tuple[FaceBlock, ...] = boundary(cells)
        self.count = sum(len(block.nodes) for block in self.blocks)
        self.corners = np.full((self.count, 4), -1, dtype=np.int64)
        edges, owners, first = [], [], 0
        for block in self.blocks:
            rows = np.arange(first, first + len(block.nodes))
            self.corners[rows, : CORNERS[block.kind]] = block.nodes[:, : CORNERS[block.kind]]
            edges.append(block.nodes[:, np.array(EDGES[block.kind])].reshape(-1, 3))
            owners.append(np.repeat(rows, len(EDGES[block.kind])))
            first += len(rows)
        self.edge: Index = np.concatenate(edges)
        self.owner: Index = np.concatenate(owners)

    @cached_property
    def keys(self) -> Index:
        """Sorted corners (count, 4) that identify the facets, -1 first for triangles."""
        return np.sort(self.corners, axis=1)

    @cached_property
    def centres(self) -> Array:
        """Mean of the corners (count, 3), mm."""
        known = self.corners >= 0
        total: Array = (self.points[self.corners] * known[..., None]).sum(axis=1)
        return total / known.sum(axis=1)[:, None]

    @cached_property
    def area_vectors(self) -> Array:
        """Integral of the outward normal over each facet (count, 3), mm2."""
        return self._integrals[0]

    @cached_property
    def areas(self) -> Array:
        """Area of the facets (count,), mm2: that of their area vectors, exact for flat ones."""
        size: Array = np.linalg.norm(self.area_vectors, axis=1)
        return size

    @cached_property
    def normals(self) -> Array:
        """Unit normals (count, 3), leaving the solid."""
        return self.area_vectors / np.maximum(self.areas, 1e-300)[:, None]

    @cached_property
    def shares(self) -> Array:
        """Volume under each facet (count,), int x.n / 3, mm3; over a closed set it sums up to what the set encloses."""
        return self._integrals[1]

    @cached_property
    def _integrals(self) -> tuple[Array, Array]:
        parts = [integrals(self.points[block.nodes] - self._origin, block.kind) for block in self.blocks]
        return np.concatenate([vector for vector, _ in parts]), np.concatenate([share for _, share in parts])

    @property
    def _origin(self) -> Array:
        middle: Array = 0.5 * (self.points.min(axis=0) + self.points.max(axis=0))
        return middle

    def closing_volume(self, corners: Array) -> float:
        """Return what 6-node triangles (m, 6, 3), mm, add to the volume that `shares` sum up."""
        return float(integrals(corners - self._origin, "triangle6")[1].sum())

    @cached_property
    def pairs(self) -> tuple[Index, Index]:
        """Directed edges (p,) and (p,) of `edge` that two facets share; edges of more than two facets join none."""
        ends = np.sort(self.edge[:, :2], axis=1)
        order = np.lexsort(ends.T)
        ends = ends[order]
        new = np.append(True, (ends[1:] != ends[:-1]).any(axis=1))
        start = np.flatnonzero(new)
        twice = start[np.diff(np.append(start, len(ends))) == 2]
        return order[twice], order[twice + 1]

    @cached_property
    def _edge_normals(self) -> Array:
        """Unit normal (e, 3) of each edge's facet in the middle of the edge."""
        result = []
        for block in self.blocks:
            places = NODES[block.kind][[middle for _, _, middle in EDGES[block.kind]]]
            tangent = np.einsum("eni,qnj->eqij", self.points[block.nodes], shape_gradient(block.kind, places))
            result.append(np.cross(tangent[..., 0], tangent[..., 1]).reshape(-1, 3))
        normal = np.concatenate(result)
        return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None])

    def patches(self, angle: float) -> Index:
        """Return numbers (count,) of smooth patches: neighbours that meet at less than an angle (rad) share one."""
        a, b = self.pairs
        smooth = np.einsum("ij,ij->i", self._edge_normals[a], self._edge_normals[b]) > np.cos(angle)
        return self._joined(smooth)

    def components(self, cut: Index) -> Index:
        """Return numbers (count,) of the pieces that hang together by edges, after cutting edges (k, 2 or 3) open."""
        a, _ = self.pairs
        width = len(self.points)
        ends = np.sort(self.edge[a, :2], axis=1) @ np.array([width, 1])
        return self._joined(~np.isin(ends, np.sort(cut[:, :2], axis=1) @ np.array([width, 1])))

    def facets_beside(self, edges: Index) -> Index:
        """Return the facets (k,) that have the directed edges (k, 2 or 3) of the surface."""
        keys, owner = self._directed
        return owner[np.searchsorted(keys, edges[:, 0] * len(self.points) + edges[:, 1])]

    @cached_property
    def _directed(self) -> tuple[Index, Index]:
        keys = self.edge[:, 0] * len(self.points) + self.edge[:, 1]
        order = np.argsort(keys)
        return keys[order], self.owner[order]

    def _joined(self, chosen: Mask) -> Index:
        a, b = self.pairs
        i, j = self.owner[a[chosen]], self.owner[b[chosen]]
        graph = coo_array((np.ones(len(i), dtype=bool), (i, j)), shape=(self.count, self.count))
        labels: Index = connected_components(graph, directed=False)[1].astype(np.int64)
        return labels

    def part(self, mask: Mask) -> tuple[FaceBlock, ...]:
        """Return the blocks of the chosen facets."""
        result, first = [], 0
        for block in self.blocks:
            rows = mask[first : first + len(block.nodes)]
            first += len(block.nodes)
            if rows.any():
                result.append(FaceBlock(block.kind, np.ascontiguousarray(block.nodes[rows])))
        return tuple(result)

    def nodes_of(self, mask: Mask) -> Index:
        """Return the nodes of the chosen facets, each once."""
        return np.unique(np.concatenate([block.nodes.ravel() for block in self.part(mask)]))

    def flat(self, mask: Mask) -> bool:
        """Return whether the chosen facets lie in one plane, to a millionth of their size."""
        x = self.points[self.nodes_of(mask)]
        centre = x.mean(axis=0)
        total = self.area_vectors[mask].sum(axis=0)
        size = float(np.linalg.norm(np.ptp(x, axis=0)))
        length = float(np.linalg.norm(total))
        return length > 0.0 and float(np.abs((x - centre) @ total).max()) < 1e-6 * size * length


def integrals(nodes: Array, kind: str) -> tuple[Array, Array]:
    """Return for facets with nodes (m, n, 3), mm, the integrals of n (m, 3), mm2, and of x.n / 3 (m,), mm3."""
    places, weight = quadrature(kind)
    tangent = np.einsum("eni,qnj->eqij", nodes, shape_gradient(kind, places), optimize=True)
    normal = np.cross(tangent[..., 0], tangent[..., 1]) * weight[:, None]
    x = np.einsum("eni,qn->eqi", nodes, shape(kind, places), optimize=True)
    return normal.sum(axis=1), np.einsum("eqi,eqi->e", x, normal) / 3.0
