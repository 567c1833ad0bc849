"""Large deflections of an inextensible slender cantilever: dead end load and end moment."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit

from pneumorph.errors import InputError

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
# PL²/EI up to here is solved to rounding; all but 1.5 % of the length then stands along the force
LOAD_LIMIT = 1e4


class CantileverTip(NamedTuple):
    """The tip of a cantilever that leaves its clamp along x: axial and transverse position, mm; rotation, rad."""

    axial: float
    transverse: float
    rotation: float


def end_load(bending_stiffness: float, length: float, force: float) -> CantileverTip:
    """Return the tip under a transverse end force that keeps its direction (dead load).

    bending_stiffness: EI, N mm²; in plane strain E / (1 - nu²) takes the place of E.
    length: L, mm.
    force:  P, N, of either sign; the beam bends to its side. |P| L²/EI up to 1e4.

    From EI theta'' = -P cos theta with theta = 0 at the clamp, theta' = 0 at the tip: the elliptic integrals of
    Bisshopp and Drucker, Quart. Appl. Math. 3 (1945) 272, in a variable v that keeps the integrands smooth,
        L sqrt(P/EI) = int dv / sqrt(1 + t²),   t = sqrt((1 - s)/2) sinh v from 0 to sqrt(s),   s = sin(rotation).
    Raises InputError for a stiffness or length that is not positive, or a load that is not finite or beyond 1e4.
    """
    _check(bending_stiffness, length, force, "force")
    load = abs(force) * length**2 / bending_stiffness
    if load > LOAD_LIMIT:
        raise InputError(f"force * length² / bending_stiffness = {load:g}, allowed: up to {LOAD_LIMIT:g}")
    if load == 0.0:
        return CantileverTip(length, 0.0, 0.0)

    # s = expit(x), so that neither s nor 1 - s loses digits: s = load / 2 for small loads, 1 - s ~ exp(-2 sqrt(load))
    low = math.log(load) - 5.0
    high = 2.0 * math.sqrt(load) + 10.0
    x = brentq(lambda x: _integrals(x)[0] - math.sqrt(load), low, high, xtol=1e-14, rtol=1e-14)
    sine, rest = expit(x), expit(-x)
    side = math.copysign(1.0, force)
    return CantileverTip(
        axial=length * math.sqrt(2.0 * sine / load),
        transverse=side * length * _integrals(x)[1] / math.sqrt(load),
        rotation=side * math.atan2(sine, math.sqrt(rest * (1.0 + sine))),
    )


def end_moment(bending_stiffness: float, length: float, moment: float) -> CantileverTip:
    """Return the tip under an end moment M, N mm: the beam is an arc of curvature M/EI, rotation M L/EI.

    The chord from clamp to tip turns by half of the tip's rotation.
    Raises InputError for a stiffness or length that is not positive, or a moment that is not finite.
    """
    _check(bending_stiffness, length, moment, "moment")
    rotation = moment * length / bending_stiffness
    return CantileverTip(
        axial=length * float(np.sinc(rotation / math.pi)),
        transverse=length * 0.5 * rotation * float(np.sinc(0.5 * rotation / math.pi)) ** 2,
        rotation=rotation,
    )


def _integrals(x: float) -> tuple[float, float]:
    """Return length and transverse position of the tip over sqrt(EI/P) where the sine of its rotation is expit(x)."""
    sine, rest = expit(x), expit(-x)
    m = 0.5 * rest
    top = math.asinh(math.sqrt(sine / m))
    t = math.sqrt(m) * np.sinh(0.5 * top * (_NODES + 1.0))
    steps = 0.5 * top * _WEIGHTS / np.sqrt(1.0 + t * t)
    return float(steps.sum()), float((steps * (sine - t * t) / (1.0 + t * t)).sum())


def _check(bending_stiffness: float, length: float, load: float, name: str) -> None:
    if not (0.0 < bending_stiffness < math.inf and 0.0 < length < math.inf):
        raise InputError(
            f"bending_stiffness = {bending_stiffness:g} N mm², length = {length:g} mm, allowed: finite and more than 0"
        )
    if not math.isfinite(load):
        raise InputError(f"{name} = {load}, allowed: finite")
