"""Faces of cells: which nodes make them, which of them are boundary, and whether a set of faces closes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from pneumorph.mesh.mesh import CellBlock, FaceBlock

# kind of cell -> (kind of face, local nodes) in VTK's order, oriented outward
CELL_FACES: dict[str, tuple[tuple[str, tuple[int, ...]], ...]] = {
    "tetra10": (
        ("triangle6", (0, 1, 3, 4, 8, 7)),
        ("triangle6", (1, 2, 3, 5, 9, 8)),
        ("triangle6", (2, 0, 3, 6, 7, 9)),
        ("triangle6", (0, 2, 1, 6, 5, 4)),
    ),
    "wedge18": (
        ("triangle6", (0, 2, 1, 8, 7, 6)),
        ("triangle6", (3, 4, 5, 9, 10, 11)),
        ("quad9", (0, 1, 4, 3, 6, 13, 9, 12, 15)),
        ("quad9", (1, 2, 5, 4, 7, 14, 10, 13, 16)),
        ("quad9", (2, 0, 3, 5, 8, 12, 11, 14, 17)),
    ),
    "hexahedron27": (
        ("quad9", (0, 3, 2, 1, 11, 10, 9, 8, 24)),
        ("quad9", (4, 5, 6, 7, 12, 13, 14, 15, 25)),
        ("quad9", (0, 1, 5, 4, 8, 17, 12, 16, 22)),
        ("quad9", (1, 2, 6, 5, 9, 18, 13, 17, 21)),
        ("quad9", (2, 3, 7, 6, 10, 19, 14, 18, 23)),
        ("quad9", (3, 0, 4, 7, 11, 16, 15, 19, 20)),
    ),
    "triangle6": (("line3", (0, 1, 3)), ("line3", (1, 2, 4)), ("line3", (2, 0, 5))),
}

# kind of face or cell -> number of corners, which come first in its nodes
CORNERS = {"line3": 2, "triangle6": 3, "quad9": 4, "tetra10": 4, "wedge18": 6, "hexahedron27": 8}

Nodes = NDArray[np.int64]


def boundary(blocks: Iterable[CellBlock]) -> tuple[FaceBlock, ...]:
    """Return the faces that belong to one cell only, one block a kind, oriented outward."""
    faces: dict[str, list[Nodes]] = {}
    for block in blocks:
        for kind, local in CELL_FACES[block.kind]:
            faces.setdefault(kind, []).append(block.nodes[:, local])
    result = []
    for kind, parts in faces.items():
        nodes = np.concatenate(parts)
        keys = corner_keys(kind, nodes)
        _, inverse, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
        result.append(FaceBlock(kind, nodes[counts[inverse.ravel()] == 1]))
    return tuple(block for block in result if len(block.nodes))


def corner_keys(kind: str, nodes: Nodes) -> Nodes:
    """Return the sorted corner nodes (faces, corners) that identify faces whatever their orientation."""
    return np.sort(nodes[:, : CORNERS[kind]], axis=1)


def rows_in(rows: Nodes, others: Nodes) -> NDArray[np.bool_]:
    """Return which rows (n, k) are among others (m, k), as bool (n,)."""
    _, number = np.unique(np.concatenate([others, rows]), axis=0, return_inverse=True)
    number = number.ravel()
    return np.isin(number[len(others) :], number[: len(others)])


def compressed(
    points: NDArray[np.float64], blocks: Iterable[CellBlock], faces: Mapping[str, tuple[FaceBlock, ...]] | None = None
) -> tuple[NDArray[np.float64], tuple[CellBlock, ...], dict[str, tuple[FaceBlock, ...]]]:
    """Return points, cells and faces without the points that no cell uses."""
    cells = tuple(blocks)
    used = np.unique(np.concatenate([block.nodes.ravel() for block in cells]))
    new = np.full(len(points), -1, dtype=np.int64)
    new[used] = np.arange(len(used))
    named = {
        name: tuple(FaceBlock(block.kind, new[block.nodes]) for block in parts) for name, parts in (faces or {}).items()
    }
    return points[used], tuple(CellBlock(block.kind, block.domain, new[block.nodes]) for block in cells), named


def open_edges(faces: Iterable[FaceBlock]) -> Nodes:
    """Return the edges (k, 2), or points (k, 1) of lines, at which a set of faces does not close or crosses itself.

    A closed, consistently oriented surface passes every edge exactly once in each direction; the result is then empty.
    """
    ends: list[Nodes] = []
    for face in faces:
        corners = face.nodes[:, : CORNERS[face.kind]]
        if face.kind == "line3":
            # a closed curve leaves every point as often as it reaches it
            ends.append(np.column_stack([corners[:, 0], np.full(len(corners), -1)]))
            ends.append(np.column_stack([np.full(len(corners), -1), corners[:, 1]]))
        else:
            after = np.roll(corners, -1, axis=1)
            ends.append(np.column_stack([corners.ravel(), after.ravel()]))
    if not ends:
        return np.empty((0, 2), dtype=np.int64)
    directed = np.concatenate(ends)
    forward = directed[:, 0] < directed[:, 1]
    keys, inverse = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True)
    ahead = np.bincount(inverse.ravel()[forward], minlength=len(keys))
    back = np.bincount(inverse.ravel()[~forward], minlength=len(keys))
    bad: Nodes = keys[(ahead != 1) | (back != 1)]
    return bad[:, 1:] if (bad[:, 0] < 0).all() and len(bad) else bad
