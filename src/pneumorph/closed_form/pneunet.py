"""Bending of a PneuNet segment: round channels side by side on an inextensible, infinitely thin layer.

Plane strain, incompressible neo-Hookean. Each channel is a thick-walled tube of radii R1 < R2 (reference) and r1 < r2
(deformed), R² = r² - 2 C1. n outer diameters lie along the layer, n 2 R2 = RS theta, and along the line of the channel
centres, n 2 r2 = (RS + r2) theta, so that kappa = 1/RS = 1/R2 - 1/r2.
Source: 'A combined analytical and numerical study of locomotion of pneumatic-network soft robots', eqs. 1-5.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.closed_form.roots import first_crossing
from pneumorph.errors import InputError


def pneunet_pressure(shear_modulus: float, inner: float, outer: float, curvature: ArrayLike) -> NDArray[np.float64]:
    """Return the gauge pressure, MPa, that bends a segment to curvatures of its layer.

    p = mu [ln(R2 r1/(R1 r2)) + C1 (1/r1² - 1/r2²)], which tends to mu ln(R2/R1) as the curvature nears 1/R2.
    shear_modulus: mu, initial, MPa; inner, outer: R1 < R2, mm; curvature: 1/mm, from 0 to less than 1/R2, any shape.
    Raises InputError for values outside these ranges.
    """
    _check(shear_modulus, inner, outer)
    kappa = np.asarray(curvature, dtype=float)
    if not ((kappa >= 0.0) & (kappa < 1.0 / outer)).all():
        raise InputError(f"curvature = {curvature!r} /mm, allowed: 0 to less than 1/outer = {1.0 / outer:g} /mm")
    r2 = outer / (1.0 - kappa * outer)
    c1 = 0.5 * (r2**2 - outer**2)
    r1 = np.sqrt(inner**2 + 2.0 * c1)
    return np.asarray(shear_modulus * (np.log(outer * r1 / (inner * r2)) + c1 * (1.0 / r1**2 - 1.0 / r2**2)))


def pneunet_curvature(shear_modulus: float, inner: float, outer: float, pressure: float) -> float:
    """Return the curvature of the layer, 1/mm, under a gauge pressure, MPa.

    Raises InputError as `pneunet_pressure` does, and for a pressure outside 0 to mu ln(R2/R1), where no state exists.
    """
    _check(shear_modulus, inner, outer)
    return first_crossing(
        lambda kappa: pneunet_pressure(shear_modulus, inner, outer, kappa),
        pressure,
        0.0,
        (1.0 - 1e-6) / outer,
        "pressure",
        "MPa",
    )


def _check(shear_modulus: float, inner: float, outer: float) -> None:
    if not 0.0 < shear_modulus < np.inf:
        raise InputError(f"shear_modulus = {shear_modulus:g} MPa, allowed: finite and more than 0")
    if not 0.0 < inner < outer < np.inf:
        raise InputError(f"inner = {inner:g} mm, outer = {outer:g} mm, allowed: 0 < inner < outer")
