"""All contacts of a model at work: their sum for the solver, its steps, friction, and what is reported."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.mechanics.contact.apart import axis_text, check_apart, place_text, whole_bodies
from pneumorph.mechanics.contact.definition import Contact
from pneumorph.mechanics.contact.free_apart import check_free_apart
from pneumorph.mechanics.contact.free_body import Frame
from pneumorph.mechanics.contact.ipc import FacetContact, Surfaces
from pneumorph.mechanics.contact.obstacles import HalfSpace, Pipe, direction
from pneumorph.mechanics.contact.part import Entries, Part, Place, Touch
from pneumorph.mechanics.contact.smooth import SmoothContact
from pneumorph.mechanics.contact.vertices import Vertices
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_FINER = 0.2  # share of a default reach for which the rest of it is given up, to keep creases from crossing


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

    shear: smallest shear modulus of the model, MPa; frames: its free bodies. Raises InputError for unknown faces,
    surfaces that intersect at rest, a reach beyond a gap, a free body in contact with itself.
    """

    def __init__(self, mesh: Mesh, contacts: Sequence[Contact], shear: float, frames: Sequence[Frame] = ()):
        self.mesh, self.contacts = mesh, tuple(contacts)
        self.vertices = Vertices(mesh, frames)
        self.pairs = [_interaction(self.vertices, contact, shear) for contact in contacts]
        self._creep = [contact.creep or 1e-3 * mesh.size for contact in contacts]

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

    def crossing(self, position: Array, ways: Array) -> str | None:
        """Return which surfaces intersect, and where, as a clause; None where all are apart."""
        for contact, pair, way in zip(self.contacts, self.pairs, ways, strict=True):
            where = pair.intersection(Place(position, float(way)))
            if where is not None:
                return f"surfaces of contact {_pair(contact)} intersect at ({place_text(where)}) mm"
        return None

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
            left = np.ones(len(push), dtype=bool)
            by_face = {}
            for name in (*contact.faces, *(body.name for body in self.vertices.bodies(contact.other_faces))):
                nodes = self.mesh.face_nodes(name)
                nodes = nodes[left[nodes]]
                left[nodes] = False  # a node on the rim of two faces counts once
                by_face[name] = _numbers((push + rub)[nodes].sum(axis=0))
            own = self.vertices.nodes(contact.faces)
            area, pressure = self._bearing(i, Place(position, float(ways[i])), push)
            force, sideways = (push + rub)[own].sum(axis=0), rub[own].sum(axis=0)
            distance = pair.distance(Place(position, float(ways[i])))
            result[contact.name] = Touch(_numbers(force), _numbers(sideways), by_face, area, pressure, distance)
        return result

    def _bearing(self, i: int, place: Place, push: Array) -> tuple[float, float]:
        """Return the deformed area of the named faces within reach, mm2, and the largest pressure on it, MPa."""
        pair, names, mesh = self.pairs[i], self.contacts[i].faces, self.mesh
        found = self._bodies_bearing(pair, self.vertices.bodies(names), place)
        faces = [name for name in names if name in mesh.faces]
        if faces and isinstance(pair, SmoothContact):
            found.append(pair.bearing(place, self.vertices.force_points(faces, place.position)))
        elif faces:
            areas = self.vertices.areas(faces, place.position)[: len(mesh.points)]
            own = np.flatnonzero(areas)
            size = np.linalg.norm(push[own], axis=1)
            bearing = size > 1e-9 * float(size.max())
            found.append((float(areas[own][bearing].sum()), float((size / areas[own]).max())))
        return sum(area for area, _ in found), max(pressure for _, pressure in found)

    def _bodies_bearing(
        self, pair: SmoothContact | FacetContact, bodies: Sequence[Frame], place: Place
    ) -> list[tuple[float, float]]:
        if not bodies:
            return []
        if isinstance(pair, SmoothContact):  # its last groups are those of the bodies
            forces = pair.pressing(place)[-len(bodies) :]
        else:
            sizes = np.zeros(self.vertices.count)
            sizes[pair.nodes] = np.linalg.norm(pair.forces(place), axis=1)
            forces = [sizes[self.vertices.numbers(body.name)] for body in bodies]
        return [self.vertices.bearing(body, force) for body, force in zip(bodies, forces, strict=True)]


def _pair(contact: Contact) -> str:
    return f"'{contact.name}' between {', '.join(contact.faces)} and {contact.other}"


def _numbers(values: Array) -> tuple[float, ...]:
    return tuple(float(value) for value in values)


def _way_out(pair: SmoothContact, position: Array) -> str:
    """Return in words the shift that takes a surface at nodes (nodes, d) out of its obstacle.

    The deepest point is moved out along its normal until none is left: from a plane that is the smallest shift, in a
    pipe, whose inside is convex, one near it.
    """
    shift = np.zeros(position.shape[1])
    for _ in range(200):
        gap, where = pair.worst(Place(position + shift))
        if gap > 0.0:
            size = float(np.linalg.norm(shift))
            return f"move them apart by {size:.4g} mm along {axis_text(shift / size)}"
        shift = shift + (pair.reach - gap) * pair.obstacle.gap(where[None])[1][0]
    return "no shift takes them apart"


def _interaction(vertices: Vertices, contact: Contact, shear: float) -> SmoothContact | FacetContact:
    """Return the pair of surfaces of a contact, checked at rest."""
    mesh = vertices.mesh
    owner, d = f"contact '{contact.name}'", mesh.dimension
    if mesh.space == "axisymmetric" and contact.motion and contact.motion.direction[:1] not in ((0,), (0.0,)):
        raise InputError(f"{owner}: with axial symmetry an obstacle moves along the axis, direction (0, 1)")
    motion = contact.motion
    along = direction(motion.direction, d, f"motion '{motion.name}'", "direction") if motion else np.zeros(d)
    stiffness = contact.stiffness or min(shear, vertices.resting((*contact.faces, *contact.other_faces)))
    reach = contact.reach or 1e-3 * mesh.size
    against, free = contact.against, vertices.bodies((*contact.faces, *contact.other_faces))
    if free and against is None:
        raise InputError(f"{owner}: a free body does not touch itself; give what '{free[0].name}' may touch")
    if isinstance(against, HalfSpace | Pipe):
        smooth = SmoothContact(vertices.force_points(contact.faces), against, along, reach, stiffness, contact.friction)
        gap, where = smooth.worst(Place(mesh.points))
        if gap <= 0.0:
            raise InputError(
                f"{owner}: {', '.join(contact.faces)} and {contact.other} intersect at ({place_text(where)}) mm; "
                f"{_way_out(smooth, mesh.points)}"
            )
        return smooth
    rigid, rigid_facets = np.empty((0, d)), np.empty((0, d), dtype=np.int64)
    sides = None
    soft, areas = vertices.facets(contact.faces), vertices.areas(contact.faces)
    if isinstance(against, tuple):
        other = vertices.facets(against)
        sides = np.repeat([0, 1], [len(soft), len(other)])
        shared = np.intersect1d(soft, other)
        soft, areas = np.concatenate([soft, other]), vertices.areas((*contact.faces, *against))
        if len(shared):
            raise InputError(
                f"{owner}: {', '.join(contact.faces)} and {', '.join(against)} share nodes; they must be apart"
            )
    elif against is not None:
        rigid, rigid_facets = against.facets(d)
    riders = vertices.carried(np.unique(soft))
    surfaces = Surfaces(soft, areas, sides, rigid, rigid_facets, along, riders)
    pair = FacetContact(mesh.points, surfaces, reach, stiffness, contact.friction)
    if free:
        check_free_apart(vertices, surfaces, contact)
    else:
        check_apart(whole_bodies(mesh, surfaces), mesh, contact)
    if against is None or sides is not None:
        gap = pair.distance(Place(mesh.points), 5.0 * reach)
        if against is None:  # unless facets are too small for it, the sides of a crease are kept apart, too
            finer = FacetContact(mesh.points, surfaces, reach, stiffness, contact.friction, rings=1)
            close = finer.distance(Place(mesh.points), 5.0 * reach)
            if close >= min(gap, 2.0 * reach if contact.reach else _FINER * min(gap, 5.0 * reach)):
                pair, gap = finer, close
        if contact.reach is None:
            pair.reach = min(reach, gap / 5.0)
        elif gap <= reach and against is None:
            raise InputError(
                f"{owner}: reach = {reach:g} mm, allowed: less than the smallest gap at rest, {gap:.4g} mm"
            )
    return pair
