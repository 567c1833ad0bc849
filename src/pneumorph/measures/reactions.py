"""Reactions: the force and the moment that a support gives to the body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.measures.faces import sample
from pneumorph.mechanics import State
from pneumorph.mechanics.supports import axis_index

Array = NDArray[np.float64]


def _nodal(state: State, face: str) -> tuple[NDArray[np.int64], Array]:
    nodes = state.model.mesh.face_nodes(face)
    return nodes, state.reactions.reshape(state.displacement.shape)[nodes]


@dataclass(frozen=True)
class ReactionForce:
    """Force that the support on a named face gives to the body, N; the body pushes the support with its opposite.

    face: name of the supported face. Nodes that it shares with another supported face count too.
    component: 'x', 'y' or 'z' for a signed component, None for the magnitude.
    In plane strain it is that of 1 mm of depth; with axial symmetry that of the full ring.
    Raises NameNotFoundError for a face, InputError for a component.
    """

    face: str = "clamp"
    component: str | None = None
    name: str = "reaction_force"
    kind: str = "force"

    def vector(self, state: State) -> Array:
        """Return the force (d,), N."""
        return _nodal(state, self.face)[1].sum(axis=0)

    def __call__(self, state: State) -> float:
        """Return the component or the magnitude, N."""
        force = self.vector(state)
        if self.component is None:
            return float(np.linalg.norm(force))
        return float(force[axis_index(self.component, state.model.mesh, self.name)])


@dataclass(frozen=True)
class ReactionMoment:
    """Moment that the support on a named face gives to the body, N mm: sum of (x - about) x force at deformed places.

    about: a fixed point, mm; None takes the centre of the face in the reference.
    component: 'x', 'y' or 'z' for a signed component (right-hand rule), None for the magnitude; about z in the plane.
    Raises NameNotFoundError for a face, InputError for a component, for a point with the wrong number of coordinates
    and with axial symmetry, where forces on a ring have no moment.
    """

    face: str = "clamp"
    about: tuple[float, ...] | None = None
    component: str | None = None
    name: str = "reaction_moment"
    kind: str = "moment"

    def __post_init__(self) -> None:
        if self.component not in (None, "x", "y", "z"):
            raise InputError(f"{self.name}: component = {self.component!r}, allowed: x, y, z or None")

    def vector(self, state: State) -> Array:
        """Return the moment (3,), N mm."""
        mesh = state.model.mesh
        if mesh.space == "axisymmetric":
            raise InputError(f"{self.name}: a model with axial symmetry has no moment")
        nodes, forces = _nodal(state, self.face)
        point = sample(state, self.face).centre if self.about is None else np.asarray(self.about, dtype=float)
        if point.shape != (mesh.dimension,):
            raise InputError(f"{self.name}: about = {self.about!r}, expected {mesh.dimension} coordinates")
        arms = state.positions[nodes] - point
        three = [np.pad(values, ((0, 0), (0, 3 - mesh.dimension))) for values in (arms, forces)]
        return np.cross(three[0], three[1]).sum(axis=0)

    def __call__(self, state: State) -> float:
        """Return the component or the magnitude, N mm."""
        moment = self.vector(state)
        return float(np.linalg.norm(moment) if self.component is None else moment["xyz".index(self.component)])
