"""A gait: phases that settle the robot, then phases that repeat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.mechanics import Phase, Programme


@dataclass(frozen=True)
class Gait:
    """What is driven in which order, and how often.

    phases: one cycle. settle: phases before the first cycle: gravity, a first posture. cycles: how often, 1 or more.
    Phases ramp as those of a `Programme` do; what a phase does not name stays. The next cycle starts from where the
    last one ends.

    Raises InputError for a cycle without phases or without end, and for a name given to two phases.

    >>> gait = Gait((Phase("+PN1", {"PN1": 0.013}), Phase("-PN1", {"PN1": 0.0})), cycles=2)
    >>> [phase.name for phase in gait.programme.phases]
    ['+PN1', '-PN1', '+PN1, cycle 2', '-PN1, cycle 2']
    """

    phases: tuple[Phase, ...]
    settle: tuple[Phase, ...] = ()
    cycles: int = 1

    def __post_init__(self) -> None:
        check_cycles(self.cycles)
        if not self.phases:
            raise InputError("gait: a cycle without phases, expected at least one")
        _ = self.programme

    @property
    def programme(self) -> Programme:
        """The phases one after the other; from the second cycle on their names say which it is."""
        repeated = [
            replace(phase, name=in_cycle(phase.name, cycle)) for cycle in range(self.cycles) for phase in self.phases
        ]
        return Programme((*self.settle, *repeated))

    @property
    def ends(self) -> tuple[int, ...]:
        """Times of the programme, in phases, at which the first cycle starts and each of them ends (cycles + 1,)."""
        return tuple(len(self.settle) + cycle * len(self.phases) for cycle in range(self.cycles + 1))

    def renamed(self, names: Mapping[str, str]) -> Gait:
        """Return the gait with targets under other names: the mirrored gait where names swaps left and right.

        names: target -> other target; the others keep theirs. Raises NameNotFoundError for a target that no phase
        has, InputError where two targets would get one name.
        """
        driven = sorted({name for phase in (*self.settle, *self.phases) for name in phase.targets})
        for name in names:
            if name not in driven:
                raise NameNotFoundError("gait: " + unknown_name("target", name, driven))
        if len({names.get(name, name) for name in driven}) < len(driven):
            raise InputError(f"gait: names = {dict(names)} give one name to two targets of {', '.join(driven)}")

        def other(phase: Phase) -> Phase:
            return replace(phase, targets={names.get(name, name): value for name, value in phase.targets.items()})

        return replace(self, settle=tuple(map(other, self.settle)), phases=tuple(map(other, self.phases)))


def check_cycles(cycles: object, owner: str = "gait: cycles") -> None:
    """Raise InputError for a number of cycles that is no whole number of 1 or more."""
    if isinstance(cycles, bool) or not isinstance(cycles, int) or cycles < 1:
        raise InputError(f"{owner} = {cycles!r}, allowed: a whole number of at least 1; every cycle has an end")


def in_cycle(name: str, cycle: int) -> str:
    """Return the name of a phase in a cycle, counted from 0."""
    return name if cycle == 0 else f"{name}, cycle {cycle + 1}"
