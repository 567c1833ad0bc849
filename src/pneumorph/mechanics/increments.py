"""What an increment starts from, the unknowns that are tried in it, and what comes out."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.contact.contacts import Rubbing
from pneumorph.mechanics.state import State
from pneumorph.mechanics.supplies import Gas

Array = NDArray[np.float64]


@dataclass(eq=False)
class Trial:
    """The unknowns of an increment: displacement (nodes, d), pressure modes, cavity pressures (cavities,).

    ways (contacts,): how far obstacles have moved, mm; they wait where nothing gives way.
    carried: stresses for the tangent, see `Body.carry`; None for those of the place.
    """

    displacement: Array
    modes: list[Array]
    pressure: Array
    ways: Array = field(default_factory=lambda: np.zeros(0))
    carried: list[Array] | None = None

    def stepped(self, factor: float, du: Array, dq: list[Array], dp: Array, dw: Array, carried: list[Array]) -> Trial:
        """Return the trial after a part of a step, with the stresses carried along it."""
        modes = [q + factor * d for q, d in zip(self.modes, dq, strict=True)]
        pressure, ways = self.pressure + factor * dp, self.ways + factor * dw
        return Trial(self.displacement + factor * du, modes, pressure, ways, carried)


@dataclass(frozen=True, eq=False)
class Converged:
    """A trial in equilibrium, with what the iteration found on the way.

    imbalance (unknowns,): internal minus applied forces, N, without those of a drag.
    gas: in the cavities; flow_error: of the integration of its flow, over what the settings allow.
    rubbing: the friction that it is in equilibrium with. shifted: whether unstable tangents were shifted on the way.
    """

    trial: Trial
    volume: Array
    imbalance: Array
    iterations: int
    unstable_modes: int | None
    smallest_volume_ratio: float
    gas: Gas
    flow_error: float
    rubbing: Rubbing | None
    shifted: bool


class IncrementFailedError(Exception):
    """An increment did not converge; the message says why."""


class Drag(Protocol):
    """A force on the body beside those of the model, linear in the displacement, with a symmetric matrix."""

    def force(self, displacement: Array) -> Array:
        """Return the force (unknowns,), N, with which it resists at a displacement (nodes, d)."""

    def add_tangent(self, values: Array) -> None:
        """Add its matrix to the values of the tangent, in the order of the body's pattern."""


@dataclass(frozen=True, eq=False)
class Increment:
    """What an increment starts from, how long it takes and what it meets.

    start: the state before; seconds: time that passes, 0 where the phase has no duration; share: of the phase.
    """

    start: State
    seconds: float = 0.0
    drag: Drag | None = None
    share: float = 1.0
