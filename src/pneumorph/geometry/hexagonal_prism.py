"""Hexagonal column with one rectangular cavity assembly on each of its six flat sides (Wang et al. 2022)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres, whole_number

SIDES = 6


@dataclass(frozen=True)
class HexagonalPrism(Actuator):
    """Hexagonal-prism bending and expanding actuator; lengths in mm.

    The column stands on the clamped end (z = 0, face "clamp") and ends in "tip"; both are hexagonal rings, because the
    hollow core goes through the whole length and is open at both ends (its wall is the face "core", never pressurised).
    On each flat side stands one assembly of `chambers` air chambers in a row, centred along the length: `cavity_1`
    looks along x, the others follow anticlockwise seen from the tip. A row that begins at the clamped end, because its
    end walls take up the rest of the length, is clamped with it. Chambers are separate blocks with gaps between
    them; the airway runs through the gaps on the column's side inside a small bridge. Blocks as wide as the column's
    side touch the next assembly along the hexagon's edge only, which leaves a 60 degree groove and a clean solid.

    An end plate (domain "plate", its own faces "plate") takes the place of the last part of the column and bears the
    free end, as what modules of a robot are joined by does: without one a soft end rolls in when chambers balloon.

    Source: Wang, Zhang, Zhang, Zhao, Peng, Actuators 2022, 11, 125, Table 1 and Figure 5. Raises GeometryError.
    """

    side: float = millimetres(20.0, "a", "side of the hexagon", given=True)
    length: float = millimetres(112.0, "l", "length of the column", given=True)
    core_radius: float = millimetres(14.0, "r", "radius of the hollow core", given=True)
    chambers: int = whole_number(11, "N", "air chambers of one cavity", given=True)
    chamber_height: float = millimetres(19.0, "h2", "height of the air chamber, radial", given=True)
    chamber_width: float = millimetres(14.0, "w2", "width of the air chamber, tangential", given=True)
    chamber_length: float = millimetres(4.0, "l2", "length of the air chamber, axial", given=True)
    expansion_wall: float = millimetres(2.0, "l1", "wall between a chamber and the gap", given=True)
    gap: float = millimetres(2.0, "l3", "gap between neighbouring chambers' walls")
    end_wall: float = millimetres(2.0, "l5", "outer wall of the first and the last chamber of a row")
    top_wall: float = millimetres(3.0, "h1", "wall on top of a chamber")
    side_wall: float = millimetres(3.0, "w1", "wall beside a chamber")
    airway_width: float = millimetres(3.0, "w3", "width of the airway")
    airway_height: float = millimetres(3.0, "h3", "height of the airway")
    airway_roof: float = millimetres(1.5, "h4", "wall of the bridge above the airway")
    airway_side: float = millimetres(1.5, "w4", "wall of the bridge beside the airway")
    end_plate: float = millimetres(0.0, "t", "thickness of a plate that closes the free end, 0 for none", zero=True)
    end_plate_bore: float = millimetres(3.0, "r2", "radius of the hole in that plate, for the tubing")
    half: bool = field(default=False, metadata={"help": "keep x >= 0 only, cut in a plane between two cavities"})

    @property
    def cavities(self) -> tuple[str, ...]:
        """cavity_1 to cavity_6, in order around the column; of a half cavity_1, cavity_2 and cavity_6."""
        return tuple(name for _, name in self.sides)

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tip, outer, core, plate if there is one, the cavities, and symmetry_x of a half."""
        plate = ("plate",) if self.end_plate > 0.0 else ()
        return ("clamp", "tip", "outer", "core", *plate, *self.cavities, *(("symmetry_x",) if self.half else ()))

    @property
    def domains(self) -> tuple[str, ...]:
        """body, and plate if there is one."""
        return ("body", "plate") if self.end_plate > 0.0 else ("body",)

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """Expansion, top and side walls, and the roof of the airway."""
        walls = {"expansion_wall": self.expansion_wall, "top_wall": self.top_wall, "side_wall": self.side_wall}
        return walls | ({"airway_roof": self.airway_roof} if self.chambers > 1 else {})

    @property
    def default_size(self) -> float:
        """Two fifths of the side, 8 mm by default."""
        return 0.4 * self.side

    @property
    def face_sizes(self) -> Mapping[str, float]:
        """About thirteen edges around the core, so that its thin wall keeps its thickness."""
        return {"core": 0.5 * self.core_radius}

    @property
    def apothem(self) -> float:
        """Distance of the flat sides from the axis, mm."""
        return self.side * math.sqrt(3.0) / 2.0

    @property
    def block_length(self) -> float:
        """Outer length of one chamber, La = 2 l1 + l2, mm."""
        return 2.0 * self.expansion_wall + self.chamber_length

    @property
    def block_width(self) -> float:
        """Outer width of one chamber, Wa = 2 w1 + w2, mm."""
        return 2.0 * self.side_wall + self.chamber_width

    @property
    def block_height(self) -> float:
        """Outer height of one chamber, Ha = h1 + h2, mm."""
        return self.top_wall + self.chamber_height

    @property
    def assembly_length(self) -> float:
        """Length of the row of chambers, N La + (N - 1) l3 + 2 (l5 - l1), mm."""
        ends = 2.0 * (self.end_wall - self.expansion_wall)
        return self.chambers * self.block_length + (self.chambers - 1) * self.gap + ends

    @property
    def chamber_starts(self) -> tuple[float, ...]:
        """z at which each chamber's air begins, mm."""
        first = (self.length - self.assembly_length) / 2.0 + self.end_wall
        return tuple(first + i * (self.block_length + self.gap) for i in range(self.chambers))

    @property
    def blocks(self) -> tuple[tuple[float, float], ...]:
        """z at which the block of each chamber begins and ends, mm."""
        inner = [self.expansion_wall] * (self.chambers - 1)
        walls = zip(self.chamber_starts, [self.end_wall, *inner], [*inner, self.end_wall], strict=True)
        return tuple((low - below, low + self.chamber_length + above) for low, below, above in walls)

    @property
    def sides(self) -> tuple[tuple[int, str], ...]:
        """Number and cavity of the flat sides that there are; side i looks 60 degrees times i away from x."""
        numbers = (0, 1, 5) if self.half else range(SIDES)
        return tuple((number, f"cavity_{number + 1}") for number in numbers)

    @property
    def cavity_volume(self) -> float:
        """Air in one cavity: N l2 w2 h2 + (N - 1) (l3 + 2 l1) w3 h3, mm³."""
        chamber = self.chamber_length * self.chamber_width * self.chamber_height
        airway = (self.gap + 2.0 * self.expansion_wall) * self.airway_width * self.airway_height
        return self.chambers * chamber + (self.chambers - 1) * airway

    def _check_fit(self) -> None:
        self._require(isinstance(self.half, bool), f"half = {self.half!r}: expected True or False")
        self._require(
            self.core_radius < self.apothem,
            f"core_radius = {self.core_radius:g} mm leaves no wall: expected less than {self.apothem:.4g} mm "
            "(side * sqrt(3) / 2)",
        )
        self._require(
            self.end_plate < self.length,
            f"end_plate = {self.end_plate:g} mm leaves no column: expected less than length = {self.length:g} mm",
        )
        self._require(
            self.end_plate_bore < self.core_radius,
            f"end_plate_bore = {self.end_plate_bore:g} mm leaves no plate in the core: expected less than core_radius "
            f"= {self.core_radius:g} mm",
        )
        self._require(
            self.end_wall >= self.expansion_wall,
            f"end_wall = {self.end_wall:g} mm: expected at least expansion_wall = {self.expansion_wall:g} mm, the "
            "thinnest walls",
        )
        self._require(
            self.assembly_length <= self.length + 1e-9,
            f"the chambers overlap or do not fit: {self.chambers} * (chamber_length + 2 * expansion_wall) + "
            f"{self.chambers - 1} * gap + 2 * (end_wall - expansion_wall) = {self.assembly_length:g} mm, expected at "
            f"most length = {self.length:g} mm",
        )
        self._require(
            self.block_width <= self.side + 1e-9,
            f"neighbouring cavities overlap: chamber_width + 2 * side_wall = {self.block_width:g} mm, expected at most "
            f"side = {self.side:g} mm",
        )
        self._require(
            self.airway_width <= self.chamber_width,
            f"airway_width = {self.airway_width:g} mm: expected at most chamber_width = {self.chamber_width:g} mm",
        )
        self._require(
            self.airway_height <= self.chamber_height,
            f"airway_height = {self.airway_height:g} mm: expected at most chamber_height = {self.chamber_height:g} mm",
        )
        self._require(
            self.airway_width + 2.0 * self.airway_side <= self.block_width,
            f"the airway's bridge, airway_width + 2 * airway_side = {self.airway_width + 2.0 * self.airway_side:g} mm, "
            f"is wider than a chamber's block: expected at most {self.block_width:g} mm",
        )
        self._require(
            self.airway_height + self.airway_roof <= self.block_height,
            f"the airway's bridge, airway_height + airway_roof = {self.airway_height + self.airway_roof:g} mm, is "
            f"higher than a chamber's block: expected at most {self.block_height:g} mm",
        )

    def shape(self) -> occ.Shape:
        """Return the solid; its faces are clamp, tip, core, outer and cavity_1 to cavity_6, and those of a plate."""
        outline = occ.regular_polygon(SIDES, self.side, math.pi / SIDES)
        top = self.length - self.end_plate
        column = occ.prism(outline, 0.0, top, "clamp", "tip")
        column = self._kept(occ.cut(column, [occ.cylinder(self.core_radius, 0.0, top, "core")]))
        solids = [column]
        air = []
        for number, name in self.sides:
            silicone, hollow = self._assembly(name)
            solids += [occ.turned(part, 60.0 * number) for part in silicone]
            air.append(occ.turned(occ.fused(hollow), 60.0 * number))
        body = occ.check_solid(occ.cut(occ.fused(solids), air), 1, "HexagonalPrism")
        if not self.end_plate:
            return body
        plate = occ.prism(outline, top, self.length, "plate", "tip")
        plate = self._kept(occ.cut(plate, [occ.cylinder(self.end_plate_bore, top, self.length, "plate")]))
        return occ.bonded([(body, "body"), (plate, "plate")])

    def _kept(self, solid: occ.Shape) -> occ.Shape:
        """Return a part of the column, cut if this is a half."""
        if not self.half:
            return solid
        far = 4.0 * (self.side + self.block_height)
        kept = occ.box((0.0, -far, -self.length), (far, far, 2.0 * self.length))
        return occ.common(solid, occ.name_low_faces(kept, {"x": "symmetry_x"}))

    def _assembly(self, name: str) -> tuple[list[occ.Shape], list[occ.Shape]]:
        """Return the silicone blocks and the air boxes of the assembly on the side that looks along x."""
        floor = self.apothem
        silicone: list[occ.Shape] = []
        air: list[occ.Shape] = []

        def add(parts: list[occ.Shape], height: float, width: float, low: float, high: float, face: str | None) -> None:
            parts.append(occ.box((floor, -width / 2.0, low), (floor + height, width / 2.0, high), face))

        wall, bridge = (
            self.expansion_wall,
            (self.airway_height + self.airway_roof, self.airway_width + 2 * self.airway_side),
        )
        for i, (low, (bottom, top)) in enumerate(zip(self.chamber_starts, self.blocks, strict=True)):
            add(silicone, self.block_height, self.block_width, bottom, top, None)
            if bottom < 1e-9:
                occ.name_low_faces(silicone[-1], {"z": "clamp"})
            add(air, self.chamber_height, self.chamber_width, low, low + self.chamber_length, name)
            if i < self.chambers - 1:
                add(silicone, *bridge, top, top + self.gap, None)
                add(air, self.airway_height, self.airway_width, top - wall, top + self.gap + wall, name)
        return silicone, air
