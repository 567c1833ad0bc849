"""The still pictures of a report: the mesh by name, fields on the deformed shape, the row of shapes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pneumorph.mechanics import State
from pneumorph.report.compose import Bar, Picture, compose
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import Field
from pneumorph.report.render import Scene
from pneumorph.report.view import View
from pneumorph.units import show

_AREA = 620_000  # pixels of a panel
_HIGHEST = 900


def caption(state: State) -> str:
    """Return time, if it counts, and pressures or else driven values of a state as text: '0.2 s: cavity 60 kPa'."""
    clock = show(state.clock, "time", 3) if state.clock else ""
    driven = _driven(state)
    return ": ".join(part for part in (clock, driven) if part) or "at rest"


def _driven(state: State) -> str:
    pressed = {name: p for name, p in state.pressure.items() if abs(p) > 1e-12}
    if pressed:
        texts = {name: show(p, "pressure", 3) for name, p in pressed.items()}
    else:
        kinds = state.model.kinds
        texts = {name: show(v, kinds[name], 3) for name, v in state.values.items() if name in kinds and v}
    if not texts:
        return ""
    if len(set(texts.values())) == 1:
        names = f" in {len(texts)} cavities" if pressed and len(texts) > 1 else ""
        return next(iter(texts.values())) + names
    shown = [f"{name} {text}" for name, text in list(texts.items())[:2]]
    return ", ".join(shown) + (" …" if len(texts) > 2 else "")


def height_of(view: View, area: float = _AREA) -> int:
    """Return the height in pixels of a panel that shows a view."""
    return int(min(_HIGHEST, np.sqrt(area / view.aspect)))


def mesh_picture(drawing: Drawing) -> Picture:
    """Return the body at rest: mesh with faces by name; for solids also seen through, and cut."""
    with Scene(drawing.corner_view, height_of(drawing.corner_view)) as scene:
        panels = [("Mesh", scene.draw(drawing.faces()))]
        if not drawing.flat:
            largest = _largest_name(drawing)
            panels.append((f"Seen through '{largest}'", scene.draw(drawing.faces(transparent=largest))))
    if not drawing.flat:
        view = drawing.rest_cut_view
        with Scene(view, height_of(view)) as scene:
            panels.append(("Cut", scene.draw(drawing.cut_faces())))
    return compose(panels, legend=drawing.colours, columns=_columns([p for _, p in panels]))


def field_picture(drawing: Drawing, field: Field, state: State, scale: Sequence[State] | None = None) -> Picture:
    """Return a state coloured by a field, outside and cut; `scale`: the states that set the ends of the colours."""
    low, high, largest = drawing.limits(field, scale or [state])
    values, bodies = drawing.values(field, state), drawing.bodies.layers(state.values, state.positions)
    with Scene(drawing.view, height_of(drawing.view)) as scene:
        panels = [(caption(state), scene.draw([*drawing.body(state.positions, values, (low, high), field), *bodies]))]
    if not drawing.flat:
        with Scene(drawing.cut_view, height_of(drawing.cut_view)) as scene:
            layers = drawing.cut_body(state.positions, values, (low, high), field)
            panels.append(("Cut along the body", scene.draw([*layers, *bodies])))
    return compose(panels, bar=bar(field, low, high, largest), columns=_columns([p for _, p in panels]))


def shapes_picture(drawing: Drawing, field: Field, states: Sequence[State]) -> Picture:
    """Return several states side by side, on one scale of size and colour."""
    low, high, largest = drawing.limits(field, states)
    height = height_of(drawing.view, _AREA / 2)
    with Scene(drawing.view, height) as scene:
        panels = []
        for state in states:
            layers = drawing.body(state.positions, drawing.values(field, state), (low, high), field)
            bodies = drawing.bodies.layers(state.values, state.positions)
            panels.append((caption(state), scene.draw([*layers, *bodies])))
    return compose(panels, bar=bar(field, low, high, largest), columns=_columns([p for _, p in panels]))


def bar(field: Field, low: float, high: float, largest: float) -> Bar:
    """Return the colour bar of a field for ends in inside units."""
    return Bar(field.title, field.printed(low), field.printed(high), field.printed(largest), field.colour_map)


def _columns(panels: Sequence[Picture]) -> int:
    """Return how many panels stand side by side: at most 2400 pixels, rows of one length where that is possible."""
    count = len(panels)
    most = max(1, min(count, 2400 // max(p.shape[1] for p in panels)))
    rows = -(-count // most)
    return -(-count // rows)


def _largest_name(drawing: Drawing) -> str:
    """Return the face with the largest area that is no cavity."""
    skin, inside = drawing.skin, {name for cavity in drawing.states[0].model.cavities for name in cavity.faces}
    points = skin.weights @ drawing.mesh.points
    a, b, c = (points[skin.triangles[:, i]] for i in range(3))
    area = np.bincount(skin.label, np.linalg.norm(np.cross(b - a, c - a), axis=1), minlength=len(skin.names))
    for number, name in enumerate(skin.names):
        if name in inside:
            area[number] = -1.0
    return skin.names[int(np.argmax(area))]
