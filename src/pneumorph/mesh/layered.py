"""Extrude a flat mesh of triangles through layers of material, and roll it if wanted: 18-node wedges."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.reference import jacobians

Array = NDArray[np.float64]

# of a wedge between the planes k, k + 1, k + 2 of nodes: (plane, node of the flat triangle6) in VTK's order
_WEDGE = [(0, 0), (0, 1), (0, 2), (2, 0), (2, 1), (2, 2), (0, 3), (0, 4), (0, 5), (2, 3), (2, 4), (2, 5)]
_WEDGE += [(1, 0), (1, 1), (1, 2), (1, 3), (1, 4), (1, 5)]
# of a hexahedron: (plane, node of the flat quad9); corners, mids below, above and between, centres of faces, centre
_HEXAHEDRON = [(plane, node) for plane in (0, 2) for node in range(4)]
_HEXAHEDRON += [(plane, node) for plane in (0, 2) for node in range(4, 8)] + [(1, node) for node in range(4)]
_HEXAHEDRON += [(1, 7), (1, 5), (1, 4), (1, 6), (0, 8), (2, 8), (1, 8)]
# of the quadrilateral above a line3 (ends 0 and 1, middle 2), outward if the flat mesh lies on the left of the line
_QUAD = [(0, 0), (0, 1), (2, 1), (2, 0), (0, 2), (1, 1), (2, 2), (1, 0), (1, 2)]


def extrude(
    sheet: Mesh,
    layers: Sequence[tuple[float, str]],
    mapping: Callable[[Array], Array] | None = None,
    *,
    bending_walls: Mapping[str, float] | None = None,
) -> Mesh:
    """Return the wedge18 mesh of a flat triangle6 mesh extruded along z through layers.

    sheet: mesh in two dimensions (mm); its face names become the names of the sides. Its domains are not used.
    layers: (thickness in mm, material domain) from bottom (z = 0) to top; every entry is one cell thick.
    mapping: takes all points (n, 3) to where they shall be, such as `rolled(radius)`; it must keep the orientation.

    Faces: bottom, top (triangle6) and the sheet's names (quad9). Raises MeshError for a sheet that is not flat, a bad
    layer, a clash of names, or a mapping that turns cells over.
    """
    if sheet.dimension != 2:
        raise MeshError("extrude: expected a flat mesh with points (n, 2)")
    if clash := {"bottom", "top"} & set(sheet.faces):
        raise MeshError(f"extrude: the flat mesh already has a face named {', '.join(sorted(clash))}: rename it first")
    heights = _heights(layers)
    count = len(sheet.points)
    points = np.column_stack([np.tile(sheet.points, (len(heights), 1)), np.repeat(heights, count)])
    flat = np.concatenate([block.nodes for block in sheet.blocks])
    cells: dict[str, list[NDArray[np.int64]]] = {}
    for i, (_, domain) in enumerate(layers):
        cells.setdefault(domain, []).append(_lift(flat, _WEDGE, 2 * i, count))
    faces: dict[str, tuple[FaceBlock, ...]] = {
        "bottom": (FaceBlock("triangle6", flat[:, [0, 2, 1, 5, 4, 3]]),),
        "top": (FaceBlock("triangle6", flat + 2 * len(layers) * count),),
    }
    for name, lines in sheet.faces.items():
        line = np.concatenate([block.nodes for block in lines])
        faces[name] = (
            FaceBlock("quad9", np.concatenate([_lift(line, _QUAD, 2 * i, count) for i in range(len(layers))])),
        )
    if mapping is not None:
        points = np.asarray(mapping(points), dtype=np.float64)
    blocks = tuple(CellBlock("wedge18", domain, np.concatenate(parts)) for domain, parts in cells.items())
    if not all((jacobians(points, "wedge18", block.nodes) > 0.0).all() for block in blocks):
        raise MeshError("extrude: the mapping turns cells over: det J is not positive everywhere")
    return Mesh(points, blocks, MappingProxyType(faces), "3d", dict(bending_walls or {}))


def rolled(radius: float) -> Callable[[Array], Array]:
    """Return the mapping that rolls a sheet around the y axis; `radius` in mm.

    x becomes the length of the arc at z = 0, z the height above the radius.

    Raises MeshError for a radius that is not positive.
    """
    if not math.isfinite(radius) or radius <= 0.0:
        raise MeshError(f"rolled: radius = {radius!r}: expected a finite length in mm greater than 0")

    def mapping(points: Array) -> Array:
        angle, distance = points[:, 0] / radius, radius + points[:, 2]
        return np.column_stack([distance * np.sin(angle), points[:, 1], distance * np.cos(angle)])

    return mapping


def lifted(kind: str, flat: NDArray[np.int64], plane: int, count: int) -> NDArray[np.int64]:
    """Return the nodes of one layer of cells on flat cells: wedge18 on triangle6, hexahedron27 on quad9.

    flat: nodes (k, 6) or (k, 9), anticlockwise. plane: of nodes, below the layer; it ends two planes higher.
    count: nodes in a plane; node i of plane p has the number p * count + i.
    """
    return _lift(flat, {"triangle6": _WEDGE, "quad9": _HEXAHEDRON}[kind], plane, count)


def _heights(layers: Sequence[tuple[float, str]]) -> Array:
    """Return the heights of the planes of nodes, two a layer and the ground."""
    if not layers:
        raise MeshError("extrude: expected at least one layer (thickness, domain)")
    heights = [0.0]
    for thickness, domain in layers:
        if not math.isfinite(thickness) or thickness <= 0.0:
            raise MeshError(
                f"extrude: layer '{domain}' of thickness {thickness!r}: expected a length in mm greater than 0"
            )
        heights += [heights[-1] + thickness / 2.0, heights[-1] + thickness]
    return np.array(heights)


def _lift(flat: NDArray[np.int64], pattern: list[tuple[int, int]], plane: int, count: int) -> NDArray[np.int64]:
    return np.stack([flat[:, node] + (plane + up) * count for up, node in pattern], axis=1)
