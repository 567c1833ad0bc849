"""Actuator -> mesh of 10-node tetrahedra with named faces."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from pneumorph.errors import MeshError
from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator
from pneumorph.geometry.bending_skin import BendingSkin
from pneumorph.geometry.crawler import PlaneCrawler
from pneumorph.geometry.finger import Finger
from pneumorph.geometry.forearm import Forearm
from pneumorph.geometry.gripper import Gripper
from pneumorph.geometry.hexagonal_prism import HexagonalPrism
from pneumorph.geometry.pipe_robot import PipeRobot
from pneumorph.geometry.quadruped import Quadruped
from pneumorph.mesh.body import MeshSize
from pneumorph.mesh.crawler import mesh_crawler
from pneumorph.mesh.finger import mesh_finger
from pneumorph.mesh.forearm import mesh_forearm
from pneumorph.mesh.gripper import mesh_gripper
from pneumorph.mesh.hexagonal_prism import mesh_prism
from pneumorph.mesh.imported import Imported
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.pipe_robot import mesh_pipe_robot
from pneumorph.mesh.quadratic import positive
from pneumorph.mesh.quadruped import mesh_quadruped
from pneumorph.mesh.reference import straightened
from pneumorph.mesh.skinned import mesh_skinned_tube
from pneumorph.mesh.topology import boundary, corner_keys

# templates that have a block grid of hexahedra beside tetrahedra, each meshed by (actuator, size in mm)
_GRIDS: dict[type[Actuator], Callable[..., Mesh]] = {Finger: mesh_finger, HexagonalPrism: mesh_prism}


def generate(
    actuator: Actuator,
    size: float | None = None,
    *,
    coarse: bool = False,
    grading: float | None = None,
    detail: float | None = None,
    wall_size: float | None = None,
    hexahedra: bool = False,
) -> Mesh:
    """Return the mesh of an actuator: 10-node tetrahedra, one block a material domain, curved where the solid is.

    size: largest edge in mm (automatic: the actuator's `default_size`, 1.625 times it if coarse).
    coarse: choose `size` and `detail` for the fewest cells that keep the shape.
    grading: how fast the size may change, above 0 (slowly) to 1; automatic 0.8.
    detail: how much short edges refine their surroundings, 1 for an element no larger than the edge; 1, coarse 0.2.
    wall_size: largest edge in mm on the cavity faces, if smaller than `size`.
    hexahedra: a block grid in place of the tetrahedra of a `Finger` or `HexagonalPrism`, one cell through each wall and
        no more than from wall to wall, unless `size` is given.

    An imported body is meshed when it is made: here its mesh is returned or, with other settings, made anew. A
    `BendingSkin` is layered (see `mesh.skinned`), a `PlaneCrawler` a plane grid (see `mesh.crawler`), a
    `Quadruped`, a `Gripper` and a `Forearm` block grids (see `mesh.quadruped` and so on): of the settings they take
    size and coarse only.

    Raises MeshError for settings out of range or a solid that Netgen cannot mesh.
    """
    if hexahedra:
        if type(actuator) not in _GRIDS:
            raise MeshError(
                f"mesh: hexahedra = true: {type(actuator).__name__} has no choice of cells, "
                f"{', '.join(sorted(kind.__name__ for kind in _GRIDS))} have; leave it out"
            )
        _refuse_settings(grading=grading, detail=detail, wall_size=wall_size)
        return _GRIDS[type(actuator)](actuator, math.inf if size is None else _positive("size", size))
    if isinstance(actuator, Imported):
        if wall_size is not None:
            raise MeshError(f"mesh: wall_size = {wall_size!r}: only templates know their walls before they are meshed")
        asked = MeshSize(size, coarse, grading, detail)
        return actuator.mesh if asked in (MeshSize(), actuator.meshing) else replace(actuator, meshing=asked).mesh
    if isinstance(actuator, BendingSkin | PlaneCrawler | Quadruped | Gripper | PipeRobot | Forearm):
        _refuse_settings(grading=grading, detail=detail, wall_size=wall_size)
        chosen = (actuator.default_size * (2.0 if coarse else 1.0)) if size is None else _positive("size", size)
        if isinstance(actuator, PlaneCrawler):
            return mesh_crawler(actuator, chosen)
        if isinstance(actuator, Quadruped):
            return mesh_quadruped(actuator, chosen)
        if isinstance(actuator, Gripper):
            return mesh_gripper(actuator, chosen)
        if isinstance(actuator, Forearm):
            return mesh_forearm(actuator, chosen)
        if isinstance(actuator, PipeRobot):
            return mesh_pipe_robot(actuator, chosen)
        return mesh_skinned_tube(actuator.tube, chosen, half=actuator.half)
    size = _positive("size", actuator.default_size * (1.625 if coarse else 1.0) if size is None else size)
    grading = _positive("grading", 0.8 if grading is None else grading, 1.0)
    detail = _positive("detail", (0.2 if coarse else 1.0) if detail is None else detail)
    sizes = dict(actuator.face_sizes)
    if wall_size is not None:
        sizes |= dict.fromkeys(actuator.cavities, _positive("wall_size", wall_size))
    raw = occ.mesh_solid(actuator.shape(), size=size, grading=grading, detail=detail, face_sizes=sizes)
    return from_raw(raw, actuator)


def from_raw(raw: occ.RawMesh, actuator: Actuator) -> Mesh:
    """Return the checked mesh of an actuator from the arrays that Netgen delivers."""
    points, cells = raw.points, positive(raw.points, raw.cells)
    points = straightened(points, "tetra10", cells)
    used, cells = np.unique(cells, return_inverse=True)
    triangles = np.searchsorted(used, raw.triangles)
    cells = cells.reshape(-1, 10)
    blocks = tuple(
        CellBlock("tetra10", name, np.ascontiguousarray(cells[raw.domain == i])) for i, name in enumerate(raw.domains)
    )
    (skin,) = boundary(blocks)
    faces = _name_faces(skin, triangles, raw.face, raw.face_names)
    if set(faces) != set(actuator.face_names):
        raise MeshError(
            f"{type(actuator).__name__}: the mesh has the faces {', '.join(sorted(faces))}, "
            f"expected {', '.join(sorted(actuator.face_names))}"
        )
    return Mesh(
        points[used], blocks, MappingProxyType(faces), bending_walls=MappingProxyType(dict(actuator.bending_walls))
    )


def _refuse_settings(**settings: float | None) -> None:
    for name, value in settings.items():
        if value is not None:
            raise MeshError(f"mesh: {name} = {value!r}: a layered mesh has its size only, leave it out")


def _positive(name: str, value: float, largest: float = math.inf) -> float:
    if not isinstance(value, int | float) or not 0.0 < value <= largest or not math.isfinite(value):
        upper = f" and at most {largest:g}" if math.isfinite(largest) else ""
        raise MeshError(f"mesh: {name} = {value!r}: expected a finite number greater than 0{upper}")
    return float(value)


def _name_faces(
    skin: FaceBlock, triangles: np.ndarray, face: np.ndarray, names: tuple[str, ...]
) -> dict[str, tuple[FaceBlock, ...]]:
    """Return the boundary faces by name; Netgen's triangles give the names, the cells give the orientation."""
    mine, theirs = corner_keys("triangle6", skin.nodes), corner_keys("triangle6", triangles)
    order, other = np.lexsort(mine.T), np.lexsort(theirs.T)
    if len(mine) != len(theirs) or not np.array_equal(mine[order], theirs[other]):
        raise MeshError("the surface triangles of the solid are not the boundary of its tetrahedra")
    label = np.empty(len(mine), dtype=np.int64)
    label[order] = face[other]
    return {
        name: (FaceBlock("triangle6", np.ascontiguousarray(skin.nodes[label == i])),)
        for i, name in enumerate(names)
        if (label == i).any()
    }
