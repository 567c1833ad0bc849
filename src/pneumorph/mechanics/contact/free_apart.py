"""Whether free bodies are apart from what they may touch at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.mechanics.contact.apart import body_of_nodes, place_text, shift_text
from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.facets import split
from pneumorph.mechanics.contact.ipc import FacetContact, Surfaces
from pneumorph.mechanics.contact.obstacles import encloses
from pneumorph.mechanics.contact.part import Place
from pneumorph.mechanics.contact.vertices import Vertices
from pneumorph.mesh.topology import boundary

Integers = NDArray[np.int64]


def check_free_apart(vertices: Vertices, surfaces: Surfaces, contact: Contact) -> None:
    """Raise an InputError where the bodies on the two sides of a contact intersect, or one lies inside another.

    surfaces: of the contact; of soft bodies all is looked at, not only the faces that it names.
    """
    mesh = vertices.mesh
    still = replace(mesh, points=vertices.at(mesh.points), frames={})
    one = _closed(vertices, contact.faces)
    other = _closed(vertices, contact.other_faces)
    soft = [facets for _, facets in (*one, *other)]
    sides = None
    if other:
        sides = np.repeat([0, 1], [sum(len(f) for _, f in side) for side in (one, other)])
    whole = replace(surfaces, soft=np.concatenate(soft), sides=sides, areas=np.ones(vertices.count), riders=None)
    pair = FacetContact(still.points, whole, 1e-3 * mesh.size, 1.0, 0.0)
    where = pair.intersection(Place(still.points))
    if where is not None:
        names = f"{', '.join(contact.faces)} and {contact.other}"
        text = f"contact '{contact.name}': {names} intersect at ({place_text(where)}) mm"
        raise InputError(f"{text}; {shift_text(pair, still)}")
    against = [(name, still.points, facets) for name, facets in other]
    if len(surfaces.rigid):
        against.append((contact.other, surfaces.rigid, surfaces.rigid_facets))
    for name, facets in one:
        for second, points, others in against:
            for inner, place, outer, corners, bounds in (
                (name, still.points[facets[0, 0]], second, points, others),
                (second, points[others[0, 0]], name, still.points, facets),
            ):
                if encloses(corners, bounds, place):
                    raise InputError(
                        f"contact '{contact.name}': {inner} lies inside {outer}, at ({place_text(place)}) mm"
                    )


def _closed(vertices: Vertices, names: tuple[str, ...]) -> list[tuple[str, Integers]]:
    """Return the bodies that have some faces: name and closed surface (m, d) of each, on vertices."""
    mesh, found = vertices.mesh, []
    blocks = vertices.blocks(names)
    if blocks:
        label, skin = body_of_nodes(mesh), split(boundary(mesh.blocks))
        for number in np.unique(label[split(blocks)]):
            owned = [name for name in names if name in mesh.faces and number in label[mesh.face_nodes(name)]]
            found.append((f"the body with {', '.join(owned)}", skin[label[skin[:, 0]] == number]))
    found += [(body.name, vertices.facets((body.name,))) for body in vertices.bodies(names)]
    return found
