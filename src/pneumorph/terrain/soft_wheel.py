"""The soft wheel: reduced limbs around a hub, as data and as bodies, hinges and springs in MJCF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import atan2, cos, hypot, pi, sin
from xml.etree import ElementTree as xml

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.terrain.limb import ReducedLimb
from pneumorph.terrain.si import KILOGRAM, METRE, NEWTON_METRE, text
from pneumorph.units import show

Array = NDArray[np.float64]

CONTACT = 0.005  # s, time constant of contacts with limbs: MuJoCo's default of 20 ms lets light tips sink in by 4 mm
_AROUND = 24  # points around a foot
_AXLE = text(0.5**0.5, 0.5**0.5, 0.0, 0.0)  # a cylinder's axis from z to y
SOFT, HUB = "0.84 0.37 0.0 1", "0.25 0.25 0.25 1"


@dataclass(frozen=True, eq=False)
class SoftWheel:
    """Equal limbs at equal angles around a hub; mm, tonne, s.

    limb:       the reduced limb; its `mount` places the first limb in the wheel's plane, whose axes are x forward and y
                downwards, so that positive angles roll forward; `mirrored` turns the wheel's other side to the viewer.
    limb_share: share of the wheel's mass that its limbs have; the rest is the hub's.
    relaxation: damping of a hinge over its stiffness, s.
    hinge_time: each hinge has an inertia of its own of its largest stiffness times this time squared, s, so that none
                swings faster than 1 / hinge_time however light its link; time steps must not be longer.

    Assumed: number of limbs apart, all numbers. Raises InputError for numbers out of range.
    """

    limb: ReducedLimb
    limbs: int = 4
    mirrored: bool = False
    hub_radius: float = 20.0
    limb_share: float = 0.8
    relaxation: float = 0.003
    hinge_time: float = 0.001

    def __post_init__(self) -> None:
        if not 1 <= self.limbs <= 12:
            raise InputError(f"soft wheel: limbs = {self.limbs}, expected 1 to 12")
        if not 0.0 < self.hub_radius < self.radius:
            raise InputError(
                f"soft wheel: hub_radius = {show(self.hub_radius, 'length')}, expected more than 0 and less than the "
                f"radius of the wheel, {show(self.radius, 'length')}"
            )
        if not 0.0 < self.limb_share < 1.0:
            raise InputError(f"soft wheel: limb_share = {self.limb_share:g}, expected between 0 and 1")
        for name in ("relaxation", "hinge_time"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise InputError(f"soft wheel: {name} = {show(getattr(self, name), 'time')}, expected more than 0")

    @property
    def name(self) -> str:
        """Such as 'soft-4'."""
        return f"soft-{self.limbs}"

    @property
    def width(self) -> float:
        """Extent along the axle, mm."""
        return self.limb.width

    @cached_property
    def radius(self) -> float:
        """The largest distance of its surface from the axle over the fitted pressures, mm."""
        return 0.5 * max(self.height(p) for p in np.linspace(*self.limb.pressures, 21))

    def height(self, pressure: float) -> float:
        """Return the diameter, mm, of the circle around the unloaded wheel with one pressure in all limbs.

        Raises InputError for a pressure outside the fitted range.
        """
        return 2.0 * float(np.linalg.norm(self.outline(pressure), axis=1).max())

    def outline(self, pressure: float, force: Sequence[float] = (0.0, 0.0)) -> Array:
        """Return corners of the first limb's boxes and points around its foot in the wheel's axes, (points, 2), mm.

        force: at the load point, in the limb's axes, N. Raises InputError as `ReducedLimb.equilibrium`.
        """
        limb = self.limb
        turn = np.concatenate([[0.0], np.cumsum(limb.equilibrium(pressure, force))])
        hinges, _ = limb.shape(np.diff(turn))
        starts = np.vstack([np.zeros(2), hinges])
        first = np.vstack([np.zeros(2), limb.hinges])
        corners = [
            starts[box.link] + (corner - first[box.link]) @ _rotation(turn[box.link]).T
            for box in link_boxes(limb)
            for corner in box.corners
        ]
        if limb.foot:
            x, y = foot_axis(limb)
            around = np.linspace(0.0, 2.0 * pi, _AROUND, endpoint=False)
            circle = np.array([x, y]) + limb.foot * np.stack([np.cos(around), np.sin(around)], axis=1)
            corners.extend(starts[-1] + (circle - first[-1]) @ _rotation(turn[-1]).T)
        x, y, angle = limb.mount
        return np.asarray(np.array([x, y]) + np.array(corners) @ _rotation(angle).T)


@dataclass(frozen=True)
class LinkBox:
    """A box of a link (0: the clamped one) in the limb's axes, unloaded: centre, angle of its length from x towards y,
    length, thickness."""

    link: int
    x: float
    y: float
    angle: float
    length: float
    thickness: float

    @property
    def corners(self) -> Array:
        """(4, 2), mm."""
        half = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [self.length, self.thickness]
        return np.asarray([self.x, self.y] + half @ _rotation(self.angle).T)


def link_boxes(limb: ReducedLimb) -> list[LinkBox]:
    """Return a box for each of the n + 1 links, the clamped one first."""
    ends, boxes = np.vstack([np.zeros(2), limb.hinges, limb.end]), []
    below, above = limb.thickness
    for number, (start, end) in enumerate(pairwise(ends)):
        along = end - start
        angle, length = atan2(along[1], along[0]), hypot(*along)
        x, y = 0.5 * (start + end) + 0.5 * (above - below) * np.array([-sin(angle), cos(angle)])
        boxes.append(LinkBox(number, float(x), float(y), angle, length, below + above))
    return boxes


def foot_axis(limb: ReducedLimb) -> tuple[float, float]:
    """Return the middle of the foot, unloaded, in the limb's axes: a cylinder that touches the ground at the load point
    where the last link lies level."""
    along = limb.end - limb.hinges[-1]
    outwards = np.array([-along[1], along[0]]) / hypot(*along)
    x, y = limb.load_point - limb.foot * outwards
    return float(x), float(y)


def add_soft_wheel(body: xml.Element, wheel: SoftWheel, mass: float, prefix: str) -> None:
    """Add hub and limbs to the MJCF body of a wheel at zero pressure; mass: of the whole wheel, tonne.

    The hinges are named `prefix`.limb.hinge, both from 1.
    """
    hub = (1.0 - wheel.limb_share) * mass * KILOGRAM
    xml.SubElement(
        body, "geom", type="cylinder", size=text(wheel.hub_radius * METRE, 0.5 * wheel.width * METRE),
        quat=_AXLE, mass=text(hub), rgba=HUB,
    )  # fmt: skip
    for number in range(wheel.limbs):
        add_limb(
            body,
            wheel,
            wheel.limb_share * mass / wheel.limbs,
            2.0 * pi * number / wheel.limbs,
            f"{prefix}.{number + 1}",
        )


def add_limb(body: xml.Element, wheel: SoftWheel, mass: float, turned: float, prefix: str) -> None:
    """Add one limb, turned about the axle, as a chain of bodies; the last one has the site `prefix`.load."""
    limb, side = wheel.limb, -1.0 if wheel.mirrored else 1.0
    x, y, angle = limb.mount
    c, s = cos(turned), sin(turned)
    y, angle = side * y, side * angle
    link = xml.SubElement(
        body, "body", name=prefix, pos=_place(c * x - s * y, s * x + c * y), quat=_quaternion(angle + turned)
    )
    boxes = link_boxes(limb)
    volume = sum(box.length * box.thickness for box in boxes)
    stiffness, rest = limb.stiffness(0.0), limb.rest_angles(0.0)
    starts = np.vstack([np.zeros(2), limb.hinges])
    for number, start in enumerate(starts):
        if number > 0:
            before = starts[number - 1]
            link = xml.SubElement(
                link, "body", name=f"{prefix}.{number}", pos=_place(start[0] - before[0], side * (start[1] - before[1]))
            )
            spring = stiffness[number - 1] * NEWTON_METRE
            xml.SubElement(
                link, "joint", name=f"{prefix}.{number}", type="hinge", stiffness=text(spring),
                springref=text(side * rest[number - 1]), damping=text(wheel.relaxation * spring),
                armature=text(wheel.hinge_time**2 * NEWTON_METRE * (stiffness + limb.stop_stiffness)[number - 1]),
            )  # fmt: skip
        for box in boxes:
            if box.link == number:
                half = (0.5 * box.length, 0.5 * limb.width, 0.5 * box.thickness)
                share = box.length * box.thickness / volume
                xml.SubElement(
                    link, "geom", type="box", size=text(*(v * METRE for v in half)), mass=text(mass * KILOGRAM * share),
                    pos=_place(box.x - start[0], side * (box.y - start[1])), quat=_quaternion(side * box.angle),
                    rgba=SOFT, solref=text(CONTACT, 1.0), priority="1",
                )  # fmt: skip
    if limb.foot:
        x, y = np.array(foot_axis(limb)) - starts[-1]
        xml.SubElement(
            link, "geom", type="cylinder", size=text(limb.foot * METRE, 0.5 * limb.width * METRE), quat=_AXLE,
            mass="0", pos=_place(x, side * y), rgba=SOFT, solref=text(CONTACT, 1.0), priority="1",
        )  # fmt: skip
    point = limb.load_point - starts[-1]
    xml.SubElement(link, "site", name=f"{prefix}.load", pos=_place(point[0], side * point[1]), size="0.002")


def _rotation(angle: float) -> Array:
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


def _place(x: float, y: float) -> str:
    """Return a place of the wheel's plane, x forward and y downwards in mm, as MJCF's x, y, z."""
    return text(x * METRE, 0.0, -y * METRE)


def _quaternion(angle: float) -> str:
    """Return a turn from x towards y of the wheel's plane, which is one about MJCF's y."""
    return text(cos(0.5 * angle), 0.0, sin(0.5 * angle), 0.0)
