"""Human forearm as a tapered elliptic cylinder: what a finger massages."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, millimetres

Places = TypeVar("Places", float, NDArray[np.float64])


@dataclass(frozen=True)
class Forearm(Actuator):
    """Forearm along x from "wrist" (x = 0) to "elbow"; the axes of its ellipses grow evenly; lengths in mm.

    One solid without cavity, its round side is "skin". The source says where it is pressed, but gives no dimension: all
    others are assumed, about those of a grown man, with 161 mm around the wrist and 274 mm around the thick end.

    Raises GeometryError.

    Source of the task: 'Numerical and experimental methods for the assessment of a human finger-inspired soft pneumatic
    actuator for gripping applications' (MethodsX).
    """

    length: float = millimetres(250.0, "L", "length from wrist to elbow")
    wrist_width: float = millimetres(60.0, "Bw", "width of the wrist, along y")
    wrist_thickness: float = millimetres(42.0, "Hw", "thickness of the wrist, along z")
    elbow_width: float = millimetres(92.0, "Be", "width at the elbow, along y")
    elbow_thickness: float = millimetres(82.0, "He", "thickness at the elbow, along z")
    pressed: float = millimetres(30.0, "x", "where it is pressed, from the wrist: the mesh is finest there", given=True)

    @property
    def cavities(self) -> tuple[str, ...]:
        """None."""
        return ()

    @property
    def face_names(self) -> tuple[str, ...]:
        """wrist, elbow and skin."""
        return ("wrist", "elbow", "skin")

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """None: it is solid."""
        return {}

    @property
    def default_size(self) -> float:
        """A fifth of the thickness of the wrist."""
        return self.wrist_thickness / 5.0

    @property
    def cavity_volume(self) -> float:
        """None: 0."""
        return 0.0

    @property
    def axis(self) -> tuple[float, float, float]:
        """Along x."""
        return (1.0, 0.0, 0.0)

    def half_axes(self, x: Places) -> tuple[Places, Places]:
        """Return half the width and half the thickness, mm, of the section at x, or at several."""
        share = x / self.length
        return (
            0.5 * (self.wrist_width + share * (self.elbow_width - self.wrist_width)),
            0.5 * (self.wrist_thickness + share * (self.elbow_thickness - self.wrist_thickness)),
        )

    @property
    def volume(self) -> float:
        """Volume, mm3: the section is quadratic along x, so Simpson's rule is exact."""
        areas = [math.pi * a * b for a, b in map(self.half_axes, (0.0, 0.5 * self.length, self.length))]
        return self.length * (areas[0] + 4.0 * areas[1] + areas[2]) / 6.0

    def _check_fit(self) -> None:
        self._require(
            self.pressed <= self.length,
            f"pressed = {self.pressed:g} mm: expected at most length = {self.length:g} mm",
        )
        for end in ("wrist", "elbow"):
            width, thickness = getattr(self, f"{end}_width"), getattr(self, f"{end}_thickness")
            self._require(
                thickness <= width,
                f"{end}_thickness = {thickness:g} mm: expected at most {end}_width = {width:g} mm; turn the arm",
            )

    def shape(self) -> occ.Shape:
        """Return the solid; its faces are wrist, elbow and skin."""
        arm = occ.elliptic_loft(self.half_axes(0.0), self.half_axes(self.length), self.length, "skin")
        return occ.check_solid(occ.name_end_faces(arm, self.axis, "wrist", "elbow"), 1, "Forearm")
