"""Finite-element runs of a soft limb under pressure and tip forces, and the data that a reduced limb is fitted to."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from importlib.metadata import version
from math import atan2, cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.geometry.soft_limb import SoftLimb
from pneumorph.measures.faces import best_rotation, sample
from pneumorph.mechanics import Cavity, Clamp, Contact, Model, Phase, Programme, State, Symmetry
from pneumorph.mechanics.loads import Force
from pneumorph.solution import Solution, solve
from pneumorph.solution.solve import Progress
from pneumorph.studies.reproductions.soft_wheel_limb import LimbStudy
from pneumorph.terrain.limb_data import LimbData

Array = NDArray[np.float64]

_PLANE = [0, 2]  # the limb bends in the plane of x and z
_HALF = 0.5  # the model is one half: it bears half of every force


@dataclass(frozen=True)
class LimbRuns:
    """What the finite-element limb goes through; MPa, N, mm, rad.

    pressures:  the tip forces act at each of these. forces: (size, direction) of each; the direction counts from the
                line of the unloaded foot to the axle, towards x -> z.
    held_out:   (pressure, size, direction) of forces that no fit uses: they test it.
    coarse: the mesh of the quick part `limb`, else that of the full one.
    """

    limb: SoftLimb = field(default_factory=lambda: SoftLimb(half=True))
    pressures: tuple[float, ...] = (0.0, 0.01, 0.02, 0.03)
    forces: tuple[tuple[float, float], ...] = ((1.25, 0.0), (0.5, 0.5 * pi))
    held_out: tuple[tuple[float, float, float], ...] = (
        (0.0, 0.6, 0.25 * pi),
        (0.01, 0.8, 0.0),
        (0.03, 1.6, 0.0),
    )
    coarse: bool = True

    def __post_init__(self) -> None:
        _ = self._study  # refuses a limb that is no half
        if tuple(sorted(set(self.pressures))) != self.pressures or self.pressures[0] != 0.0 or len(self.pressures) < 2:
            raise InputError(f"limb runs: pressures = {self.pressures}, expected 0 first, and growing")
        if not self.forces:
            raise InputError("limb runs: no forces, expected at least one")
        for pressure, _, _ in self.held_out:
            if pressure not in self.pressures:
                raise InputError(f"limb runs: a held-out force at {pressure:g} MPa, expected one of {self.pressures}")

    @property
    def _study(self) -> LimbStudy:
        return LimbStudy(self.coarse, self.limb)

    @property
    def inputs(self) -> dict[str, Any]:
        """All of it as JSON can hold it."""
        return dict(json.loads(json.dumps(asdict(self) | {"template": type(self.limb).__name__})))

    @property
    def digest(self) -> str:
        """SHA-256 of the inputs and of the materials' laws."""
        laws = {domain: repr(material) for domain, material in self._study.materials.items()}
        return hashlib.sha256(json.dumps([self.inputs, laws], sort_keys=True).encode()).hexdigest()

    @property
    def inwards(self) -> float:
        """Direction, rad from x to z, from the unloaded foot to the axle."""
        x, _, z = self.limb.foot_point
        axle = self.limb.axle
        return atan2(axle[2] - z, axle[0] - x)

    def programme(self) -> Programme:
        """Return the phases: at each pressure all forces, one after the other; then on to the next."""
        phases = []
        for number, pressure in enumerate(self.pressures, start=1):
            if pressure > 0.0:
                targets = {"cavity": pressure, "force x": 0.0, "force z": 0.0}
                phases.append(Phase(f"{number} inflate", targets, first=0.2, largest=0.34))
            for n, (size, direction) in enumerate(self.forces, start=1):
                phases.append(Phase(f"{number} force {n}", self._targets(size, direction), first=0.2, largest=0.4))
            for n, (_, size, direction) in enumerate((h for h in self.held_out if h[0] == pressure), start=1):
                phases.append(Phase(f"{number} held out {n}", self._targets(size, direction), first=0.2, largest=0.4))
        return Programme(tuple(phases))

    def _targets(self, size: float, direction: float) -> dict[str, float]:
        angle = self.inwards + direction
        return {"force x": _HALF * size * cos(angle), "force z": _HALF * size * sin(angle)}

    def model(self) -> Model:
        """Return the half limb, clamped at the hub, with its cavity, a force on the foot and pleats that touch."""
        return Model(
            self._study.mesh(),
            self._study.materials,
            (Clamp("clamp"), Symmetry("symmetry_y")),
            (Force("foot", (1.0, 0.0, 0.0), "force x"), Force("foot", (0.0, 0.0, 1.0), "force z")),
            (Cavity("cavity", ("cavity",), mirrors=("symmetry_y",)),),
            contacts=(Contact("walls", ("pleats",)),),
        )


def run_limb(
    runs: LimbRuns, folder: Path | None, *, resume: bool = False, progress: Callable[[Progress], None] | None = None,
    command: str = "",
) -> LimbData:  # fmt: skip
    """Solve the runs and return their data; see `solve` for folder, resume, progress and errors."""
    solution = solve(
        runs.model(), runs.programme(), folder=folder, resume=resume, progress=progress,
        about={"title": "limb of the soft wheel under pressure and tip forces", "sha256": runs.digest},
    )  # fmt: skip
    return limb_data(runs, solution, command)


def limb_data(runs: LimbRuns, solution: Solution, command: str = "") -> LimbData:
    """Return the shapes of all states of a solution of `runs`, also of those between the ends of the phases."""
    limb, programme = runs.limb, runs.programme()
    sections = _Sections(limb, solution.states[0])
    rotations, points, load_points, held_out = [], [], [], []
    for state in solution.states:
        turned, places = sections.measure(state)
        rotations.append(turned)
        points.append(places)
        load_points.append(sample(state, "foot").moved_centre[_PLANE])
        # the phase that a state ends or lies in: times are numbers of phases done
        name = programme.phases[int(np.ceil(state.time - 1e-9)) - 1 if state.time > 0.0 else 0].name
        held_out.append("held out" in name)
    values = [programme.values(state.time) for state in solution.states]
    forces = [[v.get("force x", 0.0) / _HALF, v.get("force z", 0.0) / _HALF] for v in values]
    mid, across = 0.5 * limb.base, limb.height
    return LimbData(
        stations=sections.places, hinges=sections.hinges,
        load_point=sample(solution.states[0], "foot").centre[_PLANE],
        pressures=np.array([v.get("cavity", 0.0) for v in values]), forces=np.array(forces),
        rotations=np.array(rotations), points=np.array(points), load_points=np.array(load_points),
        held_out=np.array(held_out), thickness=(across - mid, mid), width=limb.depth,
        foot=0.5 * limb.foot_length,
        mount=(-limb.axle[0], -limb.axle[2], 0.0),
        provenance={
            "command": command, "inputs": runs.inputs, "sha256": runs.digest,
            "mesh": f"{solution.model.mesh.cell_count} cells, {len(solution.model.mesh.points)} nodes",
            "pneumorph": version("pneumorph"),
        },
    )  # fmt: skip


class _Sections:
    """Sections across the base of a limb: at the clamp, in the middle between pleats, and the solid end."""

    def __init__(self, limb: SoftLimb, state: State):
        mesh, r = state.model.mesh, limb.radius
        first, pitch = limb.root / r, limb.pitch
        # (x, z) of the mid-surface of the base at angles of the arc
        self.angles = np.array([0.0, *(first + pitch * np.arange(1, limb.chambers)), limb.turn])
        self.places = self._line(limb, self.angles)
        self.hinges = self._line(limb, first + pitch * (np.arange(limb.chambers) + 0.5))
        nodes = np.unique(np.concatenate([b.nodes.ravel() for b in mesh.blocks if b.domain == "base"]))
        x, z = mesh.points[nodes][:, _PLANE].T
        turn, inwards = np.arctan2(x, z + r), r - np.hypot(x, z + r)
        layer = inwards > -1e-6 * r  # without the foot
        turn = turn % (2.0 * np.pi)
        self.nodes = [
            nodes[layer & (np.abs(turn - angle) < 0.25 * pitch)] for angle in self.angles[1:-1]
        ] + [nodes[layer & (turn > limb.turn - limb.end / r) & (turn < limb.turn + 1e-6)]]  # fmt: skip

    @staticmethod
    def _line(limb: SoftLimb, angles: NDArray[Any]) -> Array:
        r = limb.radius - 0.5 * limb.base
        return np.stack([r * np.sin(angles), r * np.cos(angles) - limb.radius], axis=1)

    def measure(self, state: State) -> tuple[Array, Array]:
        """Return rotation (n + 1,) and place (n + 1, 2) of the sections; the clamped one stays.

        The nodes of the base beside a section give its best rigid motion.
        """
        reference, moved, weight = state.model.mesh.points, state.positions, state.model.unit_mass
        turned, places = [0.0], [self.places[0]]
        for nodes, place in zip(self.nodes, self.places[1:], strict=True):
            before, after, share = reference[nodes][:, _PLANE], moved[nodes][:, _PLANE], weight[nodes]
            rotation = best_rotation(before, after, share)
            centre, now = np.average(before, axis=0, weights=share), np.average(after, axis=0, weights=share)
            turned.append(atan2(rotation[1, 0], rotation[0, 0]))
            places.append(now + rotation @ (place - centre))
        return np.unwrap(turned), np.array(places)
