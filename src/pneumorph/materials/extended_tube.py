"""The extended tube law."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt

import numpy as np

from pneumorph.errors import InputError
from pneumorph.materials.material import Array
from pneumorph.materials.stretch import StretchEnergy, StretchMaterial


@dataclass(frozen=True)
class ExtendedTube(StretchMaterial):
    """W = gc/2 [(1 - delta²) x/(1 - delta² x) + ln(1 - delta² x)] + 2 ge/beta² (λ̄1^-beta + λ̄2^-beta + λ̄3^-beta - 3).

    Here x = Ī1 - 3. The first part is that of the cross-linked network, whose chains have a finite length; the second
    that of the tubes in which entanglements with their neighbours hold them.

    gc:    modulus of the cross-links, MPa, 0 or more.
    ge:    modulus of the entanglements, MPa, 0 or more, not 0 together with gc.
    beta:  how far the tubes release under stretch, more than 0, up to 1.
    delta: inextensibility, from 0 (chains of any length) to less than 1/sqrt(2); there is no state beyond x = 1/delta²:
           energy, stress and tangent are nan there, and a solve cuts its increment.

    The initial shear modulus is gc (1 - 2 delta²) + ge. Four constants with a meaning follow filled and unfilled rubber
    in all three tests to the end: Marckmann, Verron, Rubber Chem. Technol. 79 (2006) 835, rank it first of twenty laws.

    Raises InputError for constants out of range, and as `Material` does.
    Source: Kaliske, Heinrich, Rubber Chem. Technol. 72 (1999) 602.

    >>> ExtendedTube(gc=0.2, ge=0.15, beta=0.2, delta=0.1).shear_modulus
    0.346
    """

    gc: float = field(metadata={"kind": "stress"})
    ge: float = field(metadata={"kind": "stress"})
    beta: float = field(metadata={"kind": "number"})
    delta: float = field(metadata={"kind": "number"})

    def _check_law(self) -> None:
        for name in ("gc", "ge"):
            if getattr(self, name) < 0.0:
                self._refuse(name, getattr(self, name), "0 or more")
        if self.gc + self.ge == 0.0:
            raise InputError("ExtendedTube: gc = ge = 0 MPa, allowed: one of them more than 0")
        if not 0.0 < self.beta <= 1.0:
            self._refuse("beta", self.beta, "more than 0, up to 1")
        if not 0.0 <= self.delta < sqrt(0.5):
            self._refuse("delta", self.delta, "0 or more, less than 1/sqrt(2)")

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, MPa."""
        return self.gc * (1.0 - 2.0 * self.delta**2) + self.ge

    def derivatives(self, logs: Array) -> StretchEnergy:
        """Return W and its derivatives, see `StretchMaterial.derivatives`."""
        d = self.delta**2
        # an iterate of Newton's method may be far out: there the chains are over-stretched, and all is nan below
        with np.errstate(over="ignore"):
            grown = np.expm1(2.0 * logs)
            x = grown.sum(axis=0)
            left = 1.0 - d * x
        left = np.where((left > 0.0) & np.isfinite(x), left, np.nan)
        w1 = 0.5 * self.gc * ((1.0 - d) / left**2 - d / left)
        w11 = 0.5 * self.gc * (2.0 * d * (1.0 - d) / left**3 - d**2 / left**2)
        squares = grown + 1.0
        shrunk = np.expm1(-self.beta * logs)

        w = 0.5 * self.gc * ((1.0 - d) * x / left + np.log(left)) + 2.0 * self.ge / self.beta**2 * shrunk.sum(axis=0)
        # without the constant -2 ge/beta: one pressure for all directions, which the projection takes out anyway
        first = 2.0 * w1 * squares - 2.0 * self.ge / self.beta * shrunk
        second = np.empty((6, *logs.shape[1:]))
        second[:3] = 4.0 * w11 * squares**2 + 4.0 * w1 * squares + 2.0 * self.ge * (shrunk + 1.0)
        for row, (a, b) in enumerate(((1, 2), (0, 2), (0, 1)), start=3):
            second[row] = 4.0 * w11 * squares[a] * squares[b]
        return StretchEnergy(w, first, second)
