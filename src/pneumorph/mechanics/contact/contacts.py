"""All contacts of a model at work: their sum for the solver, its steps, friction, and what is reported."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from pneumorph.errors import InputError
from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.facets import force_points, nodal_areas, split
from pneumorph.mechanics.contact.ipc import FacetContact, Surfaces
from pneumorph.mechanics.contact.obstacles import HalfSpace, Pipe, direction, encloses
from pneumorph.mechanics.contact.part import Entries, Part, Place, Touch
from pneumorph.mechanics.contact.smooth import SmoothContact
from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.mesh.topology import boundary

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Total:
    """All contacts together; see `Part`. coupling: one column (unknowns, contacts) for each."""

    energy: float
    gradient: Array
    entries: Entries
    coupling: Array


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Friction in an increment: where it began, how long it takes, and the normal forces that it goes by.

    start, ways: position (nodes, d) and ways of the obstacles (contacts,) before; seconds: time that passes.
    lags: one for each contact, None where there is no friction.
    """

    start: Array
    ways: Array
    seconds: float
    lags: Sequence[object]


class Contacts:
    """The contacts of a mesh; `ways` are the distances (contacts,), mm, that their obstacles have moved.

    shear: smallest shear modulus of the model, MPa. Raises InputError for unknown faces, surfaces that intersect at
    rest, a reach beyond a gap.
    """

    def __init__(self, mesh: Mesh, contacts: Sequence[Contact], shear: float):
        self.mesh, self.contacts = mesh, tuple(contacts)
        self.pairs = [_interaction(mesh, contact, shear) for contact in contacts]
        self._creep = [contact.creep or 1e-3 * mesh.size for contact in contacts]
        self._areas = [nodal_areas(mesh, _blocks(mesh, contact.faces)) for contact in contacts]

    def __bool__(self) -> bool:
        return bool(self.contacts)

    @property
    def friction(self) -> bool:
        """Whether there is friction anywhere."""
        return any(contact.friction for contact in self.contacts)

    def ways(self, values: Mapping[str, float]) -> Array:
        """Return how far the obstacles have moved at the values of a programme."""
        motions = [contact.motion for contact in self.contacts]
        return np.array([values.get(motion.name, 0.0) if motion else 0.0 for motion in motions])

    def rubbing(self, start: Array, ways: Array, seconds: float, at: tuple[Array, Array] | None = None) -> Rubbing:
        """Return the friction of an increment, by the normal forces at its start or at other positions and ways."""
        position, present = at or (start, ways)
        lags = [
            pair.lag(Place(position, float(way))) if contact.friction else None
            for pair, contact, way in zip(self.pairs, self.contacts, present, strict=True)
        ]
        return Rubbing(start, ways, seconds, lags)

    def evaluate(
        self, position: Array, ways: Array, rubbing: Rubbing | None, *, hessian: bool, exact: bool = True
    ) -> Total:
        """Return energy, forces and tangent at deformed nodes (nodes, d)."""
        parts = [self._parts(i, position, ways, rubbing, hessian, exact) for i in range(len(self.pairs))]
        every = [part for pair in parts for part in pair]
        entries = tuple(np.concatenate(item) for item in zip(*(part.entries for part in every), strict=True))
        coupling = np.column_stack([sum(part.coupling for part in pair) for pair in parts])
        gradient = np.sum([part.gradient for part in every], axis=0)
        return Total(sum(part.energy for part in every), gradient, entries, coupling)  # type: ignore[arg-type]

    def _parts(
        self, i: int, position: Array, ways: Array, rubbing: Rubbing | None, hessian: bool, exact: bool
    ) -> list[Part]:
        pair, place = self.pairs[i], Place(position, float(ways[i]))
        parts = [pair.normal(place, hessian=hessian, exact=exact)]
        if rubbing is not None and rubbing.lags[i] is not None:
            before = Place(rubbing.start, float(rubbing.ways[i]))
            transition = self._creep[i] * rubbing.seconds
            parts.append(pair.tangential(rubbing.lags[i], before, place, transition, hessian=hessian))
        return parts

    def limit(self, start: tuple[Array, Array], end: tuple[Array, Array]) -> float:
        """Return the share, 0 to 1, of a way from (positions, ways) to others on which nothing collides."""
        share = 1.0
        (before, old), (after, new) = start, end
        for i, pair in enumerate(self.pairs):
            way = old[i] + share * (new[i] - old[i])
            last = Place(before + share * (after - before), float(way))
            share *= pair.limit(Place(before, float(old[i])), last)
        return share

    def blocking(self, start: tuple[Array, Array], end: tuple[Array, Array]) -> list[str]:
        """Return the contacts that leave less than a hundredth of such a way: names and what they are between."""
        names = []
        for contact, pair, old, new in zip(self.contacts, self.pairs, start[1], end[1], strict=True):
            if pair.limit(Place(start[0], float(old)), Place(end[0], float(new))) < 0.01:
                names.append(_pair(contact))
        return names

    def tightest(self, touches: Mapping[str, Touch]) -> str:
        """Return a clause on the contact whose surfaces are closest, in terms of its reach; '' where none touches."""
        pairs = zip(self.contacts, self.pairs, strict=True)
        touching = [(touches[c.name].distance / p.reach, c) for c, p in pairs if c.name in touches]
        ratio, contact = min(touching, key=lambda item: item[0], default=(np.inf, None))
        if contact is None or not np.isfinite(ratio):
            return ""
        return f"; closest is contact {_pair(contact)}, {touches[contact.name].distance:.3g} mm apart"

    def energy(self, position: Array, ways: Array) -> float:
        """Return the energy stored in the barriers, mJ."""
        places = (Place(position, float(way)) for way in ways)
        return sum(pair.normal(at, hessian=False).energy for pair, at in zip(self.pairs, places, strict=True))

    def drives(self, touches: Mapping[str, Touch]) -> Array:
        """Return the force (contacts,), N, that moves each obstacle along its direction; 0 where there is no report."""
        forces = []
        for contact, pair in zip(self.contacts, self.pairs, strict=True):
            touch = touches.get(contact.name)
            forces.append(float(np.dot(touch.force, pair.along)) if touch else 0.0)
        return np.array(forces)

    def distance(self, position: Array, ways: Array) -> float:
        """Return the smallest distance of all, mm: infinite beyond reach, not positive where surfaces intersect."""
        places = (Place(position, float(way)) for way in ways)
        return min(pair.distance(place) for pair, place in zip(self.pairs, places, strict=True))

    def near(self, position: Array, ways: Array) -> Integers:
        """Return pairs of nodes (k, 2) that may soon be coupled."""
        places = (Place(position, float(way)) for way in ways)
        return np.concatenate([pair.near(place) for pair, place in zip(self.pairs, places, strict=True)])

    def slipped(self, position: Array, ways: Array, rubbing: Rubbing) -> float:
        """Return the energy that friction took in the increment, mJ: its forces times the slip."""
        total = 0.0
        moved = (position - rubbing.start).ravel()
        for i, pair in enumerate(self.pairs):
            for part in self._parts(i, position, ways, rubbing, False, True)[1:]:
                total += float(part.gradient @ moved) + float(part.push @ pair.along) * float(ways[i] - rubbing.ways[i])
        return total

    def touches(self, position: Array, ways: Array, rubbing: Rubbing | None) -> dict[str, Touch]:
        """Return what is reported of each contact."""
        result = {}
        d = self.mesh.dimension
        for i, (contact, pair) in enumerate(zip(self.contacts, self.pairs, strict=True)):
            normal, *tangential = self._parts(i, position, ways, rubbing, False, True)
            push = -normal.gradient.reshape(-1, d)
            rub = -tangential[0].gradient.reshape(-1, d) if tangential else np.zeros_like(push)
            left = self._areas[i] > 0.0
            by_face = {}
            for name in contact.faces:
                nodes = np.unique(np.concatenate([b.nodes.ravel() for b in self.mesh.face_blocks(name)]))
                nodes = nodes[left[nodes]]
                left[nodes] = False  # a node on the rim of two faces counts once
                by_face[name] = _numbers((push + rub)[nodes].sum(axis=0))
            own = self._areas[i] > 0.0
            area, pressure = self._bearing(i, Place(position, float(ways[i])), push)
            force, sideways = (push + rub)[own].sum(axis=0), rub[own].sum(axis=0)
            distance = pair.distance(Place(position, float(ways[i])))
            result[contact.name] = Touch(_numbers(force), _numbers(sideways), by_face, area, pressure, distance)
        return result

    def _bearing(self, i: int, place: Place, push: Array) -> tuple[float, float]:
        """Return the deformed area of the named faces within reach, mm2, and the largest pressure on it, MPa."""
        pair, own = self.pairs[i], self._areas[i] > 0.0
        blocks = _blocks(self.mesh, self.contacts[i].faces)
        if isinstance(pair, SmoothContact):
            return pair.bearing(place, force_points(self.mesh, blocks, place.position))
        areas = nodal_areas(self.mesh, blocks, place.position)[own]
        size = np.linalg.norm(push[own], axis=1)
        bearing = size > 1e-9 * float(size.max())
        return float(areas[bearing].sum()), float((size / areas).max())


def _pair(contact: Contact) -> str:
    return f"'{contact.name}' between {', '.join(contact.faces)} and {contact.other}"


def _numbers(values: Array) -> tuple[float, ...]:
    return tuple(float(value) for value in values)


def _blocks(mesh: Mesh, names: Sequence[str]) -> list[FaceBlock]:
    return [block for name in names for block in mesh.face_blocks(name)]


def _interaction(mesh: Mesh, contact: Contact, shear: float) -> SmoothContact | FacetContact:
    """Return the pair of surfaces of a contact, checked at rest."""
    owner, d = f"contact '{contact.name}'", mesh.dimension
    if mesh.space == "axisymmetric" and contact.motion and contact.motion.direction[:1] not in ((0,), (0.0,)):
        raise InputError(f"{owner}: with axial symmetry an obstacle moves along the axis, direction (0, 1)")
    motion = contact.motion
    along = direction(motion.direction, d, f"motion '{motion.name}'", "direction") if motion else np.zeros(d)
    stiffness = contact.stiffness or shear
    reach = contact.reach or 1e-3 * mesh.size
    blocks, against = _blocks(mesh, contact.faces), contact.against
    if isinstance(against, HalfSpace | Pipe):
        smooth = SmoothContact(force_points(mesh, blocks), against, along, reach, stiffness, contact.friction)
        gap, where = smooth.worst(Place(mesh.points))
        if gap <= 0.0:
            raise InputError(
                f"{owner}: {', '.join(contact.faces)} and {contact.other} intersect at ({_show(where)}) mm; "
                f"move them apart by {reach - gap:.4g} mm along {_axis(against.gap(where[None])[1][0])}"
            )
        return smooth
    rigid, rigid_facets = np.empty((0, d)), np.empty((0, d), dtype=np.int64)
    sides = None
    if isinstance(against, tuple):
        other = _blocks(mesh, against)
        sides = np.repeat([0, 1], [len(split(blocks)), len(split(other))])
        blocks = blocks + other
        shared = np.intersect1d(split(blocks[: len(blocks) - len(other)]), split(other))
        if len(shared):
            raise InputError(
                f"{owner}: {', '.join(contact.faces)} and {', '.join(against)} share nodes; they must be apart"
            )
    elif against is not None:
        rigid, rigid_facets = against.facets(d)
    surfaces = Surfaces(split(blocks), nodal_areas(mesh, blocks), sides, rigid, rigid_facets, along)
    pair = FacetContact(mesh.points, surfaces, reach, stiffness, contact.friction)
    _check_apart(_bodies(mesh, surfaces), mesh, contact)
    if against is None or sides is not None:
        gap = pair.distance(Place(mesh.points), 5.0 * reach)
        if against is None:  # where facets are large enough, the sides of a crease may meet, too
            finer = FacetContact(mesh.points, surfaces, reach, stiffness, contact.friction, rings=1)
            if finer.distance(Place(mesh.points), 5.0 * reach) >= gap:
                pair = finer
        if contact.reach is None:
            pair.reach = min(reach, gap / 5.0)
        elif gap <= reach and against is None:
            raise InputError(
                f"{owner}: reach = {reach:g} mm, allowed: less than the smallest gap at rest, {gap:.4g} mm"
            )
    return pair


def _bodies(mesh: Mesh, surfaces: Surfaces) -> FacetContact:
    """Return the contact of whole bodies: named faces may lie inside another body without crossing its named ones."""
    skin = split(boundary(mesh.blocks))
    sides = None
    if surfaces.sides is not None:
        label = _components(mesh)
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


def _components(mesh: Mesh) -> Integers:
    """Return the number of the body (nodes,) that each node belongs to."""
    ends = np.concatenate([np.stack([b.nodes[:, :-1].ravel(), b.nodes[:, 1:].ravel()], axis=1) for b in mesh.blocks])
    links = sparse.coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(mesh.points),) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _check_apart(pair: FacetContact, mesh: Mesh, contact: Contact) -> None:
    """Raise an InputError with the place, and the shift that helps, where surfaces intersect at rest."""
    where, surfaces, against = pair.intersection(Place(mesh.points)), pair.surfaces, contact.against
    if where is None and len(surfaces.rigid):
        label = _components(mesh)
        for body in np.unique(label[surfaces.soft]):
            inside = mesh.points[np.flatnonzero(label == body)[0]]
            if encloses(surfaces.rigid, surfaces.rigid_facets, inside):
                raise InputError(
                    f"contact '{contact.name}': the body with {', '.join(contact.faces)} lies inside the "
                    f"{contact.other}, at ({_show(inside)}) mm"
                )
    if where is None:
        return
    one = ", ".join(contact.faces)
    text = f"contact '{contact.name}': {one} and {contact.other} intersect at ({_show(where)}) mm"
    if against is None:
        raise InputError(f"{text}; the surface of the body must not cross itself")
    raise InputError(f"{text}; {_shift(pair, mesh)}")


def _shift(pair: FacetContact, mesh: Mesh) -> str:
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
    return f"the smallest shift along an axis that takes the faces free is {best[0]:.4g} mm along {_axis(best[1])}"


def _axis(axis: Array) -> str:
    return "(" + ", ".join(f"{x + 0.0:.4g}" for x in axis) + ")"


def _show(point: Array) -> str:
    return ", ".join(f"{x:.4g}" for x in point)
