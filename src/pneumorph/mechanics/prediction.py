"""Where an increment starts: all unknowns, and the stresses, extrapolated through the last states of its phase."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.increments import Trial
from pneumorph.mechanics.state import State

Array = NDArray[np.float64]

_LAST = 3  # states, for a quadratic
_LEAST = 0.2  # det F of a prediction


class Predictor:
    """The last states of a march with their stresses."""

    def __init__(self, states: Sequence[State]):
        self._past: deque[tuple[State, list[Array]]] = deque(maxlen=_LAST)
        for state in states[-_LAST:]:
            self.add(state)

    @property
    def last(self) -> State:
        """The last state."""
        return self._past[-1][0]

    def add(self, state: State) -> None:
        """Take up a new state."""
        self._past.append((state, state.model.body.stresses(state.positions, state.memory)))

    def trial(self, time: float) -> Trial:
        """Return the unknowns at a time: linear through two states of the same phase, quadratic through three.

        Stresses are extrapolated like displacements: those of the extrapolated place would be far from any equilibrium
        where stiff parts turn.
        """
        last = self.last
        same = [(state, stress) for state, stress in self._past if state.time >= int(last.time)]
        trial = _extrapolated(same, time)
        if len(same) > 1:
            position = last.model.mesh.points + trial.displacement
            if last.model.body.smallest_volume_ratio(position, fine=False) <= _LEAST:
                return _extrapolated(same[-1:], time)
        return trial


def _extrapolated(past: Sequence[tuple[State, list[Array]]], time: float) -> Trial:
    states = [state for state, _ in past]
    weights = _lagrange([state.time for state in states], time)
    last = states[-1]

    def total(parts: Sequence[Array]) -> Array:
        return sum((w * part for w, part in zip(weights, parts, strict=True)), np.zeros_like(parts[0]))

    return Trial(
        total([state.displacement for state in states]),
        [total(parts) for parts in zip(*(state.pressure_modes for state in states), strict=True)],
        total([np.array(list(state.pressure.values())) for state in states]),
        last.model.contact.ways(last.values),
        [total(parts) for parts in zip(*(stress for _, stress in past), strict=True)],
    )


def _lagrange(times: Sequence[float], time: float) -> list[float]:
    """Return the weights of the polynomial through some times, at another time."""
    return [float(np.prod([(time - other) / (one - other) for other in times if other != one])) for one in times]
