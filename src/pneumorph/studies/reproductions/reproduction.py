"""What a reproduction of published work consists of, and the registry of all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, ReportedCurve
from pneumorph.studies.study import Study


@dataclass(frozen=True)
class Reproduction:
    """A published system, rebuilt.

    study:   (quick) -> what is solved; a quick one is coarser and stops earlier.
    compare: (solution, study) -> rows of reported and computed numbers; what was not reached has no computed one.
    curves:  (study) -> reported curves for the figures.
    notes:   sentences on what was assumed and what was left out.
    """

    name: str
    title: str
    source: str
    study: Callable[[bool], Study]
    compare: Callable[[Solution, Study], tuple[Comparison, ...]]
    curves: Callable[[Study], tuple[ReportedCurve, ...]]
    notes: tuple[str, ...] = ()


_KNOWN: dict[str, Reproduction] = {}


def register(item: Reproduction) -> Reproduction:
    """Make a reproduction known by its name."""
    _KNOWN[item.name] = item
    return item


def names() -> tuple[str, ...]:
    """Return the names of all reproductions, sorted."""
    return tuple(sorted(_KNOWN))


def reproduction(name: str) -> Reproduction:
    """Return a reproduction by name; raises NameNotFoundError with the nearest name."""
    if name not in _KNOWN:
        raise NameNotFoundError(unknown_name("reproduction", name, _KNOWN))
    return _KNOWN[name]
