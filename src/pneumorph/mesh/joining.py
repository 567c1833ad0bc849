"""Several meshes -> one: nodes that coincide are merged, faces between the parts are no boundary any more."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from pneumorph.errors import MeshError
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.reference import jacobians
from pneumorph.mesh.topology import compressed, corner_keys

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_CLOSE = 1e-6  # of the size of the whole: nodes nearer to each other are one


def placed(
    mesh: Mesh, mapping: Callable[[Array], Array] | None = None, *, rename: Mapping[str, str] | None = None
) -> Mesh:
    """Return the mesh with its points (n, 3) moved by a mapping and faces called otherwise; equal names are one.

    Raises MeshError for a face that it does not have, or a mapping that turns cells over.
    """
    names = dict(rename or {})
    if missing := set(names) - set(mesh.faces):
        raise MeshError(f"placed: no face {', '.join(sorted(missing))}: the mesh has {', '.join(sorted(mesh.faces))}")
    points = mesh.points if mapping is None else np.asarray(mapping(mesh.points), dtype=float)
    faces: dict[str, tuple[FaceBlock, ...]] = {}
    for name, blocks in mesh.faces.items():
        new = names.get(name, name)
        faces[new] = _by_kind([*faces.get(new, ()), *blocks])
    if not all((jacobians(points, block.kind, block.nodes) > 0.0).all() for block in mesh.blocks):
        raise MeshError("placed: the mapping turns cells over: det J is not positive everywhere")
    return replace(mesh, points=points, faces=MappingProxyType(faces))


def join(meshes: Sequence[Mesh]) -> Mesh:
    """Return meshes as one body: nodes nearer than a millionth of its size are merged, faces that meet are dropped.

    Cells of one kind and domain are put together, as are faces of one name and what they say of walls.

    Raises MeshError for parts that overlap, that hang together by no face, or whose faces meet with other mid nodes;
    for meshes with caps or of other spaces.
    """
    if not meshes:
        raise MeshError("join: expected at least one mesh")
    if any(mesh.caps for mesh in meshes) or len({mesh.space for mesh in meshes}) > 1:
        raise MeshError("join: expected meshes of one space, without caps")
    start = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    points, number = _merged(np.concatenate([mesh.points for mesh in meshes]))
    cells: dict[tuple[str, str], list[Integers]] = {}
    walls: dict[str, float] = {}
    for mesh, first in zip(meshes, start, strict=False):
        walls |= mesh.bending_walls
        for block in mesh.blocks:
            cells.setdefault((block.kind, block.domain), []).append(number[block.nodes + first])
    blocks = [CellBlock(kind, domain, np.concatenate(parts)) for (kind, domain), parts in cells.items()]
    for block in blocks:
        corners = corner_keys(block.kind, block.nodes)
        if len(np.unique(corners, axis=0)) < len(corners):
            raise MeshError("join: the parts overlap: two cells have the same corners")
    faces = _outside(meshes, start, number)
    points, merged, named = compressed(points, blocks, faces)
    return Mesh(points, merged, MappingProxyType(named), meshes[0].space, MappingProxyType(walls))


def _merged(points: Array) -> tuple[Array, Integers]:
    """Return the points without those that coincide with another, and the new number (n,) of each."""
    near = cKDTree(points).query_pairs(_CLOSE * float(np.ptp(points, axis=0).max()), output_type="ndarray")
    links = coo_matrix((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(len(points), len(points)))
    number = connected_components(links, directed=False)[1].astype(np.int64)
    _, first, number = np.unique(number, return_index=True, return_inverse=True)
    return points[first], number


def _outside(meshes: Sequence[Mesh], start: Integers, number: Integers) -> dict[str, tuple[FaceBlock, ...]]:
    """Return the named faces that do not meet one of another part; start: first node of each part."""
    listed = [
        (part, name, block.kind, number[block.nodes + start[part]])
        for part, mesh in enumerate(meshes)
        for name, blocks in mesh.faces.items()
        for block in blocks
    ]
    links: list[Integers] = []
    named: dict[str, list[FaceBlock]] = {}
    for kind in dict.fromkeys(item[2] for item in listed):
        mine = [item for item in listed if item[2] == kind]
        nodes = np.concatenate([item[3] for item in mine])
        owner = np.repeat([item[0] for item in mine], [len(item[3]) for item in mine])
        keys = corner_keys(kind, nodes)
        _, inverse, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
        inverse = inverse.ravel()
        if counts.max() > 2:
            raise MeshError("join: the parts overlap: more than two of their faces have the same corners")
        inner = counts[inverse] == 2
        order = np.flatnonzero(inner)[np.argsort(inverse[inner], kind="stable")]
        if not np.array_equal(np.sort(nodes[order[::2]], axis=1), np.sort(nodes[order[1::2]], axis=1)):
            raise MeshError("join: faces of two parts have the same corners, but mid nodes elsewhere")
        links.append(np.column_stack([owner[order[::2]], owner[order[1::2]]]))
        ends = np.cumsum([0, *(len(item[3]) for item in mine)])
        for (_, name, _, block), a, b in zip(mine, ends[:-1], ends[1:], strict=True):
            if not inner[a:b].all():
                named.setdefault(name, []).append(FaceBlock(kind, block[~inner[a:b]]))
    _check_connected(np.concatenate(links), len(meshes))
    return {name: _by_kind(blocks) for name, blocks in named.items()}


def _check_connected(links: Integers, count: int) -> None:
    matrix = coo_matrix((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(count, count))
    parts = connected_components(matrix, directed=False)[1]
    if parts.any():
        lost = ", ".join(str(i + 1) for i in np.flatnonzero(parts))
        raise MeshError(f"join: part {lost} of {count} shares no face with the first or what hangs on it")


def _by_kind(blocks: Sequence[FaceBlock]) -> tuple[FaceBlock, ...]:
    """Return one block a kind."""
    kinds = dict.fromkeys(block.kind for block in blocks)
    return tuple(FaceBlock(k, np.concatenate([block.nodes for block in blocks if block.kind == k])) for k in kinds)
