"""Load stepping: increments that grow where they are easy, are cut where they fail, and always leave a state behind.

Where Newton's method finds no state even with shifted tangents (see `shift`), a viscous term is added to the potential,
    c / 2 int |u - u_n|^2 dV,
with u_n the displacement before: a row of such steps at fixed targets, with c falling to zero, slides the body to its
next stable state. Only that state, in equilibrium without viscosity, is kept; what the slide dissipated is recorded.
An increment no larger than the first of its phase slides before it is cut: cutting only creeps up to a limit point.

In a phase with inertia (see `dynamics`) nothing slides: the body moves, and increments are also held small enough for
the accuracy of the time integration.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import NotConvergedError
from pneumorph.mechanics.dynamics import SCHEMES, Inertia, kinetic
from pneumorph.mechanics.increments import Converged, Increment, IncrementFailedError, Trial
from pneumorph.mechanics.mass import Mass
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.newton import Newton
from pneumorph.mechanics.prediction import Predictor
from pneumorph.mechanics.programme import Programme
from pneumorph.mechanics.settings import Settings
from pneumorph.mechanics.state import Energies, State, rest

Array = NDArray[np.float64]
_log = logging.getLogger(__name__)


def march(
    model: Model, programme: Programme, settings: Settings | None = None, start: Sequence[State] = ()
) -> Iterator[State]:
    """Yield the states of a programme as they converge; raises NotConvergedError where it cannot go on.

    start: the last states of an earlier run to go on from (three give the same predictor as without the break);
    without them the first state that comes is the one at rest.
    """
    programme.check(model)
    settings = settings or Settings()
    few = 3 * settings.few if model.contacts else settings.few  # contact is sought step by step
    newton = Newton(model, settings)
    mass = Mass(model) if any(phase.inertia for phase in programme.phases) else None
    predictor = Predictor(start or [replace(rest(model), next_increment=programme.phases[0].first)])
    if not start:
        yield predictor.last
    while predictor.last.time < len(programme.phases):
        last = predictor.last
        number = int(last.time)
        phase = programme.phases[number]
        done = last.time - number
        planned = last.next_increment if done > 0.0 else phase.first
        while True:
            ends = [mark for mark in (*sorted(phase.marks), 1.0) if mark > done + 1e-12]
            increment = min(planned, ends[0] - done)
            if ends[0] - done - increment < 0.02 * planned:  # no sliver of an increment before a mark
                increment = ends[0] - done
            fraction = ends[0] if increment == ends[0] - done else done + increment
            time = number + fraction
            values, lost, growth = programme.values(time), 0.0, settings.growth
            seconds = programme.clock(time) - last.clock
            inertia = Inertia(mass, SCHEMES[phase.inertia], last, seconds) if mass and phase.inertia else None
            step = Increment(last, seconds, inertia, time - last.time)
            try:
                try:
                    found = newton.solve(newton.start(predictor.trial(time), values, step), values, step)
                except IncrementFailedError as failure:
                    if not settings.viscosity or increment > phase.first or inertia:
                        raise
                    _log.info("phase %s at %.4f: %s; sliding viscously", phase.name, fraction, failure)
                    found, lost = _slide(newton, step, values)
                moved = inertia.error(found.trial.displacement) if inertia else 0.0
                growth = _growth(max(moved, 0.0 if lost else found.flow_error), growth)
                break
            except IncrementFailedError as failure:
                reason = str(failure)
            planned = settings.cut * increment
            _log.info("phase %s at %.4f: %s; increment cut to %.2g", phase.name, fraction, reason, planned)
            if planned < phase.smallest:
                raise NotConvergedError(
                    f"stopped in phase '{phase.name}' at {done:.4f} of it, state {last.index}: {reason} "
                    f"with the smallest increment {phase.smallest:g}{model.contact.tightest(last.touches)}"
                )
        if growth < 1.0 or (found.iterations <= few and increment >= 0.999 * planned):
            planned = min(growth * increment, phase.largest)
        state = _state(step, phase.name, time, found, values, lost, planned)
        predictor.add(state)
        yield state


def _growth(error: float, most: float) -> float:
    """Return the factor on the next increment that keeps the accuracy; raises IncrementFailedError where it is lost.

    error: of the time integration in this increment, over what is allowed.
    """
    if error > 2.0:
        raise IncrementFailedError(f"the time step misses its accuracy {error:.2g} times")
    return min(most, max(0.5, 0.9 * error ** (-1.0 / 3.0))) if error else most


class _Viscosity:
    """The viscous term (a `Drag`): coefficient (MPa / mm2) and the displacement it starts from."""

    def __init__(self, model: Model, coefficient: float, origin: Array):
        self.coefficient, self.origin = coefficient, origin
        self.diagonal = model.body.pattern.diagonal
        self.weights = coefficient * np.repeat(model.unit_mass, model.body.dimension)

    def force(self, displacement: Array) -> Array:
        """Return the force (unknowns,), N."""
        result: Array = self.weights * (displacement - self.origin).ravel()
        return result

    def add_tangent(self, values: Array) -> None:
        """Add the derivative of the force to the tangent."""
        values[self.diagonal] += self.weights


def _slide(newton: Newton, step: Increment, values: dict[str, float]) -> tuple[Converged, float]:
    """Return the equilibrium that viscous sliding from the last state leads to, and the energy lost on the way, mJ."""
    last, model = step.start, newton.model
    pressure = np.array([last.pressure[n] for n in last.pressure])
    trial = Trial(last.displacement, last.pressure_modes, pressure, model.contact.ways(last.values))
    scale = max(m.shear_modulus for m in model.materials.values()) / model.mesh.size**2
    coefficient, lost, count = newton.settings.viscosity * scale, 0.0, 0
    for _ in range(newton.settings.relaxations):
        drag = _Viscosity(model, coefficient, trial.displacement)
        try:
            found = newton.solve(trial, values, replace(step, drag=drag), loose=True)
        except IncrementFailedError as failure:
            _log.debug("viscosity %.3g: %s", coefficient / scale, failure)
            coefficient *= 5.0
            continue
        moved = (found.trial.displacement - trial.displacement).ravel()
        largest = float(np.abs(moved).max())
        lost += float(drag.weights @ moved**2)
        count += found.iterations
        trial = found.trial
        _log.debug("viscosity %.3g: %d iterations, moved %.3g mm", coefficient / scale, found.iterations, largest)
        coefficient *= 0.3
        if largest < 1e-3 * model.mesh.size or coefficient < scale:
            try:
                found = newton.solve(trial, values, step)
            except IncrementFailedError:
                continue
            if not found.unstable_modes:  # a saddle on the way is not where a slide ends
                return replace(found, iterations=count + found.iterations), lost
    raise IncrementFailedError("viscous sliding found no equilibrium")


def _state(
    step: Increment, phase: str, time: float, found: Converged, values: dict[str, float], lost: float, planned: float
) -> State:
    """Return the new state, its energies integrated from the last by the trapezoidal rule.

    A snap, in a viscous slide or under shifted tangents, goes at the new targets all the way: then what is driven works
    with its new value, and all of that which is not stored is lost.
    """
    last, trial = step.start, found.trial
    snapped = lost > 0.0 or found.shifted
    model, old = last.model, last.energies
    names = list(model.surfaces)
    pressure = dict(zip(names, map(float, trial.pressure), strict=True))
    volume = dict(zip(names, map(float, found.volume), strict=True))
    share = {n: 1.0 if snapped and model.surfaces[n].cavity.supply.sets_pressure else 0.5 for n in names}
    supply = sum(
        (share[n] * pressure[n] + (1.0 - share[n]) * last.pressure[n]) * (volume[n] - last.volume[n]) for n in names
    )
    new = 1.0 if snapped else 0.5
    moved = (trial.displacement - last.displacement).ravel()
    load = sum(
        (new * values.get(name, 0.0) + (1.0 - new) * last.values.get(name, 0.0)) * float(pattern @ moved)
        for name, pattern in model.load_patterns.items()
    )
    held = model.held
    reactions = np.zeros_like(found.imbalance)
    reactions[held] = found.imbalance[held]
    moving: dict[str, Array] = {}
    motion, damped = 0.0, old.kinetic  # without inertia, motion ends
    if isinstance(step.drag, Inertia):
        velocity, acceleration = step.drag.motion(trial.displacement)
        moving = {"velocity": velocity, "acceleration": acceleration, "imbalance": found.imbalance}
        reactions[held] += step.drag.mass.times(acceleration).ravel()[held]
        motion = kinetic(step.drag.mass, velocity)
        damped = step.drag.lost(trial.displacement, found.imbalance)
    load += 0.5 * float((reactions + last.reactions)[held] @ moved[held])
    position = model.mesh.points + trial.displacement
    contact, ways = model.contact, trial.ways
    touches = contact.touches(position, ways, found.rubbing)
    rubbed = contact.slipped(position, ways, found.rubbing) if found.rubbing else 0.0
    way = ways - contact.ways(last.values)
    load += 0.5 * float((contact.drives(touches) + contact.drives(last.touches)) @ way)
    memory = model.body.remember(position, last.memory, step.seconds)
    lost += model.body.overstress_work((last.positions, position), (last.memory, memory))
    _, strain = model.body.energies(position, trial.modes)
    touching = contact.energy(position, ways)
    if snapped:
        lost = max(lost, supply + load - (strain - old.strain) - (touching - old.contact) - rubbed)
    energies = Energies(
        strain, old.supply + supply, old.load + load, old.viscous + lost, motion, old.numerical + damped,
        touching, old.friction + rubbed,
    )  # fmt: skip
    return State(
        model, last.index + 1, phase, time, trial.displacement, trial.modes, pressure, volume, values, reactions,
        energies, found.iterations, None if moving else found.unstable_modes, found.smallest_volume_ratio, planned,
        last.clock + step.seconds, memory=memory, gas=found.gas, touches=touches, **moving,
    )  # fmt: skip
