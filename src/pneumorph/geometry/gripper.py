"""Gripper: fingers that hang from a holder around an axis and curl inwards."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import GeometryError
from pneumorph.geometry.actuator import angle, millimetres, whole_number
from pneumorph.geometry.finger import Finger
from pneumorph.geometry.occ import Shape

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Gripper(Finger):
    """Fingers at equal angles about the z axis, hanging down from a holder at z = 0; each has a finger's dimensions.

    Their bases face the axis, so that they curl inwards when they are inflated. The holder is no part of the body: it
    is the face "clamp" of all fingers. Finger 1 lies at x > 0, the others follow anticlockwise seen from above; finger
    n has the faces tip_n, outer_n and cavity_n. It is meshed in hexahedra (see `mesh.gripper`) and has no CAD solid.

    palm_radius: from the axis to the bases of the fingers at the holder.
    tilt: by which the fingers spread outwards, between -45 and 45 degrees.
    half: finger 1 alone and of it the part with y >= 0, cut in its plane of symmetry.

    Source: the same study; it lifts a small cup with three fingers and gives no dimension. Raises GeometryError.
    """

    fingers: int = whole_number(3, "n", "fingers", given=True)
    palm_radius: float = millimetres(36.0, "Rp", "from the axis to the bases of the fingers")
    tilt: float = angle(0.0, "tau", "angle by which the fingers spread outwards")
    half: bool = field(default=False, metadata={"help": "half of finger 1 only, cut in its plane of symmetry"})

    @property
    def finger(self) -> Finger:
        """One of the fingers, in its own axes."""
        return Finger(**{item.name: getattr(self, item.name) for item in fields(Finger)})

    @property
    def angles(self) -> tuple[float, ...]:
        """Where the fingers stand about z, rad; of a half the first alone."""
        count = 1 if self.half else self.fingers
        return tuple(2.0 * math.pi * number / self.fingers for number in range(count))

    @property
    def cavities(self) -> tuple[str, ...]:
        """cavity_1 and so on."""
        return tuple(f"cavity_{n}" for n in range(1, len(self.angles) + 1))

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tips, outsides, cavities, and symmetry_y of a half."""
        own = [f"{name}_{n}" for name in ("tip", "outer") for n in range(1, len(self.angles) + 1)]
        return ("clamp", *own, *self.cavities, *(("symmetry_y",) if self.half else ()))

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """None: the grid has one quadratic cell through each wall, of whatever thickness."""
        return {}

    @property
    def default_size(self) -> float:
        """Three times the thickness of a wall."""
        return 3.0 * self.wall

    @property
    def axis(self) -> tuple[float, float, float]:
        """Downwards."""
        return (0.0, 0.0, -1.0)

    @property
    def cavity_volume(self) -> float:
        """Air in one finger, or its half, mm³."""
        return self.finger.cavity_volume / (2.0 if self.half else 1.0)

    def place(self, points: Array, turn: float) -> Array:
        """Return points (n, 3), mm, of a finger in its own axes as they stand in the gripper at an angle (rad) about z.

        Its length shows down, its height outwards.
        """
        out = np.array([math.cos(turn), math.sin(turn), 0.0])
        up = np.array([0.0, 0.0, 1.0])
        along = math.sin(self.tilt) * out - math.cos(self.tilt) * up
        high = math.cos(self.tilt) * out + math.sin(self.tilt) * up
        result: Array = self.palm_radius * out + points @ np.stack([along, np.cross(up, out), high])
        return result

    def _check_fit(self) -> None:
        super()._check_fit()
        self._require(isinstance(self.half, bool), f"half = {self.half!r}: expected True or False")
        self._require(
            abs(self.tilt) <= math.pi / 4.0,
            f"tilt = {math.degrees(self.tilt):g} deg: expected -45 to 45 deg",
        )
        self._require(self.fingers >= 2, f"fingers = {self.fingers}: expected 2 or more, that one can press on another")
        # the inner edges of neighbours at the holder
        room = 2.0 * self.palm_radius * math.tan(math.pi / self.fingers) if self.fingers > 2 else math.inf
        self._require(
            room > self.width,
            f"the fingers overlap at the holder: palm_radius = {self.palm_radius:g} mm leaves {room:.4g} mm for each "
            f"of {self.fingers}, expected more than width = {self.width:g} mm",
        )

    def shape(self) -> Shape:
        """Raise GeometryError: there is no solid."""
        raise GeometryError("Gripper: it has no CAD solid: export one finger, or the mesh of the gripper")
