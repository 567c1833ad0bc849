"""The energy check: work done on the body against what it stores and loses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from pneumorph.mechanics import State


@dataclass(frozen=True)
class EnergyImbalance:
    """What works and energies differ by, over the largest of them; 0 when all is accounted for (see `Energies`).

    The works are integrated over the increments by the trapezoidal rule, so what is left falls with their square.
    """

    name: str = "energy_imbalance"
    kind: str = "number"

    def __call__(self, state: State) -> float:
        """Return the ratio."""
        return state.energies.relative_error


def energy_check(states: Iterable[State]) -> float:
    """Return the largest imbalance over some states (mJ) over the largest strain energy among them; 0 at rest."""
    worst, largest = 0.0, 0.0
    for state in states:
        energies = state.energies
        worst = max(worst, abs(energies.difference))
        largest = max(largest, abs(energies.strain))
    return worst / largest if largest else 0.0
