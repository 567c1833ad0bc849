"""Rigid bodies in pictures: seen through, so that they hide nothing, where the programme or their motion puts them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics import HalfSpace, State
from pneumorph.mechanics.contact.outlines import outline, rigid_bodies, way_of
from pneumorph.report import style
from pneumorph.report.render import Layer
from pneumorph.report.surface import spatial

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_MARGIN = 0.1  # of the body's size, around all its states: as far as planes, pipes and large bodies are shown
_OPACITY = 0.3
_RIM = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
_FREE_OPACITY = 0.55  # of free bodies: what is held is looked for


class RigidBodies:
    """The rigid bodies that a model touches, for the pictures of some of its states."""

    def __init__(self, states: Sequence[State]):
        mesh = states[0].model.mesh
        clouds = np.concatenate([mesh.points, *(state.positions for state in states)])
        margin = _MARGIN * mesh.size
        self._low, self._high = clouds.min(axis=0) - margin, clouds.max(axis=0) + margin
        self._bodies = list(rigid_bodies(states[0].model.contacts).values())
        self._frames = states[0].model.frames
        self._flat = mesh.dimension == 2

    def clouds(self, states: Sequence[State]) -> list[Array]:
        """Return the points (n, d) of the bodies that pictures of some states should show."""
        box = self._low, self._high
        ends = states[:: max(1, len(states) - 1)]
        driven = [
            np.clip(outline(body, *box, way_of(body, state.values))[0], *box) for state in ends for body in self._bodies
        ]
        return driven + [frame.surface(state.positions) for state in ends for frame in self._frames]

    def layers(self, values: Mapping[str, float], positions: Array) -> list[Layer]:
        """Return the bodies where the values of a programme and positions (nodes, d) of the mesh put them."""
        driven = [outline(body, self._low, self._high, way_of(body, values)) for body in self._bodies]
        free = [(frame.surface(positions), frame.facets) for frame in self._frames]
        # a plane that is seen along itself would not be seen at all without its rim
        planes = [points for body, (points, _) in zip(self._bodies, driven, strict=True) if isinstance(body, HalfSpace)]
        return [
            *(self._layer(points, facets, _OPACITY) for points, facets in driven),
            *(
                Layer(spatial(points), segments=_RIM, colour=style.OBSTACLE, width=2.0)
                for points in (() if self._flat else planes)
            ),
            *(self._layer(points, facets, _FREE_OPACITY) for points, facets in free),
        ]

    def _layer(self, points: Array, facets: Integers, opacity: float) -> Layer:
        if self._flat:
            return Layer(spatial(points), segments=facets, colour=style.OBSTACLE, width=2.5)
        return Layer(spatial(points), facets, colour=style.OBSTACLE, opacity=opacity)
