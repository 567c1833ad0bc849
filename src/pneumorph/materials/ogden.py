"""The Ogden law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from pneumorph.errors import InputError
from pneumorph.materials.material import Array
from pneumorph.materials.stretch import StretchEnergy, StretchMaterial, diagonal
from pneumorph.units import show

_MOST_TERMS = 4


@dataclass(frozen=True)
class Ogden(StretchMaterial):
    """W = sum over p of mus[p]/alphas[p] (λ̄1^alphas[p] + λ̄2^alphas[p] + λ̄3^alphas[p] - 3), one to four terms.

    mus:    MPa, of either sign.
    alphas: exponents, as many, of either sign but not 0.

    The initial shear modulus is half the sum of mus[p] alphas[p], and more than 0. With every product mus[p] alphas[p]
    positive the law is stable at all stretches. This is Ogden's own convention. Sources that write 2 mu_p/alpha_p²
    where mu_p/alpha_p stands here, as Abaqus does, so that their mu_p add up to the initial shear modulus, go through
    `Ogden.from_shear_moduli`.

    Raises InputError for terms out of range or of unequal number, and as `Material` does.
    Source: Ogden, Proc. R. Soc. Lond. A 326 (1972) 565, eq. 12.

    >>> round(Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)).shear_modulus, 4)
    0.4225
    """

    mus: tuple[float, ...] = field(metadata={"kind": "stress", "many": True})
    alphas: tuple[float, ...] = field(metadata={"kind": "number", "many": True})

    @classmethod
    def from_shear_moduli(
        cls,
        moduli: Sequence[float],
        alphas: Sequence[float],
        *,
        bulk: float | None = None,
        density: float | None = None,
    ) -> Ogden:
        """Return the law of W = sum of 2 moduli[p]/alphas[p]² (λ̄1^alphas[p] + ... - 3): mus[p] = 2 moduli[p]/alphas[p].

        moduli: MPa; their sum is the initial shear modulus. Raises InputError as the class.

        >>> Ogden.from_shear_moduli([0.4], [4.0])
        Ogden(bulk=None, density=None, prony=None, mus=(0.2,), alphas=(4.0,))
        """
        _check_terms(moduli, alphas)
        mus = tuple(2.0 * modulus / alpha for modulus, alpha in zip(moduli, alphas, strict=True))
        return cls(mus, tuple(alphas), bulk=bulk, density=density)

    def _check_law(self) -> None:
        _check_terms(self.mus, self.alphas)
        if self.shear_modulus <= 0.0:
            raise InputError(
                f"Ogden: half the sum of mus times alphas = {show(self.shear_modulus, 'stress')}, "
                "allowed: more than 0, the initial shear modulus"
            )

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, MPa."""
        return 0.5 * sum(mu * alpha for mu, alpha in zip(self.mus, self.alphas, strict=True))

    def derivatives(self, logs: Array) -> StretchEnergy:
        """Return W and its derivatives, see `StretchMaterial.derivatives`."""
        w, first, second = np.zeros(logs.shape[1:]), np.zeros_like(logs), np.zeros_like(logs)
        # an iterate of Newton's method may be far out: infinite stresses make it cut its increment
        with np.errstate(over="ignore", invalid="ignore"):
            for mu, alpha in zip(self.mus, self.alphas, strict=True):
                risen = np.expm1(alpha * logs)
                w += mu / alpha * risen.sum(axis=0)
                first += mu * risen
                second += mu * alpha * (risen + 1.0)
        # first lacks the constant sum of mu: one pressure for all directions, which the projection takes out anyway
        return StretchEnergy(w, first, diagonal(second))


def _check_terms(mus: Sequence[float], alphas: Sequence[float]) -> None:
    if len(mus) != len(alphas) or len(mus) > _MOST_TERMS:
        raise InputError(
            f"Ogden: {len(mus)} mus and {len(alphas)} alphas, "
            f"allowed: as many of one as of the other, up to {_MOST_TERMS}"
        )
    for number, alpha in enumerate(alphas, start=1):
        if alpha == 0.0:
            raise InputError(f"Ogden: alphas[{number}] = 0, allowed: not 0")
