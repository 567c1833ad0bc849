"""Tube under a skin that is a closed layer: few large cells, for a homogenised lattice."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.geometry.lattice import Cell, Lattice, SkinnedTube
from pneumorph.mesh.lattice_sheet import plain_sheet
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.skinned import roll
from pneumorph.mesh.topology import CELL_FACES

Array = NDArray[np.float64]

_SAME = 1e-9  # of the length of the sheet


def skin_domains(lattice: Lattice) -> dict[str, Cell]:
    """Return the material domain of each kind of cell in a map: 'skin 1', 'skin 2' and so on as they come."""
    cells = dict.fromkeys(cell for row in lattice.cells for cell in row)
    return {f"skin {number}": cell for number, cell in enumerate(cells, 1)}


def mesh_smooth_tube(tube: SkinnedTube, size: float | None = None, *, half: bool = False) -> Mesh:
    """Return the mesh of a tube under a skin without holes, one quadratic cell through each.

    size: largest edge along and around, mm, at the middle of the skin; automatic an eighth of the circumference around.
    half: the part y >= 0, as in `mesh_skinned_tube`; faces are named as there. `outer` is the tube's outer surface, so
          that diameters are measured on it, but inside the body: under the skin.

    Lines of the mesh lie wherever neighbouring cells of the map differ, so that each kind of cell has a material domain
    of its own, see `skin_domains`; the others are `tube` and `cap`. Raises MeshError for a size out of range, or half
    without a mirror.
    """
    lattice = tube.lattice
    size = lattice.around / 8.0 if size is None else size
    if isinstance(size, bool) or not isinstance(size, int | float) or not 0.0 < size < math.inf:
        raise MeshError(f"mesh: size = {size!r}: expected a finite number of mm greater than 0")
    if half and lattice.mirror is None:
        raise MeshError("mesh: half = True: the map of cells is not its own mirror image, expected one that is")
    start = lattice.mirror or 0.0
    extent = lattice.around / (2.0 if half else 1.0)
    x = _lines((_borders_around(lattice) - start) % lattice.around, extent, size)
    y = _lines(
        np.append(_borders_along(lattice), [tube.cap, lattice.length - tube.cap]), lattice.length, size, tube.cap
    )
    mesh = roll(plain_sheet(x, y, closed=not half), tube, 1, 1, half, rings=1)
    names = {cell: name for name, cell in skin_domains(lattice).items()}
    blocks: list[CellBlock] = []
    for block in mesh.blocks:
        if block.domain != "skin":
            blocks.append(block)
            continue
        middle = mesh.points[block.nodes].mean(axis=1)
        around = np.arctan2(middle[:, 1], middle[:, 0]) / (2.0 * math.pi) * lattice.around + start
        columns = (around // lattice.width).astype(int) % lattice.columns
        rows = np.minimum(middle[:, 2] // lattice.height, len(lattice.cells) - 1).astype(int)
        found = np.array([names[lattice.cells[row][column]] for row, column in zip(rows, columns, strict=True)])
        for name in names.values():
            if (found == name).any():
                blocks.append(CellBlock(block.kind, name, np.ascontiguousarray(block.nodes[found == name])))
    covered = {}
    for block in mesh.blocks:
        if block.domain == "tube":
            kind, local = CELL_FACES[block.kind][1]  # the far side of a cell that `layered.lifted` stands on another
            covered[kind] = FaceBlock(kind, np.ascontiguousarray(block.nodes[:, local]))
    return replace(mesh, blocks=tuple(blocks), faces=MappingProxyType({**mesh.faces, "outer": tuple(covered.values())}))


def _borders_around(lattice: Lattice) -> Array:
    """Return x of the borders between columns that differ, mm; always at least 0."""
    found = [place for place in range(lattice.columns) if any(row[place - 1] != row[place] for row in lattice.cells)]
    return lattice.width * np.array([0, *found], dtype=np.float64)


def _borders_along(lattice: Lattice) -> Array:
    """Return y of the borders between rows that differ, mm."""
    rows = itertools.pairwise(lattice.cells)
    return lattice.height * np.array([n for n, (a, b) in enumerate(rows, 1) if a != b], dtype=np.float64)


def _lines(wanted: Array, extent: float, size: float, strip: float = 0.0) -> Array:
    """Return lines from 0 to an extent at the wanted places, and between them as the size asks; none within a strip."""
    inside = wanted[(wanted > strip * (1.0 - _SAME)) & (wanted < extent - strip * (1.0 - _SAME))]
    inside = inside[(inside > _SAME * extent) & (inside < extent * (1.0 - _SAME))]
    places = np.unique(np.concatenate([[0.0], inside, [extent]]))
    places = places[np.append(True, np.diff(places) > _SAME * extent)]
    result = [0.0]
    for low, high in itertools.pairwise(places):
        parts = max(1, math.ceil((high - low) / size - _SAME))
        if strip and (low < strip * (1.0 - _SAME) or high > extent - strip * (1.0 - _SAME)):
            parts = 1
        result += [low + (high - low) * (i + 1) / parts for i in range(parts)]
    return np.array(result)
