"""Crawling quadruped: an X of four legs and a centre, rows of channels in a soft layer on a strain-limiting one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.errors import GeometryError
from pneumorph.geometry.actuator import Actuator, millimetres
from pneumorph.geometry.occ import Shape

LEGS = ("PN1", "PN2", "PN3", "PN4")
CENTRE = "PN5"


@dataclass(frozen=True)
class Quadruped(Actuator):
    """Robot of four legs and a centre on the plane z = 0, x forward; cavities PN1 to PN5; lengths in mm.

    PN1 is the left rear leg (x < 0, y > 0), PN2 the right rear, PN3 the left front, PN4 the right front, PN5 the
    centre, a block `body_width` wide. At each end two legs leave it side by side; each turns outward about its outer
    edge, until its root measures `leg_width` across, so that the cosine of its angle to the x axis is body_width /
    (2 leg_width). The channels lie on the strain-limiting layer (domain "base"), under a roof of the soft material
    (domain "body"), across the leg from one side wall to the other; as many as fit with the same gap at both ends as
    between them, or a little more. Either half of the centre has such a row, narrower as it is. The channels of a
    cavity share one pressure, by airways that are not modelled.

    Faces: the cavities; foot_PN1 to foot_PN4, the undersides of the legs with their tips; belly_rear and belly_front,
    the undersides of the centre; outer. `half` keeps y >= 0, cut at "symmetry_y": PN1, PN3 and half of PN5. Inflated,
    a leg or the centre arches up. It is meshed in layers and has no CAD solid.

    Source: 'A combined analytical and numerical study of locomotion of pneumatic-network soft robots', 3-D model.
    Raises GeometryError.
    """

    length: float = millimetres(135.7, "L", "whole length", given=True)
    width: float = millimetres(58.5, "B", "whole width", given=True)
    soft: float = millimetres(5.3, "h", "thickness of the soft layer, channels included", given=True)
    layer: float = millimetres(1.0, "s", "thickness of the strain-limiting layer", given=True)
    channel_depth: float = millimetres(4.0, "d", "height of a channel", given=True)
    channel: float = millimetres(1.5, "t", "width of a channel along the leg", given=True)
    gap: float = millimetres(2.0, "g", "wall between neighbouring channels", given=True)
    body_width: float = millimetres(27.5, "Bc", "width of the centre")
    leg_width: float = millimetres(15.0, "b", "width of a leg")
    junction: float = millimetres(2.0, "e", "length of the solid between the centre and a leg at its outer edge")
    side_wall: float = millimetres(2.0, "w", "wall beside the channels of a leg")
    half: bool = field(default=False, metadata={"help": "keep y >= 0 only, cut in the plane of symmetry"})

    def _check_fit(self) -> None:
        self._require(isinstance(self.half, bool), f"half = {self.half!r}: expected True or False")
        self._require(
            self.channel_depth < self.soft,
            f"the channels have no roof: channel_depth = {self.channel_depth:g} mm, expected less than soft = "
            f"{self.soft:g} mm",
        )
        self._require(
            self.body_width < 2.0 * self.leg_width,
            f"body_width = {self.body_width:g} mm: expected less than 2 * leg_width = {2.0 * self.leg_width:g} mm, so "
            "that the legs point outward",
        )
        self._require(
            self.body_width < self.width,
            f"body_width = {self.body_width:g} mm: expected less than width = {self.width:g} mm",
        )
        self._require(
            self.channel_width > 0.0,
            f"leg_width = {self.leg_width:g} mm leaves no channels: expected more than 2 * side_wall = "
            f"{2.0 * self.side_wall:g} mm",
        )
        least = 2.0 * self.gap + self.channel
        self._require(
            self.leg_length >= least,
            f"the legs of {self.leg_length:.4g} mm hold no channel: expected at least 2 * gap + channel = "
            f"{least:g} mm; a larger width or a smaller body_width makes them longer",
        )
        self._require(
            self.centre_length >= least,
            f"length = {self.length:g} mm leaves {self.centre_length:.4g} mm for the centre: expected at least "
            f"2 * gap + channel = {least:g} mm",
        )

    @property
    def leg_angle(self) -> float:
        """Angle of a leg to the x axis, rad."""
        return math.acos(self.narrowing)

    @property
    def leg_length(self) -> float:
        """Length of a leg from its root to its tip, mm."""
        return 0.5 * (self.width - self.body_width) / math.sin(self.leg_angle)

    @property
    def centre_length(self) -> float:
        """Length of the centre, mm."""
        leg = self.leg_width * math.sin(self.leg_angle) + self.leg_length * math.cos(self.leg_angle)
        return self.length - 2.0 * (self.junction + leg)

    @property
    def height(self) -> float:
        """Whole height, mm."""
        return self.soft + self.layer

    @property
    def channel_width(self) -> float:
        """Width of a channel across a leg, mm."""
        return self.leg_width - 2.0 * self.side_wall

    @property
    def leg_channels(self) -> int:
        """Channels in a leg."""
        return self._fitting(self.leg_length)

    @property
    def centre_channels(self) -> int:
        """Channels in each half of the centre."""
        return self._fitting(self.centre_length)

    def _fitting(self, length: float) -> int:
        return math.floor((length - self.gap) / (self.channel + self.gap) + 1e-9)

    @property
    def narrowing(self) -> float:
        """Half the width of the centre over that of a leg, less than 1."""
        return 0.5 * self.body_width / self.leg_width

    @property
    def cavities(self) -> tuple[str, ...]:
        """PN1 to PN5, of a half PN1, PN3 and PN5."""
        return (*self.legs, CENTRE)

    @property
    def legs(self) -> tuple[str, ...]:
        """The cavities of the legs."""
        return LEGS[::2] if self.half else LEGS

    @property
    def face_names(self) -> tuple[str, ...]:
        """Feet, bellies, outer, the cavities and the cut face of a half."""
        names = (*(f"foot_{leg}" for leg in self.legs), "belly_rear", "belly_front", "outer", *self.cavities)
        return (*names, "symmetry_y") if self.half else names

    @property
    def domains(self) -> tuple[str, ...]:
        """body, and the layer: base."""
        return ("body", "base")

    @property
    def axis(self) -> tuple[float, float, float]:
        """Forward."""
        return (1.0, 0.0, 0.0)

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """None: the channels are as narrow as the walls about them are thick, so none of these is a plate."""
        return {}

    @property
    def default_size(self) -> float:
        """Half again the gap: one cell in each channel and each wall along a leg."""
        return 1.5 * self.gap

    @property
    def cavity_volume(self) -> float:
        """Volume of the channels of a leg, mm³."""
        return self.leg_channels * self._channel_volume

    @property
    def centre_volume(self) -> float:
        """Volume of the channels of the centre, of the half if it is one, mm³."""
        return self.centre_channels * self.narrowing * self._channel_volume * (1.0 if self.half else 2.0)

    @property
    def _channel_volume(self) -> float:
        """Volume of a channel of a leg, mm³."""
        return self.channel_width * self.channel * self.channel_depth

    @property
    def plan_area(self) -> float:
        """Area seen from above, of the half if it is one, mm²."""
        turned = 0.25 * self.body_width * (2.0 * self.junction + self.leg_width * math.sin(self.leg_angle))
        area = self.centre_length * self.body_width + 4.0 * (turned + self.leg_length * self.leg_width)
        return area / (2.0 if self.half else 1.0)

    def shape(self) -> Shape:
        """Raise GeometryError: there is no CAD solid."""
        raise GeometryError("Quadruped: it is meshed in layers and has no CAD solid: export its mesh instead")
