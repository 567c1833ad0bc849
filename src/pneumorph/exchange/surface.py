"""The surface of a body, deformed or not, as flat triangles that close."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, MeshError, unknown_name
from pneumorph.mechanics import Model
from pneumorph.mesh.mesh import FaceBlock
from pneumorph.mesh.topology import boundary, corner_keys, open_edges

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]

WHOLE, OUTER = "whole", "outer"
PARTS = (WHOLE, OUTER)

# faces cut into triangles on their own nodes, so that neighbours share edges: nodes of a face as in VTK
_CUTS = {
    "triangle6": ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    "quad9": ((0, 4, 8), (0, 8, 7), (4, 1, 5), (4, 5, 8), (8, 5, 2), (8, 2, 6), (7, 8, 6), (7, 6, 3)),
}


@dataclass(frozen=True, eq=False)
class Surface:
    """points (n, 3), mm; triangles (k, 3), their normals leaving the body."""

    points: Array
    triangles: Nodes

    @property
    def volume(self) -> float:
        """Volume that the triangles enclose, mm3."""
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def surface_of(model: Model, positions: Array | None = None, part: str = WHOLE) -> Surface:
    """Return the surface of a model's body: six-node faces as four triangles, nine-node faces as eight.

    positions: nodes (n, 3), mm, those of a state; None takes the mesh. part: 'whole' is the boundary of the solid with
    the walls of its cavities, 'outer' leaves these out: the body as if it were filled.

    Raises InputError for a plane or axisymmetric model, an unknown part, an outer surface that does not close because
    a cavity reaches it (a cut in a mirror plane); MeshError for faces that have no triangles.
    """
    mesh = model.mesh
    if mesh.dimension != 3:
        raise InputError(f"a {mesh.space} model has no surface in space: expected a 3d one")
    if part not in PARTS:
        raise InputError(unknown_name("part of a surface", part, PARTS))
    faces = boundary(mesh.blocks)
    if part == OUTER:
        names = [name for cavity in model.cavities for name in cavity.faces]
        faces = _without(faces, [block for name in names for block in mesh.faces.get(name, ())])
    triangles = _triangles(faces)
    gaps = open_edges(faces)
    if len(gaps):
        where = ", ".join(f"{x:.4g}" for x in mesh.points[gaps[0]].mean(axis=0))
        raise InputError(f"the {part} surface is open: {len(gaps)} free edges, one at ({where}) mm; take 'whole'")
    used, numbers = np.unique(triangles, return_inverse=True)
    points = (mesh.points if positions is None else positions)[used]
    return Surface(points, numbers.reshape(-1, 3))


def completed_surface(model: Model, mirror: str, positions: Array | None = None, part: str = WHOLE) -> Surface:
    """Return the surface of the body whose half is modelled: that of the half, and its image in a plane face.

    mirror: name of the plane face, which is left out; positions, part: as for `surface_of`.

    Raises InputError as `surface_of`, and where the half does not close with its image.
    """
    mesh = model.mesh
    if mesh.dimension != 3:
        raise InputError(f"a {mesh.space} model has no surface in space: expected a 3d one")
    if part not in PARTS:
        raise InputError(unknown_name("part of a surface", part, PARTS))
    left_out = list(mesh.face_blocks(mirror))
    if part == OUTER:
        left_out += [block for cavity in model.cavities for n in cavity.faces for block in mesh.faces.get(n, ())]
    faces = _without(boundary(mesh.blocks), left_out)
    plane = mesh.points[mesh.face_nodes(mirror)]
    normal = np.linalg.svd(plane - plane.mean(axis=0))[2][-1]
    height = (mesh.points - plane[0]) @ normal
    on = np.abs(height) < 1e-6 * mesh.size
    gaps = open_edges(faces)
    if len(gaps) and not on[gaps].all():
        raise InputError(f"the {part} surface of the half does not end in the plane of '{mirror}'")
    x = mesh.points if positions is None else positions
    image = x - 2.0 * np.outer((x - plane[0]) @ normal, normal)
    half = _triangles(faces)
    other = np.where(on[half], half, half + len(x))[:, ::-1]  # nodes in the plane are their own images
    used, numbers = np.unique(np.concatenate([half, other]), return_inverse=True)
    return Surface(np.concatenate([x, image])[used], numbers.reshape(-1, 3))


def _triangles(faces: tuple[FaceBlock, ...]) -> Nodes:
    for block in faces:
        if block.kind not in _CUTS:
            raise MeshError(f"{block.kind} faces cannot be cut into triangles: known are {', '.join(_CUTS)}")
    return np.concatenate([block.nodes[:, _CUTS[block.kind]].reshape(-1, 3) for block in faces])


def _without(faces: tuple[FaceBlock, ...], removed: list[FaceBlock]) -> tuple[FaceBlock, ...]:
    """Return the faces that are not among those removed."""
    gone = {tuple(key) for block in removed for key in corner_keys(block.kind, block.nodes).tolist()}
    kept = []
    for block in faces:
        stays = np.array([tuple(key) not in gone for key in corner_keys(block.kind, block.nodes).tolist()])
        if stays.any():
            kept.append(FaceBlock(block.kind, block.nodes[stays]))
    return tuple(kept)
