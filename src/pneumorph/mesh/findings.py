"""What there is in a mesh, for a reader: domains, faces and cavities with their measures."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.mesh.reference import jacobians, quadrature
from pneumorph.mesh.rims import cap_corners
from pneumorph.mesh.skin import integrals
from pneumorph.mesh.topology import open_edges

Array = NDArray[np.float64]

_FLAT = 1e-6  # of a face's size: how far its nodes may lie from their plane


@dataclass(frozen=True, eq=False)
class DomainFound:
    """A material domain: kinds and number of its cells, volume in mm³."""

    name: str
    kinds: tuple[str, ...]
    cells: int
    volume: float


@dataclass(frozen=True, eq=False)
class FaceFound:
    """A named face: number of facets, area in mm², centre of area (3,) in mm; normal (3,), None if it is not flat."""

    name: str
    facets: int
    area: float
    centre: Array
    normal: Array | None


@dataclass(frozen=True, eq=False)
class CavityFound:
    """A cavity: its faces and the caps among them, volume in mm³, middle of its box (3,) in mm.

    gap: a point (3,) on an open edge of its wall, None where it closes; then only `mirrors` can close it.
    """

    name: str
    faces: tuple[str, ...]
    caps: tuple[str, ...]
    volume: float
    middle: Array
    gap: Array | None


def domains_found(mesh: Mesh) -> list[DomainFound]:
    """Return the material domains of a solid mesh."""
    result = []
    for name in mesh.domains:
        blocks = [block for block in mesh.blocks if block.domain == name]
        volume = sum(float((jacobians(mesh.points, b.kind, b.nodes) @ quadrature(b.kind)[1]).sum()) for b in blocks)
        kinds = tuple(dict.fromkeys(block.kind for block in blocks))
        result.append(DomainFound(name, kinds, sum(len(b.nodes) for b in blocks), volume))
    return result


def faces_found(mesh: Mesh) -> list[FaceFound]:
    """Return the named faces of a solid mesh."""
    return [_face(mesh, name, blocks) for name, blocks in mesh.faces.items()]


def _face(mesh: Mesh, name: str, blocks: Iterable[FaceBlock]) -> FaceFound:
    blocks = tuple(blocks)
    vectors = np.concatenate([integrals(mesh.points[block.nodes], block.kind)[0] for block in blocks])
    middles = np.concatenate([mesh.points[block.nodes].mean(axis=1) for block in blocks])
    areas, total = np.linalg.norm(vectors, axis=1), vectors.sum(axis=0)
    centre = np.average(middles, axis=0, weights=areas)
    points = mesh.points[mesh.face_nodes(name)]
    length = float(np.linalg.norm(total))
    normal = None
    if length > 0.5 * areas.sum():
        unit = total / length
        if np.ptp(points @ unit) < _FLAT * mesh.size:
            normal = unit
    return FaceFound(name, len(areas), float(areas.sum()), centre, normal)


class _Hollow(Protocol):
    """What has cavities: an actuator, or several bodies."""

    @property
    def cavities(self) -> tuple[str, ...]: ...

    def cavity_faces(self, cavity: str) -> tuple[str, ...]: ...


def cavities_found(mesh: Mesh, actuator: _Hollow) -> list[CavityFound]:
    """Return the cavities of an actuator, or of several bodies, on its solid mesh."""
    result = []
    for name in actuator.cavities:
        names = actuator.cavity_faces(name)
        caps = tuple(face for face in names if face in mesh.caps)
        walls = [block for face in names if face not in caps for block in mesh.face_blocks(face)]
        nodes = np.unique(np.concatenate([block.nodes.ravel() for block in walls]))
        box = mesh.points[nodes]
        middle = 0.5 * (box.min(axis=0) + box.max(axis=0))
        volume = -sum(float(integrals(mesh.points[b.nodes] - middle, b.kind)[1].sum()) for b in walls)
        for cap in caps:
            volume -= float(integrals(cap_corners(mesh.points, mesh.caps[cap]) - middle, "triangle6")[1].sum())
        edges = np.empty((0, 2), dtype=np.int64) if caps else open_edges(walls)
        gap = mesh.points[edges[0]].mean(axis=0) if len(edges) else None
        result.append(CavityFound(name, names, caps, volume, middle, gap))
    return result
