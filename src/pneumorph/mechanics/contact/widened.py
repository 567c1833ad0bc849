"""The pattern of the tangent with room for pairs of nodes in contact, on top of that of the cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.contact.part import Entries
from pneumorph.mechanics.pattern import Pattern

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class WidenedPattern:
    """A pattern that grows, and puts values in the order of the cells' pattern at their places in it.

    It is never made smaller: each growth costs an analysis of the linear solver.
    """

    def __init__(self, base: Pattern):
        self.base = self.pattern = base
        self._places: Integers | None = None

    def missing(self, entries: Entries) -> Integers:
        """Return the pairs of nodes (k, 2) of matrix entries that have no place."""
        d, nodes = self.base.dimension, self.base.nodes
        first, second = entries[0] // d, entries[1] // d
        keys, _ = self._without_place((first * nodes + second)[first != second])
        return np.column_stack([keys // nodes, keys % nodes])

    def include(self, pairs: Integers) -> bool:
        """Give places to pairs of nodes (k, 2), first < second; return whether the pattern had to grow."""
        nodes = self.base.nodes
        new, places = self._without_place(pairs[:, 0] * nodes + pairs[:, 1])
        if not len(new):
            return False
        keys = np.insert(self.pattern.keys, places, new)
        start = np.searchsorted(keys, np.arange(nodes + 1) * nodes)
        self.pattern = Pattern(nodes, self.base.dimension, keys, start)
        self._places = self.base.embedded(self.pattern)
        return True

    def _without_place(self, keys: Integers) -> tuple[Integers, Integers]:
        """Return those of some keys of pairs that the pattern has not, sorted, each once, and where they belong."""
        wanted, there = np.unique(keys), self.pattern.keys
        places = np.searchsorted(there, wanted)
        new = np.append(there, -1)[places] != wanted
        return wanted[new], places[new]

    def widen(self, values: Array) -> Array:
        """Return values in the order of the base's pattern in that of this one."""
        if self._places is None:
            return values
        result = np.zeros(self.pattern.indptr[-1])
        result[self._places] = values
        return result

    def add(self, entries: Entries, values: Array) -> None:
        """Add matrix entries (upper triangle) to values in the order of this pattern."""
        rows, columns, numbers = entries
        values += np.bincount(self.pattern.places(rows, columns), numbers, len(values))
