"""Linear elastic thick-walled tube (plane strain) and sphere under internal pressure.

Source: Timoshenko and Goodier, Theory of Elasticity (3rd ed., 1970), sections 28 (tube) and 136 (sphere).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from pneumorph.closed_form.thick_wall import WallState
from pneumorph.errors import InputError


def lame_tube(
    shear_modulus: float, inner: float, outer: float, pressure: float, radius: ArrayLike, poisson_ratio: float = 0.5
) -> WallState:
    """Return displacement (mm) and stresses (MPa) at radii in a tube in plane strain.

    u = p A²/(B² - A²) [(1 - 2 nu) R + B²/R] / (2 mu), stresses p A²/(B² - A²) (1 ∓ B²/R²), axial 2 nu p A²/(B² - A²).
    shear_modulus: MPa; inner, outer: A < B, mm; pressure: gauge, MPa; radius: mm, any shape; poisson_ratio: up to 0.5.
    Raises InputError for a modulus that is not positive, and for radii or a Poisson's ratio outside these ranges.
    """
    radii = _check(shear_modulus, inner, outer, radius, poisson_ratio)
    base = pressure * inner**2 / (outer**2 - inner**2)
    displacement = base * ((1.0 - 2.0 * poisson_ratio) * radii + outer**2 / radii) / (2.0 * shear_modulus)
    swing = base * outer**2 / radii**2
    axial = np.full_like(radii, 2.0 * poisson_ratio * base)
    return WallState(radii + displacement, displacement, base - swing, base + swing, axial)


def lame_sphere(
    shear_modulus: float, inner: float, outer: float, pressure: float, radius: ArrayLike, poisson_ratio: float = 0.5
) -> WallState:
    """Return displacement (mm) and stresses (MPa) at radii in a sphere; arguments and errors as in `lame_tube`.

    u = p A³/(B³ - A³) [(1 - 2 nu) R/(1 + nu) + B³/(2 R²)] / (2 mu); radial stress p A³/(B³ - A³) (1 - B³/R³), hoop
    stress p A³/(B³ - A³) (1 + B³/(2 R³)).
    """
    radii = _check(shear_modulus, inner, outer, radius, poisson_ratio)
    base = pressure * inner**3 / (outer**3 - inner**3)
    spread = (1.0 - 2.0 * poisson_ratio) / (1.0 + poisson_ratio) * radii
    displacement = base * (spread + outer**3 / (2.0 * radii**2)) / (2.0 * shear_modulus)
    swing = base * outer**3 / radii**3
    hoop = base + 0.5 * swing
    return WallState(radii + displacement, displacement, base - swing, hoop, hoop)


def _check(shear_modulus: float, inner: float, outer: float, radius: ArrayLike, poisson_ratio: float) -> np.ndarray:
    radii = np.asarray(radius, dtype=float)
    if not 0.0 < shear_modulus < np.inf:
        raise InputError(f"shear_modulus = {shear_modulus:g} MPa, allowed: finite and more than 0")
    if not (0.0 < inner < outer < np.inf and ((radii >= inner) & (radii <= outer)).all()):
        raise InputError(
            f"inner = {inner:g}, radius = {radius!r}, outer = {outer:g} mm, allowed: 0 < inner <= radius <= outer"
        )
    if not -1.0 < poisson_ratio <= 0.5:
        raise InputError(f"poisson_ratio = {poisson_ratio:g}, allowed: more than -1, up to 0.5")
    return radii
