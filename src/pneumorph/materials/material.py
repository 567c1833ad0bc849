"""What every material gives the solver: isochoric energy, stress and tangent, bulk modulus, density.

The solver splits the stored energy into W(C), which does not feel a change of volume, and a volumetric part of its own
that needs the bulk modulus alone. A law in the invariants is a frozen dataclass under `InvariantMaterial` with one
vectorised method, `derivatives`. A law in the principal stretches (Ogden) belongs under a second base beside it, which
gives `energy`, `stress_and_tangent` and `stretch_derivatives` through an eigen-decomposition that is safe for equal
stretches; nothing else in the package needs to know which of the two a material is.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from numbers import Real
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.materials import isochoric
from pneumorph.units import show

Array = NDArray[np.float64]

# bulk modulus over initial shear modulus where a source says "incompressible"
INCOMPRESSIBLE_RATIO = 1000.0


class InvariantEnergy(NamedTuple):
    """W(Ī1, Ī2) in MPa and its derivatives at n points: each an array (n,) or one number for all points."""

    w: Array | float
    w1: Array | float
    w2: Array | float = 0.0
    w11: Array | float = 0.0
    w12: Array | float = 0.0
    w22: Array | float = 0.0


@dataclass(frozen=True)
class Material(ABC):
    """A hyperelastic solid, nearly incompressible.

    bulk:    bulk modulus, MPa; None takes 1000 times the initial shear modulus.
    density: mass density, tonne/mm³; None where it is not known, then the material bears no gravity or inertia.

    Raises InputError for a value that is not finite or not positive, and for a bulk modulus under 2/3 of the shear
    modulus (a negative Poisson's ratio).
    """

    bulk: float | None = field(default=None, kw_only=True, metadata={"kind": "stress"})
    density: float | None = field(default=None, kw_only=True, metadata={"kind": "density"})

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if value is not None or item.default is not None:
                self._check_finite(item.name, value, item.metadata["kind"])
        self._check_positive("density")
        self._check_law()
        least = 2.0 / 3.0 * self.shear_modulus
        if self.bulk is not None and self.bulk < least:
            raise InputError(
                f"{type(self).__name__}: bulk = {show(self.bulk, 'stress')}, "
                f"allowed: at least {show(least, 'stress')}, 2/3 of the initial shear modulus"
            )

    @abstractmethod
    def _check_law(self) -> None:
        """Raise InputError for constants of the law that are not allowed."""

    def _check_finite(self, name: str, value: object, kind: str) -> None:
        if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
            raise InputError(f"{type(self).__name__}: {name} = {value!r}, allowed: a finite {kind}")

    def _check_positive(self, name: str) -> None:
        value = getattr(self, name)
        if value is not None and value <= 0.0:
            kind = next(item.metadata["kind"] for item in fields(self) if item.name == name)
            raise InputError(f"{type(self).__name__}: {name} = {show(value, kind)}, allowed: more than 0")

    @property
    @abstractmethod
    def shear_modulus(self) -> float:
        """Initial shear modulus, MPa."""

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus, MPa: the one given, or 1000 times the initial shear modulus."""
        return INCOMPRESSIBLE_RATIO * self.shear_modulus if self.bulk is None else self.bulk

    @property
    def poisson_ratio(self) -> float:
        """Initial Poisson's ratio."""
        bulk, shear = self.bulk_modulus, self.shear_modulus
        return (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)

    @abstractmethod
    def energy(self, c: Array) -> Array:
        """Return the isochoric energy density (n,), MPa, at right Cauchy-Green tensors `c` (n, 6).

        `c` holds tensor components in the order 11, 22, 33, 23, 13, 12; its determinant J² need not be 1, but must be
        positive: nan comes back where it is not.
        """

    @abstractmethod
    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S = 2 dW/dC (n, 6) and CC = 4 d²W/dCdC (n, 21), MPa, of the isochoric energy at `c` (n, 6).

        S and `c` hold tensor components in the order 11, 22, 33, 23, 13, 12. CC holds the upper triangle, row by row,
        of the symmetric 6 x 6 table over the same pairs, tensor components again: CC_IJKL = 2 dS_IJ/dC_KL with no
        factor 2 on shears. nan comes back where det C is not positive. `out` takes the two C-contiguous arrays to
        write into. Safe to call from several threads at once.
        """

    @abstractmethod
    def stretch_derivatives(self, stretches: ArrayLike) -> Array:
        """Return dW/dλa (..., 3), MPa, at principal stretches (..., 3) with product 1 (incompressible).

        Defined up to a pressure: only differences of the Cauchy stresses λa dW/dλa mean something.
        """

    def uniaxial_tension(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress, MPa, of an incompressible bar at axial stretches of any shape, each positive."""
        first = _stretch(stretch)
        side = first**-0.5
        return self._nominal(first, side, side)

    def equibiaxial_tension(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress, MPa, of an incompressible sheet stretched alike in both directions."""
        first = _stretch(stretch)
        return self._nominal(first, first, first**-2)

    def planar_tension(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress, MPa, along the pull of an incompressible wide strip (pure shear)."""
        first = _stretch(stretch)
        return self._nominal(first, np.ones_like(first), 1.0 / first)

    def _nominal(self, first: Array, second: Array, third: Array) -> Array:
        """Return the first principal nominal stress where the third principal stress is zero."""
        slope = self.stretch_derivatives(np.stack([first, second, third], axis=-1))
        return slope[..., 0] - slope[..., 2] * third / first


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
        c = _voigt(c)
        basis = np.empty((3, len(c)))
        isochoric.invariants(c, basis)
        result = np.empty(len(c))
        result[:] = self.derivatives(basis[0], basis[1]).w
        return result

    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S (n, 6) and CC (n, 21), see `Material.stress_and_tangent`."""
        c = _voigt(c)
        stress, tangent = (np.empty((len(c), 6)), np.empty((len(c), 21))) if out is None else out
        if stress.shape != (len(c), 6) or tangent.shape != (len(c), 21):
            raise InputError(
                f"out has shapes {stress.shape} and {tangent.shape}: expected ({len(c)}, 6), ({len(c)}, 21)"
            )
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


def _voigt(c: Array) -> Array:
    """Return `c` as contiguous float64 (n, 6), the one signature that the kernels are compiled for."""
    c = np.ascontiguousarray(c, dtype=np.float64)
    if c.ndim != 2 or c.shape[1] != 6:
        raise InputError(f"c has shape {c.shape}: expected (n, 6), right Cauchy-Green tensors in Voigt order")
    return c


def _stretch(stretch: ArrayLike) -> Array:
    values = np.asarray(stretch, dtype=np.float64)
    if not (np.isfinite(values) & (values > 0.0)).all():
        raise InputError(f"stretch = {stretch!r}, allowed: finite and more than 0")
    return values
