"""Newton's method for one increment: displacement, pressure modes and cavity pressures together.

Full steps, limited by a cap on the displacement and by det F > 0, are all that guards it: an energy line search is
worse than cutting the increment, because the large bulk modulus makes the energy rise along good steps. Where no cut
helps, `continuation` adds a viscous term, which comes here as an `Anchor`.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mechanics.body import Assembly
from pneumorph.mechanics.linear import LinearSolver, linear_solver
from pneumorph.mechanics.model import Model

Array = NDArray[np.float64]
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Settings:
    """How a solve steps and when it is content.

    tolerance:     residual force over the largest of applied forces and reactions.
    iterations:    iterations before an increment is given up.
    largest_step:  cap on a nodal displacement in one iteration, as a fraction of the body's size.
    growth, few:   an increment that took at most `few` iterations is followed by one `growth` times larger.
    cut:           factor on an increment that failed.
    viscosity:     first coefficient of the viscous regularisation that is tried where increments fail, in units of
                   mu / size2 (see `continuation`); 0 switches it off for good.
    relaxations:   viscous steps before an increment is given up.
    """

    tolerance: float = 1e-8
    iterations: int = 12
    largest_step: float = 0.05
    growth: float = 1.5
    few: int = 7
    cut: float = 0.4
    viscosity: float = 100.0
    relaxations: int = 60


@dataclass(eq=False)
class Trial:
    """The unknowns of an increment: displacement (nodes, d), pressure modes, cavity pressures (cavities,)."""

    displacement: Array
    modes: list[Array]
    pressure: Array

    def stepped(self, factor: float, du: Array, dq: list[Array], dp: Array) -> Trial:
        """Return the trial after a part of a step."""
        modes = [q + factor * d for q, d in zip(self.modes, dq, strict=True)]
        return Trial(self.displacement + factor * du, modes, self.pressure + factor * dp)


@dataclass(frozen=True, eq=False)
class Converged:
    """A trial in equilibrium, with what the iteration found on the way."""

    trial: Trial
    volume: Array
    reactions: Array
    iterations: int
    unstable_modes: int | None
    smallest_volume_ratio: float


class IncrementFailedError(Exception):
    """An increment did not converge; the message says why."""


@dataclass(frozen=True, eq=False)
class Anchor:
    """Viscous regularisation of an increment: coefficient (MPa / mm2) and the displacement it starts from."""

    coefficient: float
    displacement: Array


class Newton:
    """Solves increments of one model; keeps the analysis of its matrix pattern between them."""

    def __init__(self, model: Model, settings: Settings):
        self.model = model
        self.settings = settings
        self.linear: LinearSolver = linear_solver()
        body = model.body
        self._indices = body.pattern.indices
        self._indptr = body.pattern.indptr.astype(np.int32)
        self._held = model.held
        self._struck = body.pattern.touching(self._held)
        self._free = np.ones(body.unknowns, dtype=bool)
        self._free[self._held] = False
        self._surfaces = list(model.surfaces.values())
        self._supplies = [surface.cavity.supply for surface in self._surfaces]
        self.mass = np.repeat(model.unit_mass, body.dimension)

    def solve(self, trial: Trial, values: Mapping[str, float], anchor: Anchor, *, loose: bool = False) -> Converged:
        """Return the equilibrium at the values of the programme; raises IncrementFailedError.

        loose: be content with a thousandth of the forces, within half the iterations (steps of a viscous slide).
        """
        settings = self.settings
        tolerance = 1e-3 if loose else settings.tolerance
        iterations = settings.iterations // 2 if loose else settings.iterations
        load = self._load(values)
        given = self.model.prescribed(values)[self._held]
        unstable: int | None = 0
        best, settled = np.inf, False
        for iteration in range(iterations):
            assembly = self._assemble(trial)
            position = self.model.mesh.points + trial.displacement
            gradients = [surface.gradient(position) for surface in self._surfaces]
            volumes = np.array([surface.volume(position) for surface in self._surfaces])
            applied = load + sum((p * g for p, g in zip(trial.pressure, gradients, strict=True)), np.zeros_like(load))
            drag = anchor.coefficient * self.mass * (trial.displacement - anchor.displacement).ravel()
            residual = assembly.force - applied + drag
            equations = self._equations(trial.pressure, volumes, values)
            move = given - trial.displacement.ravel()[self._held]
            error = self._error(residual, applied, equations, volumes, move)
            if not np.isfinite(error):
                raise IncrementFailedError("the residual is not finite")
            if (error <= tolerance or (settled and error <= 1e-3)) and iteration > 0:
                ratio = self.model.body.smallest_volume_ratio(position, fine=True)
                reactions = np.where(self._free, 0.0, residual)
                return Converged(trial, volumes, reactions, iteration, unstable, ratio)
            _log.debug("iteration %d: error %.3g, unstable modes %s", iteration, error, unstable)
            best = min(best, error)
            if error > 1e6 * max(best, settings.tolerance):
                raise IncrementFailedError(f"the residual grew to {error:.2g} of the applied forces")
            matrix = self._tangent(assembly, position, trial.pressure, anchor)
            step = self._step(matrix, residual, gradients, equations, move)
            unstable = step.unstable_modes
            dq = self.model.body.pressure_step(assembly.gains, step.du)
            largest = float(np.abs(step.du).max())
            factor = min(1.0, settings.largest_step * self.model.mesh.size / max(largest, 1e-300))
            factor = self._keep_orientation(position, step.du, factor)
            trial = trial.stepped(factor, step.du, dq, step.dp)
            # under a very small load the residual stays at the rounding of the bulk term: then the step tells
            settled = factor == 1.0 and largest <= 1e-10 * self.model.mesh.size
        raise IncrementFailedError(f"no convergence in {iterations} iterations")

    def _assemble(self, trial: Trial) -> Assembly:
        return self.model.body.assemble(self.model.mesh.points + trial.displacement, trial.modes)

    def _load(self, values: Mapping[str, float]) -> Array:
        total = np.zeros(self.model.body.unknowns)
        for name, pattern in self.model.load_patterns.items():
            total += values.get(name, 0.0) * pattern
        return total

    def _equations(self, pressure: Array, volumes: Array, values: Mapping[str, float]) -> Array:
        """Return (cavities, 3): g, dg/dp, dg/dV of each supply."""
        rows = [
            surface.cavity.supply.equation(p, v, surface.reference_volume, values.get(surface.cavity.name, 0.0))
            for surface, p, v in zip(self._surfaces, pressure, volumes, strict=True)
        ]
        return np.array(rows, dtype=float).reshape(-1, 3)

    def _error(self, residual: Array, applied: Array, equations: Array, volumes: Array, move: Array) -> float:
        """Return the largest of the relative errors in force, supplies and given displacements."""
        size = np.linalg.norm
        shear = max(material.shear_modulus for material in self.model.materials.values())
        least = 1e-6 * shear * self.model.mesh.size**2  # on a way back to zero no force is left to compare with
        scale = max(float(size(applied[self._free])), float(size(residual[self._held])), least)
        force = float(size(residual[self._free]) / scale)
        supplies = np.abs(equations[:, 0]) / (np.abs(equations[:, 1]) * shear + np.abs(equations[:, 2]) * volumes)
        return max(force, supplies.max(initial=0.0), np.abs(move).max(initial=0.0) / self.model.mesh.size)

    def _tangent(self, assembly: Assembly, position: Array, pressure: Array, anchor: Anchor) -> Array:
        """Return the values of the tangent at fixed cavity pressures, before supports are applied."""
        values = assembly.values
        for surface, p in zip(self._surfaces, pressure, strict=True):
            surface.add_hessian(position, -p, values)
        values[self.model.body.pattern.diagonal] += anchor.coefficient * self.mass
        return values

    def _step(self, values: Array, residual: Array, gradients: list[Array], equations: Array, move: Array) -> _Step:
        diagonal = self.model.body.pattern.diagonal
        right = -residual
        if np.any(move):
            moved = np.zeros_like(residual)
            moved[self._held] = move
            right -= _multiply(self._matrix(values), moved)
        typical = float(np.abs(values[diagonal]).mean())
        values[self._struck] = 0.0
        values[diagonal[self._held]] = typical
        self.linear.factorise(self._matrix(values))
        columns = np.column_stack([right, *gradients])
        columns[self._held] = 0.0
        solved = self.linear.solve(columns)
        first, response = solved[:, 0].copy(), solved[:, 1:]
        first[self._held] = move
        slopes = np.array(gradients).reshape(len(gradients), len(residual))
        compliance = slopes @ response
        g, by_pressure, by_volume = equations.T
        dp = np.linalg.solve(
            np.diag(by_pressure) + by_volume[:, None] * compliance, -g - by_volume * (slopes @ first)
        ) if len(g) else np.zeros(0)  # fmt: skip
        du = (first + response @ dp).reshape(-1, self.model.mesh.dimension)
        return _Step(du, dp, self._unstable(compliance, by_volume))

    def _unstable(self, compliance: Array, by_volume: Array) -> int | None:
        """Return the unstable modes at fixed targets: a fixed volume removes one for each negative compliance."""
        negative = self.linear.negative_pivots()
        if negative is None:
            return None
        fixed = by_volume != 0.0
        stiffened = int(np.sum(np.linalg.eigvals(compliance[np.ix_(fixed, fixed)]).real < 0.0)) if fixed.any() else 0
        return negative - stiffened

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
class _Step:
    du: Array
    dp: Array
    unstable_modes: int | None


def _multiply(upper: sparse.csr_matrix, vector: Array) -> Array:
    """Return A x for a symmetric A given by its upper triangle."""
    result: Array = upper @ vector + upper.T @ vector - upper.diagonal() * vector
    return result
