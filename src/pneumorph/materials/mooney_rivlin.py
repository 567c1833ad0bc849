"""The Mooney-Rivlin law with two to five constants."""

from __future__ import annotations

from dataclasses import dataclass, field

from pneumorph.errors import InputError
from pneumorph.materials.invariant import InvariantEnergy, InvariantMaterial
from pneumorph.materials.material import Array
from pneumorph.units import show


@dataclass(frozen=True)
class MooneyRivlin(InvariantMaterial):
    """W = c10 (Ī1 - 3) + c01 (Ī2 - 3) + c20 (Ī1 - 3)² + c11 (Ī1 - 3)(Ī2 - 3) + c02 (Ī2 - 3)².

    c10, c01: MPa, of either sign, with a sum of more than 0; the initial shear modulus is 2 (c10 + c01).
    c20, c11, c02: MPa, of either sign; without them it is the law with two constants, good to stretches of about 2.

    Raises InputError for a sum c10 + c01 that is not positive, and as `Material` does.
    Source: Mooney, J. Appl. Phys. 11 (1940) 582; Rivlin, Saunders, Phil. Trans. R. Soc. A 243 (1951) 251.

    >>> MooneyRivlin(0.16, 0.04).shear_modulus
    0.4
    """

    c10: float = field(metadata={"kind": "stress"})
    c01: float = field(metadata={"kind": "stress"})
    c20: float = field(default=0.0, metadata={"kind": "stress"})
    c11: float = field(default=0.0, metadata={"kind": "stress"})
    c02: float = field(default=0.0, metadata={"kind": "stress"})

    def _check_law(self) -> None:
        if self.c10 + self.c01 <= 0.0:
            raise InputError(
                f"MooneyRivlin: c10 + c01 = {show(self.c10 + self.c01, 'stress')}, allowed: more than 0, "
                "half of the initial shear modulus"
            )

    def derivatives(self, i1: Array, i2: Array) -> InvariantEnergy:
        """Return W and its derivatives, see `InvariantMaterial.derivatives`."""
        x, y = i1 - 3.0, i2 - 3.0
        return InvariantEnergy(
            w=x * (self.c10 + self.c20 * x + self.c11 * y) + y * (self.c01 + self.c02 * y),
            w1=self.c10 + 2.0 * self.c20 * x + self.c11 * y,
            w2=self.c01 + self.c11 * x + 2.0 * self.c02 * y,
            w11=2.0 * self.c20,
            w12=self.c11,
            w22=2.0 * self.c02,
        )
