"""Curvature of the centre line, or of a material line, by a circle fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneumorph.errors import InputError
from pneumorph.measures.centre_line import centre_line
from pneumorph.measures.circle import Circle, fit_circle
from pneumorph.measures.faces import unit_axis
from pneumorph.measures.locate import locate
from pneumorph.mechanics import State


@dataclass(frozen=True)
class Curvature:
    """Curvature of the circle nearest to a deformed line, 1/mm; 0 for a straight one.

    clamp, tip: names of the end faces. The line is the straight one between their centres, carried by the rigid motion
                of `sections` slices (see `centre_line`), or
    line:       a straight line in the reference given by its two end points inside the body, mm, at `sections` points.
    axis:       without it the curvature has no sign; with it, it is positive where the line turns about the axis by
                the right-hand rule on the way from the clamp to the tip. In the plane the axis is z.

    Raises NameNotFoundError for a face, InputError for fewer than three sections or a line that leaves the body.
    """

    clamp: str = "clamp"
    tip: str = "tip"
    line: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    axis: tuple[float, float, float] | None = None
    sections: int = 16
    name: str = "curvature"
    kind: str = "curvature"

    def __post_init__(self) -> None:
        if self.sections < 3:
            raise InputError(f"{self.name}: sections = {self.sections}, allowed: 3 or more")

    def fit(self, state: State) -> Circle:
        """Return the circle with its residual."""
        if self.line is None:
            return fit_circle(centre_line(state, self.clamp, self.tip, self.sections).points)
        first, last = (np.asarray(end, dtype=float) for end in self.line)
        places = first + np.linspace(0.0, 1.0, self.sections)[:, None] * (last - first)
        return fit_circle(locate(state.model.mesh, places).interpolate(state.positions))

    def __call__(self, state: State) -> float:
        """Return the curvature, 1/mm."""
        circle = self.fit(state)
        axis = unit_axis(self.axis, state.model.mesh.dimension, self.name)
        sign = 1.0 if axis is None or axis @ circle.normal >= 0.0 else -1.0
        return sign * circle.curvature


@dataclass(frozen=True)
class CurvatureResidual:
    """Root mean square distance of the line of a `Curvature` from its circle, mm: how uniform the bending is."""

    curvature: Curvature = Curvature()
    name: str = "curvature_residual"
    kind: str = "length"

    def __call__(self, state: State) -> float:
        """Return the residual, mm."""
        return self.curvature.fit(state).residual
