"""What every material gives the solver: isochoric energy, stress and tangent, bulk modulus, density.

The solver splits the stored energy into W(C), which does not feel a change of volume, and a volumetric part of its own
that needs the bulk modulus alone. A law is a frozen dataclass with one vectorised method, `derivatives`, under one of
two bases: `InvariantMaterial` for a law in the isochoric invariants, `StretchMaterial` for one in the isochoric
principal stretches. Nothing else in the package needs to know which of the two a material is.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.materials import tension
from pneumorph.materials.constants import as_numbers, check_finite
from pneumorph.materials.prony import Prony
from pneumorph.units import show

Array = NDArray[np.float64]

# bulk modulus over initial shear modulus where a source says "incompressible"
INCOMPRESSIBLE_RATIO = 1000.0


class PointLaw(Protocol):
    """A law at given points: what the solver evaluates. Every material without directions is one."""

    def energy(self, c: Array) -> Array:
        """Return the energy density (n,), see `Material.energy`."""

    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S (n, 6) and CC (n, 21), see `Material.stress_and_tangent`."""


@dataclass(frozen=True)
class Material(ABC):
    """A hyperelastic solid, nearly incompressible, viscous on request.

    bulk:    bulk modulus, MPa; None takes 1000 times the initial shear modulus.
    density: mass density, tonne/mm³; None where it is not known, then the material bears no gravity or inertia.
    prony:   relaxation of the isochoric stress; None for a purely elastic solid. The constants of the law are the
             long-term ones, so that states at rest do not feel it.

    Raises InputError for a value that is not finite or not positive, and for a bulk modulus under 2/3 of the shear
    modulus (a negative Poisson's ratio).
    """

    bulk: float | None = field(default=None, kw_only=True, metadata={"kind": "stress"})
    density: float | None = field(default=None, kw_only=True, metadata={"kind": "density"})
    prony: Prony | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        for item in fields(self):
            value, kind = getattr(self, item.name), item.metadata.get("kind")
            if kind is None or (value is None and item.default is None):
                continue
            if item.metadata.get("many"):
                object.__setattr__(self, item.name, as_numbers(type(self).__name__, item.name, value, kind))
            else:
                check_finite(type(self).__name__, item.name, value, kind)
        if not (self.prony is None or isinstance(self.prony, Prony)):
            raise InputError(f"{type(self).__name__}: prony = {self.prony!r}, allowed: a Prony or None")
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

    def _check_positive(self, name: str) -> None:
        value = getattr(self, name)
        if value is not None and value <= 0.0:
            self._refuse(name, value, "more than 0")

    def _refuse(self, name: str, value: float, allowed: str) -> None:
        """Raise the InputError of a constant; `name` is that of its field."""
        kind = next(item.metadata["kind"] for item in fields(self) if item.name == name)
        raise InputError(f"{type(self).__name__}: {name} = {show(value, kind)}, allowed: {allowed}")

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

    def at(self, place: Array) -> PointLaw:
        """Return the law at reference positions (n, 3), mm: another one for a material with directions of its own."""
        return self

    @abstractmethod
    def energy(self, c: Array) -> Array:
        """Return the isochoric energy density (n,), MPa, at right Cauchy-Green tensors `c` (n, 6).

        `c` holds tensor components in the order 11, 22, 33, 23, 13, 12; its determinant J² need not be 1, but must be
        positive: nan comes back where it is not, and where a law that locks has no state.
        """

    @abstractmethod
    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S = 2 dW/dC (n, 6) and CC = 4 d²W/dCdC (n, 21), MPa, of the isochoric energy at `c` (n, 6).

        S and `c` hold tensor components in the order 11, 22, 33, 23, 13, 12. CC holds the upper triangle, row by row,
        of the symmetric 6 x 6 table over the same pairs, tensor components again: CC_IJKL = 2 dS_IJ/dC_KL with no
        factor 2 on shears. nan comes back where det C is not positive, and where a law that locks has no state. `out`
        takes the two C-contiguous arrays to write into. Safe to call from several threads at once.
        """

    @abstractmethod
    def stretch_derivatives(self, stretches: ArrayLike) -> Array:
        """Return dW/dλa (..., 3), MPa, at principal stretches (..., 3) with product 1 (incompressible).

        Defined up to a pressure: only differences of the Cauchy stresses λa dW/dλa mean something.
        """

    def uniaxial_tension(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress, MPa, of an incompressible bar at axial stretches of any shape, each positive."""
        return self._nominal("uniaxial", stretch)

    def equibiaxial_tension(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress, MPa, of an incompressible sheet stretched alike in both directions."""
        return self._nominal("equibiaxial", stretch)

    def planar_tension(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress, MPa, along the pull of an incompressible wide strip (pure shear)."""
        return self._nominal("planar", stretch)

    def _nominal(self, mode: str, stretch: ArrayLike) -> Array:
        """Return the first principal nominal stress where the third principal stress is zero."""
        stretches = tension.principal_stretches(mode, stretch)
        slope = self.stretch_derivatives(stretches)
        return slope[..., 0] - slope[..., 2] * stretches[..., 2] / stretches[..., 0]


def voigt(c: Array) -> Array:
    """Return `c` as contiguous float64 (n, 6), the one signature that the kernels are compiled for."""
    c = np.ascontiguousarray(c, dtype=np.float64)
    if c.ndim != 2 or c.shape[1] != 6:
        raise InputError(f"c has shape {c.shape}: expected (n, 6), right Cauchy-Green tensors in Voigt order")
    return c


def outputs(count: int, out: tuple[Array, Array] | None) -> tuple[Array, Array]:
    """Return the arrays (n, 6) and (n, 21) to write into: those given, if their shapes are right, or new ones."""
    stress, tangent = (np.empty((count, 6)), np.empty((count, 21))) if out is None else out
    if stress.shape != (count, 6) or tangent.shape != (count, 21):
        raise InputError(f"out has shapes {stress.shape} and {tangent.shape}: expected ({count}, 6), ({count}, 21)")
    return stress, tangent
