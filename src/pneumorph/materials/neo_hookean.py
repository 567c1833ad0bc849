"""The neo-Hookean law."""

from __future__ import annotations

from dataclasses import dataclass, field

from pneumorph.materials.invariant import InvariantEnergy, InvariantMaterial
from pneumorph.materials.material import Array


@dataclass(frozen=True)
class NeoHookean(InvariantMaterial):
    """W = mu/2 (Ī1 - 3): one constant, good to stretches of about 1.5.

    mu: initial shear modulus, MPa, more than 0. A source that prints C10 means mu = 2 C10.

    Raises InputError for a mu that is not positive, and as `Material` does.
    Source: Treloar, Trans. Faraday Soc. 39 (1943) 241; Holzapfel, Nonlinear Solid Mechanics (2000), eq. 6.129.

    >>> NeoHookean(0.037).bulk_modulus
    37.0
    """

    mu: float = field(metadata={"kind": "stress"})

    def _check_law(self) -> None:
        self._check_positive("mu")

    def derivatives(self, i1: Array, i2: Array) -> InvariantEnergy:
        """Return W and its derivatives, see `InvariantMaterial.derivatives`."""
        return InvariantEnergy(w=0.5 * self.mu * (i1 - 3.0), w1=0.5 * self.mu)
