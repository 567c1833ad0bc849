"""The [body.NAME] and [[contact]] sections: rigid bodies, and what may touch what."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, Strict, WithJsonSchema

from pneumorph.errors import InputError, NameNotFoundError, StudyError, unknown_name
from pneumorph.mechanics import Block, Contact, Cylinder, HalfSpace, Motion, Pipe, SurfaceFile
from pneumorph.mechanics.contact.obstacles import Obstacle
from pneumorph.studies.direction import Direction
from pneumorph.studies.importing import located
from pneumorph.studies.json_types import place_schema
from pneumorph.studies.section import Section, quantity

Length: Any = quantity("length")
Names = Annotated[tuple[str, ...], Strict(False)]
# two lengths in plane models
Place = Annotated[tuple[Length, ...], Strict(False), Field(min_length=2, max_length=3), WithJsonSchema(place_schema())]


class _BodySection(Section):
    """A rigid body.

    direction: makes the name of the body a target of the phases: how far it is moved along this direction, an axis with
        its sign or three numbers; left out, it stays where it is.
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


class BlockSection(_BodySection):
    """A block with its edges along the axes.

    lower: its corner with the smallest coordinates.
    upper: its corner with the largest coordinates.
    """

    shape: Literal["block"]
    lower: Place
    upper: Place
    direction: Direction | None = None


class CylinderSection(_BodySection):
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


class SurfaceSection(_BodySection):
    """The closed surface in an STL file, lengths in mm.

    file: name of the file, seen from the study file.
    shift: how far it is moved from where the file has it, before anything else.
    """

    shape: Literal["surface"]
    file: Annotated[str, BeforeValidator(located)]
    shift: Place | None = None
    direction: Direction | None = None


BODY_SECTIONS: dict[str, type[Section]] = {
    "half-space": HalfSpaceSection,
    "pipe": PipeSection,
    "block": BlockSection,
    "cylinder": CylinderSection,
    "surface": SurfaceSection,
}
BodySection: Any = Annotated[
    HalfSpaceSection | PipeSection | BlockSection | CylinderSection | SurfaceSection, Field(discriminator="shape")
]


class ContactSection(Section):
    """What may touch: named faces themselves and each other, a rigid body, or other faces.

    name: name in history and report; left out, contact_1 and so on.
    faces: faces of the actuator; a cavity's walls touch themselves in a contact of their own.
    body: name of a rigid body that they touch.
    against: names of other faces that they touch.
    friction: coefficient of Coulomb friction, 0 to 5.
    reach: distance below which surfaces push each other off; left out, a thousandth of the actuator's size, at most a
        fifth of the smallest gap that a surface has with itself or another.
    stiffness: pressure at which surfaces are at about three quarters of the reach; left out, the smallest shear modulus
        of the materials.
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


def bodies_of(sections: Mapping[str, Any], dimension: int) -> dict[str, Obstacle]:
    """Return the rigid bodies by name; raises InputError, naming it, for one without extent or without a surface.

    dimension: 3, or 2 for plane and axisymmetric models.
    """
    bodies = {}
    for name, section in sections.items():
        try:
            motion = None
            if section.direction is not None:
                motion = Motion(name, _flat(section.direction, dimension, "direction"))
            body = _SHAPES[section.shape](section, motion, dimension)
            # made once, so that what is wrong shows before anything is meshed
            if isinstance(body, HalfSpace | Pipe):
                body.gap(np.zeros((1, dimension)))
            else:
                body.facets(dimension)
            bodies[name] = body
        except InputError as error:
            raise type(error)(f"body.{name}: {error}") from error
    return bodies


def contacts_of(sections: tuple[ContactSection, ...], bodies: Mapping[str, Obstacle]) -> tuple[Contact, ...]:
    """Return the contacts; raises NameNotFoundError for an unknown body, StudyError for one that nothing touches."""
    contacts = []
    for number, item in enumerate(sections, 1):
        owner = f"contact[{number}]"
        if item.body is not None and item.against is not None:
            raise StudyError(f"{owner}: both body and against are given; expected one of them, or a contact for each")
        if item.body is not None and item.body not in bodies:
            raise NameNotFoundError(f"{owner}: " + unknown_name("body", item.body, bodies))
        against = bodies[item.body] if item.body is not None else item.against
        contacts.append(
            Contact(
                item.name or f"contact_{number}", item.faces, against, item.friction, reach=item.reach,
                stiffness=item.stiffness, creep=item.creep, body=item.body or "",
            )
        )  # fmt: skip
    for name in bodies:
        if name not in [item.body for item in sections]:
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
    "surface": lambda section, motion, dimension: SurfaceFile(section.file, section.shift or (), motion=motion),
}
