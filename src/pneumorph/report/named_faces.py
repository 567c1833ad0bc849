"""A picture of a mesh that nothing has been computed on yet: its named faces from two sides, and cut open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mesh.findings import CavityFound
from pneumorph.mesh.mesh import Mesh
from pneumorph.report import style
from pneumorph.report.compose import Picture
from pneumorph.report.cut import Plane, cap, cut_lines, cut_surface, rim
from pneumorph.report.labels import Anchors, anchors, key_colours, labelled
from pneumorph.report.pictures import height_of
from pneumorph.report.render import Layer, Scene
from pneumorph.report.surface import Lines, Surface, edges, outline, surface
from pneumorph.report.view import View, long_axis

Array = NDArray[np.float64]

_MOST = 60_000  # triangles
_AREA = 520_000  # pixels of a panel


def named_faces_picture(mesh: Mesh, cavities: Sequence[CavityFound]) -> Picture:
    """Return the picture of a solid mesh with the names of faces, caps and material domains on it.

    cavities: the cut goes along the body through the middle of the largest; of several, another across it.
    """
    along = long_axis(mesh)
    across = _across(mesh, along)
    front = View(_vector(across), _vector(np.abs(np.cross(along, across))))
    behind = View(_vector(-across), front.up)
    skin, sharp, net = surface(mesh, _MOST), outline(mesh), edges(mesh)
    names = [*skin.names, *mesh.caps, *(f"domain {name}" for name in mesh.domains)]
    colours = style.face_colours(names) | {f"domain {name}": style.SECTION for name in mesh.domains}
    keys = key_colours(names)
    inside = {face for cavity in cavities for face in cavity.faces if cavity.gap is None and not cavity.caps}
    shown = skin.part([name for name in skin.names if name not in inside])

    def panel(view: View, parts: Sequence[Surface], lines: Sequence[tuple[Lines, float]]) -> tuple[Picture, Anchors]:
        fitted = view.fitted([mesh.points])
        with Scene(fitted, height_of(fitted, _AREA)) as scene:
            drawn = [layer for part in parts for layer in _surface(part, mesh, colours)]
            drawn += [layer for name in mesh.caps for layer in _membrane(mesh, name, colours[name], 0.75)]
            for line, width in lines:
                drawn.append(Layer(line.weights @ mesh.points, segments=line.segments, colour=style.EDGE, width=width))
            flat = [layer for part in parts for layer in _surface(part, mesh, keys, shaded=False)]
            flat += [layer for name in mesh.caps for layer in _membrane(mesh, name, keys[name], 1.0)]
            return scene.draw(drawn), anchors(scene.draw(flat), keys)

    middle = 0.5 * (mesh.points.min(axis=0) + mesh.points.max(axis=0))
    target = max(cavities, key=lambda cavity: cavity.volume).middle if cavities else middle

    def cut(normal: Array, view: View) -> tuple[Picture, Anchors]:
        plane = Plane(_vector(middle + normal * (normal @ (target - middle))), _vector(normal))
        section = cap(mesh, plane)
        names = tuple(f"domain {name}" for name in section.names)
        parts = [cut_surface(skin, mesh, plane), Surface(section.weights, section.triangles, names, section.label)]
        return panel(view, parts, [(cut_lines(sharp, mesh, plane), 0.8), (rim(skin, mesh, plane), 1.4)])

    panels = [
        ("From one side", *panel(front.turned(), [shown], [(net, 0.4), (sharp, 1.2)])),
        ("From the other side", *panel(behind.turned(), [shown], [(net, 0.4), (sharp, 1.2)])),
        ("Cut along the body", *cut(across, front.turned(18.0, 18.0))),
    ]
    if len(cavities) > 1:  # they may lie side by side
        panels.append(("Cut across the body", *cut(along, View(_vector(along), front.up).turned(18.0, 18.0))))
    words = {name: f"{name} (cap)" for name in mesh.caps}
    return labelled(panels, colours, words)


def _across(mesh: Mesh, along: Array) -> Array:
    """Return the coordinate direction of the cut's normal: the shorter side of the body's section, -y of equal ones."""
    extent = np.ptp(mesh.points, axis=0) + 1e9 * along
    axis = min(range(3), key=lambda i: (round(float(extent[i] / mesh.size), 3), i != 1))
    return np.asarray(-np.eye(3)[axis])


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _surface(part: Surface, mesh: Mesh, colours: Mapping[str, style.Colour], shaded: bool = True) -> list[Layer]:
    if not len(part.triangles):
        return []
    table = np.array([colours[name] for name in part.names])
    lit = shaded and not part.names[0].startswith("domain ")
    # triangles of different colours must not share points
    points = (part.weights @ mesh.points)[part.triangles].reshape(-1, 3)
    if lit:
        return [Layer(part.weights @ mesh.points, part.triangles, colour=table[part.label])]
    triangles = np.arange(len(points)).reshape(-1, 3)
    return [Layer(points, triangles, colour=table[part.label], shaded=False)]


def _membrane(mesh: Mesh, name: str, colour: style.Colour, opacity: float) -> list[Layer]:
    triangles = np.concatenate([block.nodes for block in mesh.caps[name]])
    return [Layer(mesh.points, triangles, colour=colour, opacity=opacity, shaded=False)]
