"""The element kernels: one generic source over tabulated arrays, compiled once for each shape of element.

Displacement u and, in each cell, a few pressure modes q make the two-field energy
    integral of W(C) + U(J) + q (J - 1) - q^2 / (2 K)
(Sussman and Bathe 1987, with the pressure a Lagrange multiplier of J - 1). With modes L,
M = int L L', b = int L (J - 1), B = int cof(F) grad N L, and q kept as a state that is updated linearly,
    r_q = b - M q / K,    residual = f(q) + K B M^-1 r_q,    tangent = K_uu + K B M^-1 B',
    q <- q + K M^-1 (r_q + B' du).
Eliminating q exactly takes nearly twice the iterations (docs/decisions.md). U acts at every point and keeps the cell
from turning inside out while its mean volume is held by q, see `volumetric`.

Where a beam turns, the step of Newton's method stretches it to second order, and the stress of that is many times the
true one. The tangent's geometric part therefore takes stresses that were carried along the step to first order,
    S(u) + CC : sym(F' grad du),    U'(J) + U'' cof(F) : grad du,
the residual those of the place (Magisano, Leonetti, Garcea, CMAME 313 (2017) 235: mixed integration points).

Plane strain has F_33 = 1; axial symmetry F_33 = r / R and the volume factor 2 pi R.
"""

from __future__ import annotations

import numpy as np
from numba import njit

# The rounding of a sum may change, infinities and NaN must stay visible.
_FAST = {"contract", "nsz", "arcp", "reassoc"}
_VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
# position in the stored upper triangle (21 numbers) of each pair of Voigt indices
_PACKED = np.zeros((6, 6), dtype=np.int64)
_PACKED[np.triu_indices(6)] = np.arange(21)
_PACKED = np.maximum(_PACKED, _PACKED.T)


@njit(cache=True, nogil=True, inline="always")
def _invert(a, inverse):  # type: ignore[no-untyped-def]
    """Write the inverse of a 3 x 3 matrix and return its determinant."""
    inverse[0, 0] = a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1]
    inverse[0, 1] = a[0, 2] * a[2, 1] - a[0, 1] * a[2, 2]
    inverse[0, 2] = a[0, 1] * a[1, 2] - a[0, 2] * a[1, 1]
    inverse[1, 0] = a[1, 2] * a[2, 0] - a[1, 0] * a[2, 2]
    inverse[1, 1] = a[0, 0] * a[2, 2] - a[0, 2] * a[2, 0]
    inverse[1, 2] = a[0, 2] * a[1, 0] - a[0, 0] * a[1, 2]
    inverse[2, 0] = a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0]
    inverse[2, 1] = a[0, 1] * a[2, 0] - a[0, 0] * a[2, 1]
    inverse[2, 2] = a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0]
    det = a[0, 0] * inverse[0, 0] + a[0, 1] * inverse[1, 0] + a[0, 2] * inverse[2, 0]
    scale = 1.0 / det if det != 0.0 else 0.0
    for i in range(3):
        for j in range(3):
            inverse[i, j] *= scale
    return det


def sizes_of(nodes_a_cell: int, dimension: int, modes: int, axisymmetric: bool) -> tuple[tuple[int, ...], ...]:
    """Return the `sizes` argument of the kernels: tuples whose lengths the compiler knows, so that it unrolls."""
    return (0,) * nodes_a_cell, (0,) * dimension, (0,) * modes, (0,) * axisymmetric


@njit(cache=True, nogil=True, inline="always")
def _kinematics(sizes, cell, points, position, shape, gradient, q, g, h, a, inverse, f):  # type: ignore[no-untyped-def]
    """Fill gradients g (d, n), hoop terms h (n) and F; return the reference volume factor."""
    n, d = len(sizes[0]), len(sizes[1])
    for i in range(3):
        for j in range(3):
            a[i, j] = 1.0 if i == j else 0.0
            f[i, j] = 1.0 if i == j else 0.0
    for i in range(d):
        for j in range(d):
            value = 0.0
            for m in range(n):
                value += points[cell[m], i] * gradient[q, m, j]
            a[i, j] = value
    factor = _invert(a, inverse)
    for j in range(d):
        for m in range(n):
            value = 0.0
            for i in range(d):
                value += gradient[q, m, i] * inverse[i, j]
            g[j, m] = value
    for i in range(d):
        for j in range(d):
            value = 0.0
            for m in range(n):
                value += position[cell[m], i] * g[j, m]
            f[i, j] = value
    if len(sizes[3]):
        radius = 0.0
        deformed = 0.0
        for m in range(n):
            radius += shape[q, m] * points[cell[m], 0]
            deformed += shape[q, m] * position[cell[m], 0]
        if radius > 0.0:
            f[2, 2] = deformed / radius
            for m in range(n):
                h[m] = shape[q, m] / radius
        else:  # on the axis the hoop stretch is the radial one
            f[2, 2] = f[0, 0]
            for m in range(n):
                h[m] = g[0, m]
        factor *= 2.0 * np.pi * radius
    return factor


@njit(cache=True, nogil=True, fastmath=_FAST)
def deformation(sizes, points, position, cells, shape, gradient, c, volume_ratio):  # type: ignore[no-untyped-def]
    """Write C (cells, q, 6) and J (cells, q); return the smallest J (reference cells must not be inverted)."""
    n, d = len(sizes[0]), len(sizes[1])
    g, h = np.empty((d, n)), np.empty(n)
    a, inverse, f = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    smallest = np.inf
    for e in range(len(cells)):
        for q in range(len(shape)):
            _kinematics(sizes, cells[e], points, position, shape, gradient, q, g, h, a, inverse, f)
            for i in range(3):
                for j in range(i, 3):
                    c[e, q, _VOIGT[i, j]] = f[0, i] * f[0, j] + f[1, i] * f[1, j] + f[2, i] * f[2, j]
            det = _invert(f, inverse)
            volume_ratio[e, q] = det
            smallest = min(smallest, det)
    return smallest


@njit(cache=True, nogil=True, inline="always")
def _solve_modes(mass, right):  # type: ignore[no-untyped-def]
    """Replace mass by its Cholesky factor and right (k, m) by factor^-1 right."""
    k = len(mass)
    for i in range(k):
        for j in range(i + 1):
            value = mass[i, j]
            for m in range(j):
                value -= mass[i, m] * mass[j, m]
            mass[i, j] = np.sqrt(value) if i == j else value / mass[j, j]
    for i in range(k):
        for j in range(i):
            for m in range(right.shape[1]):
                right[i, m] -= mass[i, j] * right[j, m]
        for m in range(right.shape[1]):
            right[i, m] /= mass[i, i]


@njit(cache=True, nogil=True, inline="always")
def _scatter(sizes, cell, matrix, slot, indptr, data):  # type: ignore[no-untyped-def]
    """Add a symmetric element matrix (upper blocks i <= l given) to the upper-triangular block rows."""
    n, d = len(sizes[0]), len(sizes[1])
    pair = 0
    for m in range(n):
        for b in range(m, n):
            if m == b:
                for i in range(d):
                    start = indptr[d * cell[m] + i] - i
                    for l in range(i, d):
                        data[start + l] += matrix[i, l, m, m]
            else:
                low, high = (m, b) if cell[m] < cell[b] else (b, m)
                for i in range(d):
                    start = indptr[d * cell[low] + i] + d - i + d * slot[pair]
                    for l in range(d):
                        data[start + l] += matrix[i, l, low, high] if i <= l else matrix[l, i, high, low]
            pair += 1


@njit(cache=True, nogil=True)
def add_matrices(sizes, cells, matrices, slots, indptr, data):  # type: ignore[no-untyped-def]
    """Add symmetric matrices (cells, d, d, n, n) of cells or faces to the values of the pattern."""
    for e in range(len(cells)):
        _scatter(sizes, cells[e], matrices[e], slots[e], indptr, data)


@njit(cache=True, nogil=True, fastmath=_FAST)
def integrate(  # type: ignore[no-untyped-def]
    sizes, points, position, cells, shape, gradient, weight, mode, bulk, local, pressure, s, cc,
    carried, slots, indptr, residual, data, gain_constant, gain, tangent,
):  # fmt: skip
    """Add the residual and, with `tangent`, the stiffness of all cells.

    s (cells, q, 6), cc (cells, q, 21): stress and tangent of the material; pressure (cells, k): q modes.
    residual (nodes * d,), data: values of the matrix whose block pattern `indptr` and `slots` describe.
    gain_constant (cells, k) and gain (cells, k, d, n): K M^-1 r_q and K M^-1 B', which update q.
    carried (cells, q, 7): S and U' that the tangent takes for those of the place, see `advance`.
    """
    n, d, k = len(sizes[0]), len(sizes[1]), len(sizes[2])
    g, h = np.empty((d, n)), np.empty(n)
    a, inverse, f = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    cof, p = np.empty((3, 3)), np.empty((3, 3))
    elasticity = np.empty((3, 3, 3, 3))
    row = np.empty((d, d))
    matrix = np.empty((d, d, n, n))
    force = np.empty((d, n))
    mass = np.empty((k, k))
    right = np.empty((k, d * n + 1))  # B' and, in the last column, r_q
    half = np.empty(6)
    for e in range(len(cells)):
        cell = cells[e]
        matrix[:] = 0.0
        force[:] = 0.0
        mass[:] = 0.0
        right[:] = 0.0
        for q in range(len(shape)):
            w = weight[q] * _kinematics(sizes, cell, points, position, shape, gradient, q, g, h, a, inverse, f)
            det = _invert(f, inverse)
            multiplier = 0.0
            for m in range(k):
                multiplier += mode[q, m] * pressure[e, m]
            total = multiplier + 0.5 * local * (det - 1.0 / det)
            second = 0.5 * local * (1.0 + 1.0 / (det * det))
            held = multiplier + carried[e, q, 6]
            for i in range(3):
                for j in range(3):
                    cof[i, j] = det * inverse[j, i]
            for i in range(3):
                for j in range(3):
                    value = total * cof[i, j]
                    for m in range(3):
                        value += f[i, m] * s[e, q, _VOIGT[m, j]]
                    p[i, j] = value
            for i in range(d):
                for j in range(d):
                    for m in range(n):
                        force[i, m] += w * p[i, j] * g[j, m]
            if len(sizes[3]):
                for m in range(n):
                    force[0, m] += w * p[2, 2] * h[m]
            for r in range(k):
                for m in range(r + 1):
                    mass[r, m] += w * mode[q, r] * mode[q, m]
                right[r, d * n] += w * mode[q, r] * (det - 1.0 - multiplier / bulk)
                for i in range(d):
                    for j in range(d):
                        value = w * mode[q, r] * cof[i, j]
                        for m in range(n):
                            right[r, i * n + m] += value * g[j, m]
                if len(sizes[3]):
                    value = w * mode[q, r] * cof[2, 2]
                    for m in range(n):
                        right[r, m] += value * h[m]
            if not tangent:
                continue
            # dP_iJ / dF_kL = F_iI CC_IJKL F_kK + delta_ik S_JL + (q + U') d2J / dF_iJ dF_kL + U'' cof_iJ cof_kL
            for i in range(3):
                for j in range(3):
                    if (i >= d or j >= d) and not (len(sizes[3]) and i == 2 and j == 2):
                        continue
                    for v in range(6):
                        value = 0.0
                        for m in range(3):
                            value += f[i, m] * cc[e, q, _PACKED[_VOIGT[m, j], v]]
                        half[v] = value
                    for r in range(3):
                        for l in range(3):
                            value = (held + second * det) * det * inverse[j, i] * inverse[l, r]
                            value -= held * det * inverse[l, i] * inverse[j, r]
                            for m in range(3):
                                value += f[r, m] * half[_VOIGT[m, l]]
                            if i == r:
                                value += carried[e, q, _VOIGT[j, l]]
                            elasticity[i, j, r, l] = w * value
            for i in range(d):
                for m in range(n):
                    for r in range(d):
                        for l in range(d):
                            value = 0.0
                            for j in range(d):
                                value += g[j, m] * elasticity[i, j, r, l]
                            if len(sizes[3]) and i == 0:
                                value += h[m] * elasticity[2, 2, r, l]
                            row[r, l] = value
                    for r in range(i, d):
                        for l in range(d):
                            value = row[r, l]
                            for b in range(n):
                                matrix[i, r, m, b] += value * g[l, b]
                    if len(sizes[3]) and i == 0:  # columns of the hoop strain; in stored blocks only u_r meets u_r
                        value = h[m] * elasticity[2, 2, 2, 2]
                        for j in range(d):
                            value += g[j, m] * elasticity[2, 2, 0, j]
                        for b in range(n):
                            matrix[0, 0, m, b] += value * h[b]
        # condensation with M = U U': right becomes U^-1 [B', r_q]
        _solve_modes(mass, right)
        for i in range(d):
            for m in range(n):
                value = force[i, m]
                for r in range(k):
                    value += bulk * right[r, i * n + m] * right[r, d * n]
                residual[d * cell[m] + i] += value
        if not tangent:
            continue
        for r in range(k):
            for i in range(d):
                for l in range(i, d):
                    for m in range(n):
                        value = bulk * right[r, i * n + m]
                        for b in range(n):
                            matrix[i, l, m, b] += value * right[r, l * n + b]
        for m in range(d * n + 1):  # gain = K U^-T right
            for i in range(k - 1, -1, -1):
                value = right[i, m]
                for j in range(i + 1, k):
                    value -= mass[j, i] * right[j, m]
                right[i, m] = value / mass[i, i]
        for r in range(k):
            gain_constant[e, r] = bulk * right[r, d * n]
            for i in range(d):
                for m in range(n):
                    gain[e, r, i, m] = bulk * right[r, i * n + m]
        _scatter(sizes, cell, matrix, slots[e], indptr, data)


@njit(cache=True, nogil=True, fastmath=_FAST)
def advance(sizes, points, position, step, cells, shape, gradient, local, cc, carried):  # type: ignore[no-untyped-def]
    """Add to S and U' in `carried` (cells, q, 7) their change along a step (nodes, d), to first order in the step."""
    n, d = len(sizes[0]), len(sizes[1])
    g, h = np.empty((d, n)), np.empty(n)
    a, inverse, f = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    df, strain = np.zeros((3, 3)), np.empty(6)
    for e in range(len(cells)):
        cell = cells[e]
        for q in range(len(shape)):
            _kinematics(sizes, cell, points, position, shape, gradient, q, g, h, a, inverse, f)
            for i in range(d):
                for j in range(d):
                    value = 0.0
                    for m in range(n):
                        value += step[cell[m], i] * g[j, m]
                    df[i, j] = value
            if len(sizes[3]):
                value = 0.0
                for m in range(n):
                    value += step[cell[m], 0] * h[m]
                df[2, 2] = value
            for i in range(3):
                for j in range(i, 3):
                    value = 0.0
                    for m in range(3):
                        value += f[m, i] * df[m, j] + f[m, j] * df[m, i]
                    strain[_VOIGT[i, j]] = 0.5 * value if i == j else value  # shears count twice in CC : dE
            for i in range(6):
                value = 0.0
                for j in range(6):
                    value += cc[e, q, _PACKED[i, j]] * strain[j]
                carried[e, q, i] += value
            det = _invert(f, inverse)
            value = 0.0
            for i in range(3):
                for j in range(3):
                    value += inverse[j, i] * df[i, j]
            carried[e, q, 6] += 0.5 * local * (det + 1.0 / det) * value


@njit(cache=True, nogil=True)
def volumetric(sizes, points, position, cells, shape, gradient, weight, mode, bulk, local, pressure, density):  # type: ignore[no-untyped-def]
    """Return (int of W + U, condensed K/2 b' M^-1 b, mixed int of q (J - 1) - q^2 / (2 K)).

    density (cells, q): the isochoric energy at the quadrature points.
    """
    n, d, k = len(sizes[0]), len(sizes[1]), len(sizes[2])
    g, h = np.empty((d, n)), np.empty(n)
    a, inverse, f = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    mass, right = np.empty((k, k)), np.empty((k, 1))
    pointwise, condensed, mixed = 0.0, 0.0, 0.0
    for e in range(len(cells)):
        mass[:] = 0.0
        right[:] = 0.0
        for q in range(len(shape)):
            w = weight[q] * _kinematics(sizes, cells[e], points, position, shape, gradient, q, g, h, a, inverse, f)
            det = _invert(f, inverse)
            pointwise += w * (density[e, q] + 0.25 * local * (det * det - 1.0 - 2.0 * np.log(det)))
            multiplier = 0.0
            for r in range(k):
                multiplier += mode[q, r] * pressure[e, r]
                right[r, 0] += w * mode[q, r] * (det - 1.0)
                for m in range(r + 1):
                    mass[r, m] += w * mode[q, r] * mode[q, m]
            mixed += w * multiplier * (det - 1.0 - 0.5 * multiplier / bulk)
        _solve_modes(mass, right)
        for r in range(k):
            condensed += 0.5 * bulk * right[r, 0] ** 2
    return pointwise, condensed, mixed
