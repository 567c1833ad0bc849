"""Where a part of a study stands, as text with units in its section."""

from __future__ import annotations

from pneumorph.errors import InputError
from pneumorph.mesh.assembly import Placement, Turn
from pneumorph.studies.direction import Direction
from pneumorph.studies.section import Section, quantity
from pneumorph.studies.touching import Place


class TurnSection(Section):
    """A turn by the right-hand rule about an axis.

    axis: direction of the axis, an axis with its sign or three numbers; in plane models z.
    angle: by how much.
    about: a point on the axis; left out, the origin.
    """

    axis: Direction
    angle: quantity("angle")  # type: ignore[valid-type]
    about: Place = (0.0, 0.0, 0.0)


def placement_of(name: str, turns: tuple[TurnSection, ...], shift: tuple[float, ...]) -> Placement:
    """Return where a part stands; raises InputError, naming it, for an axis without direction."""
    try:
        made = tuple(Turn(item.axis, item.angle, _spatial(item.about)) for item in turns)
        return Placement(made, _spatial(shift))
    except InputError as error:
        raise type(error)(f"part.{name}: {error}") from error


def _spatial(place: tuple[float, ...]) -> tuple[float, ...]:
    return (*place, 0.0) if len(place) == 2 else place
