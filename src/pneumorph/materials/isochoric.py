"""Numba kernels: from C to the isochoric invariants, and from the derivatives of W to the stress and its tangent."""

from __future__ import annotations

import math

from numba import njit
from numpy.typing import NDArray

# error_model "numpy": a singular C gives nan or inf in its own row instead of stopping the whole call.


@njit(cache=True, nogil=True, fastmath=False, error_model="numpy")
def invariants(c: NDArray, out: NDArray) -> None:
    """Write Ī1, Ī2 and J^(-2/3) of `c` (n, 6), Voigt order 11, 22, 33, 23, 13, 12, into the rows of `out` (3, n).

    A row whose determinant is not positive gives nan.
    """
    for n in range(c.shape[0]):
        c0, c1, c2, c3, c4, c5 = c[n, 0], c[n, 1], c[n, 2], c[n, 3], c[n, 4], c[n, 5]
        m0 = c1 * c2 - c3 * c3
        m1 = c0 * c2 - c4 * c4
        m2 = c0 * c1 - c5 * c5
        determinant = c0 * m0 + c5 * (c3 * c4 - c5 * c2) + c4 * (c5 * c3 - c1 * c4)
        a = math.exp(-math.log(determinant) / 3.0) if determinant > 0.0 else math.nan
        out[0, n] = a * (c0 + c1 + c2)
        out[1, n] = a * a * (m0 + m1 + m2)
        out[2, n] = a


@njit(cache=True, nogil=True, fastmath=False, error_model="numpy")
def stress_and_tangent(c: NDArray, scale: NDArray, w: NDArray, s: NDArray, cc: NDArray) -> None:
    """Write S = 2 dW/dC into `s` (n, 6) and 4 d²W/dCdC into `cc` (n, 21) at `c` (n, 6).

    `scale` (n,) is J^(-2/3), called a below; `w` (5, n) holds W1, W2, W11, W12, W22.
    With G = C^-1 the gradients of the invariants are, over the three tensors I, C and G,
        dĪ1/dC = a I - a I1/3 G,        dĪ2/dC = a² I1 I - a² C - 2/3 a² I2 G,
    so every outer product of the tangent is a symmetric 3 x 3 table k over (I, C, G). What is left are the two
    fourth-order terms t G.G (from dG/dC) and -W2 a² times the identity (from dC/dC).
    """
    for n in range(c.shape[0]):
        c0, c1, c2, c3, c4, c5 = c[n, 0], c[n, 1], c[n, 2], c[n, 3], c[n, 4], c[n, 5]
        a = scale[n]
        aa = a * a
        w1, w2, w11, w12, w22 = w[0, n], w[1, n], w[2, n], w[3, n], w[4, n]

        # 1 / det C = a^3
        r = aa * a
        m0 = c1 * c2 - c3 * c3
        m1 = c0 * c2 - c4 * c4
        m2 = c0 * c1 - c5 * c5
        g0 = r * m0
        g1 = r * m1
        g2 = r * m2
        g3 = r * (c4 * c5 - c0 * c3)
        g4 = r * (c5 * c3 - c1 * c4)
        g5 = r * (c3 * c4 - c2 * c5)
        i1 = c0 + c1 + c2
        i2 = m0 + m1 + m2

        # coefficients of the two gradients over (I, C, G); the first has none on C
        p1 = a
        r1 = -a * i1 / 3.0
        p2 = aa * i1
        q2 = -aa
        r2 = -2.0 / 3.0 * aa * i2

        on_i = 2.0 * (w1 * p1 + w2 * p2)
        on_c = 2.0 * w2 * q2
        on_g = 2.0 * (w1 * r1 + w2 * r2)
        s[n, 0] = on_i + on_c * c0 + on_g * g0
        s[n, 1] = on_i + on_c * c1 + on_g * g1
        s[n, 2] = on_i + on_c * c2 + on_g * g2
        s[n, 3] = on_c * c3 + on_g * g3
        s[n, 4] = on_c * c4 + on_g * g4
        s[n, 5] = on_c * c5 + on_g * g5

        ii = 4.0 * (w11 * p1 * p1 + 2.0 * w12 * p1 * p2 + w22 * p2 * p2 + w2 * aa)
        ic = 4.0 * (w12 * p1 * q2 + w22 * p2 * q2)
        ig = 4.0 * (w11 * p1 * r1 + w12 * (p1 * r2 + p2 * r1) + w22 * p2 * r2 - w1 * a / 3.0 - w2 * p2 * 2.0 / 3.0)
        k_cc = 4.0 * w22 * q2 * q2
        cg = 4.0 * (w12 * q2 * r1 + w22 * q2 * r2 - w2 * q2 * 2.0 / 3.0)
        gg = 4.0 * (w11 * r1 * r1 + 2.0 * w12 * r1 * r2 + w22 * r2 * r2 + w1 * a * i1 / 9.0 + w2 * aa * i2 * 4.0 / 9.0)
        t = 4.0 * (w1 * a * i1 + w2 * 2.0 * aa * i2) / 3.0
        h = 0.5 * t
        e = -4.0 * w2 * aa

        # rows of k times (I, C, G), once for each Voigt pair: x over I, y over C, z over G
        x0 = ii + ic * c0 + ig * g0
        x1 = ii + ic * c1 + ig * g1
        x2 = ii + ic * c2 + ig * g2
        y0 = ic + k_cc * c0 + cg * g0
        y1 = ic + k_cc * c1 + cg * g1
        y2 = ic + k_cc * c2 + cg * g2
        y3 = k_cc * c3 + cg * g3
        y4 = k_cc * c4 + cg * g4
        y5 = k_cc * c5 + cg * g5
        z0 = ig + cg * c0 + gg * g0
        z1 = ig + cg * c1 + gg * g1
        z2 = ig + cg * c2 + gg * g2
        z3 = cg * c3 + gg * g3
        z4 = cg * c4 + gg * g4
        z5 = cg * c5 + gg * g5

        cc[n, 0] = x0 + y0 * c0 + z0 * g0 + t * g0 * g0 + e
        cc[n, 1] = x0 + y0 * c1 + z0 * g1 + t * g5 * g5
        cc[n, 2] = x0 + y0 * c2 + z0 * g2 + t * g4 * g4
        cc[n, 3] = y0 * c3 + z0 * g3 + t * g4 * g5
        cc[n, 4] = y0 * c4 + z0 * g4 + t * g0 * g4
        cc[n, 5] = y0 * c5 + z0 * g5 + t * g0 * g5
        cc[n, 6] = x1 + y1 * c1 + z1 * g1 + t * g1 * g1 + e
        cc[n, 7] = x1 + y1 * c2 + z1 * g2 + t * g3 * g3
        cc[n, 8] = y1 * c3 + z1 * g3 + t * g1 * g3
        cc[n, 9] = y1 * c4 + z1 * g4 + t * g3 * g5
        cc[n, 10] = y1 * c5 + z1 * g5 + t * g1 * g5
        cc[n, 11] = x2 + y2 * c2 + z2 * g2 + t * g2 * g2 + e
        cc[n, 12] = y2 * c3 + z2 * g3 + t * g2 * g3
        cc[n, 13] = y2 * c4 + z2 * g4 + t * g2 * g4
        cc[n, 14] = y2 * c5 + z2 * g5 + t * g3 * g4
        cc[n, 15] = y3 * c3 + z3 * g3 + h * (g1 * g2 + g3 * g3) + 0.5 * e
        cc[n, 16] = y3 * c4 + z3 * g4 + h * (g2 * g5 + g3 * g4)
        cc[n, 17] = y3 * c5 + z3 * g5 + h * (g3 * g5 + g1 * g4)
        cc[n, 18] = y4 * c4 + z4 * g4 + h * (g0 * g2 + g4 * g4) + 0.5 * e
        cc[n, 19] = y4 * c5 + z4 * g5 + h * (g0 * g3 + g4 * g5)
        cc[n, 20] = y5 * c5 + z5 * g5 + h * (g0 * g1 + g5 * g5) + 0.5 * e
