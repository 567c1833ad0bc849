"""Linear elasticity in logarithmic strains, for stiff parts."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from pneumorph.errors import InputError
from pneumorph.materials import tension
from pneumorph.materials.material import Array
from pneumorph.materials.stretch import StretchEnergy, StretchMaterial, diagonal


@dataclass(frozen=True)
class LinearElastic(StretchMaterial):
    """W = mu [(ln λ̄1)² + (ln λ̄2)² + (ln λ̄3)²]: Hooke's law in Hencky's strains, for stiff parts.

    young:   Young's modulus, MPa, more than 0.
    poisson: Poisson's ratio, from 0 to less than 0.5.

    mu = young/(2 (1 + poisson)), and the bulk modulus is young/(3 (1 - 2 poisson)): there is none to give. Plastics
    and sheets (PLA, PET) turn far but strain little, and there every finite-strain form of Hooke's law is the same; in
    compression this one, unlike Saint Venant and Kirchhoff's, resists to the end.

    Raises InputError for constants out of range or a bulk modulus, and as `Material` does.
    Source: Hencky, Z. Tech. Phys. 9 (1928) 215; Anand, J. Appl. Mech. 46 (1979) 78.

    >>> round(LinearElastic(3500.0, 0.36).bulk_modulus)
    4167
    """

    young: float = field(metadata={"kind": "stress"})
    poisson: float = field(metadata={"kind": "number"})

    def _check_law(self) -> None:
        self._check_positive("young")
        if not 0.0 <= self.poisson < 0.5:
            self._refuse("poisson", self.poisson, "0 or more, less than 0.5")
        if self.bulk is not None:
            raise InputError("LinearElastic: bulk is given, allowed: young and poisson, from which it follows")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus, MPa."""
        return 0.5 * self.young / (1.0 + self.poisson)

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus, MPa."""
        return self.young / (3.0 * (1.0 - 2.0 * self.poisson))

    def derivatives(self, logs: Array) -> StretchEnergy:
        """Return W and its derivatives, see `StretchMaterial.derivatives`."""
        mu = self.shear_modulus
        return StretchEnergy(mu * (logs**2).sum(axis=0), 2.0 * mu * logs, diagonal(np.full_like(logs, 2.0 * mu)))

    def uniaxial_tension(self, stretch: ArrayLike) -> Array:
        """Return E ln(λ)/λ, MPa, the nominal stress of a bar that contracts as its Poisson's ratio says.

        This and the other two tests differ from what every other law gives in that they feel the change of volume. They
        are exact for the energy K (ln J)²/2; the solver's differs by terms of the order of the squared volume change.
        """
        return self._hooke("uniaxial", stretch, self.young)

    def equibiaxial_tension(self, stretch: ArrayLike) -> Array:
        """Return E/(1 - ν) ln(λ)/λ, MPa, see `uniaxial_tension`."""
        return self._hooke("equibiaxial", stretch, self.young / (1.0 - self.poisson))

    def planar_tension(self, stretch: ArrayLike) -> Array:
        """Return E/(1 - ν²) ln(λ)/λ, MPa, see `uniaxial_tension`."""
        return self._hooke("planar", stretch, self.young / (1.0 - self.poisson**2))

    @staticmethod
    def _hooke(mode: str, stretch: ArrayLike, modulus: float) -> Array:
        first = tension.principal_stretches(mode, stretch)[..., 0]
        return modulus * np.log(first) / first
