"""Normal force: how hard faces are pressed on what they touch, all around."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.mechanics import Model, State, Symmetry
from pneumorph.mechanics.contact.part import Place

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NormalForce:
    """Sum of the sizes of the normal forces of a contact on its faces, N: times the friction it is the largest hold.

    In a pipe forces from opposite sides add up, while in their resultant they cancel. Images in planes of symmetry
    count too: it is that of the whole body. In plane strain it is that of 1 mm of depth.

    contact: its name. Raises NameNotFoundError for an unknown one.
    """

    contact: str
    name: str = "normal_force"
    kind: str = "force"

    def __call__(self, state: State) -> float:
        """Return the force, N."""
        model = state.model
        number = contact_number(model, self.contact, self.name)
        nodes = [model.mesh.face_nodes(face) for face in model.contacts[number].faces]
        images = 2 ** sum(isinstance(support, Symmetry) for support in model.supports)
        push = normal_forces(state, number)[np.unique(np.concatenate(nodes))]
        return images * float(np.linalg.norm(push, axis=1).sum())


def normal_forces(state: State, number: int) -> Array:
    """Return the nodal normal forces (nodes, d), N, of the contact with a number in the model."""
    model = state.model
    way = float(model.contact.ways(state.values)[number])
    push = model.contact.pairs[number].normal(Place(state.positions, way), hessian=False).gradient
    return -push.reshape(-1, model.mesh.dimension)


def contact_number(model: Model, contact: str, owner: str) -> int:
    """Return the place of a contact among those of the model; raises NameNotFoundError, led by `owner`."""
    names = [item.name for item in model.contacts]
    if contact not in names:
        raise NameNotFoundError(f"{owner}: " + unknown_name("contact", contact, names))
    return names.index(contact)
