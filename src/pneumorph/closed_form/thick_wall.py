"""Incompressible thick-walled tube (plane strain) and sphere under internal gauge pressure, for any material.

The wall keeps its volume, so the inner radius alone fixes the deformation: r^m = R^m + a^m - A^m, with m = 2 in the
tube (axial stretch 1) and 3 in the sphere; R, A in the reference, r, a deformed. With the hoop stretch h = r/R the
principal stretches (radial, hoop, third) are (1/h, h, 1) and (h^-2, h, h). Radial equilibrium
    d sigma_r/dr = (m - 1) (sigma_hoop - sigma_r)/r,   sigma_r(a) = -p,   sigma_r(b) = 0
gives the stress by quadrature. In u = ln R, where dr/r = h^-m du, its integrand is smooth.
Source: Ogden, Non-linear Elastic Deformations (1984), sections 5.3.1 and 5.3.3; Holzapfel (2000).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.closed_form.roots import first_crossing
from pneumorph.errors import InputError
from pneumorph.materials import Material

TUBE, SPHERE = 2, 3
# 64 Gauss points give the integrals to rounding for walls up to ten times the inner radius
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
# the inverse looks up to this hoop stretch at the inner face
STRETCH_LIMIT = 10.0


class WallState(NamedTuple):
    """State of a wall at given reference radii, arrays of their shape.

    position: deformed radius, mm; displacement: radial, mm; radial_stress, hoop_stress: Cauchy, MPa;
    axial_stress: Cauchy, MPa, along the axis of a tube; the second hoop stress in a sphere.
    """

    position: NDArray[np.float64]
    displacement: NDArray[np.float64]
    radial_stress: NDArray[np.float64]
    hoop_stress: NDArray[np.float64]
    axial_stress: NDArray[np.float64]


def tube_pressure(material: Material, inner: float, outer: float, deformed_inner: ArrayLike) -> NDArray[np.float64]:
    """Return the gauge pressure, MPa, that brings a tube's inner radius from `inner` to `deformed_inner`.

    inner, outer:   radii in the reference, mm, 0 < inner < outer.
    deformed_inner: deformed inner radius, mm, more than 0, any shape; smaller than `inner` under vacuum.
    Raises InputError for radii outside these ranges.
    """
    return _pressure(material, inner, outer, deformed_inner, TUBE)


def sphere_pressure(material: Material, inner: float, outer: float, deformed_inner: ArrayLike) -> NDArray[np.float64]:
    """Return the gauge pressure, MPa, that brings a sphere's inner radius from `inner` to `deformed_inner`.

    Arguments as in `tube_pressure`.
    """
    return _pressure(material, inner, outer, deformed_inner, SPHERE)


def tube_inner_radius(material: Material, inner: float, outer: float, pressure: float) -> float:
    """Return the deformed inner radius, mm, of a tube under a gauge pressure, MPa, on the branch from rest.

    Raises InputError for radii as in `tube_pressure` and for a pressure that the tube does not reach on the way to ten
    times its inner radius (negative pressure: to a tenth), with the range that it does reach.
    """
    return _inner_radius(material, inner, outer, pressure, TUBE)


def sphere_inner_radius(material: Material, inner: float, outer: float, pressure: float) -> float:
    """Return the deformed inner radius, mm, of a sphere under a gauge pressure, MPa, on the branch from rest.

    Raises InputError as `tube_inner_radius` does; above the pressure maximum of a sphere there may be no state.
    """
    return _inner_radius(material, inner, outer, pressure, SPHERE)


def tube_state(material: Material, inner: float, outer: float, deformed_inner: float, radius: ArrayLike) -> WallState:
    """Return displacement and Cauchy stresses in a tube at reference radii `radius`, mm, from `inner` to `outer`.

    Raises InputError as `tube_pressure` does, and for a radius outside the wall.
    """
    return _state(material, inner, outer, deformed_inner, radius, TUBE)


def sphere_state(material: Material, inner: float, outer: float, deformed_inner: float, radius: ArrayLike) -> WallState:
    """Return displacement and Cauchy stresses in a sphere; arguments and errors as in `tube_state`."""
    return _state(material, inner, outer, deformed_inner, radius, SPHERE)


def _check(inner: float, outer: float, deformed_inner: NDArray) -> None:
    if not 0.0 < inner < outer < np.inf:
        raise InputError(f"inner = {inner:g} mm, outer = {outer:g} mm, allowed: 0 < inner < outer")
    if not (np.isfinite(deformed_inner) & (deformed_inner > 0.0)).all():
        raise InputError(f"deformed_inner = {deformed_inner} mm, allowed: finite and more than 0")


def _differences(material: Material, hoop: NDArray, power: int) -> tuple[NDArray, NDArray]:
    """Return hoop minus radial and third minus radial Cauchy stress at hoop stretches."""
    third = np.ones_like(hoop) if power == TUBE else hoop
    stretches = np.stack([1.0 / (hoop * third), hoop, third], axis=-1)
    principal = stretches * material.stretch_derivatives(stretches)
    return principal[..., 1] - principal[..., 0], principal[..., 2] - principal[..., 0]


def _radial_stress(material: Material, outer: float, growth: NDArray, radius: NDArray, power: int) -> NDArray:
    """Return sigma_r at `radius` = -(m - 1) int (sigma_hoop - sigma_r)/r dr from there to the free outer face.

    `growth` is a^m - A^m; it and `radius` share one shape.
    """
    depth = np.log(outer / radius)[..., np.newaxis]
    places = radius[..., np.newaxis] * np.exp(0.5 * depth * (_NODES + 1.0))
    swollen = 1.0 + growth[..., np.newaxis] / places**power
    hoop_minus_radial, _ = _differences(material, swollen ** (1.0 / power), power)
    return -(power - 1) * 0.5 * depth[..., 0] * ((hoop_minus_radial / swollen) @ _WEIGHTS)


def _pressure(material: Material, inner: float, outer: float, deformed_inner: ArrayLike, power: int) -> NDArray:
    deformed = np.asarray(deformed_inner, dtype=float)
    _check(inner, outer, deformed)
    growth = deformed**power - inner**power
    return -_radial_stress(material, outer, growth, np.full_like(deformed, inner), power)


def _inner_radius(material: Material, inner: float, outer: float, pressure: float, power: int) -> float:
    end = inner * STRETCH_LIMIT if pressure >= 0.0 else inner / STRETCH_LIMIT
    return first_crossing(
        lambda deformed: _pressure(material, inner, outer, deformed, power), pressure, inner, end, "pressure", "MPa"
    )


def _state(
    material: Material, inner: float, outer: float, deformed_inner: float, radius: ArrayLike, power: int
) -> WallState:
    radii = np.asarray(radius, dtype=float)
    _check(inner, outer, np.asarray(deformed_inner, dtype=float))
    if not ((radii >= inner) & (radii <= outer)).all():
        raise InputError(f"radius = {radius!r} mm, allowed: {inner:g} to {outer:g} mm")
    growth = np.full_like(radii, deformed_inner**power - inner**power)
    hoop = (1.0 + growth / radii**power) ** (1.0 / power)
    radial_stress = _radial_stress(material, outer, growth, radii, power)
    hoop_minus_radial, third_minus_radial = _differences(material, hoop, power)
    return WallState(
        position=hoop * radii,
        displacement=(hoop - 1.0) * radii,
        radial_stress=radial_stress,
        hoop_stress=radial_stress + hoop_minus_radial,
        axial_stress=radial_stress + third_minus_radial,
    )
