"""A converged state of a model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.mechanics.contact import BodyMotion, Touch
from pneumorph.mechanics.contact.body_motion import motion_of
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.supplies import Gas
from pneumorph.mechanics.supplies.network import gas_at_rest

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Energies:
    """Energies since the start, mJ.

    strain: stored elastically; supply: work of the cavities' fluids; load: work of loads and moved supports;
    viscous: work of the overstresses of viscous materials (lost, or held until they relax), and lost in regularisation;
    kinetic: of motion; numerical: lost in the damping of the time integration;
    contact: stored in barriers; friction: lost in it.
    strain + kinetic + contact + viscous + numerical + friction = supply + load, but for the integration over finite
    increments.
    """

    strain: float = 0.0
    supply: float = 0.0
    load: float = 0.0
    viscous: float = 0.0
    kinetic: float = 0.0
    numerical: float = 0.0
    contact: float = 0.0
    friction: float = 0.0

    @property
    def difference(self) -> float:
        """Work that was not found as energy or loss, mJ."""
        return (
            self.supply
            + self.load
            - (self.strain + self.kinetic + self.contact + self.viscous + self.numerical + self.friction)
        )

    @property
    def relative_error(self) -> float:
        """Difference over the largest term; 0 at rest."""
        largest = max(abs(self.strain), abs(self.supply), abs(self.load), abs(self.kinetic), abs(self.friction))
        return self.difference / largest if largest else 0.0


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
    clock: seconds since the start, by the durations of the phases.
    velocity, acceleration (nodes, d), mm/s and mm/s2, and imbalance (nodes * d,): internal minus applied forces, N,
    after an increment with inertia; None after one without.
    memory: for each block of cells, (terms + 1, cells, q, 6), MPa: elastic stress and overstresses of its Prony series
    (terms 0 and an empty array where its material has none).
    gas: in the cavities that hold gas.
    touches: contact -> forces, area and smallest distance; none at rest before the first increment.
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
    clock: float = 0.0
    velocity: Array | None = None
    acceleration: Array | None = None
    imbalance: Array | None = None
    memory: list[Array] = field(default_factory=list)
    gas: Gas = field(default_factory=Gas)
    touches: Mapping[str, Touch] = field(default_factory=dict)

    @property
    def positions(self) -> Array:
        """Deformed nodes (nodes, d), mm."""
        return self.model.mesh.points + self.displacement

    def body_motion(self, name: str) -> BodyMotion:
        """Return where a free body is and how it moves; raises NameNotFoundError for an unknown one."""
        frames = {frame.name: frame for frame in self.model.frames}
        if name not in frames:
            raise NameNotFoundError(unknown_name("free body", name, frames))
        return motion_of(frames[name], self.positions, self.velocity)

    def temperature(self, cavity: str) -> float:
        """Return the temperature of the gas in a cavity, K; raises KeyError where it holds none."""
        outside, mass = self.model.atmosphere, self.gas.mass[cavity]
        volume = self.volume[cavity] + getattr(self.model.supplies[cavity], "dead_volume", 0.0)
        return float((self.pressure[cavity] + outside.pressure) * volume / (mass * outside.gas_constant))


def rest(model: Model) -> State:
    """Return the state at rest."""
    volumes = {name: surface.reference_volume for name, surface in model.surfaces.items()}
    zero = np.zeros_like(model.mesh.points)
    return State(
        model, 0, "rest", 0.0, zero, model.body.zero_pressure(), dict.fromkeys(volumes, 0.0), volumes, {}, zero.ravel(),
        memory=model.body.zero_memory(), gas=gas_at_rest(model.surfaces, model.atmosphere),
    )  # fmt: skip
