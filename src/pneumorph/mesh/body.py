"""Files -> points, quadratic cells and the file's own sets, in mm: CAD solids and closed surfaces are meshed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, MeshError, unknown_name
from pneumorph.geometry import occ
from pneumorph.geometry.stl_import import read_stl
from pneumorph.mesh.files import MESH_SUFFIXES, read_mesh_file
from pneumorph.mesh.memory import check_cells, check_file
from pneumorph.mesh.mesh import CellBlock
from pneumorph.mesh.quadratic import QUADRATIC, positive, quadratic
from pneumorph.mesh.reference import jacobians, straightened
from pneumorph.mesh.skin import Index, Mask, Skin

Array = NDArray[np.float64]

CAD_SUFFIXES = (".iges", ".igs", ".step", ".stp")
SUFFIXES = (*CAD_SUFFIXES, ".stl", *MESH_SUFFIXES)
# mm in a unit of the file
UNITS = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1000.0, "in": 25.4}

_TETRAHEDRON = 6.0 * math.sqrt(2.0)  # cells of edge 1 in a unit of volume


@dataclass(frozen=True)
class MeshSize:
    """How a CAD solid or a closed surface is meshed; see `mesh.generate`. None: automatic."""

    size: float | None = None
    coarse: bool = False
    grading: float | None = None
    detail: float | None = None


@dataclass(frozen=True, eq=False)
class Body:
    """What a file gives before anything is named, in mm.

    points (n, 3), cells: quadratic; sets: name -> facets (count,) of `skin` that the file's sets hold; adopted: those
    of them that the file means as faces; notes: sentences for a reader; size: largest
    edge asked for or, of a mesh, the mean edge of its cells.
    """

    points: Array
    cells: tuple[CellBlock, ...]
    skin: Skin
    sets: Mapping[str, Mask]
    adopted: tuple[str, ...]
    notes: tuple[str, ...]
    size: float


def check_files(paths: tuple[Path, ...], unit: str | None) -> None:
    """Raise InputError for files that are missing, of an unknown or mixed kind, too large, or whose unit is open."""
    for path in paths:
        suffix = path.suffix.lower()
        if suffix not in SUFFIXES:
            raise InputError(f"'{path}': {unknown_name('suffix of a geometry or mesh file', suffix, SUFFIXES)}")
        if not path.is_file():
            raise InputError(f"'{path}': there is no such file")
        check_file(path)
        if len(paths) > 1 and suffix != ".stl":
            raise InputError(f"'{path}': several files make one body only if all are .stl")
        if suffix in CAD_SUFFIXES and unit is not None:
            raise InputError(f"'{path}': unit = '{unit}': the file says its unit itself, leave it out")
        if suffix not in CAD_SUFFIXES and unit is None:
            raise InputError(f"'{path}': unit: missing; a {suffix} file does not say it. Allowed: {', '.join(UNITS)}")
    if not paths:
        raise InputError("file: expected at least one")
    if unit is not None and unit not in UNITS:
        raise InputError(unknown_name("unit", str(unit), UNITS))


@lru_cache(maxsize=4)
def read_body(files: tuple[tuple[str, int], ...], unit: str | None, meshing: MeshSize) -> Body:
    """Return the body in files (path, time of change); kept, because studies, reports and tables ask for the same."""
    paths = [Path(name) for name, _ in files]
    scale = UNITS[unit or "mm"]
    if paths[0].suffix.lower() in MESH_SUFFIXES:
        if meshing != MeshSize():
            raise MeshError(f"'{paths[0]}' is a mesh already: size, grading and detail cannot be chosen")
        return _from_mesh_file(paths[0], scale)
    if paths[0].suffix.lower() in CAD_SUFFIXES:
        return _from_cad(paths[0], meshing)
    points, triangles = read_stl(paths)
    points = points * scale
    corners = points[triangles]
    area = (
        float(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()) / 2
    )
    volume = float(np.linalg.det(corners - points.mean(axis=0)).sum()) / 6.0
    size, grading, _ = _sizes(meshing, volume, area, paths[0])
    return _from_raw(occ.mesh_triangles(points, triangles, size=size, grading=grading), size)


def _sizes(meshing: MeshSize, volume: float, area: float, path: Path) -> tuple[float, float, float]:
    """Return size, grading and detail. Automatic: half again the mean thickness of a wall, 2 V / A."""
    size = 3.0 * volume / area * (1.625 if meshing.coarse else 1.0) if meshing.size is None else meshing.size
    grading = 0.8 if meshing.grading is None else meshing.grading
    detail = (0.2 if meshing.coarse else 1.0) if meshing.detail is None else meshing.detail
    for name, value, largest in (("size", size, math.inf), ("grading", grading, 1.0), ("detail", detail, math.inf)):
        if not 0.0 < value <= largest or not math.isfinite(value):
            raise MeshError(f"mesh: {name} = {value!r}: expected a finite number greater than 0, at most {largest:g}")
    check_cells(_TETRAHEDRON * volume / size**3, f"'{path}' at size {size:.3g} mm")
    return size, grading, detail


def _from_cad(path: Path, meshing: MeshSize) -> Body:
    cad = occ.read_cad(path)
    size, grading, detail = _sizes(meshing, cad.volume, cad.area, path)
    raw = occ.mesh_solid(cad.shape, size=size, grading=grading, detail=detail)
    sets: dict[str, list[int]] = {}
    for number, (name, colour) in enumerate(zip(cad.names, cad.colours, strict=True)):
        for label in filter(None, (name, colour)):
            sets.setdefault(label, []).append(number)
    places = {
        name: np.isin(raw.face, [raw.face_names.index(str(n)) for n in members if str(n) in raw.face_names])
        for name, members in sets.items()
    }
    keys = {name: _padded(raw.triangles[mask, :3]) for name, mask in places.items()}
    return _from_raw(raw, size, keys, tuple(name for name in dict.fromkeys(cad.names) if name))


def _padded(corners: Index) -> Index:
    return np.column_stack([np.full(len(corners), -1), np.sort(corners, axis=1)])


def _from_raw(
    raw: occ.RawMesh, size: float, keys: Mapping[str, Index] | None = None, adopted: tuple[str, ...] = ()
) -> Body:
    cells = positive(raw.points, raw.cells)
    points = straightened(raw.points, "tetra10", cells)
    blocks = tuple(CellBlock("tetra10", name, cells[raw.domain == i]) for i, name in enumerate(raw.domains))
    return _finished(points, blocks, keys or {}, {}, adopted, (), size)


def _from_mesh_file(path: Path, scale: float) -> Body:
    read = read_mesh_file(path)
    for block in read.cells:
        if block.nodes.min() < 0 or block.nodes.max() >= len(read.points):
            raise MeshError(f"'{path}': a {block.kind} names a node that is not there")
    check_cells(sum(len(block.nodes) for block in read.cells), f"'{path}'")
    notes = []
    kinds = sorted({block.kind for block in read.cells if QUADRATIC[block.kind] != block.kind})
    if kinds:
        notes.append(
            f"{', '.join(kinds)}: mid-edge nodes were added, since linear cells lock; the shape keeps its flat facets"
        )
    points, blocks = quadratic(read.points * scale, read.cells)
    blocks = tuple(
        CellBlock(b.kind, b.domain, positive(points, b.nodes) if b.kind == "tetra10" else b.nodes) for b in blocks
    )
    for block in blocks:
        det = jacobians(points, block.kind, block.nodes)
        if det.min() <= 0.0:
            where = points[block.nodes[int(np.argmin(det.min(axis=1)))]].mean(axis=0)
            place = ", ".join(f"{x:.4g}" for x in where)
            raise MeshError(
                f"'{path}': {int((det.min(axis=1) <= 0.0).sum())} {block.kind} turned inside out, one at ({place}) mm"
            )
    volume = sum(float(np.linalg.norm(np.ptp(points[b.nodes], axis=1), axis=1).sum()) for b in blocks)
    size = volume / sum(len(b.nodes) for b in blocks) / math.sqrt(3.0)
    return _finished(points, blocks, {**read.other, **read.faces}, read.nodes, tuple(read.faces), tuple(notes), size)


def _finished(
    points: Array, blocks: tuple[CellBlock, ...], keys: Mapping[str, Index], nodes: Mapping[str, Index],
    adopted: tuple[str, ...], notes: tuple[str, ...], size: float,
) -> Body:  # fmt: skip
    """Return the body with points that cells use only, and the file's sets on its boundary."""
    used = np.unique(np.concatenate([block.nodes.ravel() for block in blocks]))
    new = np.full(len(points) + 1, -1, dtype=np.int64)  # the last place stands for -1
    new[used] = np.arange(len(used))
    cells = tuple(CellBlock(b.kind, b.domain, np.ascontiguousarray(new[b.nodes])) for b in blocks)
    skin = Skin(points[used], cells)
    sets: dict[str, Mask] = {}
    marked = np.zeros(len(used) + 1, dtype=bool)
    for name, members in nodes.items():
        marked[:] = False
        marked[new[members]] = True
        marked[-1] = True
        sets[name] = np.asarray(marked[skin.corners].all(axis=1))
    for name, corners in keys.items():
        sets[name] = _rows_in(skin.keys, np.sort(new[corners], axis=1))
    return Body(points[used], cells, skin, sets, adopted, notes, size)


def _rows_in(rows: Index, others: Index) -> Mask:
    everything = np.concatenate([rows, others])
    _, number = np.unique(everything, axis=0, return_inverse=True)
    number = number.ravel()
    return np.isin(number[: len(rows)], number[len(rows) :])
