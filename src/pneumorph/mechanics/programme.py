"""Programmes: what is driven to which value, phase by phase."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.mechanics.dynamics import SCHEMES
from pneumorph.mechanics.mass import densities_of
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.supplies.checks import check_masses, check_phases
from pneumorph.mechanics.supplies.network import gas_at_rest


@dataclass(frozen=True)
class Phase:
    """One ramp: every named target goes linearly from where it stands to its value, the others stay.

    targets: name of a cavity, load or prescribed displacement -> value at the end of the phase, in inside units.
    marks:   fractions of the phase in (0, 1) that are hit exactly, besides its end.
    first, largest, smallest: sizes of the increments as fractions of the phase.
    duration: time that the phase takes, s; needed where something depends on time (flow, inertia). Viscous materials
    answer with their long-term stiffness in a phase without one.
    inertia: 'transient', 'moderate' or 'quasi-static', the damping of the time integration (see `dynamics`); None for
    a phase without inertia.
    """

    name: str
    targets: Mapping[str, float]
    marks: tuple[float, ...] = ()
    first: float = 0.05
    largest: float = 0.2
    smallest: float = 1e-5
    duration: float | None = None
    inertia: str | None = None

    def __post_init__(self) -> None:
        if not self.targets:
            raise InputError(f"phase '{self.name}': no targets, expected at least one")
        for name, value in self.targets.items():
            if not abs(value) < float("inf"):
                raise InputError(f"phase '{self.name}': target {name} = {value}, expected a finite number")
        if self.duration is not None and not 0.0 < self.duration < float("inf"):
            raise InputError(f"phase '{self.name}': duration = {self.duration} s, allowed: more than 0")
        if self.inertia is not None and self.inertia not in SCHEMES:
            raise InputError(f"phase '{self.name}': inertia = {self.inertia!r}, allowed: {', '.join(SCHEMES)}")
        if self.inertia is not None and self.duration is None:
            raise InputError(f"phase '{self.name}': inertia needs a duration")
        if any(not 0 < mark < 1 for mark in self.marks):
            raise InputError(f"phase '{self.name}': marks = {self.marks}, allowed: between 0 and 1")
        if not 0 < self.smallest <= self.first <= self.largest <= 1:
            raise InputError(
                f"phase '{self.name}': increments smallest = {self.smallest}, first = {self.first}, largest = "
                f"{self.largest}, allowed: 0 < smallest <= first <= largest <= 1"
            )


@dataclass(frozen=True)
class Programme:
    """Phases, one after the other; everything starts from zero."""

    phases: tuple[Phase, ...]

    def __post_init__(self) -> None:
        if not self.phases:
            raise InputError("programme: no phases, expected at least one")
        names = [phase.name for phase in self.phases]
        if len(set(names)) != len(names):
            raise InputError(f"programme: phase names {names}, expected each once")

    def check(self, model: Model) -> None:
        """Raise an InputError for a target that the model does not have, a load never driven, a missing density.

        Also for what the supplies of its cavities refuse: no duration for a flow, a target below empty space.
        """
        driven = {name for phase in self.phases for name in phase.targets}
        check_phases(self.phases, model.supplies, model.tubes, model.atmosphere)
        check_masses(self.phases, model.supplies, gas_at_rest(model.surfaces, model.atmosphere).mass)
        for phase in self.phases:
            for name in phase.targets:
                if name not in model.kinds:
                    raise NameNotFoundError(f"phase '{phase.name}': " + unknown_name("target", name, model.kinds))
        if any(phase.inertia for phase in self.phases):
            densities_of(model)
        for body in model.loose_bodies:
            for phase in self.phases:
                if phase.inertia is None:
                    raise InputError(
                        f"phase '{phase.name}': nothing holds the free body '{body}' without inertia; give the phase a "
                        "duration and inertia ('quasi-static' brings it to rest)"
                    )
        for name in model.kinds:
            if name not in driven and name not in model.surfaces:
                raise InputError(f"'{name}' is in the model, but no phase drives it")

    def values(self, time: float) -> dict[str, float]:
        """Return name -> value at a time, the number of phases done plus the fraction of the present one."""
        values: dict[str, float] = {}
        for number, phase in enumerate(self.phases):
            fraction = min(max(time - number, 0.0), 1.0)
            if fraction > 0.0:
                for name, end in phase.targets.items():
                    start = values.get(name, 0.0)
                    values[name] = end if fraction == 1.0 else start + fraction * (end - start)
        return values

    def clock(self, time: float) -> float:
        """Return the seconds since the start at a time in phases; a phase without duration takes none."""
        durations = [phase.duration or 0.0 for phase in self.phases]
        whole = min(int(time), len(durations))
        rest = (time - whole) * durations[whole] if whole < len(durations) else 0.0
        return sum(durations[:whole]) + rest
