"""Flat panel of lattice cells, with or without a closed layer under it -> layered mesh of wedges and hexahedra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.geometry.lattice import Cell, Lattice
from pneumorph.mesh.lattice_sheet import SheetMesh, mesh_sheet
from pneumorph.mesh.layered import lifted
from pneumorph.mesh.memory import check_cells
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.topology import boundary

Array = NDArray[np.float64]

_SOLID = {"triangle6": "wedge18", "quad9": "hexahedron27"}


def mesh_panel(
    cell: Cell, counts: tuple[int, int], lengths: tuple[float, float, float], layers: Sequence[tuple[float, str, bool]],
    size: float,
) -> Mesh:  # fmt: skip
    """Return the mesh of a panel of equal cells, columns along x and cells along y, built up along z from z = 0.

    counts: columns (x) and cells (y). lengths: width w, height h of a cell and beam width b, mm.
    layers: (thickness in mm, material domain, whether it has the holes), from z = 0; each is one quadratic cell thick.
    size:   largest edge in the plane, mm.

    The cuts at x = 0 and y = 0 are those of a skin's seam and clamp, so that cells repeat across them node by node.
    Faces: x0, x1, y0, y1, bottom (z = 0), top, and `holes` for all the rest. Raises MeshError for layers, counts or a
    size out of range, GeometryError as `Lattice`.
    """
    for name, count in zip(("columns", "cells along"), counts, strict=True):
        if isinstance(count, bool) or not isinstance(count, int) or count < 1:
            raise MeshError(f"panel: {name} = {count!r}: expected a whole number of at least 1")
    _, sheet = _sheet(cell, counts, lengths, layers, size)
    return _raised(sheet, layers, {kind: np.ones(len(nodes), dtype=bool) for kind, nodes in sheet.cells.items()})


def mesh_unit_cell(
    cell: Cell, lengths: tuple[float, float, float], layers: Sequence[tuple[float, str, bool]], size: float
) -> Mesh:
    """Return the mesh of one cell out of the inside of a panel, as `mesh_panel` makes it; it repeats node by node.

    Along y it ends at the lower edge of a row of holes and of the next but one, where lines of the panel's mesh lie.
    Faces: x0, x1, bottom, top, and `holes` for the rest, both ends along y included.
    """
    lattice, sheet = _sheet(cell, (1, 3), lengths, layers, size)
    chosen = {}
    for kind, nodes in sheet.cells.items():
        middle = sheet.points[nodes].mean(axis=1)
        edges = lattice.levels(middle[:, 0] + (lattice.mirror or 0.0))
        chosen[kind] = (middle[:, 1] > edges[4]) & (middle[:, 1] < edges[8])  # rows 2 and 3 of six
    return _raised(sheet, layers, chosen)


def _sheet(
    cell: Cell, counts: tuple[int, int], lengths: tuple[float, float, float], layers: Sequence[tuple[float, str, bool]],
    size: float,
) -> tuple[Lattice, SheetMesh]:  # fmt: skip
    if not layers or not all(math.isfinite(thick) and thick > 0.0 for thick, _, _ in layers):
        raise MeshError(f"panel: layers = {list(layers)!r}: expected at least one, of a thickness in mm more than 0")
    if isinstance(size, bool) or not isinstance(size, int | float) or not 0.0 < size < math.inf:
        raise MeshError(f"panel: size = {size!r}: expected a finite number of mm greater than 0")
    # a sheet twice as wide, cut at its lines of symmetry: half of it stays open at both ends
    lattice = Lattice(*lengths, cells=((cell,) * (2 * counts[0]),) * counts[1])
    if lattice.mirror is None:
        raise MeshError("panel: the cell is not its own mirror image, expected one that is")
    check_cells(lattice.around * lattice.length / size**2 * len(layers), f"panel at {size:g} mm")
    return lattice, mesh_sheet(lattice, size, None, half=True)


def _raised(sheet: SheetMesh, layers: Sequence[tuple[float, str, bool]], chosen: dict[str, NDArray[np.bool_]]) -> Mesh:
    """Return the layers on the chosen cells of a flat mesh."""
    corners = np.concatenate([[0.0], np.cumsum([thickness for thickness, _, _ in layers])])
    planes = np.sort(np.concatenate([corners, (corners[1:] + corners[:-1]) / 2.0]))
    count = len(sheet.points)
    points = np.column_stack([np.tile(sheet.points, (len(planes), 1)), np.repeat(planes, count)])
    parts: dict[tuple[str, str], list[NDArray[np.int64]]] = {}
    for kind, nodes in sheet.cells.items():
        for number, (_, domain, holed) in enumerate(layers):
            flat = nodes[chosen[kind] & sheet.beam[kind]] if holed else nodes[chosen[kind]]
            if len(flat):
                parts.setdefault((_SOLID[kind], domain), []).append(lifted(kind, flat, 2 * number, count))
    used, numbers = np.unique(
        np.concatenate([cells.ravel() for p in parts.values() for cells in p]), return_inverse=True
    )
    blocks, first = [], 0
    for (kind, domain), cells in parts.items():
        total = sum(part.size for part in cells)
        nodes = numbers.ravel()[first : first + total].reshape(-1, cells[0].shape[1]).astype(np.int64)
        blocks.append(CellBlock(kind, domain, np.ascontiguousarray(nodes)))
        first += total
    blocks.sort(key=lambda block: [domain for _, domain, _ in layers].index(block.domain))
    return Mesh(points[used], tuple(blocks), MappingProxyType(_faces(points[used], blocks)))


def _faces(points: Array, blocks: list[CellBlock]) -> dict[str, tuple[FaceBlock, ...]]:
    """Return the boundary by name, told from where the nodes of each face lie."""
    low, high = points.min(axis=0), points.max(axis=0)
    small = 1e-7 * float((high - low).max())
    sides = [("bottom", 2, low), ("top", 2, high), ("x0", 0, low), ("x1", 0, high), ("y0", 1, low), ("y1", 1, high)]
    named: dict[str, list[FaceBlock]] = {}
    for skin in boundary(blocks):
        left = np.ones(len(skin.nodes), dtype=bool)
        for name, axis, place in sides:
            chosen = left & (np.abs(points[skin.nodes][:, :, axis] - place[axis]) < small).all(axis=1)
            left &= ~chosen
            if chosen.any():
                named.setdefault(name, []).append(FaceBlock(skin.kind, np.ascontiguousarray(skin.nodes[chosen])))
        if left.any():
            named.setdefault("holes", []).append(FaceBlock(skin.kind, np.ascontiguousarray(skin.nodes[left])))
    return {name: tuple(faces) for name, faces in named.items()}
