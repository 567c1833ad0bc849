"""The gaits of the PneuNet and pipe robots: phases over named cavities."""

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


def earthworm(
    rear: Sequence[str],
    middle: str,
    front: Sequence[str],
    pressure: float,
    stretch: float,
    *,
    cycles: int = 1,
    settle: Sequence[Phase] = (),
    **ramp: Any,
) -> Gait:
    """Return the gait of an earthworm in a pipe near its own size: one end holds while the other is moved.

    The rear is filled first, before `settle`, so that it holds when gravity comes. The cycle is +middle, +front, -rear,
    -middle, +rear, -front: lengthen, hold in front, let go behind, draw up, hold behind, let go in front.

    rear, front: cavities that press their end against the pipe. middle: that lengthens the body. pressure, stretch:
    gauge, MPa, of the ends and of the middle. Other arguments as for `undulation`. Raises InputError for a cavity named
    twice, and for an end without one.
    """
    if not rear or not front:
        raise InputError(f"gait: no cavities in the {'front' if rear else 'rear'}, expected at least one")
    _each_once((*rear, middle, *front))
    fill, vent = (dict.fromkeys(rear, value) for value in (pressure, 0.0))
    grip, release = (dict.fromkeys(front, value) for value in (pressure, 0.0))
    steps: list[tuple[str, dict[str, float]]] = [
        (f"+{middle}", {middle: stretch}),
        ("+front", grip),
        ("-rear", vent),
        (f"-{middle}", {middle: 0.0}),
        ("+rear", fill),
        ("-front", release),
    ]
    first = _phases([("hold", fill)], ramp)
    return Gait(_phases(steps, ramp), (*first, *settle), cycles)


def inchworm(
    rear: Sequence[str],
    middle: str,
    front: Sequence[str],
    pressure: float,
    stretch: float,
    *,
    cycles: int = 1,
    settle: Sequence[Phase] = (),
    **ramp: Any,
) -> Gait:
    """Return the gait of an inchworm in a pipe much wider than itself: an end holds by bending until it is wedged.

    The order of `earthworm`, with the cavities on one side of each end alone; `settle` (gravity) comes first, as
    the robot lies on the pipe. Arguments and errors as there.
    """
    gait = earthworm(rear, middle, front, pressure, stretch, cycles=cycles, **ramp)
    return Gait(gait.phases, (*settle, *gait.settle), cycles)


def _phases(steps: Sequence[tuple[str, Mapping[str, float]]], ramp: Mapping[str, Any]) -> tuple[Phase, ...]:
    return tuple(Phase(name, targets, **ramp) for name, targets in steps)


def _each_once(names: Sequence[str]) -> None:
    if not names or len(set(names)) < len(names):
        raise InputError(f"gait: cavities {', '.join(names) or 'missing'}, expected each once")
