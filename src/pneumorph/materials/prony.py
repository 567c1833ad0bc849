"""Linear viscoelasticity at finite strain: a Prony series and the step by which its overstresses are integrated."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.materials.constants import as_numbers
from pneumorph.units import show

Array = NDArray[np.float64]


class ViscousStep(NamedTuple):
    """One step of the overstresses, see `Prony.step`.

    factor:     S = factor * S∞ + history; the algorithmic tangent is factor times the elastic one.
    history:    (n, 6), MPa.
    overstress: (terms, n, 6), MPa, at the end of the step.
    """

    factor: float
    history: Array
    overstress: Array


@dataclass(frozen=True)
class Prony:
    """Relaxation of the isochoric stress: G(t) = G0 [1 - sum of g_i (1 - exp(-t / tau_i))]; the bulk stays elastic.

    g:   relative moduli, shares of the instantaneous modulus G0, each between 0 and 1, with a sum under 1.
    tau: relaxation times, s, as many, each more than 0.

    The constants of the law that a Prony series goes with are LONG-TERM ones (G∞ = G0 (1 - sum g), what slow tests
    measure and a static solve takes): Abaqus's MODULI=LONG TERM. From instantaneous constants (MODULI=INSTANTANEOUS),
    multiply every modulus of the law by `long_term_share`.

    Raises InputError for terms out of range or of unequal number.
    Source: Simo, Comput. Methods Appl. Mech. Eng. 60 (1987) 153; Holzapfel, Nonlinear Solid Mechanics (2000), ch. 6.10.

    >>> Prony((0.2, 0.3), (0.1, 10.0)).long_term_share
    0.5
    """

    g: tuple[float, ...] = field(metadata={"kind": "number", "many": True})
    tau: tuple[float, ...] = field(metadata={"kind": "time", "many": True})

    def __post_init__(self) -> None:
        object.__setattr__(self, "g", as_numbers("Prony", "g", self.g, "number"))
        object.__setattr__(self, "tau", as_numbers("Prony", "tau", self.tau, "time"))
        if len(self.g) != len(self.tau):
            raise InputError(f"Prony: {len(self.g)} g and {len(self.tau)} tau, allowed: as many of one as of the other")
        for number, share in enumerate(self.g, start=1):
            if not 0.0 < share < 1.0:
                raise InputError(f"Prony: g[{number}] = {share:g}, allowed: between 0 and 1")
        for number, time in enumerate(self.tau, start=1):
            if time <= 0.0:
                raise InputError(f"Prony: tau[{number}] = {show(time, 'time')}, allowed: more than 0")
        if sum(self.g) >= 1.0:
            raise InputError(f"Prony: the sum of g = {sum(self.g):g}, allowed: less than 1")

    @property
    def long_term_share(self) -> float:
        """Long-term over instantaneous modulus, 1 - sum g."""
        return 1.0 - math.fsum(self.g)

    def relaxation(self, time: ArrayLike) -> Array:
        """Return G(t) / G∞ at times (...) in s after a sudden stretch: from 1 / `long_term_share` down to 1.

        Raises InputError for a negative time.
        """
        values = _not_negative("time", time)
        return 1.0 + self._sum([b * np.exp(-values / tau) for b, tau in self._branches()])

    def storage_modulus(self, frequency: ArrayLike) -> Array:
        """Return G'(ω) / G∞ at angular frequencies (...) in rad/s. Raises InputError for a negative frequency."""
        values = _not_negative("frequency", frequency)
        return 1.0 + self._sum([b * (values * tau) ** 2 / (1.0 + (values * tau) ** 2) for b, tau in self._branches()])

    def loss_modulus(self, frequency: ArrayLike) -> Array:
        """Return G''(ω) / G∞ at angular frequencies (...) in rad/s. Raises InputError for a negative frequency."""
        values = _not_negative("frequency", frequency)
        return self._sum([b * values * tau / (1.0 + (values * tau) ** 2) for b, tau in self._branches()])

    def at_rest(self, count: int) -> Array:
        """Return the overstresses (terms, count, 6) of a body that has been at rest: zeros."""
        return np.zeros((len(self.g), count, 6))

    def step_factor(self, dt: float) -> float:
        """Return by how much a step of `dt` s stiffens the elastic stress and tangent: 1 (slow) to G0/G∞ (sudden).

        Raises InputError for a step that is not finite and positive.
        """
        return 1.0 + math.fsum(b * _ramp(_step_length(dt) / tau) for b, tau in self._branches())

    def step(self, dt: float, overstress: Array, before: Array, after: Array) -> ViscousStep:
        """Return stress and overstresses at the end of a step of `dt` s.

        overstress:    (terms, n, 6), MPa, at its start. before, after: elastic S (n, 6), MPa, at its start and end.

        Each overstress obeys dQ/dt + Q/τ = β dS∞/dt with β = g/(1 - sum g), as a Maxwell branch beside the law. The
        step is exact for an elastic stress that changes linearly in it, else of second order, and always stable:
            Q = exp(-dt/τ) Q_n + β (1 - exp(-dt/τ)) τ/dt (S∞ - S∞_n),    S = S∞ + sum Q
        (Taylor, Pister, Goudreau, Int. J. Numer. Methods Eng. 2 (1970) 45; Simo, Hughes, Computational Inelasticity
        (1998), sect. 10.3). The stresses are second Piola-Kirchhoff ones, so that no rotation enters.

        Raises InputError for a step that is not positive, or shapes that do not fit.
        """
        shape = (len(self.g), *after.shape)
        if before.shape != after.shape or overstress.shape != shape:
            raise InputError(
                f"overstress, before and after have shapes {overstress.shape}, {before.shape} and {after.shape}: "
                f"expected {shape}, {after.shape} and {after.shape}"
            )
        updated, history = np.empty(shape), np.zeros(after.shape)
        for old, new, (b, tau) in zip(overstress, updated, self._branches(), strict=True):
            ratio = _step_length(dt) / tau
            share = b * _ramp(ratio)
            carried = math.exp(-ratio) * old - share * before
            history += carried
            new[:] = carried + share * after
        return ViscousStep(self.step_factor(dt), history, updated)

    def _branches(self) -> list[tuple[float, float]]:
        """Return (β, τ): modulus of each branch over the long-term one, and its time."""
        return [(share / self.long_term_share, tau) for share, tau in zip(self.g, self.tau, strict=True)]

    @staticmethod
    def _sum(terms: list[Array]) -> Array:
        return np.sum(terms, axis=0)


def _ramp(ratio: float) -> float:
    """Return (1 - exp(-x)) / x."""
    return -math.expm1(-ratio) / ratio


def _not_negative(name: str, values: ArrayLike) -> Array:
    result = np.asarray(values, dtype=float)
    if not (result >= 0.0).all():
        raise InputError(f"{name} = {values!r}, allowed: 0 or more")
    return result


def _step_length(dt: float) -> float:
    if not (math.isfinite(dt) and dt > 0.0):
        raise InputError(f"dt = {dt!r} s, allowed: finite and more than 0")
    return dt
