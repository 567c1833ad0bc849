"""Rigid bodies in pictures: seen through, so that they hide nothing, and moved as the programme moves them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics import State
from pneumorph.mechanics.contact.outlines import outline, rigid_bodies, way_of
from pneumorph.report import style
from pneumorph.report.render import Layer
from pneumorph.report.surface import spatial

Array = NDArray[np.float64]

_MARGIN = 0.1  # of the body's size, around all its states: as far as planes, pipes and large bodies are shown
_OPACITY = 0.3


class RigidBodies:
    """The rigid bodies that a model touches, for the pictures of some of its states."""

    def __init__(self, states: Sequence[State]):
        mesh = states[0].model.mesh
        clouds = np.concatenate([mesh.points, *(state.positions for state in states)])
        margin = _MARGIN * mesh.size
        self._low, self._high = clouds.min(axis=0) - margin, clouds.max(axis=0) + margin
        self._bodies = list(rigid_bodies(states[0].model.contacts).values())
        self._flat = mesh.dimension == 2

    def clouds(self, states: Sequence[State]) -> list[Array]:
        """Return the points (n, d) of the bodies that pictures of some states should show."""
        box = self._low, self._high
        ends = states[:: max(1, len(states) - 1)]
        return [
            np.clip(outline(body, *box, way_of(body, state.values))[0], *box) for state in ends for body in self._bodies
        ]

    def layers(self, values: Mapping[str, float]) -> list[Layer]:
        """Return the bodies where the values of a programme put them."""
        result = []
        for body in self._bodies:
            points, facets = outline(body, self._low, self._high, way_of(body, values))
            place, colour = spatial(points), style.OBSTACLE
            result.append(
                Layer(place, segments=facets, colour=colour, width=2.5)
                if self._flat
                else Layer(place, facets, colour=colour, opacity=_OPACITY)
            )
        return result
