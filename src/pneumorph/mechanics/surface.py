"""Volume enclosed by a deformed surface, and its exact first and second derivatives.

For any field v with div v = 1 the volume is -int v.n da over the faces of the solid that bound it (their normal
leaves the solid, so it enters the cavity). v = P (x - x0) / tr P, with a projection P, is tangential to the planes
in which a cavity may lie open (mirror planes), so that those need no faces. The derivative of this function of
the nodes is the follower load of a unit pressure, its second derivative is symmetric by construction.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from pneumorph.mechanics.tables import face_table

Array = NDArray[np.float64]


@njit(cache=True, nogil=True)
def _solid(faces, position, origin, project, shape, gradient, weight, first, second, order):  # type: ignore[no-untyped-def]
    """Return the volume; add to first (nodes, 3) and second (faces, 3, 3, n, n) by the order asked for."""
    n = faces.shape[1]
    volume = 0.0
    scale = -1.0 / (project[0, 0] + project[1, 1] + project[2, 2])
    x, v, s, t = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for e in range(len(faces)):
        for q in range(len(weight)):
            x[:] = -origin
            s[:] = 0.0
            t[:] = 0.0
            for m in range(n):
                for i in range(3):
                    value = position[faces[e, m], i]
                    x[i] += shape[q, m] * value
                    s[i] += gradient[q, m, 0] * value
                    t[i] += gradient[q, m, 1] * value
            w = scale * weight[q]
            for i in range(3):
                v[i] = project[i, 0] * x[0] + project[i, 1] * x[1] + project[i, 2] * x[2]
            st = np.array([s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]])
            tv = np.array([t[1] * v[2] - t[2] * v[1], t[2] * v[0] - t[0] * v[2], t[0] * v[1] - t[1] * v[0]])
            vs = np.array([v[1] * s[2] - v[2] * s[1], v[2] * s[0] - v[0] * s[2], v[0] * s[1] - v[1] * s[0]])
            volume += w * (v[0] * st[0] + v[1] * st[1] + v[2] * st[2])
            if order < 1:
                continue
            for m in range(n):
                for i in range(3):
                    value = gradient[q, m, 0] * tv[i] + gradient[q, m, 1] * vs[i]
                    for j in range(3):
                        value += shape[q, m] * project[j, i] * st[j]
                    first[faces[e, m], i] += w * value
            if order < 2:
                continue
            # second variation of v . (s x t) with v = P x: terms dv-ds, dv-dt (in a) and ds-dt (in st_mb)
            for m in range(n):
                for b in range(n):
                    st_mb = gradient[q, m, 0] * gradient[q, b, 1] - gradient[q, m, 1] * gradient[q, b, 0]
                    for c in range(3):
                        i, j = (c + 1) % 3, (c + 2) % 3
                        a_mb = shape[q, m] * (gradient[q, b, 0] * t[c] - gradient[q, b, 1] * s[c])
                        a_bm = shape[q, b] * (gradient[q, m, 0] * t[c] - gradient[q, m, 1] * s[c])
                        second[e, i, j, m, b] += w * st_mb * v[c]
                        second[e, j, i, m, b] -= w * st_mb * v[c]
                        for l in range(3):  # the antisymmetric matrix of a, met by P on the side of dv
                            second[e, l, j, m, b] += w * project[i, l] * a_mb
                            second[e, l, i, m, b] -= w * project[j, l] * a_mb
                            second[e, j, l, m, b] += w * project[i, l] * a_bm
                            second[e, i, l, m, b] -= w * project[j, l] * a_bm
    return volume


def _planar(
    faces: NDArray[np.int64], position: Array, origin: Array, project: Array, axisymmetric: bool,
    shape: Array, gradient: Array, weight: Array, first: Array, second: Array | None,
) -> float:  # fmt: skip
    """Return the same for edges in the plane: area for 1 mm of depth, or the volume of revolution.

    The radial field v = (r / 2, 0) makes the latter -pi int r^2 dz: planes z = const and the axis need no faces.
    """
    x = position[faces]
    r = np.einsum("qm,emi->eqi", shape, x)
    t = np.einsum("qm,emi->eqi", gradient[:, :, 0], x)
    if axisymmetric:
        # edges run with the solid on their left, so the normal that leaves it is (t_z, -t_r)
        volume = -np.pi * np.einsum("q,eq,eq->", weight, r[:, :, 0] ** 2, t[:, :, 1])
        value = np.zeros_like(x)
        value[:, :, 0] = -2 * np.pi * np.einsum("q,eq,eq,qm->em", weight, r[:, :, 0], t[:, :, 1], shape)
        value[:, :, 1] = -np.pi * np.einsum("q,eq,qm->em", weight, r[:, :, 0] ** 2, gradient[:, :, 0])
        np.add.at(first, faces, value)
        if second is not None:
            second[:, 0, 0] = -2 * np.pi * np.einsum("q,eq,qm,qb->emb", weight, t[:, :, 1], shape, shape)
            mixed = -2 * np.pi * np.einsum("q,eq,qm,qb->emb", weight, r[:, :, 0], shape, gradient[:, :, 0])
            second[:, 0, 1] = mixed
            second[:, 1, 0] = np.swapaxes(mixed, 1, 2)
        return float(volume)
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])  # tangent -> normal that leaves the solid
    scale = -1.0 / np.trace(project)
    form = scale * project.T @ turn
    centred = r - origin
    volume = np.einsum("q,eqi,ij,eqj->", weight, centred, form, t)
    value = np.einsum("q,qm,ij,eqj->emi", weight, shape, form, t)
    value += np.einsum("q,qm,ji,eqj->emi", weight, gradient[:, :, 0], form, centred)
    np.add.at(first, faces, value)
    if second is not None:
        half = np.einsum("q,qm,qb,ij->ijmb", weight, shape, gradient[:, :, 0], form)
        second[:] = half + half.transpose(1, 0, 3, 2)
    return float(volume)


def enclosed_volume(
    kind: str, faces: NDArray[np.int64], position: Array, origin: Array, project: Array, axisymmetric: bool, order: int
) -> tuple[float, Array, Array | None]:
    """Return the volume (mm3), its gradient (nodes, d) and, for order 2, face Hessians (faces, d, d, n, n).

    kind and faces (m, n): faces of the solid, normals leaving it; position (nodes, d): deformed nodes;
    origin (d,) and project (d, d): the field v above.
    """
    shape, gradient, weight = face_table(kind)
    first = np.zeros_like(position)
    n, d = faces.shape[1], position.shape[1]
    second = np.zeros((len(faces), d, d, n, n)) if order == 2 else None
    if d == 2:
        volume = _planar(faces, position, origin, project, axisymmetric, shape, gradient, weight, first, second)
    else:
        buffer = np.zeros((0, d, d, n, n)) if second is None else second
        volume = _solid(faces, position, origin, project, shape, gradient, weight, first, buffer, order)
    return volume, first, second
