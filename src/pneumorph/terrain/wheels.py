"""Wheels of one radius: a plain disc, and one to four paddles, straight or curved."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

from pneumorph.errors import InputError
from pneumorph.units import show

MOST_PADDLES = 4
_PIECES = 4  # boxes of a curved paddle


@dataclass(frozen=True)
class Box:
    """A box in a wheel: centre (x forward, z up), sizes along its own axes, turned by `angle` from z towards x."""

    x: float
    z: float
    angle: float
    thickness: float
    width: float
    length: float


@dataclass(frozen=True)
class Wheel:
    """A wheel about the axis y that turns its top towards +x; no paddle is a plain disc. Lengths in mm.

    The outermost edge of a paddle runs on the circle of `radius`. Curved paddles are arcs of a circle that turn by
    `arc` (rad) from the axle to the tip and trail: the convex side meets the ground first.

    Raises InputError for dimensions that are not positive, a hub or paddle thickness that is not below the radius,
    more than four paddles, or an arc outside 0 to 180 degrees.
    """

    paddles: int
    curved: bool = False
    radius: float = 140.0
    width: float = 40.0
    thickness: float = 8.0
    hub_radius: float = 20.0
    arc: float = pi / 2.0

    def __post_init__(self) -> None:
        if not 0 <= self.paddles <= MOST_PADDLES:
            raise InputError(f"wheel: paddles = {self.paddles}, expected 0 (a plain disc) to {MOST_PADDLES}")
        if self.curved and self.paddles == 0:
            raise InputError("wheel: curved = True with paddles = 0, expected at least one paddle to curve")
        for name in ("radius", "width", "thickness", "hub_radius"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise InputError(f"wheel: {name} = {show(getattr(self, name), 'length')}, expected more than 0")
        for name in ("thickness", "hub_radius"):
            if getattr(self, name) >= self.radius:
                raise InputError(
                    f"wheel: {name} = {show(getattr(self, name), 'length')}, expected less than the radius, "
                    f"{show(self.radius, 'length')}"
                )
        if not 0.0 < self.arc <= pi:
            raise InputError(f"wheel: arc = {show(self.arc, 'angle')}, expected more than 0 and at most 180 deg")

    @property
    def name(self) -> str:
        """'plain', or such as 'curved-3'."""
        return f"{'curved' if self.curved else 'straight'}-{self.paddles}" if self.paddles else "plain"

    @property
    def boxes(self) -> tuple[Box, ...]:
        """The boxes of all paddles; the first paddle points down when the wheel has not turned."""
        return tuple(box for i in range(self.paddles) for box in self._paddle(pi + 2.0 * pi * i / self.paddles))

    def _paddle(self, towards: float) -> list[Box]:
        """Return the boxes of the paddle whose tip lies at an angle, from z towards x."""
        half = 0.5 * self.thickness
        # the far corners of the last box, not its middle, lie on the radius
        end = (self.radius**2 - half**2) ** 0.5
        if not self.curved:
            return [Box(0.5 * end * sin(towards), 0.5 * end * cos(towards), towards, self.thickness, self.width, end)]
        boxes, (x, z) = [], (0.0, 0.0)
        tilt = 0.5 * self.arc * (1.0 - 1.0 / _PIECES)  # of the last piece against the chord
        # chord c of the arc with |c e + half n| = radius for the outer corner of the tilted last piece
        chord = -half * sin(tilt) + (self.radius**2 - (half * cos(tilt)) ** 2) ** 0.5
        piece = chord * sin(0.5 * self.arc / _PIECES) / sin(0.5 * self.arc)
        for i in range(_PIECES):
            angle = towards + 0.5 * self.arc - self.arc * (i + 0.5) / _PIECES
            step = (piece * sin(angle), piece * cos(angle))
            boxes.append(Box(x + 0.5 * step[0], z + 0.5 * step[1], angle, self.thickness, self.width, piece))
            x, z = x + step[0], z + step[1]
        return boxes


def all_wheels() -> tuple[Wheel, ...]:
    """Return the nine wheels of the study: one to four paddles, straight and curved, and the plain one."""
    paddled = [Wheel(n, curved) for curved in (False, True) for n in range(1, MOST_PADDLES + 1)]
    return (*paddled, Wheel(0))
