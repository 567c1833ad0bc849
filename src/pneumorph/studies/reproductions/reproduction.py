"""What a reproduction of published work consists of, and the registry of all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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


@dataclass(frozen=True)
class SystemInParts:
    """A published system of several models that are run one by one; parts: name -> what it is."""

    name: str
    title: str
    source: str
    parts: Mapping[str, str]


_KNOWN: dict[str, Reproduction] = {}
_IN_PARTS: dict[str, SystemInParts] = {}


def register(item: Reproduction) -> Reproduction:
    """Make a reproduction known by its name."""
    _KNOWN[item.name] = item
    return item


def register_parts(item: SystemInParts) -> SystemInParts:
    """Make a system in parts known by its name."""
    _IN_PARTS[item.name] = item
    return item


def names() -> tuple[str, ...]:
    """Return the names of all reproductions, sorted, also of those in parts."""
    return tuple(sorted({*_KNOWN, *_IN_PARTS}))


def reproduction(name: str) -> Reproduction | SystemInParts:
    """Return a reproduction by name; raises NameNotFoundError with the nearest name."""
    if name in _IN_PARTS:
        return _IN_PARTS[name]
    if name not in _KNOWN:
        raise NameNotFoundError(unknown_name("reproduction", name, names()))
    return _KNOWN[name]
