"""Drucker's stability of a law in the three tests."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.materials.material import Material
from pneumorph.materials.tension import MODES, principal_stretches

Array = NDArray[np.float64]

# stretches that actuators reach: a law in use should be stable over them
USUAL_RANGE = (0.5, 3.0)
# stretches of a scan, evenly spaced in their logarithm: a gap of instability narrower than that is not seen
_SCAN = 400
# orthonormal basis (3, 2) of the logarithmic strain rates without a change of volume
_SHEARS = np.array([[1.0, 1.0], [-1.0, 1.0], [0.0, -2.0]]) / np.sqrt([2.0, 6.0])


class Instability(NamedTuple):
    """A law softens in a test from `stretch` on: upwards if it is over 1, downwards if under."""

    mode: str
    stretch: float

    def __str__(self) -> str:
        """Return it as text: 'unstable in planar tension from a stretch of 1.91 on'."""
        way = "tension" if self.stretch > 1.0 else "compression"
        return f"unstable in {self.mode} {way} from a stretch of {self.stretch:.3g} on"


def stability_limit(material: Material, mode: str, end: float) -> float | None:
    """Return the stretch between 1 and `end` at which a law becomes unstable; None if it is stable up to `end`.

    mode: "uniaxial", "equibiaxial" or "planar"; end: stretch of more than 0, under or over 1.

    Drucker: a further strain must take work, dτ : dε > 0, with the Kirchhoff stress τ and the logarithmic strain ε of
    an incompressible material, for each pair of principal strains, not only that of the test. A law that locks has no
    state beyond its limit and counts as stable up to there.

    Raises InputError for an `end` that is not finite and positive, NameNotFoundError for another mode.
    Source: Ogden, Non-linear Elastic Deformations (1984), ch. 6; Abaqus checks constants in the same way.
    """
    if not (np.isfinite(end) and end > 0.0):
        raise InputError(f"end = {end!r}, allowed: finite and more than 0")
    stretches = np.geomspace(1.0, end, _SCAN)
    failing = np.flatnonzero(_least_modulus(material, mode, stretches) <= 0.0)
    if len(failing) == 0:
        return None
    # bisection; the reference is stable because the shear modulus is positive
    good, bad = stretches[failing[0] - 1], stretches[failing[0]]
    while abs(bad - good) > 1e-12 * good:
        middle = 0.5 * (good + bad)
        if middle in (good, bad):
            break
        if _least_modulus(material, mode, np.array([middle]))[0] <= 0.0:
            bad = middle
        else:
            good = middle
    return float(bad)


def instabilities(material: Material, smallest: float = 0.2, largest: float = 8.0) -> tuple[Instability, ...]:
    """Return where a law becomes unstable in each test, in tension up to `largest` and compression down to `smallest`.

    Empty for a law that is stable over the whole range 0 < smallest < 1 < largest. Raises InputError for another range.

    >>> from pneumorph.materials import NeoHookean, Yeoh
    >>> instabilities(NeoHookean(0.1))
    ()
    >>> instabilities(Yeoh(0.1, -0.002), largest=6.0)[0].mode
    'uniaxial'
    """
    if not 0.0 < smallest < 1.0 < largest < np.inf:
        raise InputError(
            f"range of stretches {smallest:g} to {largest:g}, allowed: from between 0 and 1 to more than 1"
        )
    limits = ((mode, stability_limit(material, mode, end)) for mode in MODES for end in (largest, smallest))
    return tuple(Instability(mode, limit) for mode, limit in limits if limit is not None)


def _least_modulus(material: Material, mode: str, stretch: Array) -> Array:
    """Return the smaller eigenvalue (n,), MPa, of dτ/dε without a change of volume at stretches (n,) of a test."""
    squares = principal_stretches(mode, stretch) ** 2
    c = np.zeros((len(squares), 6))
    c[:, :3] = squares
    stress, tangent = material.stress_and_tangent(c)
    # τ_a = λa² S_a and d/dε_b = 2 λb² d/dC_bb
    rates = np.zeros((len(squares), 3, 3))
    for entry, (a, b) in zip((0, 1, 2, 6, 7, 11), ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)), strict=True):
        rates[:, a, b] = rates[:, b, a] = squares[:, a] * squares[:, b] * tangent[:, entry]
    rates += 2.0 * (squares * stress[:, :3])[:, :, np.newaxis] * np.eye(3)
    plane = _SHEARS.T @ rates @ _SHEARS
    mean = 0.5 * (plane[:, 0, 0] + plane[:, 1, 1])
    result: Array = mean - np.hypot(0.5 * (plane[:, 0, 0] - plane[:, 1, 1]), plane[:, 0, 1])
    return result
