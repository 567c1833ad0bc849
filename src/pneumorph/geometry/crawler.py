"""Crawling beam in plane strain: segments of round channels in a soft block on a strain-limiting layer."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from pneumorph.errors import GeometryError
from pneumorph.geometry.actuator import Actuator, millimetres, whole_number
from pneumorph.geometry.occ import Shape


@dataclass(frozen=True)
class PlaneCrawler(Actuator):
    """Beam along x in the plane, 1 mm thick, with one cavity a segment: PN1 at the rear (x = 0), then forward.

    Each channel is a round hole in a square of soft material (domain "body") of side 2 R2, whose corners are rounded
    with the radius `rounding`: 0 makes one block, a radius near R2 a row of tubes that hold together along their flat
    sides; the lower corners at the two ends of the beam, on which it stands, are never rounded. The channels of a
    segment share one pressure, by airways that are not in the plane. Below lies the layer (domain "base"), its
    underside on y = 0. The half of the underside behind the middle, with the lower half of the rear end, is the face
    "rear_foot", the half before it "front_foot"; the rest is "outer". Inflated, a segment arches up. It is meshed in
    the plane and has no solid.

    Source: 'A combined analytical and numerical study of locomotion of pneumatic-network soft robots', 2-D model.
    Raises GeometryError.
    """

    segments: int = whole_number(3, "N", "segments, each with a cavity of its own", given=True)
    channels: int = whole_number(5, "n", "channels in a segment")
    inner_radius: float = millimetres(3.0, "R1", "radius of a channel", given=True)
    outer_radius: float = millimetres(5.0, "R2", "half the side of the soft square about a channel", given=True)
    rounding: float = millimetres(4.0, "rho", "radius of the corners of a channel's square", zero=True)
    layer: float = millimetres(0.2, "s", "thickness of the strain-limiting layer")

    def _check_fit(self) -> None:
        self._require(
            self.rounding < self.outer_radius,
            f"rounding = {self.rounding:g} mm leaves no flat side: expected less than outer_radius = "
            f"{self.outer_radius:g} mm",
        )
        self._require(
            self.inner_radius < self.outer_radius,
            f"inner_radius = {self.inner_radius:g} mm leaves no wall: expected less than outer_radius = "
            f"{self.outer_radius:g} mm",
        )

    @property
    def space(self) -> str:
        """It lies in the plane."""
        return "plane_strain"

    @property
    def axis(self) -> tuple[float, float, float]:
        """Forward."""
        return (1.0, 0.0, 0.0)

    @property
    def length(self) -> float:
        """Whole length, mm."""
        return 2.0 * self.outer_radius * self.channels * self.segments

    @property
    def height(self) -> float:
        """Whole height with the layer, mm."""
        return 2.0 * self.outer_radius + self.layer

    @property
    def cavities(self) -> tuple[str, ...]:
        """PN1 at the rear, PN2, ..."""
        return tuple(f"PN{i + 1}" for i in range(self.segments))

    @property
    def face_names(self) -> tuple[str, ...]:
        """The feet, the rest of the outside and the cavities."""
        return ("rear_foot", "front_foot", "outer", *self.cavities)

    @property
    def domains(self) -> tuple[str, ...]:
        """body, and the layer: base."""
        return ("body", "base")

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """None: walls beside round channels have no one thickness; the mesh has two cells or more across the least."""
        return {}

    @property
    def default_size(self) -> float:
        """An eighth of the side of a channel's square."""
        return 0.25 * self.outer_radius

    @property
    def cavity_volume(self) -> float:
        """Volume of the channels of one segment, 1 mm thick, mm³."""
        return self.channels * math.pi * self.inner_radius**2

    def shape(self) -> Shape:
        """Raise GeometryError: there is no solid."""
        raise GeometryError("PlaneCrawler: it lies in the plane and has no CAD solid: export its mesh instead")
