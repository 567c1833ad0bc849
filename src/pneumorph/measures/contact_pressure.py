"""Contact pressure: as a field on the faces that touch, its mean over the area that bears, and its largest value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.measures.normal_force import contact_number, normal_forces
from pneumorph.mechanics import State
from pneumorph.mechanics.contact.part import Place
from pneumorph.mechanics.contact.smooth import SmoothContact

Array = NDArray[np.float64]

_BEARS = 1e-9  # of the largest nodal force: nodes with less are beside the contact


def contact_pressure(state: State, *contacts: str) -> Array:
    """Return the normal contact pressure (nodes,), MPa, on the deformed faces of contacts, 0 elsewhere; by default all.

    It is the size of a node's contact force, without friction, over the deformed area that it bears; both sides of a
    deformable pair have theirs. Nodes of facets do not face each other, so that single ones bear more than their share:
    the largest value depends on both meshes, the mean over an area hardly does. Raises NameNotFoundError for a contact.
    """
    total = np.zeros(len(state.model.mesh.points))
    for name in contacts or tuple(contact.name for contact in state.model.contacts):
        force, area = _shares(state, name)
        bears = area > 0.0
        total[bears] += force[bears] / area[bears]
    return total


def _shares(state: State, name: str) -> tuple[Array, Array]:
    """Return normal force (nodes,), N, and deformed area (nodes,), mm2, of the faces of a contact by node."""
    model, contact = state.model, state.model.contact
    number = contact_number(model, name, "contact pressure")
    item, pair, nodes = contact.contacts[number], contact.pairs[number], len(model.mesh.points)
    faces = [face for face in (*item.faces, *item.other_faces) if face in model.mesh.faces]
    if isinstance(pair, SmoothContact):
        force, area = np.zeros(nodes), np.zeros(nodes)
        place = Place(state.positions, float(contact.ways(state.values)[number]))
        deformed = contact.vertices.force_points(faces, state.positions)
        for group, now, pressed in zip(pair.points, deformed, pair.lag(place).force, strict=False):
            if group.nodes.shape[1] == 1:  # the centres of triangles lie between the nodes
                force[group.nodes[:, 0]], area[group.nodes[:, 0]] = pressed, now.weight
        return force, area
    force = np.linalg.norm(normal_forces(state, number), axis=1)
    return force, contact.vertices.areas(faces, state.positions)[:nodes]


@dataclass(frozen=True)
class MeanContactPressure:
    """Normal force of a contact over the area that bears it, both on its named faces as they are deformed, MPa.

    contact: its name. The nodal normal forces are added up by size, so that a curved area counts in full. 0 where
    nothing touches. Raises NameNotFoundError for a contact that is not there.
    """

    contact: str
    kind: str = "stress"

    @property
    def name(self) -> str:
        """Name of its column."""
        return f"mean_contact_pressure:{self.contact}"

    def __call__(self, state: State) -> float:
        """Return the pressure, MPa."""
        force, area = _shares(state, self.contact)
        own = next(item for item in state.model.contacts if item.name == self.contact).faces
        nodes = state.model.contact.vertices.nodes(own)
        force, area = force[nodes], area[nodes]
        bears = force > _BEARS * float(force.max())
        return float(force[bears].sum() / area[bears].sum()) if bears.any() else 0.0
