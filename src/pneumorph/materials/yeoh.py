"""The Yeoh law."""

from __future__ import annotations

from dataclasses import dataclass, field

from pneumorph.materials.invariant import InvariantEnergy, InvariantMaterial
from pneumorph.materials.material import Array


@dataclass(frozen=True)
class Yeoh(InvariantMaterial):
    """W = c10 (Ī1 - 3) + c20 (Ī1 - 3)² + c30 (Ī1 - 3)³: stiffens as it stretches.

    c10: MPa, more than 0; the initial shear modulus is 2 c10.
    c20: MPa, of either sign.
    c30: MPa, of either sign.

    Raises InputError for a c10 that is not positive, and as `Material` does.
    Source: Yeoh, Rubber Chem. Technol. 66 (1993) 754.

    >>> Yeoh(0.11, 0.02).shear_modulus
    0.22
    """

    c10: float = field(metadata={"kind": "stress"})
    c20: float = field(metadata={"kind": "stress"})
    c30: float = field(default=0.0, metadata={"kind": "stress"})

    def _check_law(self) -> None:
        self._check_positive("c10")

    def derivatives(self, i1: Array, i2: Array) -> InvariantEnergy:
        """Return W and its derivatives, see `InvariantMaterial.derivatives`."""
        x = i1 - 3.0
        return InvariantEnergy(
            w=x * (self.c10 + x * (self.c20 + x * self.c30)),
            w1=self.c10 + x * (2.0 * self.c20 + x * 3.0 * self.c30),
            w11=2.0 * self.c20 + x * 6.0 * self.c30,
        )
