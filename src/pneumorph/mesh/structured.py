"""Structured meshes of rectangles and boxes, mapped to any place: for sections, checks and patch tests."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError, unknown_name
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh, Space
from pneumorph.mesh.reference import MIDS, jacobians
from pneumorph.mesh.topology import boundary

Array = NDArray[np.float64]
PointMap = Callable[[Array], Array]

# Kuhn's six tetrahedra of a cube with corners x + 2 y + 4 z: their faces match those of the neighbouring cubes
_KUHN: list[tuple[int, ...]] = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]
_WEDGES: list[tuple[int, ...]] = [(0, 1, 3, 4, 5, 7), (0, 3, 2, 4, 7, 6)]
_HEXAHEDRA: list[tuple[int, ...]] = [(0, 1, 3, 2, 4, 5, 7, 6)]
_TRIANGLES: list[tuple[int, ...]] = [(0, 1, 3), (0, 3, 2)]


def rectangle(
    nx: int,
    ny: int,
    mapping: PointMap | None = None,
    *,
    width: float = 1.0,
    height: float = 1.0,
    space: Space = "plane_strain",
    distortion: float = 0.0,
    domain: str = "body",
    bending_walls: Mapping[str, float] | None = None,
) -> Mesh:
    """Return 2 nx ny triangle6 cells on [0, width] x [0, height] (mm) with the faces left, right, bottom and top.

    mapping: takes points (n, 2), corners and mid-edge nodes alike, to where they shall be, without turning cells over.
    distortion: moves inner corners by up to this share of a cell, the same way each time, before mapping (patch tests).
    space: "plane_strain" or "axisymmetric" (x is the radius).

    Raises MeshError for counts or lengths out of range or a mapping that turns cells over.
    """
    if space not in ("plane_strain", "axisymmetric"):
        raise MeshError(unknown_name("space of a rectangle", space, ("plane_strain", "axisymmetric")))
    counts, lengths = _checked({"nx": nx, "ny": ny}), _lengths({"width": width, "height": height})
    names = {(0, 0): "left", (0, 1): "right", (1, 0): "bottom", (1, 1): "top"}
    return _structured(
        "triangle6", _TRIANGLES, counts, lengths, names, mapping, distortion, space, domain, bending_walls
    )


def box(
    nx: int,
    ny: int,
    nz: int,
    kind: str = "tetra10",
    mapping: PointMap | None = None,
    *,
    lengths: tuple[float, float, float] = (1.0, 1.0, 1.0),
    distortion: float = 0.0,
    domain: str = "body",
    bending_walls: Mapping[str, float] | None = None,
) -> Mesh:
    """Return 6 tetra10, 2 wedge18 or 1 hexahedron27 for each of nx ny nz blocks of a box, with faces x0, x1, y0 .. z1.

    The box stands on the origin. lengths: its edges in mm. mapping, distortion: as for `rectangle`, on points (n, 3).
    Wedges stand along z and are distorted in x and y only. Raises MeshError as `rectangle`.
    """
    all_pieces = {"tetra10": _KUHN, "wedge18": _WEDGES, "hexahedron27": _HEXAHEDRA}
    if kind not in all_pieces:
        raise MeshError(unknown_name("kind of cell of a box", kind, all_pieces))
    counts = _checked({"nx": nx, "ny": ny, "nz": nz})
    sizes = _lengths(dict(zip(("length x", "length y", "length z"), lengths, strict=True)))
    names = {(axis, end): f"{'xyz'[axis]}{end}" for axis in range(3) for end in range(2)}
    return _structured(kind, all_pieces[kind], counts, sizes, names, mapping, distortion, "3d", domain, bending_walls)


def quadratic(corner_points: Array, kind: str, corners: NDArray[np.int64]) -> tuple[Array, NDArray[np.int64]]:
    """Return points and full node lists of cells given by their corners: mid nodes are shared and lie in the middle."""
    columns, places = [corners], [corner_points]
    total = len(corner_points)
    groups: dict[int, list[int]] = {}
    for mid, ends in MIDS[kind].items():
        groups.setdefault(len(ends), []).append(mid)
    for number, mids in groups.items():
        between = np.stack([corners[:, list(MIDS[kind][mid])] for mid in mids], axis=1)
        unique, inverse = np.unique(np.sort(between, axis=2).reshape(-1, number), axis=0, return_inverse=True)
        columns.append(total + inverse.reshape(len(corners), len(mids)))
        places.append(corner_points[unique].mean(axis=1))
        total += len(unique)
    return np.concatenate(places), np.concatenate(columns, axis=1)


def _structured(
    kind: str,
    pieces: list[tuple[int, ...]],
    counts: list[int],
    lengths: list[float],
    names: dict[tuple[int, int], str],
    mapping: PointMap | None,
    distortion: float,
    space: Space,
    domain: str,
    bending_walls: Mapping[str, float] | None,
) -> Mesh:
    grid = np.meshgrid(*[np.arange(n + 1) for n in counts], indexing="ij")
    lattice = np.stack([axis.ravel(order="F") for axis in grid], axis=1)
    steps = np.cumprod([1, *[n + 1 for n in counts[:-1]]])
    cells = np.stack(
        [axis.ravel(order="F") for axis in np.meshgrid(*[np.arange(n) for n in counts], indexing="ij")], axis=1
    )
    corner = np.array([[(i >> axis) & 1 for axis in range(len(counts))] for i in range(2 ** len(counts))]) @ steps
    corners = ((cells @ steps)[:, None, None] + corner[np.array(pieces)]).reshape(-1, len(pieces[0]))
    places = lattice + _shifts(lattice, counts, distortion, keep_z=kind == "wedge18")
    points, nodes = quadratic(places, kind, corners)
    skin = boundary([CellBlock(kind, domain, nodes)])
    # named before mapping, where a side is where a coordinate is 0 or the count
    faces: dict[str, tuple[FaceBlock, ...]] = {}
    for (axis, end), name in names.items():
        on = [np.isclose(points[block.nodes][:, :, axis], end * counts[axis], atol=1e-9).all(axis=1) for block in skin]
        faces[name] = tuple(
            FaceBlock(block.kind, block.nodes[mask]) for block, mask in zip(skin, on, strict=True) if mask.any()
        )
    points = points * (np.array(lengths) / counts)
    if mapping is not None:
        points = np.asarray(mapping(points), dtype=np.float64)
    mesh = Mesh(points, (CellBlock(kind, domain, nodes),), MappingProxyType(faces), space, dict(bending_walls or {}))
    if not (jacobians(points, kind, nodes) > 0.0).all():
        raise MeshError("the mapping or distortion turns cells over: det J is not positive everywhere")
    return mesh


def _shifts(lattice: NDArray[np.int64], counts: list[int], distortion: float, keep_z: bool) -> Array:
    """Return shifts of the inner lattice points, in cells; sides stay where they are."""
    if not 0.0 <= distortion < 0.5:
        raise MeshError(f"distortion = {distortion!r}: expected at least 0 and less than 0.5")
    shifts = distortion * (2.0 * np.random.default_rng(1).random(lattice.shape) - 1.0)
    inner = ((lattice > 0) & (lattice < np.array(counts))).all(axis=1)
    shifts[~inner] = 0.0
    if keep_z:
        shifts[:, 2] = 0.0
    return shifts


def _checked(counts: dict[str, int]) -> list[int]:
    for name, value in counts.items():
        if not isinstance(value, int | np.integer) or isinstance(value, bool) or value < 1:
            raise MeshError(f"{name} = {value!r}: expected a whole number of at least 1")
    return [int(value) for value in counts.values()]


def _lengths(lengths: dict[str, float]) -> list[float]:
    for name, value in lengths.items():
        if not np.isfinite(value) or value <= 0.0:
            raise MeshError(f"{name} = {value!r}: expected a finite length in mm greater than 0")
    return [float(value) for value in lengths.values()]
