"""The consistent mass matrix, on the nodes and in the pattern of the tangent."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mechanics.body import cell_volumes
from pneumorph.mechanics.loads import density_of
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.tables import mass_rule

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Mass:
    """int rho N_a N_b dV of a model, tonne, by a rule that integrates it exactly in cells with straight edges.

    Raises InputError for a material without a density.
    """

    def __init__(self, model: Model):
        densities = densities_of(model)
        self._pattern = model.body.pattern
        nodes = len(model.mesh.points)
        self._own = np.zeros(nodes)
        self._shared = np.zeros(len(self._pattern.keys))
        for block in model.mesh.blocks:
            rule = mass_rule(block.kind)
            weights = densities[block.domain] * cell_volumes(model.mesh, block, rule)
            matrices = np.einsum("eq,qa,qb->eab", weights, rule[0], rule[0])
            a, b = np.triu_indices(block.nodes.shape[1])
            first, second, share = block.nodes[:, a].ravel(), block.nodes[:, b].ravel(), matrices[:, a, b].ravel()
            same = first == second
            self._own += np.bincount(first[same], share[same], nodes)
            first, second, share = first[~same], second[~same], share[~same]
            self._share(first, second, share)
        for frame in model.frames:
            a, b = np.triu_indices(len(frame.nodes), 1)
            self._own[frame.nodes] += np.diag(frame.matrix)
            self._share(frame.nodes[a], frame.nodes[b], frame.matrix[a, b])

    def _share(self, first: Integers, second: Integers, share: Array) -> None:
        """Add what pairs of neighbours (n,) have in common."""
        keys = np.minimum(first, second) * self._pattern.nodes + np.maximum(first, second)
        self._shared += np.bincount(np.searchsorted(self._pattern.keys, keys), share, len(self._shared))

    def times(self, vectors: Array) -> Array:
        """Return M x (nodes, d) of nodal vectors (nodes, d)."""
        result: Array = self._matrix @ vectors
        return result

    def add(self, factor: float, values: Array) -> None:
        """Add a multiple of the matrix to values in the order of the pattern."""
        d, rows = self._pattern.dimension, self._pattern.indptr[:-1]
        node = self._pattern.keys // self._pattern.nodes
        rank = np.arange(len(node)) - self._pattern.start[node]
        for i in range(d):
            own = rows[i::d]
            values[own] += factor * self._own
            values[own[node] + d + d * rank] += factor * self._shared

    @cached_property
    def _matrix(self) -> sparse.csr_matrix:
        nodes = self._pattern.nodes
        row, column = self._pattern.keys // nodes, self._pattern.keys % nodes
        upper = sparse.csr_matrix((self._shared, (row, column)), shape=(nodes, nodes))
        return upper + upper.T + sparse.diags(self._own, format="csr")


def densities_of(model: Model) -> dict[str, float]:
    """Return domain -> density, tonne/mm3; raises InputError for a material without one."""
    return {domain: density_of(material, domain, "inertia") for domain, material in model.materials.items()}
