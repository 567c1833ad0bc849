"""Finger-like actuator: rectangular chambers followed by narrow portions, about the size of a human finger."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres, whole_number
from pneumorph.geometry.chamber_row import ChamberRow


@dataclass(frozen=True)
class Finger(Actuator):
    """Bending finger along x, one cavity; lengths in mm.

    Chambers share the length: each is (length - (N - 1) gap) / N long outside. Between them the finger narrows to the
    height of base, passage and roof. Inflated, it bends towards its base (to -z).

    Source: 'Numerical and experimental methods for the assessment of a human finger-inspired soft pneumatic actuator
    for gripping applications' (MethodsX); it gives the six passages but no dimension. Raises GeometryError.
    """

    length: float = millimetres(90.0, "L", "whole length")
    width: float = millimetres(16.0, "B", "whole width")
    height: float = millimetres(18.0, "H", "whole height of a chamber")
    chambers: int = whole_number(7, "N", "chambers, joined by N - 1 passages", given=True)
    wall: float = millimetres(2.0, "t", "axial, side, top and end walls of a chamber")
    base: float = millimetres(3.0, "b", "floor under the cavity")
    gap: float = millimetres(3.0, "g", "length of a narrow portion")
    passage_width: float = millimetres(6.0, "wp", "width of a passage")
    passage_height: float = millimetres(3.0, "hp", "height of a passage")
    passage_roof: float = millimetres(2.0, "tp", "wall above a passage")

    @property
    def cavities(self) -> tuple[str, ...]:
        """The one cavity."""
        return ("cavity",)

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tip, outer and cavity."""
        return ("clamp", "tip", "outer", "cavity")

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """Chamber walls, base, and the roof of the passages."""
        walls = {"wall": self.wall, "base": self.base}
        return walls | ({"passage_roof": self.passage_roof} if self.chambers > 1 else {})

    @property
    def default_size(self) -> float:
        """Half again the thickness of a wall, 3 mm by default as in the study."""
        return 1.5 * self.wall

    @property
    def axis(self) -> tuple[float, float, float]:
        """Along x."""
        return (1.0, 0.0, 0.0)

    @property
    def block_length(self) -> float:
        """Outer length of one chamber, mm."""
        return (self.length - (self.chambers - 1) * self.gap) / self.chambers

    @property
    def cavity_volume(self) -> float:
        """Air in chambers and passages, mm³."""
        return self._row().cavity_volume

    def _row(self) -> ChamberRow:
        return ChamberRow(
            chambers=self.chambers,
            chamber_length=self.block_length - 2.0 * self.wall,
            chamber_width=self.width - 2.0 * self.wall,
            chamber_height=self.height - self.base - self.wall,
            wall=self.wall,
            end=self.wall,
            side_wall=self.wall,
            top_wall=self.wall,
            floor=self.base,
            gap=self.gap,
            airway_width=self.passage_width,
            airway_height=self.passage_height,
            airway_roof=self.passage_roof,
        )

    def _check_fit(self) -> None:
        row = self._row()
        self._require(
            row.chamber_length > 0.0,
            f"the chambers overlap: length = {self.length:g} mm leaves {self.block_length:.4g} mm for each of "
            f"{self.chambers} chambers, expected more than 2 * wall = {2.0 * self.wall:g} mm",
        )
        self._require(
            row.chamber_width > 0.0,
            f"the side walls overlap: width = {self.width:g} mm, expected more than 2 * wall = {2.0 * self.wall:g} mm",
        )
        self._require(
            row.chamber_height > 0.0,
            f"base and top wall overlap: height = {self.height:g} mm, expected more than base + wall = "
            f"{self.base + self.wall:g} mm",
        )
        self._require(
            self.passage_width <= row.chamber_width,
            f"passage_width = {self.passage_width:g} mm: expected at most width - 2 * wall = {row.chamber_width:g} mm",
        )
        self._require(
            self.passage_height <= row.chamber_height,
            f"passage_height = {self.passage_height:g} mm: expected at most height - base - wall = "
            f"{row.chamber_height:g} mm",
        )
        low = self.base + self.passage_height + self.passage_roof
        self._require(
            low <= self.height,
            f"the narrow portion, base + passage_height + passage_roof = {low:g} mm, is higher than a chamber: "
            f"expected at most height = {self.height:g} mm",
        )

    def shape(self) -> occ.Shape:
        """Return the solid; its faces are clamp, tip, outer and cavity."""
        return occ.check_solid(self._row().solid("cavity"), 1, "Finger")
