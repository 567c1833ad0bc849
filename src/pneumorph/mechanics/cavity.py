"""Cavities: closed sets of named faces with a gauge pressure and an enclosed volume."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, LeakingCavityError
from pneumorph.mechanics import kernels
from pneumorph.mechanics.pattern import Pattern
from pneumorph.mechanics.supplies import PressureSupply, Supply
from pneumorph.mechanics.surface import enclosed_volume
from pneumorph.mesh.mesh import FaceBlock, Mesh

Array = NDArray[np.float64]

# a lens has two edges: the arc on the rim and its chord
_CORNERS = {"triangle6": 3, "quad9": 4, "line3": 2, "triangle3": 3, "lens3": 2}


@dataclass(frozen=True)
class Cavity:
    """A space that gas or liquid fills.

    name:    how programmes, histories and reports call it.
    faces:   names of the faces, and of the mesh's caps, that bound it; they must close. Several closed shells may
             share one pressure.
    supply:  what fills it; default: a pressure that the programme sets.
    mirrors: names of plane faces (symmetry cuts of the model) in whose planes the cavity may lie open. Volume and
             supply are then those of the part that is modelled.
    """

    name: str
    faces: tuple[str, ...]
    supply: Supply = field(default_factory=PressureSupply)
    mirrors: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.faces, str) or not self.faces:
            raise InputError(f"cavity '{self.name}': faces = {self.faces!r}, expected a tuple of face names")
        if len(set(self.faces)) != len(self.faces):
            raise InputError(f"cavity '{self.name}': a face is named twice in {self.faces}")


class CavitySurface:
    """The surface of one cavity on a mesh: volume and derivatives at any positions.

    Raises LeakingCavityError where the faces do not close, with a point on the gap.
    """

    def __init__(self, cavity: Cavity, mesh: Mesh, pattern: Pattern):
        self.cavity = cavity
        self._mesh = mesh
        self._pattern = pattern
        self.blocks: tuple[FaceBlock, ...] = tuple(
            b for name in cavity.faces for b in (mesh.caps.get(name) or mesh.face_blocks(name))
        )
        self._slots = [pattern.slots(block.nodes) for block in self.blocks]
        self._origin, self._project, planes = self._field()
        self._check_closed(planes)
        self.reference_volume = self.volume(mesh.points)
        if self.reference_volume <= 0.0:
            raise LeakingCavityError(
                f"cavity '{cavity.name}': volume {self.reference_volume:.4g} mm3, expected more than 0: "
                "its faces do not bound a space inside the solid"
            )

    def _field(self) -> tuple[Array, Array, list[tuple[Array, Array]]]:
        """Return x0 and P of the field v, and (point, normal) of the planes that it is tangential to."""
        d = self._mesh.dimension
        planes = [_plane(self._mesh, name, self.cavity.name) for name in self.cavity.mirrors]
        if not planes:
            return self._mesh.points.mean(axis=0), np.eye(d), planes
        normals = np.array([normal for _, normal in planes])
        _, values, axes = np.linalg.svd(normals)
        rank = int(np.sum(values > 1e-6))
        if rank < d:
            return np.zeros(d), np.eye(d) - axes[:rank].T @ axes[:rank], planes
        heights = np.array([normal @ point for point, normal in planes])
        origin, *_ = np.linalg.lstsq(normals, heights, rcond=None)
        if np.abs(normals @ origin - heights).max() > 1e-6 * self._mesh.size:
            raise InputError(f"cavity '{self.cavity.name}': its mirrors {self.cavity.mirrors} meet in no common point")
        return origin, np.eye(d), planes

    def _check_closed(self, planes: list[tuple[Array, Array]]) -> None:
        """Every edge (end point in two dimensions) must belong to two faces, or lie on a mirror or the axis."""
        edges = []
        for block in self.blocks:
            count = _CORNERS[block.kind]
            if block.kind == "line3":
                edges.append(np.column_stack([block.nodes[:, :2].ravel(), block.nodes[:, :2].ravel()]))
            else:
                ends = [(i, (i + 1) % count) for i in range(count)]
                edges += [block.nodes[:, pair] for pair in ends]
        found, counts = np.unique(np.sort(np.concatenate(edges), axis=1), axis=0, return_counts=True)
        points = self._mesh.points[found]
        closed = counts % 2 == 0
        tolerance = 1e-6 * self._mesh.size
        for point, normal in planes:
            closed |= (np.abs((points - point) @ normal) < tolerance).all(axis=1)
        if self._mesh.space == "axisymmetric":
            closed |= (points[:, :, 0] < tolerance).all(axis=1)
        if not closed.all():
            where = points[~closed][0].mean(axis=0)
            place = ", ".join(f"{x:.4g}" for x in where)
            raise LeakingCavityError(
                f"cavity '{self.cavity.name}' leaks: {int((~closed).sum())} open edges in its faces "
                f"{', '.join(self.cavity.faces)}, one at ({place}) mm"
            )

    def volume(self, position: Array) -> float:
        """Return the volume at deformed nodes (nodes, d), mm3."""
        return sum(self._evaluate(block, position, 0)[0] for block in self.blocks)

    def gradient(self, position: Array) -> Array:
        """Return dV/dx (nodes * d,), the nodal forces of a unit pressure, mm2."""
        total = np.zeros(position.size)
        for block in self.blocks:
            total += self._evaluate(block, position, 1)[1].ravel()
        return total

    def add_hessian(self, position: Array, factor: float, values: Array) -> None:
        """Add factor * d2V/dx2 to the values of the tangent's pattern."""
        if factor == 0.0:
            return
        for block, slots in zip(self.blocks, self._slots, strict=True):
            second = self._evaluate(block, position, 2)[2]
            assert second is not None
            sizes = kernels.sizes_of(block.nodes.shape[1], self._mesh.dimension, 0, False)
            kernels.add_matrices(sizes, block.nodes, factor * second, slots, self._pattern.indptr, values)

    def _evaluate(self, block: FaceBlock, position: Array, order: int) -> tuple[float, Array, Array | None]:
        revolved = self._mesh.space == "axisymmetric"
        return enclosed_volume(block.kind, block.nodes, position, self._origin, self._project, revolved, order)


def _plane(mesh: Mesh, name: str, cavity: str) -> tuple[Array, Array]:
    """Return a point and the unit normal of a named plane face."""
    points = mesh.points[mesh.face_nodes(name)]
    centre = points.mean(axis=0)
    normal = np.linalg.svd(points - centre)[2][-1]
    if np.abs((points - centre) @ normal).max() > 1e-6 * mesh.size:
        raise InputError(f"cavity '{cavity}': mirror '{name}' is not plane")
    return centre, normal
