"""Newton's method for one increment: displacement, pressure modes and cavity pressures together.

Full steps, limited by a cap on the displacement, by det F > 0 and by contact, are all that guards it: an energy line
search is worse than cutting the increment, because the large bulk modulus makes the energy rise along good steps. Two
things help stiff and slender parts that turn: the tangent takes stresses that are carried along the steps to first
order (see `kernels`), and tangents that stay unstable are shifted (see `shift`). Where no cut helps, `continuation`
adds a viscous term; `dynamics` adds inertia. Both come here as the `Drag` of an `Increment`.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mechanics.body import Assembly
from pneumorph.mechanics.increments import Converged, Drag, Increment, IncrementFailedError, Trial
from pneumorph.mechanics.linear import LinearSolver, linear_solver
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.pattern import Pattern
from pneumorph.mechanics.settings import Settings
from pneumorph.mechanics.shift import Shift
from pneumorph.mechanics.state import State
from pneumorph.mechanics.supplies.network import Equations, Network, NetworkIncrement
from pneumorph.mechanics.touching import Forces, Tangent, Touching

Array = NDArray[np.float64]
_SETTLED = 1e-4  # error at which friction takes up the present normal forces
_RENEWED = 5e-3  # error that these may make
_NEAR = 1e-2  # error below which the exact Hessian of the barrier leads on
_log = logging.getLogger(__name__)


class Newton:
    """Solves increments of one model; keeps the analysis of its matrix pattern between them."""

    def __init__(self, model: Model, settings: Settings):
        self.model = model
        self.settings = settings
        self.linear: LinearSolver = linear_solver()
        body = model.body
        self._held = model.held
        self._contact = model.contact
        self._touching = Touching(model)
        self._pattern: Pattern | None = None
        self._free = np.ones(body.unknowns, dtype=bool)
        self._free[self._held] = False
        self._surfaces = list(model.surfaces.values())
        self._shear = max(material.shear_modulus for material in model.materials.values())
        self._mass = np.repeat(model.unit_mass, body.dimension)
        self._network = Network(model.surfaces, model.tubes, model.atmosphere, self._shear)

    def solve(
        self, trial: Trial, values: Mapping[str, float], increment: Increment, *, loose: bool = False
    ) -> Converged:
        """Return the equilibrium at the values of the programme; raises IncrementFailedError.

        loose: be content with a thousandth of the forces, within half the iterations (steps of a viscous slide).
        """
        settings = self.settings
        tolerance = 1e-3 if loose else settings.tolerance
        most = settings.contact_iterations if self._contact else settings.iterations
        iterations = most // 2 if loose else most
        load = self._load(values)
        supplies = self._network.increment(increment.start, increment.seconds, values)
        given = self.model.prescribed(values)[self._held]
        passed = increment.seconds or increment.share
        goal, rounds = self._contact.ways(values), 0
        rubbing = self._touching.rubbing(increment.start, passed)
        self._touching.make_room(increment.start)
        unstable: int | None = 0  # modes of the last tangent, and of the last without a shift
        modes: int | None = 0
        first = best = before = np.inf
        settled, factor = False, 1.0
        factors: _Factors | None = None
        gain = 1e-2
        shift, origin = self._shift(increment), trial
        for iteration in range(iterations + settings.relaxations):
            if iteration - shift.iterations >= iterations:
                break
            assembly = self._assemble(trial, increment)
            position = self.model.mesh.points + trial.displacement
            gradients = [surface.gradient(position) for surface in self._surfaces]
            volumes = np.array([surface.volume(position) for surface in self._surfaces])
            applied = load + sum((p * g for p, g in zip(trial.pressure, gradients, strict=True)), np.zeros_like(load))
            imbalance = assembly.force - applied
            residual = imbalance if increment.drag is None else imbalance + increment.drag.force(trial.displacement)
            equations = supplies.equations(trial.pressure, volumes)
            move, dw = given - trial.displacement.ravel()[self._held], goal - trial.ways
            if self._contact:
                bare = residual
                pushed = self._contact.evaluate(position, trial.ways, rubbing, hessian=False).gradient
                imbalance, residual = imbalance + pushed, bare + pushed
                error = self._error(residual, applied, equations, move, pushed, dw)
                if rubbing is not None and error <= _SETTLED and rounds < settings.rounds:
                    newer = self._touching.rubbing(increment.start, passed, (position, trial.ways))
                    again = self._contact.evaluate(position, trial.ways, newer, hessian=False).gradient
                    renewed = self._error(bare + again, applied, equations, move, again, dw)
                    rounds = rounds + 1 if renewed > _RENEWED else settings.rounds
                    if rounds == settings.rounds and renewed > _RENEWED:
                        _log.warning("friction keeps normal forces that are off by %.2g of all forces", renewed)
                    if rounds < settings.rounds:
                        imbalance, residual = imbalance - pushed + again, bare + again
                        error, rubbing, factors = renewed, newer, None
            else:
                error = self._error(residual, applied, equations, move)
            if not np.isfinite(error):
                raise IncrementFailedError("the residual is not finite")
            converged = (error <= tolerance or (settled and error <= 1e-3)) and iteration > 0
            told = not self._contact  # tangents of surfaces on the verge of touching are now stable, now not
            if told and shift and shift.iterations < settings.relaxations:
                converged = False  # only the tangent alone tells whether this is a stable state
            saddle = converged and told and unstable and not increment.start.unstable_modes
            if saddle and shift.again(iteration):
                _log.debug("iteration %d: a saddle with unstable modes %s, started again", iteration, unstable)
                trial, factors, before = origin, None, np.inf
                continue
            if converged:
                crossing = self._contact.crossing(position, trial.ways)
                if crossing is not None:
                    raise IncrementFailedError(crossing)
                ratio = self.model.body.smallest_volume_ratio(position, fine=True)
                gas = supplies.gas(trial.pressure, volumes)
                flow_error = supplies.error(trial.pressure, volumes) / settings.flow_accuracy
                return Converged(
                    trial, volumes, imbalance, iteration, modes, ratio, gas, flow_error, rubbing, shift.used
                )
            _log.debug("iteration %d: error %.3g, unstable modes %s", iteration, error, unstable)
            # the last factors go on serving while they converge fast: a factorisation costs ten substitutions
            if unstable or shift or factor < 1.0 or error > min(1e-2, gain * before):
                factors = None
            first = error if iteration == 0 else first
            rough = self._contact or shift.used  # other good increments have passed their worst then
            if iteration >= 8 and error > first and not rough:
                raise IncrementFailedError(f"the residual is still larger than at first after {iteration} iterations")
            best, before = min(best, error), error
            if error > 1e6 * max(best, settings.tolerance) and not rough:
                raise IncrementFailedError(f"the residual grew to {error:.2g} of the applied forces")
            if factors is None:
                tangent = self._tangent(assembly, position, trial.pressure, increment.drag)
                exact = error < _NEAR
                without = tangent.copy() if self._contact and exact else tangent
                tangent, touch = self._touching.tangent(tangent, position, trial.ways, rubbing, exact)
                tangent[self._diagonal] += shift.relaxed(error)
                factors, gain = self._factorise(tangent, gradients, equations.softness, move, touch), 1e-2
                modes = modes if shift else factors.unstable_modes
                while shift.wanted(factors.unstable_modes):
                    factors = self._shifted(factors, tangent, shift.raised(), gradients, equations.softness)
                unstable = factors.unstable_modes
                if unstable and self._contact and exact:
                    # steps by an indefinite tangent go to and fro about a fold in contact; this one goes past it
                    tangent, touch = self._touching.tangent(without, position, trial.ways, rubbing, False)
                    factors = self._factorise(tangent, gradients, equations.softness, move, touch)
            else:
                gain = 1e-1
            pulled = residual + factors.touching.coupling @ dw
            du, dp = self._step(factors, pulled, gradients, (supplies, equations, trial.pressure), move)
            dq = self.model.body.pressure_step(assembly.gains, du)
            largest = float(np.abs(du).max())
            factor = min(1.0, settings.largest_step * self.model.mesh.size / max(largest, 1e-300))
            factor = self._keep_orientation(position, du, factor)
            if self._contact:
                factor *= self._free_way(position, trial.ways, factor * du, factor * dw)
                forces = Forces(residual, pushed, rubbing)
                place = position, trial.ways
                factor = self._touching.softened(place, (du, dw), forces, factors.touching, factor)
            carried = self.model.body.carry(assembly, position, factor * du)
            trial = trial.stepped(factor, du, dq, dp, dw, carried)
            # under a very small load the residual stays at the rounding of the bulk term: then the step tells
            settled = (
                factor == 1.0
                and not shift
                and largest <= 1e-10 * self.model.mesh.size
                and float(np.abs(dp).max(initial=0.0)) <= 1e-10 * self._shear
            )
        raise IncrementFailedError(f"no convergence in {iteration} iterations")

    def _shift(self, increment: Increment) -> Shift:
        """Return the shift of an increment: none where there is drag, or where viscosity is switched off."""
        allowed = increment.drag is None
        unit = self._shear / self.model.mesh.size**2
        return Shift(self._mass, self.settings.viscosity * unit if allowed else 0.0)

    def _adopt(self) -> None:
        """Use the present pattern; where it is a new one, the linear solver analyses again."""
        pattern = self._touching.wide.pattern
        if pattern is not self._pattern:
            self._pattern, self._indices = pattern, pattern.indices
            self._indptr = pattern.indptr.astype(np.int32)
            self._struck = pattern.touching(self._held)

    def _free_way(self, position: Array, ways: Array, du: Array, dw: Array) -> float:
        """Return the share of a step on which nothing collides; raises IncrementFailedError where nothing moves."""
        share = self._contact.limit((position, ways), (position + du, ways + dw))
        if share < 1e-6:
            names = self._contact.blocking((position, ways), (position + du, ways + dw))
            raise IncrementFailedError(f"surfaces in contact let nothing move: {', '.join(names)}")
        return share

    def start(self, trial: Trial, values: Mapping[str, float], increment: Increment) -> Trial:
        """Return where an increment begins: the prediction, or in contact the last state if its forces balance better.

        In contact a prediction counts as far as nothing collides, and even there barriers may push with many times the
        applied forces.
        """
        if not self._contact:
            return trial
        last = increment.start
        predicted = self._reachable(trial, last, values)
        resting = Trial(last.displacement, last.pressure_modes, trial.pressure, self._contact.ways(last.values))
        return min((predicted, resting), key=lambda place: self._unbalanced(place, values, increment))

    def _unbalanced(self, trial: Trial, values: Mapping[str, float], increment: Increment) -> float:
        """Return the size of the forces that are not in balance, N, without friction, at the pressures of a trial."""
        position = self.model.mesh.points + trial.displacement
        force = self._assemble(trial, increment, tangent=False).force - self._load(values)
        for surface, pressure in zip(self._surfaces, trial.pressure, strict=True):
            force = force - pressure * surface.gradient(position)
        if increment.drag is not None:
            force = force + increment.drag.force(trial.displacement)
        force = force + self._contact.evaluate(position, trial.ways, None, hessian=False).gradient
        return float(np.linalg.norm(force[self._free]))

    def _reachable(self, trial: Trial, last: State, values: Mapping[str, float]) -> Trial:
        """Return the part of the way from the last state to a prediction on which nothing collides."""
        ways = self._contact.ways(last.values)
        du, dw = trial.displacement - last.displacement, self._contact.ways(values) - ways
        share = self._contact.limit((last.positions, ways), (last.positions + du, ways + dw))
        if share == 1.0:
            return Trial(trial.displacement, trial.modes, trial.pressure, ways + dw, trial.carried)
        modes = [old + share * (new - old) for old, new in zip(last.pressure_modes, trial.modes, strict=True)]
        before = np.array([last.pressure[name] for name in last.pressure])
        pressure = before + share * (trial.pressure - before)
        return Trial(last.displacement + share * du, modes, pressure, ways + share * dw)

    def _assemble(self, trial: Trial, increment: Increment, *, tangent: bool = True) -> Assembly:
        position = self.model.mesh.points + trial.displacement
        memory, seconds = increment.start.memory, increment.seconds
        return self.model.body.assemble(
            position, trial.modes, tangent, memory=memory, seconds=seconds, carried=trial.carried
        )

    def _load(self, values: Mapping[str, float]) -> Array:
        total = np.zeros(self.model.body.unknowns)
        for name, pattern in self.model.load_patterns.items():
            total += values.get(name, 0.0) * pattern
        return total

    def _error(
        self, residual: Array, applied: Array, equations: Equations, move: Array, pushed: Array | None = None,
        dw: Array | None = None,
    ) -> float:  # fmt: skip
        """Return the largest of the relative errors in force, supplies and given displacements."""
        size = np.linalg.norm
        least = 1e-6 * self._shear * self.model.mesh.size**2  # on a way back to zero no force is left to compare with
        scale = max(float(size(applied[self._free])), float(size(residual[self._held])), least)
        if pushed is not None:
            scale = max(scale, float(size(pushed[self._free])))
        force = float(size(residual[self._free]) / scale)
        supplies = np.abs(equations.value) / equations.scale
        missed = np.abs(move).max(initial=0.0)
        if dw is not None:
            missed = max(missed, np.abs(dw).max(initial=0.0))
        return max(force, supplies.max(initial=0.0), missed / self.model.mesh.size)

    def _tangent(self, assembly: Assembly, position: Array, pressure: Array, drag: Drag | None) -> Array:
        """Return the values of the tangent at fixed cavity pressures, before supports are applied."""
        values = assembly.values
        for surface, p in zip(self._surfaces, pressure, strict=True):
            surface.add_hessian(position, -p, values)
        if drag is not None:
            drag.add_tangent(values)
        return values

    def _factorise(
        self, values: Array, gradients: list[Array], softness: Array, move: Array, touching: Tangent
    ) -> _Factors:
        """Factor the tangent with its supports, and solve for the cavities' unit pressures; overwrites `values`."""
        self._adopt()
        moved = np.zeros(self.model.body.unknowns)
        moved[self._held] = move
        pulled = _multiply(self._matrix(values), moved) if np.any(move) else moved
        typical = float(np.abs(values[self._diagonal]).mean())
        values[self._struck] = 0.0
        values[self._diagonal[self._held]] = typical
        return self._factors(values, gradients, softness, pulled, touching)

    def _shifted(
        self, factors: _Factors, values: Array, more: Array, gradients: list[Array], softness: Array
    ) -> _Factors:
        """Factor the tangent with more (unknowns,) on its diagonal, in place, where nothing is held."""
        values[self._diagonal[self._free]] += more[self._free]
        return self._factors(values, gradients, softness, factors.pulled, factors.touching)

    def _factors(
        self, values: Array, gradients: list[Array], softness: Array, pulled: Array, touching: Tangent
    ) -> _Factors:
        self.linear.factorise(self._matrix(values))
        slopes = self._slopes(gradients)
        response = self.linear.solve(slopes.T) if len(slopes) else slopes.T
        return _Factors(pulled, response, self._unstable(slopes @ response, softness), touching)

    @property
    def _diagonal(self) -> NDArray[np.int64]:
        """Where the diagonal lies in the values of the tangent."""
        return self._touching.wide.pattern.diagonal

    def _step(
        self, factors: _Factors, residual: Array, gradients: list[Array],
        filling: tuple[NetworkIncrement, Equations, Array], move: Array,
    ) -> tuple[Array, Array]:  # fmt: skip
        """Return the steps in displacement (nodes, d) and cavity pressures (cavities,) of the bordered system.

        filling: the supplies, their equations at the pressures of the trial, and these.
        """
        right = -residual - factors.pulled if np.any(move) else -residual
        right[self._held] = 0.0
        first = self.linear.solve(right)
        first[self._held] = move
        slopes = self._slopes(gradients, held=True)
        supplies, at, pressure = filling
        matrix = at.by_pressure + at.by_volume @ (slopes @ factors.response)
        dp = np.asarray(np.linalg.solve(matrix, -at.value - at.by_volume @ (slopes @ first)), dtype=np.float64)
        dp *= supplies.share(pressure, dp)
        return (first + factors.response @ dp).reshape(-1, self.model.mesh.dimension), dp

    def _slopes(self, gradients: list[Array], *, held: bool = False) -> Array:
        """Return dV/du (cavities, unknowns), zero at what is held unless asked otherwise."""
        slopes = np.array(gradients).reshape(len(gradients), self.model.body.unknowns)
        if not held:
            slopes[:, self._held] = 0.0
        return slopes

    def _unstable(self, compliance: Array, softness: Array) -> int | None:
        """Return the unstable modes at fixed targets and contents of the cavities.

        With C = S K^-1 S^T the compliance (c, c) of the volumes under pressure and E = diag(softness), the fluids
        stiffen the tangent to K + S^T E^-1 S. By Haynsworth's inertia formula, applied both ways to
        [[K, S^T], [S, -E]], that has as many negative eigenvalues less than K as C + E has.
        """
        negative = self.linear.negative_pivots()
        if negative is None:
            return None
        filled = np.isfinite(softness)
        softer = compliance[np.ix_(filled, filled)] + np.diag(softness[filled])
        return negative - int(np.sum(np.linalg.eigvalsh(0.5 * (softer + softer.T)) < 0.0))

    def _matrix(self, values: Array) -> sparse.csr_matrix:
        n = self.model.body.unknowns
        matrix = sparse.csr_matrix((n, n))
        matrix.data, matrix.indices, matrix.indptr = values, self._indices, self._indptr
        matrix.has_sorted_indices = True
        return matrix

    def _keep_orientation(self, position: Array, du: Array, factor: float) -> float:
        """Return the factor halved until no quadrature point is turned inside out."""
        for _ in range(12):
            if self.model.body.smallest_volume_ratio(position + factor * du, fine=False) > 0.0:
                return factor
            factor *= 0.5
        raise IncrementFailedError("cells turn inside out whatever the step")


@dataclass(frozen=True, eq=False)
class _Factors:
    """A factored tangent: its forces under the supports' moves, response to unit cavity pressures, inertia."""

    pulled: Array
    response: Array
    unstable_modes: int | None
    touching: Tangent


def _multiply(upper: sparse.csr_matrix, vector: Array) -> Array:
    """Return A x for a symmetric A given by its upper triangle."""
    result: Array = upper @ vector + upper.T @ vector - upper.diagonal() * vector
    return result
