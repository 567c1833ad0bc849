"""What a segment of skin does under pressure: the law that the search evaluates in place of finite elements."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.solution import History

Array = NDArray[np.float64]

# columns of the history of a run of the table
TURN, TIP, LENGTH, PRESSURE = "turn_rate", "tip_rotation", "line_length", "pressure:cavity"
_STEPS = 57


@dataclass(frozen=True)
class Lattice:
    """What tells one skin of two halves from another: cells along and around the whole tube, re-entrant columns."""

    along: int
    around: int
    reentrant: int


@dataclass(frozen=True)
class Bend:
    """turn: away from the re-entrant middle per length at rest, rad/mm; stretch: of the centre line."""

    turn: float
    stretch: float


class SegmentLaw(Protocol):
    """How a uniform skin bends and stretches its tube.

    end: length at either end of the tube, mm, that does not bend: caps keep it from swelling.
    """

    @property
    def end(self) -> float:
        """See above."""

    def bend(self, lattice: Lattice, cg: float, pressure: float) -> Bend:
        """Return turn and stretch of a long uniform tube at a pressure, MPa."""


@dataclass(frozen=True, eq=False)
class TableLaw:
    """A law interpolated in a table of runs of uniform tubes: linear in cg and in pressure, never beyond them.

    cg (m,), rising; pressure (k,), rising, MPa; turn, stretch: lattice -> values (m, k); end: mm, see `SegmentLaw`.
    """

    cg: Array
    pressure: Array
    turn: Mapping[Lattice, Array]
    stretch: Mapping[Lattice, Array]
    end: float

    def bend(self, lattice: Lattice, cg: float, pressure: float) -> Bend:
        """Return turn and stretch. Raises InputError for a lattice, cg or pressure that the table does not cover."""
        if lattice not in self.turn:
            raise InputError(f"the table holds no {lattice}")
        for name, value, axis in (("cg", cg, self.cg), ("pressure", pressure, self.pressure)):
            if not axis[0] - 1e-12 <= value <= axis[-1] + 1e-12:
                raise InputError(f"{name} = {value:g}: the table covers {axis[0]:g} to {axis[-1]:g}")
        return Bend(
            self._at(self.turn[lattice], cg, pressure),
            self._at(self.stretch[lattice], cg, pressure),
        )

    def _at(self, values: Array, cg: float, pressure: float) -> float:
        return float(np.interp(cg, self.cg, [np.interp(pressure, self.pressure, row) for row in values]))

    def lengths(self, rest: float) -> tuple[float, float]:
        """Return the shortest and the longest centre line of a tube of a length at rest, mm."""
        values = np.concatenate([stretch.ravel() for stretch in self.stretch.values()])
        return rest * float(values.min()), rest * float(values.max())


def law_of(runs: Mapping[tuple[Lattice, float], History], length: float, highest: float) -> TableLaw:
    """Return the law of a table of runs; runs: (lattice, cg) -> history, the same cg for every lattice.

    length: of the tubes at rest, mm. highest: pressure up to which it is wanted, MPa; it ends earlier where a run did.
    Raises InputError for a run without a state under pressure, or lattices with different cg.
    """
    lattices = list(dict.fromkeys(lattice for lattice, _ in runs))
    cg = np.unique([gap for _, gap in runs])
    for lattice, gap in itertools.product(lattices, cg):
        if (lattice, gap) not in runs:
            raise InputError(f"the table has no run of {lattice} with cg = {gap:g}")
    reached = min(_reached(history) for history in runs.values())
    if reached <= 0.0:
        raise InputError("a run of the table has no state under pressure: see its design.json for the reason")
    pressure = np.linspace(0.0, min(highest, reached), _STEPS)
    turn, stretch = {}, {}
    for lattice in lattices:
        curves = [_curves(runs[lattice, gap], length, pressure) for gap in cg]
        turn[lattice] = np.array([curve[0] for curve in curves])
        stretch[lattice] = np.array([curve[1] for curve in curves])
    return TableLaw(cg, pressure, turn, stretch, _end(runs.values(), length, float(pressure[-1])))


def _reached(history: History) -> float:
    return float(np.max(history.values(PRESSURE), initial=0.0)) if len(history) else 0.0


def _curves(history: History, length: float, pressure: Array) -> tuple[Array, Array]:
    """Return turn rate and stretch (k,) of a run at pressures, which rise along it."""
    known = history.values(PRESSURE)
    turn, line = history.values(TURN), history.values(LENGTH)
    return np.interp(pressure, known, turn), np.interp(pressure, known, line / length)


def _end(runs: Iterable[History], length: float, pressure: float) -> float:
    """Return how much of either end does not bend: where the whole turns by less than its middle says.

    From the run that turns most, as the difference of two angles; 0 where none turns.
    """
    best, end = 0.0, 0.0
    for history in runs:
        known = history.values(PRESSURE)
        rate = abs(float(np.interp(pressure, known, history.values(TURN))))
        tip = abs(float(np.interp(pressure, known, history.values(TIP))))
        if tip > best:
            best, end = tip, 0.5 * max(0.0, length - tip / rate)
    return min(end, 0.25 * length)
