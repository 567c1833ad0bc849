"""A converged state of a model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.model import Model

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Energies:
    """Energies since the start, mJ: strain (stored), supply (work of the cavities' fluids), load (work of loads and
    moved supports) and viscous (lost in regularisation). strain + viscous = supply + load but for the integration
    over finite increments."""

    strain: float = 0.0
    supply: float = 0.0
    load: float = 0.0
    viscous: float = 0.0

    @property
    def relative_error(self) -> float:
        """Imbalance over the largest term; 0 at rest."""
        largest = max(abs(self.strain), abs(self.supply), abs(self.load))
        return (self.supply + self.load - self.strain - self.viscous) / largest if largest else 0.0


@dataclass(frozen=True, eq=False)
class State:
    """One converged increment.

    index: 0 for the state at rest; time: phases done plus the fraction of the present one; phase: its name.
    displacement (nodes, d), mm; pressure_modes: arrays (cells, modes), MPa, one for each block of cells.
    pressure, volume: cavity -> gauge pressure (MPa) and enclosed volume (mm3); values: what the programme drives.
    reactions (nodes * d,): internal minus applied forces, N: what the supports give; zero elsewhere.
    iterations: Newton iterations it took; unstable_modes: eigenmodes in which it is unstable at fixed targets
    (None where the linear solver cannot tell); smallest_volume_ratio: smallest det F.
    next_increment: what the load stepping tries next, as a fraction of the phase.
    """

    model: Model
    index: int
    phase: str
    time: float
    displacement: Array
    pressure_modes: list[Array]
    pressure: Mapping[str, float]
    volume: Mapping[str, float]
    values: Mapping[str, float]
    reactions: Array
    energies: Energies = Energies()
    iterations: int = 0
    unstable_modes: int | None = 0
    smallest_volume_ratio: float = 1.0
    next_increment: float = 0.0

    @property
    def positions(self) -> Array:
        """Deformed nodes (nodes, d), mm."""
        return self.model.mesh.points + self.displacement


def rest(model: Model) -> State:
    """Return the state at rest."""
    volumes = {name: surface.reference_volume for name, surface in model.surfaces.items()}
    zero = np.zeros_like(model.mesh.points)
    return State(
        model, 0, "rest", 0.0, zero, model.body.zero_pressure(), dict.fromkeys(volumes, 0.0), volumes, {}, zero.ravel()
    )
