"""Contact between facets, by ipctk: the only module that imports it.

Incremental potential contact (Li et al., ACM Trans. Graph. 39 (2020) 49): a barrier on the distances of vertices to
facets and of edges to edges, weighted by area, and continuous collision detection for the steps. Facets are rigid or on
nodes of the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import ipctk
import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mechanics.contact.part import NO_ENTRIES, Part, Place, upper

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

KEPT = 0.3  # share of a distance that a step leaves
NEAR = 4.0  # reach, in that of the barrier, within which pairs get a place in the sparsity pattern
RINGS = 2  # vertices so many edges apart on one surface are never in contact


@dataclass(frozen=True, eq=False)
class FacetLag:
    """ipctk's tangential collisions."""

    collisions: Any


@dataclass(frozen=True, eq=False)
class Surfaces:
    """What may collide: facets on the mesh, and rigid ones.

    soft (m, d): facets on nodes of the mesh, or on points that follow from them (see `Vertices`); sides (m,): number of
    the surface that each belongs to, pairs come from different ones; None for a surface in contact with itself.
    areas (vertices,): what each of them bears, mm2.
    rigid, rigid_facets: points (n, d) and facets of an obstacle; along (d,): direction in which it moves.
    riders (k, nodes): how the k vertices of `soft`, sorted, each once, follow from nodes; None where they are nodes.
    """

    soft: Integers
    areas: Array
    sides: Integers | None
    rigid: Array
    rigid_facets: Integers
    along: Array
    riders: sparse.csr_matrix | None = None


class FacetContact:
    """Facets of a mesh against themselves, each other, or a rigid surface (an `Interaction`).

    rest (nodes, d): undeformed nodes; reach: mm; stiffness: MPa; coefficient: of friction. rings: vertices of one
    surface so many edges apart or less are never in contact; 1 lets the sides of a closing crease meet, but needs
    facets larger than the reach.
    """

    def __init__(
        self, rest: Array, surfaces: Surfaces, reach: float, stiffness: float, coefficient: float, rings: int = RINGS
    ):
        ipctk.set_num_threads(1)  # on several threads its sums round differently from run to run
        self.nodes = np.unique(surfaces.soft)
        self.surfaces, self.along = surfaces, surfaces.along
        self.reach, self.stiffness, self.coefficient = reach, stiffness, coefficient
        self._unknowns, self._dimension = rest.size, rest.shape[1]
        self._own_unknowns = (self._dimension * self.nodes[:, None] + np.arange(self._dimension)).ravel()
        self._lift: sparse.csr_matrix | None = None  # unknowns of the mesh -> those of the soft vertices
        if surfaces.riders is not None:
            self._lift = sparse.kron(surfaces.riders, sparse.eye(self._dimension), format="csr")
        soft = np.searchsorted(self.nodes, surfaces.soft)
        facets = np.concatenate([soft, surfaces.rigid_facets + len(self.nodes)]).astype(np.int32)
        vertices = self._vertices(Place(rest))
        if self._dimension == 3:
            triangles = np.asfortranarray(facets)
            self._mesh = ipctk.CollisionMesh(vertices, np.asfortranarray(ipctk.edges(triangles)), triangles)
        else:
            self._mesh = ipctk.CollisionMesh(vertices, np.asfortranarray(facets))
        areas = np.array(self._mesh.vertex_areas)
        areas[: len(self.nodes)] = surfaces.areas[self.nodes]
        self._mesh.vertex_areas = areas
        self._mesh.can_collide = self._filter(soft, rings)

    def _filter(self, soft: Integers, rings: int) -> Any:
        """Return which vertices may collide: those of different sides, or of one surface if not close neighbours."""
        count, rigid = len(self.nodes), len(self.surfaces.rigid)
        if rigid or self.surfaces.sides is not None:
            side = np.zeros(count + rigid, dtype=np.int32)
            if self.surfaces.sides is not None:
                side[soft] = self.surfaces.sides[:, None]
            side[count:] = -1
            return ipctk.make_vertex_patches_filter(side)
        edges = np.asarray(self._mesh.edges)
        steps = sparse.csr_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
        steps = steps + steps.T + sparse.eye(count)
        close = steps
        for _ in range(rings - 1):
            close = close @ steps
        pairs = sparse.triu(close, 1).tocoo()
        return ipctk.make_sparse_filter(
            {(int(a), int(b)): False for a, b in zip(pairs.row, pairs.col, strict=True)}, True
        )

    def _vertices(self, place: Place) -> Array:
        rigid = self.surfaces.rigid + place.way * self.along
        soft = place.position[self.nodes] if self.surfaces.riders is None else self.surfaces.riders @ place.position
        return np.asfortranarray(np.concatenate([soft, rigid]))

    def _collisions(self, vertices: Array, reach: float) -> Any:
        candidates = ipctk.Candidates()
        candidates.build(self._mesh, vertices, 1.01 * reach)
        collisions = ipctk.NormalCollisions()
        collisions.use_area_weighting = True
        collisions.build(candidates, self._mesh, vertices, reach)
        return collisions

    def _potential(self, reach: float) -> Any:
        return ipctk.BarrierPotential(reach, self.stiffness, True)

    def normal(self, place: Place, *, hessian: bool, exact: bool = True) -> Part:
        """Return the barrier; `exact` Hessian, or projected to be positive semi-definite."""
        vertices = self._vertices(place)
        collisions = self._collisions(vertices, self.reach)
        if collisions.empty():
            return self._nothing()
        potential = self._potential(self.reach)
        gradient = potential.gradient(collisions, self._mesh, vertices)
        matrix = None
        if hessian:
            method = ipctk.PSDProjectionMethod.NONE if exact else ipctk.PSDProjectionMethod.CLAMP
            matrix = potential.hessian(collisions, self._mesh, vertices, method)
        return self._part(potential(collisions, self._mesh, vertices), gradient, matrix)

    def lag(self, place: Place) -> FacetLag:
        """Return normal forces and tangential planes."""
        vertices = self._vertices(place)
        result = ipctk.TangentialCollisions()
        collisions = self._collisions(vertices, self.reach)
        result.build(self._mesh, vertices, collisions, self._potential(self.reach), self.coefficient)
        return FacetLag(result)

    def tangential(self, lag: object, start: Place, place: Place, transition: float, *, hessian: bool) -> Part:
        """Return the potential of friction on the way from `start`, with a slip (mm) up to which it holds."""
        assert isinstance(lag, FacetLag)
        if lag.collisions.empty():
            return self._nothing()
        moved = np.asfortranarray(self._vertices(place) - self._vertices(start))
        potential = ipctk.FrictionPotential(transition)
        gradient = potential.gradient(lag.collisions, self._mesh, moved)
        matrix = potential.hessian(lag.collisions, self._mesh, moved) if hessian else None
        return self._part(potential(lag.collisions, self._mesh, moved), gradient, matrix)

    def limit(self, start: Place, end: Place) -> float:
        """Return the share, 0 to 1, of a straight way that keeps all distances above a part of the present ones."""
        before, after = self._vertices(start), self._vertices(end)
        least = KEPT * min(self._gap(before, self.reach), self.reach)
        candidates = ipctk.Candidates()
        candidates.build(self._mesh, before, after, least)
        # tight inclusion takes seconds for a pair of parallel edges on a long way; this one is as conservative
        detection = ipctk.AdditiveCCD(max_iterations=100_000)
        result: float = candidates.compute_collision_free_stepsize(self._mesh, before, after, least, detection)
        return result

    def distance(self, place: Place, reach: float | None = None) -> float:
        """Return the smallest distance, mm: infinite beyond reach, 0 where surfaces intersect."""
        vertices = self._vertices(place)
        if ipctk.has_intersections(self._mesh, vertices):
            return 0.0
        return self._gap(vertices, reach or self.reach)

    def _gap(self, vertices: Array, reach: float) -> float:
        collisions = self._collisions(vertices, reach)
        return float(np.sqrt(collisions.compute_minimum_distance(self._mesh, vertices)))

    def intersection(self, place: Place) -> Array | None:
        """Return a point (d,) where an edge meets a facet; None where surfaces do not intersect."""
        vertices = self._vertices(place)
        if not ipctk.has_intersections(self._mesh, vertices):
            return None
        edges, faces = np.asarray(self._mesh.edges), np.asarray(self._mesh.faces)
        phase = ipctk.LBVH() if self._dimension == 3 else ipctk.BruteForce()
        phase.can_vertices_collide = self._mesh.can_collide
        phase.build(vertices, self._mesh.edges, self._mesh.faces, 0.0)
        if self._dimension == 3:
            for pair in phase.detect_edge_face_candidates():
                edge, corners = vertices[edges[pair.edge_id]], vertices[faces[pair.face_id]]
                if ipctk.is_edge_intersecting_triangle(*edge, *corners):
                    return _crossing(edge, corners)
        for pair in phase.detect_edge_edge_candidates():
            edge, other = vertices[edges[pair.edge0_id]], vertices[edges[pair.edge1_id]]
            if self._dimension == 2 and ipctk.segment_segment_intersect(*edge, *other):
                return _crossing(edge, other)
        return vertices[: len(self.nodes)].mean(axis=0)

    def near(self, place: Place) -> Integers:
        """Return pairs of nodes (k, 2) that may soon be coupled: all within a few times the reach."""
        vertices = self._vertices(place)
        reach = NEAR * self.reach
        collisions = self._collisions(vertices, reach)
        if collisions.empty():
            return np.empty((0, 2), dtype=np.int64)
        # its non-zeros are the pairs, found by compiled code
        matrix = self._potential(reach).hessian(collisions, self._mesh, vertices).tocoo()
        first, second = matrix.row // self._dimension, matrix.col // self._dimension
        soft = (first < second) & (second < len(self.nodes))
        if self.surfaces.riders is not None:
            carry = self.surfaces.riders.astype(bool).astype(float)
            count = len(self.nodes)
            pairs = sparse.coo_matrix((np.ones(soft.sum()), (first[soft], second[soft])), shape=(count, count))
            coupled = (carry.T @ (pairs + pairs.T) @ carry).tocoo()
            kept = coupled.row < coupled.col
            return np.column_stack([coupled.row[kept], coupled.col[kept]]).astype(np.int64)
        return np.unique(self.nodes[np.column_stack([first[soft], second[soft]])], axis=0)

    def _nothing(self) -> Part:
        zero = np.zeros(self._unknowns)
        return Part(0.0, zero, NO_ENTRIES, np.zeros(self._dimension), zero)

    def _part(self, energy: float, gradient: Array, matrix: sparse.csc_matrix | None) -> Part:
        """Return what ipctk's vertices feel as felt by the nodes of the mesh and the obstacle."""
        d, soft = self._dimension, self._dimension * len(self.nodes)
        total = self._nodal(gradient[:soft])
        push = gradient[soft:].reshape(-1, d).sum(axis=0)
        coupling = np.zeros(self._unknowns)
        if matrix is None:
            return Part(energy, total, NO_ENTRIES, push, coupling)
        if len(self.surfaces.rigid):
            way = np.concatenate([np.zeros(soft), np.tile(self.along, len(self.surfaces.rigid))])
            coupling = self._nodal((matrix @ way)[:soft])
        if self._lift is not None:
            lifted = (self._lift.T @ matrix[:soft, :soft] @ self._lift).tocoo()
            rows, columns = lifted.row.astype(np.int64), lifted.col.astype(np.int64)
            return Part(energy, total, upper(rows, columns, lifted.data), push, coupling)
        entries = matrix.tocoo()
        unknowns = self._own_unknowns
        kept = (entries.row < soft) & (entries.col < soft)
        rows, columns = unknowns[entries.row[kept]], unknowns[entries.col[kept]]
        return Part(energy, total, upper(rows, columns, entries.data[kept]), push, coupling)

    def _nodal(self, vector: Array) -> Array:
        """Return what soft vertices feel (k * d,) as felt by the nodes of the mesh (unknowns,)."""
        if self._lift is not None:
            lifted: Array = self._lift.T @ vector
            return lifted
        result = np.zeros(self._unknowns)
        result[self._own_unknowns] = vector
        return result

    def forces(self, place: Place) -> Array:
        """Return the force of the barrier on each vertex of `nodes` (k, d), N."""
        vertices = self._vertices(place)
        collisions = self._collisions(vertices, self.reach)
        if collisions.empty():
            return np.zeros((len(self.nodes), self._dimension))
        gradient = self._potential(self.reach).gradient(collisions, self._mesh, vertices)
        return -np.asarray(gradient).reshape(-1, self._dimension)[: len(self.nodes)]


def _crossing(edge: Array, facet: Array) -> Array:
    """Return the point where a segment (2, d) meets the line or plane of a facet (d, d)."""
    sides = np.column_stack([edge[1] - edge[0], *(facet[0] - corner for corner in facet[1:])])
    share, *_ = np.linalg.lstsq(sides, facet[0] - edge[0], rcond=None)
    result: Array = edge[0] + np.clip(share[0], 0.0, 1.0) * (edge[1] - edge[0])
    return result
