"""How a slender body bends in its middle, and how long its centre line is: what a piece of a longer one does."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pneumorph.errors import InputError
from pneumorph.measures.centre_line import axis_of, centre_line
from pneumorph.measures.faces import angle_between, unit_axis
from pneumorph.mechanics import State


@dataclass(frozen=True)
class TurnRate:
    """Angle by which the sections of the middle half turn, per reference length, rad/mm.

    The slope of the line through the turns of the sections between a quarter and three quarters of the way from clamp
    to tip, so that the ends, which caps keep from swelling, have no part in it. axis: gives it a sign, as for
    `TipRotation`. In the plane the axis is z.

    Raises NameNotFoundError for a face, InputError for fewer than three sections in the middle half.
    """

    clamp: str = "clamp"
    tip: str = "tip"
    axis: tuple[float, float, float] | None = None
    sections: int = 24
    name: str = "turn_rate"
    kind: str = "curvature"

    def __call__(self, state: State) -> float:
        """Return the rate, rad/mm."""
        line = centre_line(state, self.clamp, self.tip, self.sections)
        _, chord = axis_of(state, self.clamp, self.tip)
        axis = unit_axis(self.axis, state.model.mesh.dimension, self.name)
        inside = (line.station > 0.25) & (line.station < 0.75)
        if inside.sum() < 3:
            raise InputError(f"{self.name}: {inside.sum()} sections in the middle half, expected 3 or more")
        normals = [rotation @ chord for rotation in line.rotations[inside]]
        turns = np.cumsum([0.0, *(angle_between(a, b, axis, self.name) for a, b in pairwise(normals))])
        return float(np.polyfit(line.station[inside] * np.linalg.norm(chord), turns, 1)[0])


@dataclass(frozen=True)
class LineLength:
    """Length of the deformed centre line from clamp to tip, mm: chords between the centres of `sections` slices.

    Raises NameNotFoundError for a face, InputError for fewer than three sections.
    """

    clamp: str = "clamp"
    tip: str = "tip"
    sections: int = 24
    name: str = "line_length"
    kind: str = "length"

    def __call__(self, state: State) -> float:
        """Return the length, mm."""
        line = centre_line(state, self.clamp, self.tip, self.sections)
        between = float(np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum())
        # half a slice beyond the centres of the first and the last
        return between / float(line.station[-1] - line.station[0])
