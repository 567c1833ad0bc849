"""A beam along x with a row of rectangular chambers on a floor: what the finger and the PneuNet have in common."""

from __future__ import annotations

from dataclasses import dataclass

from pneumorph.geometry import occ


@dataclass(frozen=True)
class ChamberRow:
    """Dimensions in mm of the beam; the floor's underside lies at z = 0, the clamped end at x = 0, the middle at y = 0.

    `end` is the axial wall before the first and behind the last chamber, `wall` the one on either side of a gap.
    Between the chambers the beam is only as high as the airway and its roof, over its full width.
    """

    chambers: int
    chamber_length: float
    chamber_width: float
    chamber_height: float
    wall: float
    end: float
    side_wall: float
    top_wall: float
    floor: float
    gap: float
    airway_width: float
    airway_height: float
    airway_roof: float

    @property
    def pitch(self) -> float:
        """Distance from chamber to chamber."""
        return self.chamber_length + 2.0 * self.wall + self.gap

    @property
    def length(self) -> float:
        """Whole length of the beam."""
        return 2.0 * self.end + (self.chambers - 1) * self.pitch + self.chamber_length

    @property
    def width(self) -> float:
        """Whole width of the beam."""
        return self.chamber_width + 2.0 * self.side_wall

    @property
    def height(self) -> float:
        """Height of the chambers with floor and top wall."""
        return self.floor + self.chamber_height + self.top_wall

    @property
    def cavity_volume(self) -> float:
        """Air in the chambers and in the airway between them, mm³."""
        chamber = self.chamber_length * self.chamber_width * self.chamber_height
        airway = (self.gap + 2.0 * self.wall) * self.airway_width * self.airway_height
        return self.chambers * chamber + (self.chambers - 1) * airway

    def solid(self, cavity: str) -> occ.Shape:
        """Return the beam with its cavity cut out; the end faces are clamp and tip."""
        low = self.floor + self.airway_height + self.airway_roof
        profile = [(0.0, 0.0), (self.length, 0.0), (self.length, self.height)]
        for i in reversed(range(1, self.chambers)):
            left = self.end + i * self.pitch - self.wall - self.gap
            if self.gap > 0.0 and low < self.height:
                right = left + self.gap
                profile += [(right, self.height), (right, low), (left, low), (left, self.height)]
        profile.append((0.0, self.height))
        beam = occ.side_prism(profile, -self.width / 2.0, self.width / 2.0)
        occ.name_end_faces(beam, (1.0, 0.0, 0.0), "clamp", "tip")
        return occ.cut(beam, [occ.named(occ.fused(self._air()), cavity)])

    def _air(self) -> list[occ.Shape]:
        half, top = self.chamber_width / 2.0, self.floor + self.chamber_height
        starts = [self.end + i * self.pitch for i in range(self.chambers)]
        parts = [occ.box((x, -half, self.floor), (x + self.chamber_length, half, top)) for x in starts]
        half, top = self.airway_width / 2.0, self.floor + self.airway_height
        for x in starts[1:]:
            parts.append(occ.box((x - self.gap - 2.0 * self.wall, -half, self.floor), (x, half, top)))
        return parts
