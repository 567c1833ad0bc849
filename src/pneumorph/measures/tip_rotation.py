"""Tip rotation: how far the free end face has turned."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneumorph.errors import InputError
from pneumorph.measures.centre_line import centre_line
from pneumorph.measures.faces import angle_between, best_rotation, sample, unit_axis
from pneumorph.mechanics import State


@dataclass(frozen=True)
class TipRotation:
    """Angle between the reference and the deformed normal of the free end face, rad.

    The deformed normal is the reference one turned by the best rotation of the face, area-weighted, so that a face
    that bulges or bends does not disturb it. About twice the chord angle under uniform bending.

    tip:   name of the free end face; clamp: of the held one.
    axis:  without it the angle has no sign (0 to pi). With the three components of an axis it is the rotation about
           that axis, positive by the right-hand rule, and full turns count: `sections` slices of the body between clamp
           and tip tell how many there are. In the plane the axis is z.

    Raises NameNotFoundError for a face, InputError for an axis along the face's normal or a face that closes.
    """

    clamp: str = "clamp"
    tip: str = "tip"
    axis: tuple[float, float, float] | None = None
    sections: int = 24
    name: str = "tip_rotation"
    kind: str = "angle"

    def __call__(self, state: State) -> float:
        """Return the angle, rad."""
        face = sample(state, self.tip)
        if not face.normal.any():
            raise InputError(f"{self.name}: face '{self.tip}' is closed, it has no normal")
        axis = unit_axis(self.axis, state.model.mesh.dimension, self.name)
        rotation = best_rotation(face.reference, face.deformed, face.area)
        angle = angle_between(face.normal, rotation @ face.normal, axis, self.name)
        if axis is None or not state.displacement.any():
            return angle
        rotations = centre_line(state, self.clamp, self.tip, self.sections).rotations
        normals = [face.normal, *(r @ face.normal for r in rotations)]
        total = sum(angle_between(a, b, axis, self.name) for a, b in pairwise(normals))
        return angle + 2.0 * np.pi * round((total - angle) / (2.0 * np.pi))
