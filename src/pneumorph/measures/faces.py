"""Named faces in the reference and deformed: sample points with areas, centres, normals, best rotations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.mechanics import State
from pneumorph.mechanics.tables import face_table

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FaceSample:
    """Quadrature points of a face: reference and deformed places (m, d), mm; area (m,) in the reference, mm2;
    normal (d,): mean reference normal, of length 1, leaving the solid (zero for a closed face)."""

    reference: Array
    deformed: Array
    area: Array
    normal: Array

    @property
    def centre(self) -> Array:
        """Centre of area in the reference (d,), mm."""
        return np.average(self.reference, axis=0, weights=self.area)

    @property
    def moved_centre(self) -> Array:
        """Where the same material points have their centre now (d,), mm."""
        return np.average(self.deformed, axis=0, weights=self.area)


def sample(state: State, face: str) -> FaceSample:
    """Return the sample of a named face; raises NameNotFoundError."""
    mesh = state.model.mesh
    places, moved, areas, total = [], [], [], np.zeros(mesh.dimension)
    for block in mesh.face_blocks(face):
        shape, gradient, weight = face_table(block.kind)
        x, tangent = mesh.points[block.nodes], np.einsum("qmj,emi->eqij", gradient, mesh.points[block.nodes])
        if mesh.dimension == 3:
            normal = np.cross(tangent[..., 0], tangent[..., 1])
        else:  # edges run with the solid on their left
            normal = np.stack([tangent[..., 1, 0], -tangent[..., 0, 0]], axis=-1)
        normal = normal * weight[:, None]
        places.append(np.einsum("qm,emi->eqi", shape, x).reshape(-1, mesh.dimension))
        moved.append(np.einsum("qm,emi->eqi", shape, state.positions[block.nodes]).reshape(-1, mesh.dimension))
        areas.append(np.linalg.norm(normal, axis=-1).ravel())
        total += normal.sum(axis=(0, 1))
    size = float(np.linalg.norm(total))
    area = np.concatenate(areas)
    direction = total / size if size > 1e-9 * area.sum() else np.zeros_like(total)
    return FaceSample(np.concatenate(places), np.concatenate(moved), area, direction)


def best_rotation(reference: Array, deformed: Array, weight: Array) -> Array:
    """Return the rotation (d, d) that turns the reference points (m, d) best into the deformed ones.

    Weighted least squares after both centres are moved to the origin (Kabsch 1976); the points must not lie on one line
    in space, on one point in the plane.
    """
    first = reference - np.average(reference, axis=0, weights=weight)
    second = deformed - np.average(deformed, axis=0, weights=weight)
    left, _, right = np.linalg.svd((weight[:, None] * second).T @ first)
    mirror = np.ones(len(left))
    mirror[-1] = np.sign(np.linalg.det(left @ right))
    rotation: Array = (left * mirror) @ right
    return rotation


def unit_axis(axis: ArrayLike | None, dimension: int, owner: str) -> Array | None:
    """Return the axis of a signed angle (3,), of length 1: z in the plane; None where the angle has no sign.

    Raises InputError for an axis that is not three finite numbers, or is zero.
    """
    if dimension == 2 and axis is None:
        return np.array([0.0, 0.0, 1.0])
    if axis is None:
        return None
    vector = np.asarray(axis, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise InputError(f"{owner}: axis = {axis!r}, expected three numbers, not all zero")
    return vector / np.linalg.norm(vector)


def angle_between(first: Array, second: Array, axis: Array | None, owner: str) -> float:
    """Return the angle from one vector (d,) to another, rad: 0 to pi or, about an axis, -pi to pi.

    With an axis it is the angle between the projections on the plane across it, positive by the right-hand rule.
    From both sine and cosine, so that small angles keep their digits. Raises InputError where a projection vanishes.
    """
    u, v = (np.append(vector, np.zeros(3 - len(vector))) for vector in (first, second))
    if axis is not None:
        u, v = u - axis * (axis @ u), v - axis * (axis @ v)
        if np.linalg.norm(u) < 1e-6 * np.linalg.norm(first) or np.linalg.norm(v) < 1e-6 * np.linalg.norm(second):
            raise InputError(f"{owner}: axis {axis.tolist()} is parallel to the direction whose angle is asked for")
    cross = np.cross(u, v)
    sine = float(np.linalg.norm(cross)) if axis is None else float(axis @ cross)
    return float(np.arctan2(sine, u @ v))
