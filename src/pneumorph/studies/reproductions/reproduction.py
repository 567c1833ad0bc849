"""What a reproduction of published work consists of, and the registry of all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, ReportedCurve
from pneumorph.studies.study import Study


@dataclass(frozen=True)
class Reproduction:
    """A published system, rebuilt.

    study:   (quick) -> what is solved; a quick one is coarser and stops earlier.
    compare: (solution, study) -> rows of reported and computed numbers; what was not reached has no computed one.
    curves:  (study) -> reported curves for the figures; none where it is left out.
    profiles: (solution, study) -> further figures, such as stress along a line.
    notes:   sentences on what was assumed and what was left out.
    parts:   label -> name of a reproduction, for a system of several runs; its own name is among them. All are run, the
        others into folders of their label inside its folder, and their rows join its comparison.
    """

    name: str
    title: str
    source: str
    study: Callable[[bool], Study]
    compare: Callable[[Solution, Study], tuple[Comparison, ...]]
    curves: Callable[[Study], tuple[ReportedCurve, ...]] = lambda study: ()
    notes: tuple[str, ...] = ()
    profiles: Callable[[Solution, Study], tuple[Profile, ...]] = lambda solution, study: ()
    parts: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class SystemInParts:
    """A published system of several models that are run one by one; parts: name -> what it is."""

    name: str
    title: str
    source: str
    parts: Mapping[str, str]


@dataclass(frozen=True)
class SystemBySweep:
    """A published system whose trends are told from a sweep of many designs.

    parts: what is run beside the sweep, each by itself: name -> what it is.
    """

    name: str
    title: str
    source: str
    parts: Mapping[str, str] = field(default_factory=dict)


_KNOWN: dict[str, Reproduction] = {}
_BY_SWEEP: dict[str, SystemBySweep] = {}
_IN_PARTS: dict[str, SystemInParts] = {}


def register(item: Reproduction) -> Reproduction:
    """Make a reproduction known by its name."""
    _KNOWN[item.name] = item
    return item


def register_parts(item: SystemInParts) -> SystemInParts:
    """Make a system in parts known by its name."""
    _IN_PARTS[item.name] = item
    return item


def register_sweep(item: SystemBySweep) -> SystemBySweep:
    """Make a system by a sweep known by its name."""
    _BY_SWEEP[item.name] = item
    return item


def names() -> tuple[str, ...]:
    """Return the names of all reproductions, sorted, also of those in parts and by sweeps."""
    return tuple(sorted({*_KNOWN, *_IN_PARTS, *_BY_SWEEP}))


def reproduction(name: str) -> Reproduction | SystemInParts | SystemBySweep:
    """Return a reproduction by name; raises NameNotFoundError with the nearest name."""
    if name in _IN_PARTS:
        return _IN_PARTS[name]
    if name in _BY_SWEEP:
        return _BY_SWEEP[name]
    if name not in _KNOWN:
        raise NameNotFoundError(unknown_name("reproduction", name, names()))
    return _KNOWN[name]
