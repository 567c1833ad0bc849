"""Maps on one part of several: how far its surface has moved, and the contact pressure on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pneumorph.measures import contact_pressure
from pneumorph.mechanics import State
from pneumorph.report import style
from pneumorph.report.compose import Picture, compose
from pneumorph.report.fields import CONTACT_PRESSURE, FIELDS, Field
from pneumorph.report.pictures import bar, caption, height_of
from pneumorph.report.render import Layer, Scene
from pneumorph.report.surface import Lines, Surface, normals, outline, surface
from pneumorph.report.view import View
from pneumorph.solution import Solution

Array = NDArray[np.float64]

_MOST = 60_000  # triangles
_AREA = 520_000  # pixels of a panel
_AROUND = 15.0  # mm that the near view shows around the contact


def part_names(solution: Solution) -> tuple[str, ...]:
    """Return the parts of the study that a run keeps; none where it has one body, or lies in the plane."""
    study = solution.about.get("study")
    if not isinstance(study, dict) or solution.model.mesh.dimension == 2:
        return ()
    return tuple(study.get("part", {}))


def touched_most(solution: Solution) -> State | None:
    """Return the last of the states with the largest contact pressure of all, None where nothing touches."""
    keys = [f"contact_pressure:{contact.name}" for contact in solution.model.contacts]
    if not keys:
        return None
    largest = np.max([solution.history.values(key) for key in keys], axis=0)
    return solution.states[int(np.flatnonzero(largest == largest.max())[-1])] if largest.max() > 0.0 else None


class PartMap:
    """One part of a run, ready to be drawn in a state; `before`: the state from which its displacement counts."""

    def __init__(self, solution: Solution, part: str):
        mesh = solution.model.mesh
        self.part, self.mesh = part, mesh
        inside = {name for cavity in solution.model.cavities if not cavity.mirrors for name in cavity.faces}
        self.faces = [name for name in mesh.faces if name.startswith(f"{part}.") and name not in inside]
        self.nodes = np.unique(np.concatenate([mesh.face_nodes(name) for name in self.faces]))
        self.skin: Surface = surface(mesh, _MOST).part(self.faces)
        others = {name for name in mesh.faces if name not in self.faces}
        self.lines: Lines = outline(mesh, others)
        phases = list(solution.history.values("phase"))
        hanging = [row for row, phase in enumerate(phases) if phase == "gravity"]
        self.before = solution.states[hanging[-1] if hanging else 0]

    def displacement(self, state: State) -> Array:
        """Return how far nodes have moved since `before` (nodes,), mm."""
        return np.asarray(np.linalg.norm(state.displacement - self.before.displacement, axis=1))

    def picture(self, field: Field, values: Array, state: State) -> Picture:
        """Return the part, whole and near the contact, coloured by nodal values (nodes,) in inside units."""
        low, high, largest = replace(field, share=1.0).limits([values[self.nodes]])
        far, near = self._views(state)
        colour = style.coloured(np.clip(self.skin.weights @ values, low, None), (low, high), field.colour_map)
        panels = []
        for name, view in ((f"{self.part}, {caption(state)}", far), ("Where it is touched", near)):
            if view is None:
                continue
            with Scene(view, height_of(view, _AREA)) as scene:
                panels.append((name, scene.draw(self._layers(state, colour, near=view is near))))
        return compose(panels, bar=bar(field, low, high, largest))

    def _layers(self, state: State, colour: Array, near: bool) -> list[Layer]:
        place = state.positions
        skin = Layer(self.skin.weights @ place, self.skin.triangles, colour=colour, shaded=not near)
        return [skin, Layer(self.lines.weights @ place, segments=self.lines.segments, colour=style.EDGE, width=1.0)]

    def _views(self, state: State) -> tuple[View, View | None]:
        """Return the view from where the part is pressed, and the same nearer; from above where nothing presses it."""
        points = state.positions[self.nodes]
        along = np.eye(3)[int(np.argmax(np.ptp(points, axis=0)))]
        pressure = contact_pressure(state)
        pressed = self.nodes[pressure[self.nodes] > 0.01 * pressure[self.nodes].max(initial=0.0)]
        direction = np.array([0.0, 0.0, 1.0])
        if len(pressed):
            place = self.skin.weights @ state.positions
            weight = np.maximum(self.skin.weights @ pressure, 0.0) ** 2  # to see the highest pressure, face-on
            direction = weight @ normals(place, self.skin.triangles)
        direction = direction - along * (along @ direction)
        direction /= np.linalg.norm(direction)
        view = View(_vector(direction), _vector(np.cross(direction, along)))
        # a little from the side and above, so that the shape shows
        far = view.turned(20.0, 15.0).fitted([points])
        if not len(pressed):
            return far, None
        box = state.positions[pressed]
        ways = [sign * _AROUND * way for way in (view.right, np.array(view.up)) for sign in (-1.0, 1.0)]
        return far, view.fitted([box + way for way in ways])


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def part_pictures(solution: Solution) -> list[tuple[str, str, Picture]]:
    """Return (name of the file, caption, picture) of the maps of every part; raises EngineError as `render` does."""
    result = []
    touched = touched_most(solution)
    for part in part_names(solution):
        drawn, last = PartMap(solution, part), solution.states[-1]
        if touched is not None and not contact_pressure(last)[drawn.nodes].any():  # let go again
            last = touched
        since = "the phase 'gravity'" if drawn.before.index else "rest"
        text = f"Displacement of '{part}' since {since}, on its shape in state {last.index}, at {caption(last)}."
        result.append((f"{part}-displacement", text, drawn.picture(FIELDS[0], drawn.displacement(last), last)))
        pressure = contact_pressure(last)
        if pressure[drawn.nodes].any():
            text = f"Contact pressure on '{part}', nodal force over the area it bears, in state {last.index}, at "
            result.append(
                (f"{part}-contact-pressure", f"{text}{caption(last)}.", drawn.picture(CONTACT_PRESSURE, pressure, last))
            )
    return result
