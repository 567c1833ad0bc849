"""PneuNet beam: any number of chambers in a row on a floor, with an optional strain-limiting layer below."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres, whole_number
from pneumorph.geometry.chamber_row import ChamberRow


@dataclass(frozen=True)
class PneuNet(Actuator):
    """Bending PneuNet along x, one cavity; lengths in mm.

    The body (domain "body") stands on the strain-limiting layer (domain "base", below z = 0), bonded to it by shared
    nodes; `layer = 0` leaves the layer out. `gap = 0` makes a solid block with inner walls. Inflated, it bends to -z.

    All defaults are assumed: a classic bending PneuNet of centimetre size. Raises GeometryError.
    """

    chambers: int = whole_number(6, "n", "chambers")
    chamber_length: float = millimetres(4.0, "l2", "length of the air chamber, axial")
    chamber_width: float = millimetres(12.0, "w2", "width of the air chamber")
    chamber_height: float = millimetres(10.0, "h2", "height of the air chamber")
    expansion_wall: float = millimetres(1.5, "l1", "wall between a chamber and the gap")
    end_wall: float = millimetres(5.0, "l4", "solid end before the first and behind the last chamber")
    side_wall: float = millimetres(2.0, "w1", "wall beside a chamber")
    top_wall: float = millimetres(2.0, "h1", "wall on top of a chamber")
    floor: float = millimetres(2.0, "b", "wall under a chamber, of the body's material")
    gap: float = millimetres(2.0, "l3", "gap between neighbouring chambers' walls, 0 for none", zero=True)
    airway_width: float = millimetres(2.0, "w3", "width of the airway")
    airway_height: float = millimetres(2.0, "h3", "height of the airway")
    airway_roof: float = millimetres(2.0, "h4", "wall above the airway in the gap")
    layer: float = millimetres(1.0, "s", "thickness of the strain-limiting layer, 0 for none", zero=True)

    @property
    def cavities(self) -> tuple[str, ...]:
        """The one cavity."""
        return ("cavity",)

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tip, outer and cavity."""
        return ("clamp", "tip", "outer", "cavity")

    @property
    def domains(self) -> tuple[str, ...]:
        """body, and base if there is a layer."""
        return ("body", "base") if self.layer > 0.0 else ("body",)

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """Expansion, top and side walls, floor with layer, and the roof of the airway."""
        walls = {"expansion_wall": self.expansion_wall, "top_wall": self.top_wall, "side_wall": self.side_wall}
        walls["floor"] = self.floor + self.layer
        if self.chambers > 1 and self.gap > 0.0:
            walls["airway_roof"] = self.airway_roof
        return walls

    @property
    def default_size(self) -> float:
        """Twice the expansion wall, 3 mm by default."""
        return 2.0 * self.expansion_wall

    @property
    def axis(self) -> tuple[float, float, float]:
        """Along x."""
        return (1.0, 0.0, 0.0)

    @property
    def length(self) -> float:
        """Whole length, mm."""
        return self._row().length

    @property
    def width(self) -> float:
        """Whole width, mm."""
        return self._row().width

    @property
    def height(self) -> float:
        """Whole height with the layer, mm."""
        return self._row().height + self.layer

    @property
    def cavity_volume(self) -> float:
        """Air in chambers and airway, mm³."""
        return self._row().cavity_volume

    def _row(self) -> ChamberRow:
        return ChamberRow(
            chambers=self.chambers,
            chamber_length=self.chamber_length,
            chamber_width=self.chamber_width,
            chamber_height=self.chamber_height,
            wall=self.expansion_wall,
            end=self.end_wall,
            side_wall=self.side_wall,
            top_wall=self.top_wall,
            floor=self.floor,
            gap=self.gap,
            airway_width=self.airway_width,
            airway_height=self.airway_height,
            airway_roof=self.airway_roof,
        )

    def _check_fit(self) -> None:
        self._require(
            self.airway_width <= self.chamber_width,
            f"airway_width = {self.airway_width:g} mm: expected at most chamber_width = {self.chamber_width:g} mm",
        )
        self._require(
            self.airway_height <= self.chamber_height,
            f"airway_height = {self.airway_height:g} mm: expected at most chamber_height = {self.chamber_height:g} mm",
        )
        bridge, block = self.airway_height + self.airway_roof, self.chamber_height + self.top_wall
        self._require(
            bridge <= block,
            f"the gap's bridge, airway_height + airway_roof = {bridge:g} mm, is higher than a chamber: expected at "
            f"most chamber_height + top_wall = {block:g} mm",
        )

    def shape(self) -> occ.Shape:
        """Return the solid, or two bonded solids; the faces are clamp, tip, outer and cavity."""
        row = self._row()
        body = occ.check_solid(row.solid("cavity"), 1, "PneuNet")
        if self.layer == 0.0:
            return body
        layer = occ.box((0.0, -row.width / 2.0, -self.layer), (row.length, row.width / 2.0, 0.0))
        occ.name_end_faces(layer, self.axis, "clamp", "tip")
        return occ.check_solid(occ.bonded([(body, "body"), (layer, "base")]), 2, "PneuNet")
