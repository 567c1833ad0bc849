"""Thick-walled sphere under internal pressure: a check against closed forms."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres

_PLANES = {"x": "symmetry_x", "y": "symmetry_y", "z": "symmetry_z"}


@dataclass(frozen=True)
class ThickSphere(Actuator):
    """Hollow sphere about the origin, without clamp or tip; lengths in mm.

    `octant` keeps x, y, z >= 0 with the cut faces "symmetry_x", "symmetry_y" and "symmetry_z". All defaults are
    assumed. Raises GeometryError.
    """

    inner_radius: float = millimetres(10.0, "A", "inner radius")
    outer_radius: float = millimetres(15.0, "B", "outer radius")
    octant: bool = field(
        default=False, metadata={"help": "keep the part with x, y, z >= 0 only, cut in planes of symmetry"}
    )

    @property
    def cavities(self) -> tuple[str, ...]:
        """The one cavity."""
        return ("cavity",)

    @property
    def face_names(self) -> tuple[str, ...]:
        """outer, cavity and the symmetry planes of an octant."""
        return ("outer", "cavity", *(_PLANES.values() if self.octant else ()))

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """The wall."""
        return {"wall": self.outer_radius - self.inner_radius}

    @property
    def default_size(self) -> float:
        """A third of the wall, for two elements across it."""
        return (self.outer_radius - self.inner_radius) / 3.0

    @property
    def cavity_volume(self) -> float:
        """Volume inside, of the octant if it is one, mm³."""
        return 4.0 / 3.0 * math.pi * self.inner_radius**3 / (8.0 if self.octant else 1.0)

    def _check_fit(self) -> None:
        self._require(isinstance(self.octant, bool), f"octant = {self.octant!r}: expected True or False")
        self._require(
            self.inner_radius < self.outer_radius,
            f"inner_radius = {self.inner_radius:g} mm leaves no wall: expected less than outer_radius = "
            f"{self.outer_radius:g} mm",
        )

    def shape(self) -> occ.Shape:
        """Return the solid with named faces."""
        ball = occ.cut(occ.sphere(self.outer_radius, "outer"), [occ.sphere(self.inner_radius, "cavity")])
        if self.octant:
            far = 2.0 * self.outer_radius
            ball = occ.common(ball, occ.name_low_faces(occ.box((0.0, 0.0, 0.0), (far, far, far)), _PLANES))
        return occ.check_solid(ball, 1, "ThickSphere")
