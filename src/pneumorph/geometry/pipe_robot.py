"""Worm-like pipe robot: hexagonal prism - elongation actuator - hexagonal prism (Wang et al. 2022)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.errors import GeometryError
from pneumorph.geometry.actuator import millimetres, whole_number
from pneumorph.geometry.hexagonal_prism import HexagonalPrism
from pneumorph.geometry.occ import Shape


@dataclass(frozen=True)
class PipeRobot(HexagonalPrism):
    """Robot that moves in pipes, along z: a rear prism from z = 0 on, a bellows, a front prism; lengths in mm.

    The prisms are those of `HexagonalPrism`, but that the chambers of a row share one pressure without airways and
    bridges between them, unless `airways` is set: half the cells. Their outsides are the faces "rear" and "front",
    their cavities rear_1 to rear_6 and front_1 to front_6, from x on, anticlockwise seen from the tip. The bellows
    (cavity "middle", outside "outer") is a row of round rings on a neck with the section of the prisms' columns,
    closed by a disc at each end; it lengthens under pressure, and hardly widens.

    Planes of symmetry save work: `half` keeps x >= 0, which allows bending about x by rows 2 and 3 or 5 and 6 (row 2
    drives its image 3); `quarter` keeps y >= 0, too; `eighth` also the rear half of its length. The cut faces are
    symmetry_x, symmetry_y and symmetry_z. modules = 1 is a prism alone, with cavity_1 to cavity_6 and outside "outer".

    It is meshed as it is (see `mesh.pipe_robot`) and has no CAD solid. The study gives the prisms and the order of
    the parts, not the elongation actuator: all of the bellows is assumed. Source: Wang, Zhang, Zhang, Zhao, Peng,
    Actuators 2022, 11, 125. Raises GeometryError.
    """

    modules: int = whole_number(3, "M", "3 for the robot, 1 for a prism alone")
    rings: int = whole_number(5, "n", "rings of the bellows")
    ring_radius: float = millimetres(28.0, "Rb", "outer radius of the bellows' rings")
    ring_wall: float = millimetres(3.0, "tb", "walls of the rings")
    ring_air: float = millimetres(4.0, "lb", "air in a ring, axial")
    ring_gap: float = millimetres(4.0, "gb", "gap between neighbouring rings")
    end_disc: float = millimetres(4.0, "td", "thickness of the discs that close the bellows")
    airways: bool = field(default=False, metadata={"help": "airways and bridges between the chambers of a row"})
    quarter: bool = field(default=False, metadata={"help": "keep x >= 0 and y >= 0 only"})
    eighth: bool = field(default=False, metadata={"help": "keep the rear half of a quarter only"})

    def _check_fit(self) -> None:
        super()._check_fit()
        self._require(self.end_plate == 0.0, f"end_plate = {self.end_plate:g} mm: expected 0, robots have none")
        self._require(self.modules in (1, 3), f"modules = {self.modules!r}: expected 1 or 3")
        cuts = {"half": self.half, "quarter": self.quarter, "eighth": self.eighth}
        for name, value in cuts.items():
            self._require(isinstance(value, bool), f"{name} = {value!r}: expected True or False")
        chosen = [name for name, value in cuts.items() if value]
        self._require(len(chosen) < 2, f"{' and '.join(chosen)} are both set: expected one of them at most")
        self._require(isinstance(self.airways, bool), f"airways = {self.airways!r}: expected True or False")
        least = self.side + self.ring_wall
        self._require(
            self.ring_radius > least,
            f"ring_radius = {self.ring_radius:g} mm leaves no air in the rings: expected more than {least:g} mm "
            "(side + ring_wall)",
        )

    @property
    def sides(self) -> tuple[tuple[int, str], ...]:
        """Number and row (cavity_1 to cavity_6) of the flat sides that there are."""
        numbers = (0, 1) if self.quarter or self.eighth else (0, 1, 5) if self.half else range(6)
        return tuple((number, f"cavity_{number + 1}") for number in numbers)

    @property
    def prisms(self) -> tuple[str, ...]:
        """Names of the prisms, from the rear on."""
        both = ("rear", "front")[: 1 if self.eighth else 2]
        return both if self.modules == 3 else ("",)

    def row(self, prism: str, side: int) -> str:
        """Return the name of the cavity on a side, counted from 0, of a prism."""
        return f"{prism or 'cavity'}_{side + 1}"

    @property
    def cavities(self) -> tuple[str, ...]:
        """Rows of the prisms, and "middle" between them."""
        rows = [[self.row(prism, side) for side, _ in self.sides] for prism in self.prisms]
        middle = ("middle",) if self.modules == 3 else ()
        return (*rows[0], *middle, *(name for row in rows[1:] for name in row))

    @property
    def face_names(self) -> tuple[str, ...]:
        """Ends (but the one that is cut away), outsides, core, cut faces and cavities."""
        ends = ("clamp",) if self.eighth else ("clamp", "tip")
        outsides = (*self.prisms, "outer") if self.modules == 3 else ("outer",)
        return (*ends, *outsides, "core", *self.cuts, *self.cavities)

    @property
    def cuts(self) -> tuple[str, ...]:
        """Names of the cut faces."""
        count = 3 if self.eighth else 2 if self.quarter else 1 if self.half else 0
        return tuple(f"symmetry_{axis}" for axis in "xyz"[:count])

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """Walls of the prisms' chambers and of the bellows' rings."""
        walls = {"expansion_wall": self.expansion_wall, "top_wall": self.top_wall, "side_wall": self.side_wall}
        if self.airways and self.chambers > 1:
            walls["airway_roof"] = self.airway_roof
        return walls | ({"ring_wall": self.ring_wall} if self.modules == 3 else {})

    @property
    def default_size(self) -> float:
        """Half of the side, 10 mm by default: one cell across half of a chamber, two up its walls."""
        return 0.5 * self.side

    @property
    def bellows_length(self) -> float:
        """Length of the bellows at rest with its end discs, mm."""
        ring = self.ring_air + 2.0 * self.ring_wall
        return self.rings * ring + (self.rings + 1) * self.ring_gap + 2.0 * self.end_disc

    @property
    def robot_length(self) -> float:
        """Length of the whole at rest, mm."""
        return self.length if self.modules == 1 else 2.0 * self.length + self.bellows_length

    @property
    def cavity_volume(self) -> float:
        """Air in one row of chambers, mm³."""
        return super().cavity_volume if self.airways else self.chambers * self._chamber_volume

    @property
    def _chamber_volume(self) -> float:
        return self.chamber_length * self.chamber_width * self.chamber_height

    @property
    def reach(self) -> float:
        """Largest distance of the outside from the axis at rest, half of the circumscribed diameter, mm."""
        return math.hypot(self.apothem + self.block_height, self.block_width / 2.0)

    def shape(self) -> Shape:
        """Raise GeometryError: there is no solid."""
        raise GeometryError("PipeRobot: it is meshed from blocks and has no CAD solid: export its mesh instead")
