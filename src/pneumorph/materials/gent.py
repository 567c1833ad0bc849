"""The Gent law."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pneumorph.materials.invariant import InvariantEnergy, InvariantMaterial
from pneumorph.materials.material import Array


@dataclass(frozen=True)
class Gent(InvariantMaterial):
    """W = -mu jm/2 ln(1 - (Ī1 - 3)/jm): neo-Hookean at first, locks where Ī1 - 3 reaches jm.

    mu: initial shear modulus, MPa, more than 0.
    jm: limit of Ī1 - 3, more than 0; in uniaxial tension the stretch stays under about sqrt(jm + 3).

    At and beyond the limit there is no state: energy, stress and tangent are nan there, and a solve cuts its increment.

    Raises InputError for a constant that is not positive, and as `Material` does.
    Source: Gent, Rubber Chem. Technol. 69 (1996) 59, eq. 3.

    >>> Gent(0.1, 30.0).shear_modulus
    0.1
    """

    mu: float = field(metadata={"kind": "stress"})
    jm: float = field(metadata={"kind": "number"})

    def _check_law(self) -> None:
        self._check_positive("mu")
        self._check_positive("jm")

    def derivatives(self, i1: Array, i2: Array) -> InvariantEnergy:
        """Return W and its derivatives, see `InvariantMaterial.derivatives`."""
        left = 1.0 - (i1 - 3.0) / self.jm
        left = np.where(left > 0.0, left, np.nan)
        return InvariantEnergy(
            w=-0.5 * self.mu * self.jm * np.log(left),
            w1=0.5 * self.mu / left,
            w11=0.5 * self.mu / (self.jm * left**2),
        )
