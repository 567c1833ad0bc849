"""Supports, loads and steps of an .inp file: one step a phase, linear ramps as in a `Programme`.

In a *STATIC step without an amplitude both programs ramp every load and displacement from where the last step left it
to the value given, which is what a phase does; so only pressures taken from a run need an *AMPLITUDE.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.exchange.inp_mesh import ALL, CALCULIX, InpMesh, plain_names, rows
from pneumorph.mechanics import Gravity, Model, Phase, Prescribed, PressureSupply, Programme

Array = NDArray[np.float64]

# output of the last increment only: more increments than a step may have
_LAST = 100_000


@dataclass(frozen=True, eq=False)
class PressureTable:
    """Gauge pressures (n,), MPa, over time (n,), phases done plus the fraction of the present one; time[0] is 0."""

    time: Array
    pressure: Array


@dataclass(frozen=True, eq=False)
class InpSteps:
    """Supports, loads and steps. tables: cavity -> pressures of a run, in the place of its supply.

    fields: write displacement and stress of all nodes; printed: faces whose displacements go to the .dat file.

    Raises InputError for a cavity that is not driven by a pressure and has no table, or is closed by a cap, for a face
    in two cavities, contact, and a programme that does not fit the model or is not static; NameNotFoundError for a
    table or face that is not in the model.
    """

    inp: InpMesh
    model: Model
    programme: Programme
    dialect: str
    tables: Mapping[str, PressureTable]
    fields: bool
    printed: Sequence[str]

    def __post_init__(self) -> None:
        self.programme.check(self.model)
        if self.model.contacts:
            names = ", ".join(contact.name for contact in self.model.contacts)
            raise InputError(f"contact ({names}) cannot be written to an .inp file; leave it out of the study")
        for name in self.tables:
            if name not in self.model.surfaces:
                raise NameNotFoundError(unknown_name("cavity", name, self.model.surfaces))
        for name in self.printed:
            self.model.mesh.face_blocks(name)
        self._check_static()
        owner: dict[str, str] = {}
        for cavity in self.model.cavities:
            for face in cavity.faces:
                if face in self.model.mesh.caps:
                    raise InputError(
                        f"cavity '{cavity.name}' is closed by the cap '{face}', which is no part of the body: an .inp "
                        "file cannot hold the pressure on it"
                    )
            if cavity.name not in self.tables and not isinstance(cavity.supply, PressureSupply):
                raise InputError(
                    f"cavity '{cavity.name}' has a {type(cavity.supply).__name__}, which an .inp file cannot hold: "
                    "CalculiX has no such supply; export the run with the pressures that were found (--pressures)"
                )
            for face in cavity.faces:
                if owner.setdefault(face, cavity.name) != cavity.name:
                    raise InputError(f"face '{face}' belongs to the cavities '{owner[face]}' and '{cavity.name}'")

    def _check_static(self) -> None:
        viscous = [domain for domain, material in self.model.materials.items() if material.prony is not None]
        for phase in self.programme.phases:
            if phase.inertia is not None:
                raise InputError(f"phase '{phase.name}' has inertia: the steps of an .inp file are static ones")
            if phase.duration is not None and viscous:
                raise InputError(
                    f"phase '{phase.name}' has a duration and the material of '{viscous[0]}' a Prony series: the steps "
                    "of an .inp file are static ones"
                )

    def model_lines(self) -> list[str]:
        """Return what comes before the steps: amplitudes, time points, fixed supports."""
        result = []
        for name, table in self.tables.items():
            result.append(f"*AMPLITUDE, NAME={self._amplitudes[name]}, TIME=TOTAL TIME")
            pairs = [f"{t:.12g}, {p:.12g}" for t, p in zip(table.time, table.pressure, strict=True)]
            result += rows(pairs, 4)
        for number, phase in enumerate(self.programme.phases, 1):
            if phase.marks:
                result += [f"*TIME POINTS, NAME=MARKS_{number}", *rows([f"{t:.12g}" for t in (*phase.marks, 1.0)], 8)]
        return result + self._supports()

    def step_lines(self) -> list[str]:
        """Return the steps."""
        result: list[str] = []
        for number, phase in enumerate(self.programme.phases, 1):
            result += [f"** phase {number}: {' '.join(phase.name.split())}"]
            calculix = self.dialect == CALCULIX
            result += ["*STEP, NLGEOM, INC=10000" if calculix else f"*STEP, NAME=PHASE_{number}, NLGEOM=YES, INC=10000"]
            result += ["*STATIC", f"{phase.first:.9g}, 1., {phase.smallest:.9g}, {phase.largest:.9g}"]
            result += self._loads(self.programme.values(float(number)))
            result += [*self._output(number, phase), "*END STEP"]
        return result

    def _supports(self) -> list[str]:
        """Hold everything at zero, what is moved later too: until its phase it stays."""
        lines, d, mesh = [], self.model.mesh.dimension, self.model.mesh
        for support in self.model.supports:
            if isinstance(support, Prescribed):
                continue
            axes = sorted({int(unknown) % d + 1 for unknown in support.held(mesh)})
            lines += [f"{self.inp.faces[support.face]}, {axis}, {axis}" for axis in axes]
        lines += [f"{node}, {axis}, {axis}" for support in self._driven for node, axis in self._driven[support]]
        return ["*BOUNDARY", *lines] if lines else []

    @property
    def _driven(self) -> dict[str, list[tuple[int, int]]]:
        """Name of a prescribed displacement -> (node, axis), from 1, that it moves; a fixed support wins, then the
        displacement that the model names last."""
        d, mesh = self.model.mesh.dimension, self.model.mesh
        taken = np.zeros(mesh.points.size, dtype=bool)
        for support in self.model.supports:
            if not isinstance(support, Prescribed):
                taken[support.held(mesh)] = True
        result: dict[str, list[tuple[int, int]]] = {}
        for support in reversed(self.model.supports):
            if isinstance(support, Prescribed):
                unknowns = support.driven(mesh)
                free = unknowns[~taken[unknowns] & self.inp.used[unknowns // d]]
                taken[unknowns] = True
                result[support.name] = [(int(u) // d + 1, int(u) % d + 1) for u in free]
        return result

    @property
    def _amplitudes(self) -> dict[str, str]:
        return {name: f"P_{plain}" for name, plain in plain_names("cavity", self.model.surfaces).items()}

    def _loads(self, values: Mapping[str, float]) -> list[str]:
        """Return moved supports, dead loads, gravity and pressures at the end of a step."""
        lines: list[str] = []
        for name, pairs in self._driven.items():
            if name in values:
                lines += ["*BOUNDARY", *(f"{node}, {axis}, {axis}, {values[name]:.12g}" for node, axis in pairs)]
        gravity = [load for load in self.model.loads if isinstance(load, Gravity)]
        # a second gravity on the same elements would replace the first one: several become nodal forces
        gravity = gravity if len(gravity) == 1 else []
        dead = [load.name for load in self.model.loads if load not in gravity and load.name in values]
        if dead:
            lines += self._nodal_forces({name: values[name] for name in dead})
        for load in gravity:
            if load.name in values:
                direction = np.zeros(3)
                direction[: len(load.direction)] = np.asarray(load.direction) / np.linalg.norm(load.direction)
                axes = ", ".join(f"{x:.12g}" for x in direction)
                lines += ["*DLOAD", f"{ALL}, GRAV, {values[load.name]:.12g}, {axes}"]
        for cavity in self.model.cavities:
            faces = [self.inp.faces[face] for face in cavity.faces]
            if cavity.name in self.tables:
                lines += [f"*DSLOAD, AMPLITUDE={self._amplitudes[cavity.name]}", *(f"{face}, P, 1." for face in faces)]
            elif cavity.name in values:
                lines += ["*DSLOAD", *(f"{face}, P, {values[cavity.name]:.12g}" for face in faces)]
        return lines

    def _nodal_forces(self, values: Mapping[str, float]) -> list[str]:
        """Return dead loads as work-equivalent nodal forces: tractions of a fixed direction have no card of theirs."""
        shape = self.model.mesh.points.shape
        total = sum(value * self.model.load_patterns[name] for name, value in values.items())
        forces = self.inp.moved_forces(np.asarray(total).reshape(shape))
        # every node that any of the loads touches, so that a load that goes back to zero is written too
        patterns = [self.inp.moved_forces(self.model.load_patterns[name].reshape(shape)) for name in values]
        places = np.argwhere(np.any([pattern != 0.0 for pattern in patterns], axis=0)).tolist()
        return ["*CLOAD", *(f"{node + 1}, {axis + 1}, {forces[node, axis]:.12g}" for node, axis in places)]

    def _output(self, number: int, phase: Phase) -> list[str]:
        points = f", TIME POINTS=MARKS_{number}" if phase.marks else ""
        lines = []
        if self.fields and self.dialect == CALCULIX:
            lines += [f"*NODE FILE{points}", "U", f"*EL FILE{points}", "S"]
        elif self.fields:
            lines += [f"*OUTPUT, FIELD{points}", "*NODE OUTPUT", "U", "*ELEMENT OUTPUT", "S, LE"]
        for face in self.printed:
            often = points if points and self.dialect == CALCULIX else f", FREQUENCY={_LAST}"
            lines += [f"*NODE PRINT, NSET={self.inp.faces[face]}{often}", "U"]
        return lines
