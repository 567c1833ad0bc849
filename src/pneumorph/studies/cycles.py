"""The [cycle] section: which phases repeat, and how often."""

from __future__ import annotations

from collections.abc import Sequence

from pneumorph.errors import NameNotFoundError, StudyError, unknown_name
from pneumorph.gaits.gait import check_cycles, in_cycle
from pneumorph.studies.schema import CycleSection, PhaseSection


def repeated(phases: Sequence[PhaseSection], cycle: CycleSection | None) -> tuple[PhaseSection, ...]:
    """Return the phases in the order in which they are run, those of later cycles under names of their own.

    Raises InputError for a number of cycles that is not 1 or more, NameNotFoundError for an unknown phase, StudyError
    for phases that are not the last ones of the file in their order.
    """
    if cycle is None:
        return tuple(phases)
    check_cycles(cycle.repeat, "cycle: repeat")
    names = [str(phase.name) for phase in phases]
    for name in cycle.phases:
        if name not in names:
            raise NameNotFoundError("cycle: " + unknown_name("phase", name, names))
    count = len(cycle.phases)
    if not count or list(cycle.phases) != names[-count:]:
        raise StudyError(
            f"cycle: phases = {', '.join(cycle.phases) or 'none'}, expected the last phases of the file in their "
            f"order, some or all of {', '.join(names)}"
        )
    later = [
        phase.model_copy(update={"name": in_cycle(str(phase.name), number)})
        for number in range(1, cycle.repeat)
        for phase in phases[-count:]
    ]
    return (*phases, *later)


def cycle_ends(phases: Sequence[PhaseSection], cycle: CycleSection | None) -> tuple[int, ...]:
    """Return the times, in phases, at which the first cycle starts and each cycle ends; () without a cycle."""
    if cycle is None:
        return ()
    count = len(cycle.phases)
    return tuple(len(phases) - count + number * count for number in range(cycle.repeat + 1))
