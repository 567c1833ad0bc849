"""Thick-walled round tube under internal pressure: a check against closed forms."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres


@dataclass(frozen=True)
class ThickTube(Actuator):
    """Tube about the z axis from "clamp" (z = 0) to "tip"; lengths in mm.

    The ends are closed by caps; `cap = 0` leaves them open, for a piece of a long tube between two planes (its cavity
    does not close by itself). `quarter` keeps x >= 0, y >= 0 with the cut faces "symmetry_x" (x = 0) and "symmetry_y"
    (y = 0). All defaults are assumed. Raises GeometryError.
    """

    inner_radius: float = millimetres(10.0, "A", "inner radius")
    outer_radius: float = millimetres(15.0, "B", "outer radius")
    length: float = millimetres(40.0, "L", "whole length")
    cap: float = millimetres(5.0, "c", "thickness of the end caps, 0 for open ends", zero=True)
    quarter: bool = field(
        default=False, metadata={"help": "keep the part with x, y >= 0 only, cut in planes of symmetry"}
    )

    @property
    def cavities(self) -> tuple[str, ...]:
        """The one cavity."""
        return ("cavity",)

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tip, outer, cavity and the symmetry planes of a quarter."""
        return ("clamp", "tip", "outer", "cavity", *(("symmetry_x", "symmetry_y") if self.quarter else ()))

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """The wall, and the caps."""
        walls = {"wall": self.outer_radius - self.inner_radius}
        return walls | ({"cap": self.cap} if self.cap > 0.0 else {})

    @property
    def default_size(self) -> float:
        """A third of the wall, for two elements across it."""
        return (self.outer_radius - self.inner_radius) / 3.0

    @property
    def cavity_volume(self) -> float:
        """Volume inside, of the quarter if it is one, mm³."""
        whole = math.pi * self.inner_radius**2 * (self.length - 2.0 * self.cap)
        return whole / 4.0 if self.quarter else whole

    def _check_fit(self) -> None:
        self._require(isinstance(self.quarter, bool), f"quarter = {self.quarter!r}: expected True or False")
        self._require(
            self.inner_radius < self.outer_radius,
            f"inner_radius = {self.inner_radius:g} mm leaves no wall: expected less than outer_radius = "
            f"{self.outer_radius:g} mm",
        )
        self._require(
            2.0 * self.cap < self.length,
            f"the caps overlap: cap = {self.cap:g} mm, expected less than length / 2 = {self.length / 2.0:g} mm",
        )

    def shape(self) -> occ.Shape:
        """Return the solid with named faces."""
        tube = occ.cylinder(self.outer_radius, 0.0, self.length, "outer")
        occ.name_end_faces(tube, self.axis, "clamp", "tip")
        tube = occ.cut(tube, [occ.cylinder(self.inner_radius, self.cap, self.length - self.cap, "cavity")])
        if self.quarter:
            far = 2.0 * self.outer_radius
            quadrant = occ.box((0.0, 0.0, -1.0), (far, far, self.length + 1.0))
            tube = occ.common(tube, occ.name_low_faces(quadrant, {"x": "symmetry_x", "y": "symmetry_y"}))
        return occ.check_solid(tube, 1, "ThickTube")
