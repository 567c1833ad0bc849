"""What pictures are made of: triangles and lines of a mesh, as fixed weights of its nodes.

Quadratic faces are subdivided. Because a point of the drawing is the same material point in every state, a deformed
picture is one sparse product with the nodes' positions, and so is any nodal field on it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.mechanics.tables import reference_nodes, tabulate
from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.mesh.topology import boundary, corner_keys

Array = NDArray[np.float64]
Index = NDArray[np.int64]

UNNAMED = "unnamed"
_SHARP = np.cos(np.radians(30.0))  # faces that meet at a larger angle get a line between them

# local edges (end, end, middle) of the kinds that are drawn
EDGES: dict[str, tuple[tuple[int, int, int], ...]] = {
    "triangle6": ((0, 1, 3), (1, 2, 4), (2, 0, 5)),
    "quad9": ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)),
    "line3": ((0, 1, 2),),
}


@dataclass(frozen=True, eq=False)
class Lines:
    """Line segments: weights (points, nodes), segments (s, 2) into the points."""

    weights: sparse.csr_matrix
    segments: Index


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles: weights (points, nodes), triangles (t, 3) into the points, names and label (t,) into the names."""

    weights: sparse.csr_matrix
    triangles: Index
    names: tuple[str, ...]
    label: Index

    def part(self, names: Sequence[str]) -> Surface:
        """Return the triangles that have one of these names."""
        wanted = np.isin(self.label, [self.names.index(name) for name in names if name in self.names])
        used, inverse = np.unique(self.triangles[wanted], return_inverse=True)
        return Surface(self.weights[used], inverse.reshape(-1, 3), self.names, self.label[wanted])


def surface(mesh: Mesh, most: int = 60_000) -> Surface:
    """Return the boundary of a solid by face name, or the cells of a flat mesh by material domain.

    most: triangles to aim at; faces are divided into 16 to 4 triangles, or drawn flat where even these are too many.
    """
    blocks = named_blocks(mesh)
    return _joined(len(mesh.points), blocks, _level(sum(len(block.nodes) for _, block in blocks), most))


def named_blocks(mesh: Mesh) -> list[tuple[str, FaceBlock]]:
    """Return (name, faces) of everything that is drawn as a surface; faces without a name are called 'unnamed'."""
    if mesh.dimension == 2:
        return [(block.domain, FaceBlock(block.kind, block.nodes)) for block in mesh.blocks]
    result = [(name, block) for name, blocks in mesh.faces.items() for block in blocks]
    for skin in boundary(mesh.blocks):
        named = [corner_keys(block.kind, block.nodes) for _, block in result if block.kind == skin.kind]
        everything = np.concatenate([*named, corner_keys(skin.kind, skin.nodes)])
        _, first, inverse = np.unique(everything, axis=0, return_index=True, return_inverse=True)
        mine = inverse.ravel()[len(everything) - len(skin.nodes) :]
        missing = first[mine] >= len(everything) - len(skin.nodes)
        if missing.any():
            result.append((UNNAMED, FaceBlock(skin.kind, skin.nodes[missing])))
    return result


def outline(mesh: Mesh, without: Collection[str] = ()) -> Lines:
    """Return the sharp edges of a solid and the borders of its names, or the boundary of a flat mesh.

    without: names whose faces get no lines.
    """
    if mesh.dimension == 2:
        return _edge_lines(len(mesh.points), np.concatenate([skin.nodes for skin in boundary(mesh.blocks)]))
    edges, normals, owners = [], [], []
    blocks = named_blocks(mesh)
    names = list(dict.fromkeys(name for name, _ in blocks))
    for name, block in blocks:
        if name in without:
            continue
        local = EDGES[block.kind]
        places = reference_nodes(block.kind)[[middle for _, _, middle in local]]
        gradient = tabulate(block.kind, places)[1]
        tangent = np.einsum("qmj,emi->eqij", gradient, mesh.points[block.nodes])
        normal = np.cross(tangent[..., 0], tangent[..., 1])
        normals.append((normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300)).reshape(-1, 3))
        edges.append(block.nodes[:, np.array(local)].reshape(-1, 3))
        owners.append(np.full(len(edges[-1]), names.index(name)))
    edge, normal, owner = np.concatenate(edges), np.concatenate(normals), np.concatenate(owners)
    order = np.lexsort(np.sort(edge[:, :2], axis=1).T)
    edge, normal, owner = edge[order], normal[order], owner[order]
    same = (np.sort(edge[:-1, :2], axis=1) == np.sort(edge[1:, :2], axis=1)).all(axis=1)
    sharp = same & ((np.einsum("ij,ij->i", normal[:-1], normal[1:]) < _SHARP) | (owner[:-1] != owner[1:]))
    return _edge_lines(len(mesh.points), edge[:-1][sharp])


def edges(mesh: Mesh) -> Lines:
    """Return all edges of the drawn faces."""
    found = [block.nodes[:, np.array(EDGES[block.kind])].reshape(-1, 3) for _, block in named_blocks(mesh)]
    everything = np.concatenate(found)
    _, first = np.unique(np.sort(everything[:, :2], axis=1), axis=0, return_index=True)
    return _edge_lines(len(mesh.points), everything[first])


def face_lines(mesh: Mesh, name: str) -> Lines:
    """Return the lines that make a named boundary of a flat mesh."""
    return _edge_lines(len(mesh.points), np.concatenate([block.nodes for block in mesh.face_blocks(name)]))


def normals(points: Array, triangles: Index) -> Array:
    """Return unit normals at the points (n, 3): the mean of the triangles around each, by area."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    area = np.cross(b - a, c - a)
    total = np.zeros_like(points)
    for axis in range(3):
        weights = np.repeat(area[:, axis], 3)
        total[:, axis] = np.bincount(triangles.ravel(), weights=weights, minlength=len(points))
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300))


def spatial(points: Array) -> Array:
    """Return points (n, 2 or 3) with three coordinates."""
    return points if points.shape[1] == 3 else np.column_stack([points, np.zeros(len(points))])


def combine(rows: Index, columns: Index, values: Array, shape: tuple[int, int]) -> sparse.csr_matrix:
    """Return the sparse matrix with these entries."""
    return sparse.csr_matrix((np.ravel(values), (np.ravel(rows), np.ravel(columns))), shape=shape)


def _level(faces: int, most: int) -> int:
    """Return into how many parts the edges of the faces are divided."""
    return int(np.clip(np.round(np.sqrt(most / max(faces, 1))), 1, 4))


def _joined(nodes: int, blocks: Sequence[tuple[str, FaceBlock]], level: int) -> Surface:
    names = tuple(dict.fromkeys(name for name, _ in blocks))
    weights, triangles, labels, first = [], [], [], 0
    for name, block in blocks:
        shape, pattern = _subdivision(block.kind, level)
        count = len(block.nodes)
        rows = np.repeat(np.arange(count * len(shape)), shape.shape[1])
        columns = np.repeat(block.nodes, len(shape), axis=0)
        weights.append(combine(rows, columns, np.tile(shape, (count, 1)), (count * len(shape), nodes)))
        offset = first + len(shape) * np.arange(count)
        triangles.append((offset[:, None, None] + pattern).reshape(-1, 3))
        labels.append(np.full(len(triangles[-1]), names.index(name)))
        first += count * len(shape)
    return Surface(
        sparse.vstack(weights, format="csr"), np.concatenate(triangles), names, np.concatenate(labels).astype(np.int64)
    )


@cache
def _subdivision(kind: str, level: int) -> tuple[Array, Index]:
    """Return the shape functions (points, nodes) at a grid on the face, and the triangles (t, 3) of that grid."""
    steps = range(level + 1)
    if kind == "triangle6":
        grid = [(i, j) for j in steps for i in steps if i + j <= level]
    else:
        grid = [(i, j) for j in steps for i in steps]
    number = {place: n for n, place in enumerate(grid)}
    triangles = []
    for i, j in grid:
        for corners in (((i, j), (i + 1, j), (i, j + 1)), ((i + 1, j), (i + 1, j + 1), (i, j + 1))):
            if all(corner in number for corner in corners):
                triangles.append([number[corner] for corner in corners])
    return tabulate(kind, np.array(grid, dtype=float) / level)[0], np.array(triangles)


def _edge_lines(nodes: int, edge: Index, level: int = 3) -> Lines:
    """Return the lines along quadratic edges (end, end, middle)."""
    shape = tabulate("line3", np.linspace(0.0, 1.0, level + 1)[:, None])[0]
    count = len(edge)
    rows = np.repeat(np.arange(count * (level + 1)), 3)
    columns = np.repeat(edge[:, :3], level + 1, axis=0)
    weights = combine(rows, columns, np.tile(shape, (count, 1)), (count * (level + 1), nodes))
    start = (np.arange(count)[:, None] * (level + 1) + np.arange(level)).ravel()
    return Lines(weights, np.column_stack([start, start + 1]))
