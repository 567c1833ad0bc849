"""How far a named region in contact slides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.mechanics import Model, State
from pneumorph.mechanics.contact.part import Place

Array = NDArray[np.float64]


def slip(before: State, after: State, contact: str, face: str) -> Array:
    """Return how far a face slid between two states (d,), mm: the mean way of its nodes, by their normal forces after.

    Zero where it does not bear. Of an obstacle that moves the way is taken off. Raises NameNotFoundError.
    """
    model = after.model
    number = _index(model, contact, face)
    ways, old = model.contact.ways(after.values), model.contact.ways(before.values)
    pair = model.contact.pairs[number]
    push = pair.normal(Place(after.positions, float(ways[number])), hessian=False).gradient
    nodes = model.mesh.face_nodes(face)
    size = np.linalg.norm(push.reshape(-1, model.mesh.dimension)[nodes], axis=1)
    total = float(size.sum())
    if total == 0.0:
        return np.zeros(model.mesh.dimension)
    moved = (after.displacement - before.displacement)[nodes]
    return np.asarray(size @ moved / total - float(ways[number] - old[number]) * pair.along)


def _index(model: Model, contact: str, face: str) -> int:
    names = [item.name for item in model.contacts]
    if contact not in names:
        raise NameNotFoundError("slip: " + unknown_name("contact", contact, names))
    number = names.index(contact)
    if face not in model.contacts[number].faces:
        faces = model.contacts[number].faces
        raise NameNotFoundError("slip: " + unknown_name(f"face of the contact '{contact}'", face, faces))
    return number
