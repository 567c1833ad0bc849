"""The gaits of the PneuNet robots: phases over named cavities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pneumorph.errors import InputError
from pneumorph.gaits.gait import Gait
from pneumorph.mechanics import Phase


def undulation(
    cavities: Sequence[str], pressure: float, *, cycles: int = 1, settle: Sequence[Phase] = (), **ramp: Any
) -> Gait:
    """Return a wave from the first cavity to the last: each is filled in turn, then each is released in that order.

    cavities: from rear to front, to go forward. pressure: gauge, MPa. ramp: what all phases share, see `Phase`
    (duration, inertia, first, largest). Raises InputError for a cavity named twice.
    """
    _each_once(cavities)
    steps: list[tuple[str, dict[str, float]]] = [(f"+{name}", {name: pressure}) for name in cavities]
    steps += [(f"-{name}", {name: 0.0}) for name in cavities]
    return Gait(_phases(steps, ramp), tuple(settle), cycles)


def crawling(
    legs: Sequence[str], centre: str, pressure: float, *, cycles: int = 1, settle: Sequence[Phase] = (), **ramp: Any
) -> Gait:
    """Return a crawl on four legs: the centre is filled and stays so, then one leg after the other is.

    legs: the two rear ones, then the two front ones, PN1 to PN4; a phase releases the leg before it. The cycle is
    +PN3 -PN1, +PN2 -PN3, +PN4 -PN2, +PN1 -PN4. Other arguments as for `undulation`. Raises InputError for other than
    four legs, and for a cavity named twice.
    """
    if len(legs) != 4:
        raise InputError(f"crawling: {len(legs)} legs, {', '.join(legs)}, expected 4")
    _each_once((*legs, centre))
    order = [legs[0], legs[2], legs[1], legs[3]]
    first = _phases([(f"+{centre}", {centre: pressure}), (f"+{order[0]}", {order[0]: pressure})], ramp)
    pairs = zip(order, [*order[1:], order[0]], strict=True)
    steps = [(f"+{new} -{old}", {new: pressure, old: 0.0}) for old, new in pairs]
    return Gait(_phases(steps, ramp), (*settle, *first), cycles)


def _phases(steps: Sequence[tuple[str, Mapping[str, float]]], ramp: Mapping[str, Any]) -> tuple[Phase, ...]:
    return tuple(Phase(name, targets, **ramp) for name, targets in steps)


def _each_once(names: Sequence[str]) -> None:
    if not names or len(set(names)) < len(names):
        raise InputError(f"gait: cavities {', '.join(names) or 'missing'}, expected each once")
