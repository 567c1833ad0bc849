"""The fixed sparsity pattern: upper-triangular CSR over all unknowns, known by the neighbours of each node."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Pattern:
    """Rows of node A hold its own d x d block (upper part) and then one block for each neighbour B > A.

    keys: sorted A * nodes + B of all neighbour pairs A < B; start: where the neighbours of A begin in keys.
    """

    nodes: int
    dimension: int
    keys: Integers
    start: Integers

    @staticmethod
    def of_cells(nodes: int, dimension: int, connectivity: Iterable[Integers]) -> Pattern:
        """Return the pattern in which all nodes of a cell are neighbours."""
        keys = np.empty(0, dtype=np.int64)
        for cells in connectivity:
            first, second = _pairs(cells)
            found = np.unique(np.minimum(first, second) * nodes + np.maximum(first, second))
            keys = np.union1d(keys, found[found // nodes != found % nodes])
        start = np.searchsorted(keys, np.arange(nodes + 1) * nodes)
        return Pattern(nodes, dimension, keys, start)

    @cached_property
    def indptr(self) -> Integers:
        """Row pointers of the CSR matrix, (unknowns + 1,)."""
        d = self.dimension
        lengths = d * np.diff(self.start)[:, None] + np.arange(d, 0, -1)[None]
        return np.concatenate([[0], np.cumsum(lengths.ravel())])

    @cached_property
    def indices(self) -> NDArray[np.int32]:
        """Column indices of the CSR matrix, (values,)."""
        d = self.dimension
        result = np.empty(self.indptr[-1], dtype=np.int32)
        node = self.keys // self.nodes
        neighbour = self.keys % self.nodes
        rank = np.arange(len(self.keys)) - self.start[node]
        for i in range(d):
            own = self.indptr[:-1][i::d]
            for j in range(i, d):
                result[own + j - i] = d * np.arange(self.nodes) + j
            for j in range(d):
                result[own[node] + d - i + d * rank + j] = d * neighbour + j
        return result

    @cached_property
    def diagonal(self) -> Integers:
        """Position of each diagonal entry among the values."""
        return self.indptr[:-1]

    def slots(self, cells: Integers) -> NDArray[np.int32]:
        """Return, for each pair of a cell's nodes (upper triangle, row by row), the rank of the neighbour."""
        first, second = _pairs(cells)
        low, high = np.minimum(first, second), np.maximum(first, second)
        rank = np.searchsorted(self.keys, low * self.nodes + high) - self.start[low]
        return rank.reshape(len(cells), -1).astype(np.int32)

    def places(self, rows: Integers, columns: Integers) -> Integers:
        """Return where entries (rows <= columns) stand among the values; their nodes must be neighbours."""
        d = self.dimension
        first, second = rows // d, columns // d
        rank = np.searchsorted(self.keys, first * self.nodes + second) - self.start[first]
        return self.indptr[rows] + np.where(first == second, columns - rows, d - rows % d + d * rank + columns % d)

    def embedded(self, wider: Pattern) -> Integers:
        """Return where the values stand among those of a pattern that has all neighbours of this one, and more."""
        d = self.dimension
        node = self.keys // self.nodes
        rank = np.arange(len(self.keys)) - self.start[node]
        there_rank = np.searchsorted(wider.keys, self.keys) - wider.start[node]
        result = np.empty(self.indptr[-1], dtype=np.int64)
        for i in range(d):
            here, there = self.indptr[:-1][i::d], wider.indptr[:-1][i::d]
            for j in range(d - i):
                result[here + j] = there + j
            for j in range(d - i, 2 * d - i):
                result[here[node] + d * rank + j] = there[node] + d * there_rank + j
        return result

    def touching(self, unknowns: Integers) -> Integers:
        """Return the positions of all values in the rows and columns of some unknowns."""
        marked = np.zeros(self.nodes * self.dimension, dtype=bool)
        marked[unknowns] = True
        rows = np.repeat(marked, np.diff(self.indptr))
        return np.flatnonzero(rows | marked[self.indices])


def _pairs(cells: Integers) -> tuple[Integers, Integers]:
    a, b = np.triu_indices(cells.shape[1])
    return cells[:, a].ravel(), cells[:, b].ravel()
