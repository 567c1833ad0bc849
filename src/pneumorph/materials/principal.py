"""Numba kernels: from C to its principal stretches, and from the derivatives of W in them to stress and tangent."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

# error_model "numpy": a singular C gives nan in its own row instead of stopping the whole call.

# Relative distance of two eigenvalues under which the slope of the stresses stands for their divided difference. Both
# err there by 1e-11 to 1e-10: rounding over the distance, and the square of the distance.
_NEAR = 5e-6
# An off-diagonal entry this small against its diagonal ones is no longer rotated away (half the rounding, squared).
_NEGLIGIBLE = 1.2e-32
_SWEEPS = 20


@njit(cache=True, nogil=True, fastmath=False, error_model="numpy")
def spectrum(c: NDArray, logs: NDArray, squares: NDArray, axes: NDArray) -> None:
    """Write the eigenvalues λ² of `c` (n, 6), Voigt order 11, 22, 33, 23, 13, 12, into `squares` (3, n).

    `axes` (n, 3, 3) takes the unit eigenvectors as columns, `logs` (3, n) the logarithms of the isochoric stretches.
    A row that is not positive definite gives nan logarithms. Cyclic Jacobi rotations: the axes are orthonormal to
    rounding however close the eigenvalues are, and small eigenvalues keep their relative accuracy (Demmel, Veselić,
    SIAM J. Matrix Anal. Appl. 13 (1992) 1204).
    """
    a = np.empty((3, 3))
    v = np.empty((3, 3))
    for n in range(c.shape[0]):
        a[0, 0], a[1, 1], a[2, 2] = c[n, 0], c[n, 1], c[n, 2]
        a[1, 2] = a[2, 1] = c[n, 3]
        a[0, 2] = a[2, 0] = c[n, 4]
        a[0, 1] = a[1, 0] = c[n, 5]
        for i in range(3):
            for j in range(3):
                v[i, j] = 1.0 if i == j else 0.0
        for _ in range(_SWEEPS):
            turned = False
            for p in range(2):
                for q in range(p + 1, 3):
                    off = a[p, q]
                    if off * off > _NEGLIGIBLE * abs(a[p, p] * a[q, q]):
                        turned = True
                        ratio = 0.5 * (a[q, q] - a[p, p]) / off
                        tangent = 1.0 / (abs(ratio) + math.sqrt(ratio * ratio + 1.0))
                        if ratio < 0.0:
                            tangent = -tangent
                        cosine = 1.0 / math.sqrt(tangent * tangent + 1.0)
                        sine = tangent * cosine
                        a[p, p] -= tangent * off
                        a[q, q] += tangent * off
                        a[p, q] = a[q, p] = 0.0
                        r = 3 - p - q
                        arp, arq = a[r, p], a[r, q]
                        a[r, p] = a[p, r] = cosine * arp - sine * arq
                        a[r, q] = a[q, r] = sine * arp + cosine * arq
                        for i in range(3):
                            vip, viq = v[i, p], v[i, q]
                            v[i, p] = cosine * vip - sine * viq
                            v[i, q] = sine * vip + cosine * viq
            if not turned:
                break
        x0, x1, x2 = a[0, 0], a[1, 1], a[2, 2]
        if x0 > 0.0 and x1 > 0.0 and x2 > 0.0:
            e0, e1, e2 = 0.5 * math.log(x0), 0.5 * math.log(x1), 0.5 * math.log(x2)
            mean = (e0 + e1 + e2) / 3.0
            logs[0, n], logs[1, n], logs[2, n] = e0 - mean, e1 - mean, e2 - mean
        else:
            logs[0, n] = logs[1, n] = logs[2, n] = math.nan
        squares[0, n], squares[1, n], squares[2, n] = x0, x1, x2
        axes[n] = v


@njit(cache=True, nogil=True, fastmath=False, error_model="numpy")
def stress_and_tangent(
    squares: NDArray, axes: NDArray, first: NDArray, second: NDArray, s: NDArray, cc: NDArray
) -> None:
    """Write S = 2 dW/dC into `s` (n, 6) and 4 d²W/dCdC into `cc` (n, 21).

    `squares` (3, n) and `axes` (n, 3, 3) come from `spectrum`; `first` (3, n) and `second` (6, n) are the derivatives
    of W in the logarithms of the isochoric stretches. With x = λ², t = P first and H = P second P, P = 1 - 11'/3,
        s_a = t_a/x_a,    m_ab = 2 ds_a/dx_b = (H_ab - 2 δ_ab t_a)/(x_a x_b),    k_ab = (s_a - s_b)/(x_a - x_b),
        S = sum s_a A_a,  CC = sum m_ab A_a A_b + sum over a < b of k_ab B_ab B_ab,
    where A_a = N_a N_a and B_ab = N_a N_b + N_b N_a (Ogden, Non-linear Elastic Deformations (1984), ch. 6). As x_a and
    x_b meet, k_ab tends to (m_aa + m_bb)/4 - m_ab/2.
    """
    x = np.empty(3)
    t = np.empty(3)
    h = np.empty((3, 3))
    m = np.empty((3, 3))
    base = np.empty((6, 6))
    k = np.empty(3)
    for n in range(squares.shape[1]):
        mean = (first[0, n] + first[1, n] + first[2, n]) / 3.0
        for a in range(3):
            x[a] = squares[a, n]
            t[a] = first[a, n] - mean
            h[a, a] = second[a, n]
        h[1, 2] = h[2, 1] = second[3, n]
        h[0, 2] = h[2, 0] = second[4, n]
        h[0, 1] = h[1, 0] = second[5, n]
        r0 = (h[0, 0] + h[0, 1] + h[0, 2]) / 3.0
        r1 = (h[1, 0] + h[1, 1] + h[1, 2]) / 3.0
        r2 = (h[2, 0] + h[2, 1] + h[2, 2]) / 3.0
        whole = (r0 + r1 + r2) / 3.0
        rows = (r0, r1, r2)
        for a in range(3):
            for b in range(3):
                m[a, b] = (h[a, b] - rows[a] - rows[b] + whole) / (x[a] * x[b])
            m[a, a] -= 2.0 * t[a] / (x[a] * x[a])

        v = axes[n]
        for a in range(3):
            # the pair of the other two axes takes the place of its Voigt index: 23, 13, 12
            b, d = (a + 1) % 3, (a + 2) % 3
            gap = x[b] - x[d]
            if abs(gap) > _NEAR * (x[b] + x[d]):
                k[a] = (t[b] / x[b] - t[d] / x[d]) / gap
            else:
                k[a] = 0.25 * (m[b, b] + m[d, d]) - 0.5 * m[b, d]
            for i in range(3):
                j, l = (i + 1) % 3, (i + 2) % 3
                base[a, i] = v[i, a] * v[i, a]
                base[a, 3 + i] = v[j, a] * v[l, a]
                base[3 + a, i] = 2.0 * v[i, b] * v[i, d]
                base[3 + a, 3 + i] = v[j, b] * v[l, d] + v[l, b] * v[j, d]

        s0, s1, s2 = t[0] / x[0], t[1] / x[1], t[2] / x[2]
        entry = 0
        for i in range(6):
            a0, a1, a2 = base[0, i], base[1, i], base[2, i]
            s[n, i] = s0 * a0 + s1 * a1 + s2 * a2
            m0 = m[0, 0] * a0 + m[1, 0] * a1 + m[2, 0] * a2
            m1 = m[0, 1] * a0 + m[1, 1] * a1 + m[2, 1] * a2
            m2 = m[0, 2] * a0 + m[1, 2] * a1 + m[2, 2] * a2
            k0, k1, k2 = k[0] * base[3, i], k[1] * base[4, i], k[2] * base[5, i]
            for j in range(i, 6):
                cc[n, entry] = (
                    m0 * base[0, j] + m1 * base[1, j] + m2 * base[2, j]
                    + k0 * base[3, j] + k1 * base[4, j] + k2 * base[5, j]
                )  # fmt: skip
                entry += 1
