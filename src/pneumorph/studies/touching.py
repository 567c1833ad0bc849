"""The [body.NAME] and [[contact]] sections: rigid bodies, moved or free with a mass, and what may touch what."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, Strict, WithJsonSchema

from pneumorph.errors import InputError, NameNotFoundError, StudyError, unknown_name
from pneumorph.mechanics import Block, Contact, Cylinder, FreeBody, HalfSpace, Motion, Pipe, Revolved, SurfaceFile
from pneumorph.mechanics.contact.free_body import moments
from pneumorph.mechanics.contact.obstacles import Obstacle
from pneumorph.studies.direction import Direction
from pneumorph.studies.importing import located
from pneumorph.studies.json_types import place_schema
from pneumorph.studies.section import Section, quantity

Length: Any = quantity("length")
Mass: Any = quantity("mass")
Density: Any = quantity("density")
Names = Annotated[tuple[str, ...], Strict(False)]
# two lengths in plane models
Place = Annotated[tuple[Length, ...], Strict(False), Field(min_length=2, max_length=3), WithJsonSchema(place_schema())]
# distance from an axis, and height along it
ProfilePoint = Annotated[
    tuple[Length, ...], Strict(False), Field(min_length=2, max_length=2), WithJsonSchema(place_schema(2))
]


class _BodySection(Section):
    """A rigid body.

    direction: makes the name of the body a target of the phases: how far it is moved along this direction, an axis with
        its sign or three numbers; left out, it stays where it is.
    """


class _ClosedSection(_BodySection):
    """A rigid body with a closed surface, which may have a mass of its own.

    mass: makes it a free body, which moves by its weight, contact, and loads and supports on its name; contacts name it
        as their body, or among faces. It needs gravity, and phases with inertia. In plane models it is that of the
        1 mm that is modelled.
    density: in place of the mass.
    """


class HalfSpaceSection(_BodySection):
    """The ground or a wall: all behind a plane.

    point: a point of the plane.
    normal: where the soft body is, an axis with its sign or three numbers.
    """

    shape: Literal["half-space"]
    point: Place
    normal: Direction
    direction: Direction | None = None


class PipeSection(_BodySection):
    """A pipe around the soft body: all outside a round bore.

    point: a point of the pipe's axis.
    radius: radius of the bore.
    axis: direction of the pipe, an axis or three numbers.
    """

    shape: Literal["pipe"]
    point: Place
    radius: Length
    axis: Direction = (1.0, 0.0, 0.0)
    direction: Direction | None = None


class BlockSection(_ClosedSection):
    """A block with its edges along the axes.

    lower: its corner with the smallest coordinates.
    upper: its corner with the largest coordinates.
    """

    shape: Literal["block"]
    lower: Place
    upper: Place
    direction: Direction | None = None
    mass: Mass | None = None
    density: Density | None = None


class CylinderSection(_ClosedSection):
    """A round bar.

    start: middle of one end; in plane models of the disc.
    end: middle of the other end; left out in plane models.
    radius: its radius.
    segments: flats that stand for its round.
    """

    shape: Literal["cylinder"]
    start: Place
    end: Place | None = None
    radius: Length
    segments: int = 64
    direction: Direction | None = None
    mass: Mass | None = None
    density: Density | None = None


class RevolvedSection(_ClosedSection):
    """What a line makes that is turned about an axis: a cup, a ball.

    profile: points of the line from the axis to the axis, each with its distance from the axis and its height along it.
    point: where on the axis the height is 0.
    axis: direction of growing height, an axis with its sign or three numbers.
    segments: flats that stand for its round.
    """

    shape: Literal["revolved"]
    profile: Annotated[tuple[ProfilePoint, ...], Strict(False)]
    point: Place = (0.0, 0.0, 0.0)
    axis: Direction = (0.0, 0.0, 1.0)
    segments: int = 48
    direction: Direction | None = None
    mass: Mass | None = None
    density: Density | None = None


class SurfaceSection(_ClosedSection):
    """The closed surface in an STL file, lengths in mm.

    file: name of the file, seen from the study file.
    shift: how far it is moved from where the file has it, before anything else.
    """

    shape: Literal["surface"]
    file: Annotated[str, BeforeValidator(located)]
    shift: Place | None = None
    direction: Direction | None = None
    mass: Mass | None = None
    density: Density | None = None


BODY_SECTIONS: dict[str, type[Section]] = {
    "half-space": HalfSpaceSection,
    "pipe": PipeSection,
    "block": BlockSection,
    "cylinder": CylinderSection,
    "revolved": RevolvedSection,
    "surface": SurfaceSection,
}
BodySection: Any = Annotated[
    HalfSpaceSection | PipeSection | BlockSection | CylinderSection | RevolvedSection | SurfaceSection,
    Field(discriminator="shape"),
]


class ContactSection(Section):
    """What may touch: named faces themselves and each other, a rigid body, or other faces.

    name: name in history and report; left out, contact_1 and so on.
    faces: faces of the actuator, or names of free bodies; a cavity's walls touch themselves in a contact of their own.
    body: name of a rigid body that they touch.
    against: names of other faces or free bodies that they touch.
    friction: coefficient of Coulomb friction, 0 to 5.
    reach: distance below which surfaces push each other off; left out, a thousandth of the actuator's size, at most a
        fifth of the smallest gap that a surface has with itself or another.
    stiffness: pressure at which surfaces are at about three quarters of the reach; left out, the smallest shear modulus
        of the materials; between rigid bodies, at most what suits the weight of a free one.
    creep: speed below which friction holds; left out, a thousandth of the actuator's size per second.
    """

    name: str | None = None
    faces: Names
    body: str | None = None
    against: Names | None = None
    friction: float = 0.0
    reach: Length | None = None
    stiffness: quantity("stress") | None = None  # type: ignore[valid-type]
    creep: quantity("speed") | None = None  # type: ignore[valid-type]


def bodies_of(sections: Mapping[str, Any], dimension: int) -> dict[str, Obstacle | FreeBody]:
    """Return the rigid bodies by name; raises InputError, naming it, for one without extent or without a surface.

    Those with a mass are free; raises StudyError for one that is moved as well.

    dimension: 3, or 2 for plane and axisymmetric models.
    """
    bodies: dict[str, Obstacle | FreeBody] = {}
    for name, section in sections.items():
        try:
            motion = None
            if section.direction is not None:
                motion = Motion(name, _flat(section.direction, dimension, "direction"))
            body = _SHAPES[section.shape](section, motion, dimension)
            # made once, so that what is wrong shows before anything is meshed
            if isinstance(body, HalfSpace | Pipe):
                body.gap(np.zeros((1, dimension)))
                bodies[name] = body
                continue
            surface = body.facets(dimension)
            bodies[name] = body
            if is_free(section):
                if motion is not None:
                    raise StudyError("both direction and mass are given: it is moved, or it moves by itself")
                bodies[name] = FreeBody(name, body, mass=section.mass, density=section.density)
                moments(*surface, f"free body '{name}'")
        except InputError as error:
            raise type(error)(f"body.{name}: {error}") from error
    return bodies


def is_free(section: Any) -> bool:
    """Return whether a [body.NAME] section is that of a free body: whether it has a mass or a density."""
    return any(getattr(section, key, None) is not None for key in ("mass", "density"))


def check_free(sections: Mapping[str, Any], gravity: object, phases: Iterable[Any], held: Collection[str]) -> None:
    """Raise StudyError for a free body without gravity, or that nothing holds in a phase without inertia.

    gravity: the section, or None; held: names of clamped faces and bodies.
    """
    for name in (name for name, section in sections.items() if is_free(section)):
        if gravity is None:
            raise StudyError(
                f'body.{name}: a mass needs [gravity]; where there shall be none, give it with acceleration = "0 m/s²"'
            )
        for phase in phases:
            if phase.inertia is None and name not in held:
                raise StudyError(
                    f"phase '{phase.name}': nothing holds the free body '{name}' without inertia; give the phase a "
                    'duration and inertia = "quasi-static"'
                )


def contacts_of(sections: tuple[ContactSection, ...], bodies: Mapping[str, Obstacle | FreeBody]) -> tuple[Contact, ...]:
    """Return the contacts; raises NameNotFoundError for an unknown body, StudyError for one that nothing touches."""
    contacts = []
    for number, item in enumerate(sections, 1):
        owner = f"contact[{number}]"
        if item.body is not None and item.against is not None:
            raise StudyError(f"{owner}: both body and against are given; expected one of them, or a contact for each")
        if item.body is not None and item.body not in bodies:
            raise NameNotFoundError(f"{owner}: " + unknown_name("body", item.body, bodies))
        against: Obstacle | tuple[str, ...] | None = item.against
        other = bodies[item.body] if item.body is not None else None
        if isinstance(other, FreeBody):
            against = (other.name,)
        elif other is not None:
            against = other
        contacts.append(
            Contact(
                item.name or f"contact_{number}", item.faces, against, item.friction, reach=item.reach,
                stiffness=item.stiffness, creep=item.creep, body="" if isinstance(other, FreeBody) else item.body or "",
            )
        )  # fmt: skip
    used = {item.body for item in sections}
    named = {face for item in sections for face in (*item.faces, *(item.against or ()))}
    for name, body in bodies.items():
        if name not in used and not (isinstance(body, FreeBody) and name in named):
            raise StudyError(f'body.{name}: no contact names it; add [[contact]] with faces and body = "{name}"')
    return tuple(contacts)


def _flat(direction: tuple[float, ...], dimension: int, what: str) -> tuple[float, ...]:
    """Return a direction with as many numbers as the model has dimensions."""
    if any(direction[dimension:]):
        raise InputError(f"{what} = {direction} leaves the plane of the model, x, y")
    return tuple(direction[:dimension])


def _half_space(section: Any, motion: Motion | None, dimension: int) -> HalfSpace:
    return HalfSpace(section.point, _flat(section.normal, dimension, "normal"), motion=motion)


def _pipe(section: Any, motion: Motion | None, dimension: int) -> Pipe:
    return Pipe(section.point, section.radius, section.axis if dimension == 3 else (), motion=motion)


def _cylinder(section: Any, motion: Motion | None, dimension: int) -> Cylinder:
    if section.end is None and dimension == 3:
        raise StudyError("end: missing")
    return Cylinder(section.start, section.end or section.start, section.radius, section.segments, motion=motion)


_SHAPES: dict[str, Callable[[Any, Motion | None, int], Obstacle]] = {
    "half-space": _half_space,
    "pipe": _pipe,
    "block": lambda section, motion, dimension: Block(section.lower, section.upper, motion=motion),
    "cylinder": _cylinder,
    "revolved": lambda section, motion, dimension: Revolved(
        section.profile, section.point, section.axis, section.segments, motion=motion
    ),
    "surface": lambda section, motion, dimension: SurfaceFile(section.file, section.shift or (), motion=motion),
}
