"""The thin spherical balloon: pressure rises to a maximum and falls while the volume goes on rising."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

from pneumorph.errors import InputError
from pneumorph.materials import Material


def balloon_pressure(material: Material, radius: float, thickness: float, stretch: ArrayLike) -> NDArray[np.float64]:
    """Return the gauge pressure, MPa, of an incompressible membrane sphere at hoop stretches.

    p = 2 H/R h^-3 (sigma_hoop - sigma_r) at stretches (h^-2, h, h); for a neo-Hookean wall 2 mu H/R (h^-1 - h^-7).
    radius, thickness: R and H of the wall's middle in the reference, mm; the error is of order (H/R)².
    stretch: h = r/R, more than 0, any shape.
    Raises InputError for values outside these ranges.
    Source: Holzapfel, Nonlinear Solid Mechanics (2000), example 6.2.
    """
    hoop = np.asarray(stretch, dtype=float)
    if not 0.0 < thickness < radius:
        raise InputError(f"thickness = {thickness:g} mm, radius = {radius:g} mm, allowed: 0 < thickness < radius")
    # the equibiaxial nominal stress is (sigma_hoop - sigma_r)/h
    return 2.0 * thickness / radius * material.equibiaxial_tension(hoop) / hoop**2


def balloon_maximum(
    material: Material, radius: float, thickness: float, stretch_limit: float = 10.0
) -> tuple[float, float]:
    """Return hoop stretch and pressure, MPa, of the first pressure maximum: 7^(1/6) = 1.383 for a neo-Hookean wall.

    Raises InputError as `balloon_pressure` does, and where the pressure rises all the way to `stretch_limit`.
    """
    stretches = np.linspace(1.0, stretch_limit, 2001)
    pressures = balloon_pressure(material, radius, thickness, stretches)
    falling = np.flatnonzero(np.diff(pressures) < 0.0)
    if len(falling) == 0:
        raise InputError(f"stretch_limit = {stretch_limit:g}: the pressure of {material} has no maximum up to there")
    top = falling[0]
    best = minimize_scalar(
        lambda h: -float(balloon_pressure(material, radius, thickness, h)),
        bounds=(stretches[max(top - 1, 0)], stretches[top + 1]),
        method="bounded",
        options={"xatol": 1e-12},
    )
    return float(best.x), -float(best.fun)
