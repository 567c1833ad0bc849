"""Curved limb of a soft wheel: trapezoidal pleats inside a curved strain-limiting base, and a foot on the rim."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres, whole_number

Point = tuple[float, float]


@dataclass(frozen=True)
class SoftLimb(Actuator):
    """A limb that is most curved at rest and straightens when it is inflated; lengths in mm.

    The outside of the base (domain "base") is an arc of radius R in the xz plane that leaves the origin along +x and
    turns to -z. The pleats (domain "body") stand inside the arc, so that pressure turns the tip towards +z. The clamp
    lies at x = 0, the tip is the plane end face; the foot is the sole of a pad on the outside of the arc at the tip.
    The axle of the wheel is parallel to y through (-hub_radius, 0, 0). `half` keeps y >= 0, cut at "symmetry_y".

    Source: 'Soft and Steady Wins the Race' (Pans, Chen, Jovanova), which gives the heights of the wheel (230 mm
    neutral, 280 mm inflated) and the trapezoidal form but no dimension of the limb: all are assumed.
    Raises GeometryError.
    """

    chambers: int = whole_number(6, "N", "pleats with an air chamber each")
    length: float = millimetres(125.0, "L", "length of the outer arc from clamp to tip")
    radius: float = millimetres(54.5, "R", "radius of the outer arc")
    hub_radius: float = millimetres(25.0, "rh", "distance of the clamp from the axle")
    depth: float = millimetres(42.0, "d", "whole depth, along the axle")
    base: float = millimetres(5.0, "b", "thickness of the strain-limiting base")
    chamber_height: float = millimetres(14.0, "h", "height of the air chamber above the base")
    chamber_foot: float = millimetres(8.0, "x1", "width of the air chamber at the base")
    chamber_top: float = millimetres(5.0, "x2", "width of the air chamber at its top")
    wall: float = millimetres(3.0, "t", "wall between a chamber and the gap")
    side_wall: float = millimetres(3.0, "w", "wall beside a chamber")
    top_wall: float = millimetres(3.0, "ht", "wall on top of a chamber")
    airway_width: float = millimetres(8.0, "wa", "width of the airway")
    airway_height: float = millimetres(3.0, "ha", "height of the airway above the base")
    airway_roof: float = millimetres(4.0, "hr", "wall between the airway and the gap")
    root: float = millimetres(5.0, "lr", "solid end at the clamp, along the outer arc")
    end: float = millimetres(12.0, "le", "solid end at the tip, along the outer arc")
    foot_length: float = millimetres(10.0, "lf", "length of the foot along the arc")
    foot_height: float = millimetres(3.0, "hf", "height of the foot outside the base")
    half: bool = field(default=False, metadata={"help": "keep y >= 0 only, cut in the plane of symmetry"})

    @property
    def cavities(self) -> tuple[str, ...]:
        """The one cavity."""
        return ("cavity",)

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tip, foot, outer (the base's outside), pleats, cavity, and symmetry_y of a half."""
        return ("clamp", "tip", "foot", "outer", "pleats", "cavity", *(("symmetry_y",) if self.half else ()))

    @property
    def domains(self) -> tuple[str, ...]:
        """body and base."""
        return ("body", "base")

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """Walls of the pleats, base and the roof of the airway."""
        names = ("wall", "side_wall", "top_wall", "base", *(("airway_roof",) if self.chambers > 1 else ()))
        return {name: getattr(self, name) for name in names}

    @property
    def default_size(self) -> float:
        """Half again the wall, 4.5 mm by default."""
        return 1.5 * self.wall

    @property
    def axis(self) -> tuple[float, float, float]:
        """From the clamp to the tip of the outer arc."""
        turn = self.turn
        x, z = math.sin(turn), math.cos(turn) - 1.0
        size = math.hypot(x, z)
        return (x / size, 0.0, z / size)

    @property
    def turn(self) -> float:
        """Angle of the arc at rest, rad."""
        return self.length / self.radius

    @property
    def pitch(self) -> float:
        """Angle from pleat to pleat, rad."""
        return (self.length - self.root - self.end) / (self.chambers * self.radius)

    @property
    def chamber_depth(self) -> float:
        """Depth of an air chamber, along the axle, mm."""
        return self.depth - 2.0 * self.side_wall

    @property
    def height(self) -> float:
        """Height of a pleat with the base, mm."""
        return self.base + self.chamber_height + self.top_wall

    @property
    def foot_point(self) -> tuple[float, float, float]:
        """Middle of the sole of the foot, mm."""
        x, z = self.place(self.turn - 0.5 * self.foot_length / self.radius, 0.0, -self.foot_height)
        return (x, 0.0, z)

    @property
    def axle(self) -> tuple[float, float, float]:
        """Point of the wheel's axle in the middle plane, mm."""
        return (-self.hub_radius, 0.0, 0.0)

    @property
    def centre(self) -> Point:
        """Centre of the outer arc at rest, (x, z), mm."""
        return (0.0, -self.radius)

    @property
    def cuts(self) -> tuple[float, ...]:
        """Angles of the gaps between the pleats at rest about the centre, rad, from +z towards +x."""
        return tuple(self._middle(number) + 0.5 * self.pitch for number in range(self.chambers - 1))

    @property
    def pleats(self) -> tuple[tuple[Point, ...], ...]:
        """Corners (x, z) of the pleats in the middle plane, mm, from inside the base up."""
        low = self.base + 0.5 * (self.airway_height + self.airway_roof)
        return tuple(self._trapezoid(i, self._pleat_foot, low, self.height) for i in range(self.chambers))

    @property
    def air(self) -> tuple[tuple[Point, ...], ...]:
        """Corners (x, z) of the air chambers in the middle plane, mm; they begin within the base, which cuts them."""
        top = self.base + self.chamber_height
        return tuple(self._trapezoid(i, self.chamber_foot, 0.0, top) for i in range(self.chambers))

    @property
    def cavity_volume(self) -> float:
        """Air in chambers and airway, of the half if it is one, mm³."""
        return occ.volume(self._air_solid())

    def place(self, turn: float, along: float, inwards: float) -> Point:
        """Return (x, z) of a point in the frame of the outer arc at an angle: `along` the tangent, `inwards`."""
        x = (self.radius - inwards) * math.sin(turn) + along * math.cos(turn)
        z = (self.radius - inwards) * math.cos(turn) - self.radius - along * math.sin(turn)
        return (x, z)

    def _middle(self, number: int) -> float:
        """Return the angle of the middle of a pleat, rad."""
        return self.root / self.radius + (number + 0.5) * self.pitch

    @property
    def _slope(self) -> float:
        """Change of half a chamber's width with its height."""
        return 0.5 * (self.chamber_foot - self.chamber_top) / self.chamber_height

    @property
    def _pleat_foot(self) -> float:
        """Outer width of a pleat at the base."""
        return self.chamber_foot + 2.0 * self.wall * math.hypot(1.0, self._slope)

    @property
    def _pleat_top(self) -> float:
        return self._pleat_foot - 2.0 * self._slope * (self.chamber_height + self.top_wall)

    def _trapezoid(self, number: int, foot: float, bottom: float, top: float) -> tuple[Point, ...]:
        """Return the corners of a trapezoid, `foot` wide at the base, between two heights over the outer arc."""
        turn = self._middle(number)
        low, high = (0.5 * foot - self._slope * (level - self.base) for level in (bottom, top))
        corners = [(-low, bottom), (-high, top), (high, top), (low, bottom)]
        return tuple(self.place(turn, along, level) for along, level in corners)

    def _check_fit(self) -> None:
        self._require(isinstance(self.half, bool), f"half = {self.half!r}: expected True or False")
        self._require(
            self.turn < 2.0 * math.pi,
            f"length = {self.length:g} mm: expected less than a full turn, {2.0 * math.pi * self.radius:.4g} mm",
        )
        self._require(
            self.root + self.end < self.length,
            f"root + end = {self.root + self.end:g} mm: expected less than length = {self.length:g} mm",
        )
        self._require(
            self.height < self.radius,
            f"base + chamber_height + top_wall = {self.height:g} mm: expected less than radius = {self.radius:g} mm",
        )
        self._require(
            self.chamber_top <= self.chamber_foot,
            f"chamber_top = {self.chamber_top:g} mm: expected at most chamber_foot = {self.chamber_foot:g} mm",
        )
        self._require(
            self.chamber_depth > 0.0,
            f"the side walls overlap: depth = {self.depth:g} mm, expected more than 2 * side_wall = "
            f"{2.0 * self.side_wall:g} mm",
        )
        self._require(
            self.airway_width <= self.chamber_depth,
            f"airway_width = {self.airway_width:g} mm: expected at most depth - 2 * side_wall = "
            f"{self.chamber_depth:g} mm",
        )
        bridge = self.airway_height + self.airway_roof
        self._require(
            bridge < self.chamber_height + self.top_wall,
            f"airway_height + airway_roof = {bridge:g} mm: expected less than chamber_height + top_wall = "
            f"{self.chamber_height + self.top_wall:g} mm",
        )
        self._require(
            self.foot_length <= self.end,
            f"foot_length = {self.foot_length:g} mm: expected at most end = {self.end:g} mm",
        )
        for level, width in (
            (self.base + bridge, self._pleat_foot - 2.0 * self._slope * bridge),
            (self.height, self._pleat_top),
        ):
            room = 2.0 * (self.radius - level) * math.tan(0.5 * self.pitch)
            self._require(
                width < room,
                f"the pleats overlap: {width:.4g} mm wide {level:g} mm inside the outer arc, expected less than the "
                f"{room:.4g} mm that {self.chambers} pleats leave there",
            )

    def _sector(self, low: float, high: float, start: float, stop: float, depth: float) -> occ.Shape:
        """Return the part between two heights over the outer arc, and two angles."""
        return occ.side_sector(
            self.centre, (self.radius - high, self.radius - low), (start, stop), -0.5 * depth, 0.5 * depth
        )

    def _block(self, corners: tuple[Point, ...], depth: float) -> occ.Shape:
        return occ.side_prism(corners, -0.5 * depth, 0.5 * depth)

    def _air_solid(self) -> occ.Shape:
        """Return chambers and airway, with all faces named as the cavity."""
        parts = [self._block(corners, self.chamber_depth) for corners in self.air]
        if self.chambers > 1:
            ends = self._middle(0), self._middle(self.chambers - 1)
            parts.append(self._sector(0.5 * self.base, self.base + self.airway_height, *ends, self.airway_width))
        floor = self._sector(-self.foot_height, self.base, 0.0, self.turn, 2.0 * self.depth)
        return self._cut_half(occ.named(occ.cut(occ.fused(parts), [floor]), "cavity"))

    def _cut_half(self, shape: occ.Shape) -> occ.Shape:
        if not self.half:
            return shape
        far = 4.0 * (self.radius + self.length)
        box = occ.name_low_faces(occ.box((-far, 0.0, -far), (far, far, far)), {"y": "symmetry_y"})
        return occ.common(shape, box)

    def shape(self) -> occ.Shape:
        """Return two bonded solids, body and base."""
        bridge = self.base + self.airway_height + self.airway_roof
        parts = [self._sector(self.base, bridge, 0.0, self.turn, self.depth)]
        parts += [self._block(corners, self.depth) for corners in self.pleats]
        ends = ((0.0, self.root / self.radius), (self.turn - self.end / self.radius, self.turn))
        parts += [self._sector(self.base, self.height, *pair, self.depth) for pair in ends]
        floor = self._sector(-self.foot_height, self.base, 0.0, self.turn, 2.0 * self.depth)
        body = occ.named(occ.cut(occ.fused(parts), [floor]), "pleats")
        body = occ.cut(self._cut_half(body), [self._air_solid()])
        layer = self._sector(0.0, self.base, 0.0, self.turn, self.depth)
        start = self.turn - self.foot_length / self.radius
        pad = self._sector(-self.foot_height, 0.5 * self.base, start, self.turn, self.depth)
        base = self._cut_half(occ.fused([layer, pad]))
        for part in (body, base):
            occ.name_plane_faces(part, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), "clamp")
            x, z = self.place(self.turn, 0.0, 0.0)
            occ.name_plane_faces(part, (x, 0.0, z), (math.cos(self.turn), 0.0, -math.sin(self.turn)), "tip")
        occ.name_round_faces(base, self.centre, self.radius + self.foot_height, "foot")
        occ.name_round_faces(base, self.centre, self.radius - self.base, "cavity")
        return occ.check_solid(occ.bonded([(body, "body"), (base, "base")]), 2, "SoftLimb")
