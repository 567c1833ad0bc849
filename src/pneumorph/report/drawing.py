"""A body made ready to be drawn in any state: surface, outline, and the half that a cut leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mechanics import State
from pneumorph.mesh.mesh import Mesh
from pneumorph.report import style
from pneumorph.report.bodies import RigidBodies
from pneumorph.report.cut import Plane, cap, cut_lines, cut_surface, rim
from pneumorph.report.fields import Field
from pneumorph.report.render import Layer
from pneumorph.report.surface import Lines, Surface, edges, face_lines, outline, spatial, surface
from pneumorph.report.view import View, cut_plane, face_on

Array = NDArray[np.float64]
Limits = tuple[float, float]


class Drawing:
    """The drawable parts of a run's body, with one camera for all its states.

    states: those that must fit into the pictures (at least one). most: triangles to aim at for the surface.
    Bodies with axial symmetry are drawn as their whole section through the axis.
    """

    def __init__(self, states: Sequence[State], most: int = 60_000):
        self._most = most
        self.states = states
        self.mesh: Mesh = states[0].model.mesh
        self.flat = self.mesh.dimension == 2
        self._values: dict[tuple[str, int], Array] = {}
        self._signs = (1.0, -1.0) if self.mesh.space == "axisymmetric" else (1.0,)

    @cached_property
    def view(self) -> View:
        """The camera that sees the bending plane face-on."""
        view = face_on(self.states)
        if bodies := self.bodies.clouds(self.states):
            view = view.fitted([self.mesh.points, *(state.positions for state in self.states), *bodies])
        return view.fitted(self._clouds(self.states)) if len(self._signs) > 1 else view

    @cached_property
    def bodies(self) -> RigidBodies:
        """What the body may touch."""
        return RigidBodies(self.states)

    @cached_property
    def _cut(self) -> tuple[Plane, View]:
        return cut_plane(self.states, self.view)

    @property
    def cut_view(self) -> View:
        """The camera that sees the cut face-on."""
        return self._cut[1]

    @cached_property
    def rest_cut_view(self) -> View:
        """The camera that sees the cut of the body at rest face-on."""
        return self.cut_view.fitted([self.mesh.points])

    @cached_property
    def corner_view(self) -> View:
        """The camera that sees the body at rest from the side and above."""
        if self.flat:
            return self.view.fitted(self.mesh.points * np.array([sign, 1.0]) for sign in self._signs)
        return self.view.turned().fitted([self.mesh.points])

    @cached_property
    def skin(self) -> Surface:
        """The whole surface."""
        return surface(self.mesh, self._most)

    @cached_property
    def _outside(self) -> Surface:
        """The surface without the cavities that close inside the body, which nobody sees from outside."""
        cavities = self.states[0].model.cavities
        hidden = {name for cavity in cavities if not cavity.mirrors for name in cavity.faces}
        return self.skin if self.flat else self.skin.part([name for name in self.skin.names if name not in hidden])

    @cached_property
    def colours(self) -> dict[str, style.Colour]:
        """Names of faces, and of the domains of a flat mesh, with their colours."""
        if not self.flat:
            return style.face_colours(self.skin.names)
        domains = dict(zip(self.skin.names, style.DOMAINS * len(self.skin.names), strict=False))
        return style.face_colours([name for name in self.mesh.faces if name not in domains]) | domains

    @cached_property
    def _outline(self) -> Lines:
        return outline(self.mesh)

    @cached_property
    def _contour(self) -> Lines:
        """The outline without that of the cavities."""
        return outline(self.mesh, {name for cavity in self.states[0].model.cavities for name in cavity.faces})

    @cached_property
    def _half(self) -> tuple[Surface, Surface, Lines, Lines]:
        plane = self._cut[0]
        return (
            cut_surface(self.skin, self.mesh, plane), cap(self.mesh, plane), cut_lines(self._outline, self.mesh, plane),
            rim(self.skin, self.mesh, plane),
        )  # fmt: skip

    def faces(self, transparent: str | None = None) -> list[Layer]:
        """Return the body at rest with its named faces in colours and its edges; one name may be transparent."""
        colours = self.colours
        table = np.array([colours[name] for name in self.skin.names])
        x = self.mesh.points
        solid = [name for name in self.skin.names if name != transparent]
        part = self._outside if transparent is None else self.skin.part(solid)
        layers = self._surface(part, x, table[part.label])
        if transparent is not None:
            ghost = self.skin.part([transparent])
            layers += self._surface(ghost, x, table[ghost.label], opacity=0.22)
            layers += self._lines(self._outline, x, style.EDGE, 0.9, 0.6)
        else:
            layers += self._lines(edges(self.mesh), x, style.EDGE, 0.5, 0.45)
            layers += self._lines(self._outline, x, style.EDGE, 1.2)
        for name in self.mesh.faces if self.flat else ():
            layers += self._lines(face_lines(self.mesh, name), x, colours[name], 5.0)
        return layers

    def cut_faces(self) -> list[Layer]:
        """Return the half of the body at rest, its named faces in colours."""
        half, section, lines, border = self._half
        colours = style.face_colours(half.names)
        table, x = np.array([colours[name] for name in half.names]), self.mesh.points
        layers = self._surface(half, x, table[half.label])
        layers += self._surface(section, x, np.array(style.SECTION)[None].repeat(len(section.triangles), 0), lit=False)
        return layers + self._lines(lines, x, style.EDGE, 0.8) + self._lines(border, x, style.EDGE, 1.2)

    def body(self, positions: Array, values: Array, limits: Limits, field: Field) -> list[Layer]:
        """Return the deformed body coloured by nodal values (nodes,), over the outline of the body at rest."""
        layers = self._ghost(self.view)
        layers += self._surface(
            self._outside, positions, style.coloured(self._outside.weights @ values, limits, field.colour_map)
        )
        return layers + self._lines(self._contour, positions, style.EDGE, 1.0)

    def cut_body(self, positions: Array, values: Array, limits: Limits, field: Field) -> list[Layer]:
        """Return the deformed half of the body coloured by nodal values (nodes,)."""
        half, section, lines, border = self._half
        layers = self._ghost(self.cut_view)
        layers += self._surface(half, positions, style.coloured(half.weights @ values, limits, field.colour_map))
        tinted = style.coloured(section.weights @ values, limits, field.colour_map)
        layers += self._surface(section, positions, tinted, lit=False)
        return layers + self._lines(lines, positions, style.EDGE, 0.7) + self._lines(border, positions, style.EDGE, 1.2)

    def values(self, field: Field, state: State) -> Array:
        """Return the nodal values (nodes,) of a field, kept for the next picture."""
        key = (field.key, state.index)
        if key not in self._values:
            self._values[key] = field.values(state)
        return self._values[key]

    def limits(self, field: Field, states: Sequence[State]) -> tuple[float, float, float]:
        """Return the ends of a field's colour scale for some states and its largest value there, in inside units."""
        return field.limits([self.values(field, state) for state in states])

    def _ghost(self, view: View) -> list[Layer]:
        """Return the outline of the body at rest, behind everything: no line of it runs across the body."""
        behind = 2.0 * max(view.width, view.height) * np.array(view.direction)
        lines = self._lines(self._contour, self.mesh.points, style.GHOST, 0.9)
        return [replace(layer, points=layer.points - behind) for layer in lines]

    def _clouds(self, states: Sequence[State]) -> list[Array]:
        mirror = np.array([-1.0, 1.0])
        return [points for state in states for points in (state.positions, state.positions * mirror)]

    def _place(self, weights: sparse.csr_matrix, positions: Array, sign: float) -> Array:
        points = spatial(weights @ positions)
        points[:, 0] *= sign
        return points

    def _surface(
        self, part: Surface, positions: Array, colour: Array, opacity: float = 1.0, lit: bool = True
    ) -> list[Layer]:
        return [
            Layer(
                self._place(part.weights, positions, sign), part.triangles, colour=colour, opacity=opacity,
                shaded=lit and not self.flat,
            )
            for sign in self._signs
        ]  # fmt: skip

    def _lines(
        self, lines: Lines, positions: Array, colour: style.Colour, width: float, opacity: float = 1.0
    ) -> list[Layer]:
        return [
            Layer(
                self._place(lines.weights, positions, sign), segments=lines.segments, colour=colour, width=width,
                opacity=opacity,
            )
            for sign in self._signs
        ]  # fmt: skip
