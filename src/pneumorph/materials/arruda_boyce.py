"""The Arruda-Boyce (eight-chain) law."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pneumorph.materials.invariant import InvariantEnergy, InvariantMaterial
from pneumorph.materials.material import Array

# of the expansion of the inverse Langevin function, W / C_R = sum of a_i (I1^i - 3^i) / locking_stretch^(2 i - 2)
_SERIES = (1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673750.0)


@dataclass(frozen=True)
class ArrudaBoyce(InvariantMaterial):
    """W = c_r times the sum over i = 1 to 5 of a_i (Ī1^i - 3^i)/L^(2i - 2): the eight-chain model.

    The a_i are 1/2, 1/20, 11/1050, 19/7000 and 519/673750.

    c_r:             rubbery modulus n k T, MPa, more than 0. Other programs call it mu, but the initial shear modulus
                     is c_r (1 + 3/(5 L²) + 99/(175 L⁴) + 513/(875 L⁶) + 42039/(67375 L⁸)).
    locking_stretch: L, more than 1: the chain stretch sqrt(Ī1/3) near which the stress rises steeply.

    This is the series with five terms that published constants go with (Abaqus, Ansys, Marc), not the inverse Langevin
    function: it has a state at every stretch, and no longer follows the molecular model near and beyond L.

    Raises InputError for constants out of range, and as `Material` does.
    Source: Arruda, Boyce, J. Mech. Phys. Solids 41 (1993) 389, eq. 15.

    >>> round(ArrudaBoyce(0.1, 3.0).shear_modulus, 4)
    0.1075
    """

    c_r: float = field(metadata={"kind": "stress"})
    locking_stretch: float = field(metadata={"kind": "number"})

    def _check_law(self) -> None:
        self._check_positive("c_r")
        if self.locking_stretch <= 1.0:
            self._refuse("locking_stretch", self.locking_stretch, "more than 1")

    def derivatives(self, i1: Array, i2: Array) -> InvariantEnergy:
        """Return W and its derivatives, see `InvariantMaterial.derivatives`."""
        squared = self.locking_stretch**2
        powers = np.polynomial.Polynomial([0.0, *(a * squared**-i for i, a in enumerate(_SERIES))])
        slope = powers.deriv()
        return InvariantEnergy(
            w=self.c_r * (powers(i1) - powers(3.0)),
            w1=self.c_r * slope(i1),
            w11=self.c_r * slope.deriv()(i1),
        )
