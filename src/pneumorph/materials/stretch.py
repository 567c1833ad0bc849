"""The base of laws in the isochoric principal stretches."""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from pneumorph.materials import principal
from pneumorph.materials.material import Array, Material, outputs, voigt


class StretchEnergy(NamedTuple):
    """W in MPa (n,) and its derivatives in the logarithms of the stretches: first (3, n), second (6, n).

    The second derivatives are in the order 11, 22, 33, 23, 13, 12.
    """

    w: Array
    first: Array
    second: Array


class StretchMaterial(Material):
    """A law W(λ̄1, λ̄2, λ̄3), the same in any order of the stretches: one method, `derivatives`, gives all of it.

    Logarithms serve as variables because the isochoric ones are plain differences, e - mean(e), and because the powers
    of Ogden's family become exponentials without cancellation near the reference.
    """

    @abstractmethod
    def derivatives(self, logs: Array) -> StretchEnergy:
        """Return W and its derivatives at logarithms `logs` (3, ...) of the isochoric stretches, ln λa - (ln J)/3.

        W is taken as a function of three independent variables; what changes the volume is projected out afterwards.
        """

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, MPa: (W11 - W12)/2 in the logarithms at rest."""
        second = self.derivatives(np.zeros((3, 1))).second
        return float(0.5 * (second[0, 0] - second[5, 0]))

    def energy(self, c: Array) -> Array:
        """Return the isochoric energy density (n,), see `Material.energy`."""
        return self.derivatives(self._spectrum(voigt(c))[0]).w

    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S (n, 6) and CC (n, 21), see `Material.stress_and_tangent`."""
        c = voigt(c)
        stress, tangent = outputs(len(c), out)
        logs, squares, axes = self._spectrum(c)
        _, first, second = self.derivatives(logs)
        principal.stress_and_tangent(squares, axes, first, second, stress, tangent)
        return stress, tangent

    def stretch_derivatives(self, stretches: ArrayLike) -> Array:
        """Return dW/dλa = (dW/d ln λa)/λa, see `Material.stretch_derivatives`."""
        stretches = np.asarray(stretches, dtype=float)
        first = self.derivatives(np.log(np.moveaxis(stretches, -1, 0))).first
        return np.moveaxis(first, 0, -1) / stretches

    @staticmethod
    def _spectrum(c: Array) -> tuple[Array, Array, Array]:
        logs, squares, axes = np.empty((3, len(c))), np.empty((3, len(c))), np.empty((len(c), 3, 3))
        principal.spectrum(c, logs, squares, axes)
        return logs, squares, axes


def diagonal(second: Array) -> Array:
    """Return the second derivatives (6, ...) of a sum of functions of one stretch each, from their own (3, ...)."""
    return np.concatenate([second, np.zeros_like(second)])
