"""What a run says about the motion: centre of mass, forces and slip of the feet, way and cost of each cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.measures import CentreOfMass
from pneumorph.measures.centre_of_mass import nodal_mass
from pneumorph.measures.slip import slip
from pneumorph.mechanics import Gravity, State

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Foot:
    """A named region that bears: one face of a contact."""

    face: str
    contact: str = "ground"


@dataclass(frozen=True, eq=False)
class Locomotion:
    """The motion through the states (n,) of a run; d coordinates, mm, N, mJ.

    time (n,): in phases. centre (n, d): of mass. force: foot -> (n, d), what the ground does to it. slip: foot ->
    (n, d), the way it slid in the increment before each state (see `measures.slip`). delivered (n,): work of the
    supplies since the start, counted where they give work only: what a cavity gives back as it empties is vented, not
    used. weight: N. ends: times between the cycles. forward (d,): unit vector in which the robot should go.
    """

    time: Array
    centre: Array
    force: Mapping[str, Array]
    slip: Mapping[str, Array]
    delivered: Array
    weight: float
    ends: tuple[int, ...]
    forward: Array

    def at(self, time: float) -> int | None:
        """Return the number of the state at a time in phases, None where the run has none."""
        found = np.flatnonzero(np.abs(self.time - time) < 1e-9)
        return int(found[-1]) if len(found) else None

    @property
    def displacements(self) -> Array:
        """Displacement of the centre of mass in each finished cycle (cycles, d), mm."""
        return np.diff(self.centre[self._finished], axis=0)

    @property
    def forward_slip(self) -> dict[str, Array]:
        """Foot -> way (cycles,) that it slid forward in each finished cycle, mm."""
        return self._slid(1.0)

    @property
    def backward_slip(self) -> dict[str, Array]:
        """Foot -> way (cycles,) that it slid backward in each finished cycle, mm."""
        return self._slid(-1.0)

    @property
    def cost_of_transport(self) -> Array:
        """Work delivered over weight and forward displacement of each finished cycle (cycles,); nan if not forward."""
        work = np.diff(self.delivered[self._finished])
        way = self.displacements @ self.forward
        return np.where(way > 0.0, work / (self.weight * np.where(way > 0.0, way, 1.0)), np.nan)

    @property
    def _finished(self) -> list[int]:
        return [index for end in self.ends if (index := self.at(end)) is not None]

    def _slid(self, sign: float) -> dict[str, Array]:
        marks = self._finished
        ways = {name: np.maximum(sign * (moved @ self.forward), 0.0) for name, moved in self.slip.items()}
        spans = list(pairwise(marks))
        return {name: np.array([way[a + 1 : b + 1].sum() for a, b in spans]) for name, way in ways.items()}


def locomotion(
    states: Sequence[State], ends: Sequence[int], feet: Sequence[Foot], forward: Sequence[float]
) -> Locomotion:
    """Return the motion through the states of a run, from the one at rest on.

    ends: times between cycles, see `Gait.ends`. forward: direction (d,), any length.

    Raises InputError for a model without gravity, a material without a density, a direction that does not fit;
    NameNotFoundError for a contact or face that there is not.
    """
    model = states[0].model
    loads = [load for load in model.loads if isinstance(load, Gravity)]
    if not loads:
        raise InputError("locomotion: feet need gravity, and the model has none")
    d = model.mesh.dimension
    ahead = np.asarray(forward, dtype=float)
    if ahead.shape != (d,) or not np.isfinite(ahead).all() or not ahead.any():
        raise InputError(f"locomotion: forward = {tuple(forward)}, expected {d} finite numbers, not all zero")
    centre = CentreOfMass("x")
    slips: dict[str, list[Array]] = {foot.face: [np.zeros(d)] for foot in feet}
    forces: dict[str, list[Array]] = {foot.face: [] for foot in feet}
    time, rows, delivered, strongest = [], [], [0.0], 0.0
    before: State | None = None
    for state in states:
        time.append(state.time)
        rows.append(centre.vector(state))
        strongest = max(strongest, abs(state.values.get(loads[0].name, 0.0)))
        for foot in feet:
            touch = state.touches.get(foot.contact)
            forces[foot.face].append(np.array(touch.by_face[foot.face]) if touch else np.zeros(d))
        if before is not None:
            delivered.append(delivered[-1] + _given(before, state))
            for foot in feet:
                slips[foot.face].append(slip(before, state, foot.contact, foot.face))
        before = state
    return Locomotion(
        np.array(time),
        np.array(rows),
        {name: np.array(values) for name, values in forces.items()},
        {name: np.array(values) for name, values in slips.items()},
        np.array(delivered),
        strongest * float(nodal_mass(model).sum()),
        tuple(ends),
        ahead / np.linalg.norm(ahead),
    )


def _given(before: State, after: State) -> float:
    """Return the work that supplies gave in an increment, mJ: each cavity's where it is positive, trapezoidal rule."""
    return sum(
        max(0.5 * (before.pressure[name] + after.pressure[name]) * (after.volume[name] - before.volume[name]), 0.0)
        for name in after.pressure
    )
