"""Chord angle: how far the line from the clamped to the free end has turned."""

from __future__ import annotations

from dataclasses import dataclass

from pneumorph.measures.centre_line import axis_of
from pneumorph.measures.faces import angle_between, sample, unit_axis
from pneumorph.mechanics import State


@dataclass(frozen=True)
class ChordAngle:
    """Angle between the reference and the deformed line from the centre of the clamp to the centre of the tip, rad.

    clamp, tip: names of the faces. axis: gives the angle its sign, as for `TipRotation`.
    Raises NameNotFoundError for a face, InputError for an axis along the chord or ends that coincide.
    """

    clamp: str = "clamp"
    tip: str = "tip"
    axis: tuple[float, float, float] | None = None
    name: str = "chord_angle"
    kind: str = "angle"

    def __call__(self, state: State) -> float:
        """Return the angle, rad."""
        _, chord = axis_of(state, self.clamp, self.tip)
        deformed = sample(state, self.tip).moved_centre - sample(state, self.clamp).moved_centre
        axis = unit_axis(self.axis, state.model.mesh.dimension, self.name)
        return angle_between(chord, deformed, axis, self.name)
