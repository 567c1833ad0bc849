"""Whether bodies are apart at rest: where they intersect, and which shift takes one of them free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from pneumorph.errors import InputError
from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.facets import split
from pneumorph.mechanics.contact.ipc import FacetContact, Surfaces
from pneumorph.mechanics.contact.obstacles import encloses
from pneumorph.mechanics.contact.part import Place
from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.topology import boundary

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def body_of_nodes(mesh: Mesh) -> Integers:
    """Return the number of the connected body (nodes,) that each node belongs to."""
    ends = np.concatenate([np.stack([b.nodes[:, :-1].ravel(), b.nodes[:, 1:].ravel()], axis=1) for b in mesh.blocks])
    links = sparse.coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(mesh.points),) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def whole_bodies(mesh: Mesh, surfaces: Surfaces) -> FacetContact:
    """Return the contact of whole bodies: named faces may lie inside another body without crossing its named ones."""
    skin = split(boundary(mesh.blocks))
    sides = None
    if surfaces.sides is not None:
        label = body_of_nodes(mesh)
        first, second = (np.unique(label[surfaces.soft[surfaces.sides == side]]) for side in (0, 1))
        here = label[skin[:, 0]]
        if len(np.intersect1d(first, second)):  # two faces of one body
            skin, sides = surfaces.soft, surfaces.sides
        else:
            skin = np.concatenate([skin[np.isin(here, first)], skin[np.isin(here, second)]])
            sides = np.repeat([0, 1], [np.isin(here, first).sum(), np.isin(here, second).sum()])
    elif not len(surfaces.rigid):
        skin = surfaces.soft
    whole = replace(surfaces, soft=skin, sides=sides, areas=np.ones(len(mesh.points)))
    return FacetContact(mesh.points, whole, 1e-3 * mesh.size, 1.0, 0.0)


def check_apart(pair: FacetContact, mesh: Mesh, contact: Contact) -> None:
    """Raise an InputError with the place, and the shift that helps, where surfaces intersect at rest."""
    where, surfaces, against = pair.intersection(Place(mesh.points)), pair.surfaces, contact.against
    if where is None and len(surfaces.rigid):
        label = body_of_nodes(mesh)
        for body in np.unique(label[surfaces.soft]):
            inside = mesh.points[np.flatnonzero(label == body)[0]]
            if encloses(surfaces.rigid, surfaces.rigid_facets, inside):
                raise InputError(
                    f"contact '{contact.name}': the body with {', '.join(contact.faces)} lies inside the "
                    f"{contact.other}, at ({place_text(inside)}) mm"
                )
    if where is None:
        return
    one = ", ".join(contact.faces)
    text = f"contact '{contact.name}': {one} and {contact.other} intersect at ({place_text(where)}) mm"
    if against is None:
        raise InputError(f"{text}; the surface of the body must not cross itself")
    raise InputError(f"{text}; {shift_text(pair, mesh)}")


def check_parts_apart(mesh: Mesh, parts: Sequence[tuple[str, int]]) -> None:
    """Raise an InputError where bodies that were joined to one mesh intersect, or one lies inside another.

    parts: name of each body and how many nodes it has, in the order of the nodes.
    """
    skin, side = split(boundary(mesh.blocks)), np.repeat(np.arange(len(parts)), [count for _, count in parts])
    owner = side[skin[:, 0]]
    for second in range(1, len(parts)):
        for first in range(second):
            one, other = skin[owner == second], skin[owner == first]
            if not _boxes_meet(mesh.points[one], mesh.points[other]):
                continue
            facets = np.concatenate([one, other])
            sides = np.repeat([0, 1], [len(one), len(other)])
            none = np.empty((0, mesh.dimension))
            surfaces = Surfaces(
                facets, np.ones(len(mesh.points)), sides, none, none.astype(np.int64), np.zeros(mesh.dimension)
            )
            pair = FacetContact(mesh.points, surfaces, 1e-3 * mesh.size, 1.0, 0.0)
            where = pair.intersection(Place(mesh.points))
            names = f"{parts[first][0]} and {parts[second][0]}"
            if where is not None:
                text = f"{names} intersect at ({place_text(where)}) mm"
                raise InputError(f"{text}; {shift_text(pair, mesh, f'{parts[second][0]}')}")
            for inner, outer, name in ((one, other, second), (other, one, first)):
                point = mesh.points[inner[0, 0]]
                if encloses(mesh.points, outer, point):
                    holder = parts[first + second - name][0]
                    raise InputError(f"{parts[name][0]} lies inside {holder}, at ({place_text(point)}) mm")


def _boxes_meet(one: Array, other: Array) -> bool:
    """Return whether the boxes around facets (m, d, d) overlap."""
    low, high = (np.stack([f(x, axis=(0, 1)) for x in (one, other)]) for f in (np.min, np.max))
    return bool((low.max(axis=0) <= high.min(axis=0)).all())


def shift_text(pair: FacetContact, mesh: Mesh, moved: str = "the faces") -> str:
    """Return the smallest translation along a coordinate axis that takes the named faces free."""
    best = (np.inf, np.zeros(mesh.dimension))
    rigid = len(pair.surfaces.rigid) > 0
    moving = pair.surfaces.soft if pair.surfaces.sides is None else pair.surfaces.soft[pair.surfaces.sides == 0]
    nodes = np.unique(moving)
    whole = max(mesh.size, float(np.ptp(pair.surfaces.rigid, axis=0).max()) if rigid else 0.0)
    for axis in (*np.eye(mesh.dimension), *-np.eye(mesh.dimension)):

        def apart(way: float, axis: Array = axis) -> bool:
            position = mesh.points.copy()
            position[nodes] += way * axis
            return pair.distance(Place(position)) > 0.0

        steps = whole * np.geomspace(1e-4, 2.0, 40)
        free = next((k for k, way in enumerate(steps) if way < best[0] and apart(float(way))), None)
        if free is not None:
            low, high = (0.0 if free == 0 else float(steps[free - 1])), float(steps[free])
            for _ in range(8):
                middle = 0.5 * (low + high)
                low, high = (low, middle) if apart(middle) else (middle, high)
            best = (high, axis) if high < best[0] else best
    if not np.isfinite(best[0]):
        return "no shift along an axis takes them apart"
    return f"the smallest shift along an axis that takes {moved} free is {best[0]:.4g} mm along {axis_text(best[1])}"


def axis_text(axis: Array) -> str:
    """Return a direction (d,) in words."""
    return "(" + ", ".join(f"{x + 0.0:.4g}" for x in axis) + ")"


def place_text(point: Array) -> str:
    """Return a point (d,), mm, in words."""
    return ", ".join(f"{x:.4g}" for x in point)
