"""Surfaces of quadratic faces as contact sees them: small linear facets on the same nodes, and points that carry force.

The force points are the nodes of a face and, in a triangle, its centre, with rules of quadrature that are exact for
cubics (Simpson's; for the triangle corners 1/20, middles 2/15, centre 9/20). A uniform pressure on them gives the nodal
forces of the finite elements, by which corners of a triangle bear nothing; and yet each node has a share of the
surface, so that none is left unprotected.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.tables import face_sizes, reference_nodes, tabulate
from pneumorph.mesh.mesh import FaceBlock, Mesh

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_SPLIT = {
    "triangle6": ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    "quad9": tuple(
        t for a, b, c, e in ((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)) for t in ((a, b, c), (a, c, e))
    ),
    "line3": ((0, 2), (2, 1)),
}
_WEIGHTS = {
    "triangle6": np.array([1 / 20] * 3 + [2 / 15] * 3 + [9 / 20]) / 2.0,  # the reference triangle has area 1/2
    "quad9": np.array([1 / 36] * 4 + [4 / 36] * 4 + [16 / 36]),
    "line3": np.array([1 / 6, 1 / 6, 4 / 6]),
}


@dataclass(frozen=True, eq=False)
class Points:
    """Force points that mix nodes: nodes (m, k), share (m, k), weight (m,): mm2 for each.

    In the plane strain of a body 1 mm thick, weight is a length times 1 mm; with axial symmetry the ring's area.
    """

    nodes: Integers
    share: Array
    weight: Array


def split(blocks: Iterable[FaceBlock]) -> Integers:
    """Return linear facets (m, d) on the same nodes: 4 triangles of a triangle6, 8 of a quad9, 2 edges of a line3."""
    return np.concatenate(
        [block.nodes[:, _SPLIT[block.kind]].reshape(-1, len(_SPLIT[block.kind][0])) for block in blocks]
    )


def force_points(mesh: Mesh, blocks: Iterable[FaceBlock], position: Array | None = None) -> list[Points]:
    """Return the force points of faces: the nodes, each once, and the centres of triangles.

    position (nodes, d), mm: of the nodes whose areas are meant, by default those of the mesh.
    """
    place = mesh.points if position is None else position
    areas = np.zeros(len(mesh.points))
    centres = []
    for block in blocks:
        places = reference_nodes(block.kind)
        if block.kind == "triangle6":
            places = np.vstack([places, [1 / 3, 1 / 3]])
        shape, gradient = tabulate(block.kind, places)
        x = place[block.nodes]
        size = face_sizes(x, gradient)
        if mesh.space == "axisymmetric":
            radius = np.einsum("qm,em->eq", shape, x[:, :, 0])
            size = size * 2.0 * np.pi * np.maximum(radius, 0.01 * radius.max(axis=1, keepdims=True))  # the axis, too
        weight = size * _WEIGHTS[block.kind]
        count = block.nodes.shape[1]
        np.add.at(areas, block.nodes, weight[:, :count])
        if block.kind == "triangle6":
            share = np.broadcast_to(shape[count], block.nodes.shape)
            centres.append(Points(block.nodes, share, weight[:, count]))
    nodes = np.flatnonzero(areas)
    return [Points(nodes[:, None], np.ones((len(nodes), 1)), areas[nodes]), *centres]


def nodal_areas(mesh: Mesh, blocks: Iterable[FaceBlock], position: Array | None = None) -> Array:
    """Return the area (nodes,) that each node bears, mm2, all positive on the faces; `position` as in `force_points`.

    It is that of the finite elements, but for the corners of a triangle: these would bear nothing, and get a share.
    """
    areas = np.zeros(len(mesh.points))
    for points in force_points(mesh, blocks, position):
        if points.nodes.shape[1] == 1:
            areas[points.nodes[:, 0]] += points.weight
        else:  # the share of the centre goes to the middles: the corners keep 1/20 of the face each
            np.add.at(areas, points.nodes[:, 3:], points.weight[:, None] / 3.0)
    return areas
