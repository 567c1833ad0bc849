"""A programme up to a time: for files that shall end in a chosen state."""

from __future__ import annotations

from dataclasses import replace

from pneumorph.errors import InputError
from pneumorph.mechanics import Programme

# times nearer than this to the end of a phase are its end
_ROUND = 1e-9


def up_to(programme: Programme, time: float) -> Programme:
    """Return the programme until a time, phases done plus the fraction of the next one.

    The last phase ends at the values that it has then; its increments and marks are fractions of what is left of it.
    Raises InputError for a time that is not after the start and up to the end.
    """
    count = len(programme.phases)
    if not 0.0 < time <= count + _ROUND:
        raise InputError(f"time = {time:g}: expected more than 0, at most {count} (the phases of the programme)")
    whole = int(time + _ROUND)
    fraction = time - whole
    if fraction <= _ROUND:
        return Programme(programme.phases[:whole])
    phase, values = programme.phases[whole], programme.values(time)
    last = replace(
        phase,
        targets={name: values[name] for name in phase.targets},
        marks=tuple(mark / fraction for mark in phase.marks if mark < fraction - _ROUND),
        first=min(phase.first / fraction, 1.0),
        largest=min(phase.largest / fraction, 1.0),
        smallest=min(phase.smallest / fraction, 1.0),
    )
    return Programme((*programme.phases[:whole], last))
