"""The base of laws in the isochoric invariants Ī1 and Ī2."""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from pneumorph.materials import isochoric
from pneumorph.materials.material import Array, Material, outputs, voigt


class InvariantEnergy(NamedTuple):
    """W(Ī1, Ī2) in MPa and its derivatives at n points: each an array (n,) or one number for all points."""

    w: Array | float
    w1: Array | float
    w2: Array | float = 0.0
    w11: Array | float = 0.0
    w12: Array | float = 0.0
    w22: Array | float = 0.0


class InvariantMaterial(Material):
    """A law W(Ī1, Ī2): one method, `derivatives`, gives all of it."""

    @abstractmethod
    def derivatives(self, i1: Array, i2: Array) -> InvariantEnergy:
        """Return W and its first and second derivatives at isochoric invariants `i1` and `i2` of one shape.

        Ī1 = J^(-2/3) tr C and Ī2 = J^(-4/3) ((tr C)² - tr C²)/2; both are 3 in the reference.
        """

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, MPa: 2 (W1 + W2) at Ī1 = Ī2 = 3."""
        three = np.full(1, 3.0)
        slopes = self.derivatives(three, three)
        return float(np.ravel(2.0 * (np.asarray(slopes.w1) + np.asarray(slopes.w2)))[0])

    def energy(self, c: Array) -> Array:
        """Return the isochoric energy density (n,), see `Material.energy`."""
        c = voigt(c)
        basis = np.empty((3, len(c)))
        isochoric.invariants(c, basis)
        result = np.empty(len(c))
        result[:] = self.derivatives(basis[0], basis[1]).w
        return result

    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S (n, 6) and CC (n, 21), see `Material.stress_and_tangent`."""
        c = voigt(c)
        stress, tangent = outputs(len(c), out)
        basis = np.empty((3, len(c)))
        isochoric.invariants(c, basis)
        slopes = np.empty((5, len(c)))
        for row, slope in zip(slopes, self.derivatives(basis[0], basis[1])[1:], strict=True):
            row[:] = slope
        isochoric.stress_and_tangent(c, basis[2], slopes, stress, tangent)
        return stress, tangent

    def stretch_derivatives(self, stretches: ArrayLike) -> Array:
        """Return dW/dλa = 2 λa (W1 + (I1 - λa²) W2), see `Material.stretch_derivatives`."""
        stretches = np.asarray(stretches, dtype=float)
        squares = stretches**2
        i1 = squares.sum(axis=-1)
        i2 = squares[..., 0] * squares[..., 1] + squares[..., 1] * squares[..., 2] + squares[..., 2] * squares[..., 0]
        slopes = self.derivatives(i1, i2)
        w1, w2 = (np.asarray(slope)[..., np.newaxis] for slope in (slopes.w1, slopes.w2))
        return 2.0 * stretches * (w1 + (i1[..., np.newaxis] - squares) * w2)
