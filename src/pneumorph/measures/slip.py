"""How far a named region in contact slides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.measures.normal_force import contact_number, normal_forces
from pneumorph.mechanics import Model, State

Array = NDArray[np.float64]


def slip(before: State, after: State, contact: str, face: str) -> Array:
    """Return how far a face slid between two states (d,), mm: the mean way of its nodes, by their normal forces after.

    Zero where it does not bear. Of an obstacle that moves the way is taken off. Raises NameNotFoundError.
    """
    model = after.model
    number = _number(model, contact, face)
    ways, old = model.contact.ways(after.values), model.contact.ways(before.values)
    nodes = model.mesh.face_nodes(face)
    size = np.linalg.norm(normal_forces(after, number)[nodes], axis=1)
    total = float(size.sum())
    if total == 0.0:
        return np.zeros(model.mesh.dimension)
    moved = (after.displacement - before.displacement)[nodes]
    return np.asarray(size @ moved / total - float(ways[number] - old[number]) * model.contact.pairs[number].along)


def _number(model: Model, contact: str, face: str) -> int:
    number = contact_number(model, contact, "slip")
    if face not in model.contacts[number].faces:
        faces = model.contacts[number].faces
        raise NameNotFoundError("slip: " + unknown_name(f"face of the contact '{contact}'", face, faces))
    return number
