"""Thick-walled tube and sphere, and the linear solutions they start from."""

import numpy as np
import pytest
from scipy.integrate import quad

from pneumorph.closed_form.lame import lame_sphere, lame_tube
from pneumorph.closed_form.thick_wall import (
    sphere_inner_radius,
    sphere_pressure,
    sphere_state,
    tube_inner_radius,
    tube_pressure,
    tube_state,
)
from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean, Yeoh

A, B = 10.0, 14.0
LAWS = [NeoHookean(0.22), Yeoh(0.11, 0.02), Yeoh(0.11, 0.03, 0.001)]
KINDS = {
    "tube": (tube_pressure, tube_inner_radius, tube_state, lame_tube, 2),
    "sphere": (sphere_pressure, sphere_inner_radius, sphere_state, lame_sphere, 3),
}
every_kind = pytest.mark.parametrize("kind", KINDS)
every_law = pytest.mark.parametrize("law", LAWS, ids=repr)


def test_neo_hookean_tube_pressure_is_the_analytic_one():
    a = np.array([6.0, 10.0, 11.0, 15.0, 40.0])
    b = np.sqrt(B**2 + a**2 - A**2)
    growth = a**2 - A**2
    expected = 0.22 * (np.log(a * B / (A * b)) + 0.5 * growth * (1.0 / a**2 - 1.0 / b**2))
    np.testing.assert_allclose(tube_pressure(NeoHookean(0.22), A, B, a), expected, rtol=1e-12, atol=1e-16)


def test_neo_hookean_sphere_pressure_is_the_analytic_one():
    a = np.array([6.0, 10.0, 11.0, 15.0, 40.0])
    b = np.cbrt(B**3 + a**3 - A**3)
    p, q = a / A, b / B
    expected = 0.5 * 0.22 * (4.0 / q + q**-4 - 4.0 / p - p**-4)
    np.testing.assert_allclose(sphere_pressure(NeoHookean(0.22), A, B, a), expected, rtol=1e-12, atol=1e-15)


@every_kind
@every_law
def test_pressure_is_the_derivative_of_the_stored_energy_with_respect_to_the_enclosed_volume(law, kind):
    pressure, _, _, _, power = KINDS[kind]

    def energy(a):
        def density(radius):
            hoop = (1.0 + (a**power - A**power) / radius**power) ** (1.0 / power)
            third = 1.0 if kind == "tube" else hoop
            c = np.array([[(hoop * third) ** -2, hoop**2, third**2, 0.0, 0.0, 0.0]])
            return float(law.energy(c)[0]) * radius ** (power - 1)

        # per radian of the tube, per steradian of the sphere
        return quad(density, A, B, epsabs=0.0, epsrel=1e-12)[0]

    a, step = 13.0, 1e-3
    work = (energy(a + step) - energy(a - step)) / (((a + step) ** power - (a - step) ** power) / power)
    assert work > 0.01
    assert float(pressure(law, A, B, a)) == pytest.approx(work, rel=1e-6)


@every_kind
@every_law
def test_stresses_are_in_equilibrium_and_meet_both_boundary_conditions(law, kind):
    pressure, _, state, _, power = KINDS[kind]
    a = 13.0
    walls = state(law, A, B, a, np.array([A, B]))
    assert walls.radial_stress[0] == pytest.approx(-float(pressure(law, A, B, a)))
    assert walls.radial_stress[1] == pytest.approx(0.0, abs=1e-15)
    assert walls.position[0] == pytest.approx(a)

    radii = np.linspace(10.5, 13.5, 5)
    step = 1e-4
    high, low, here = (state(law, A, B, a, radii + change) for change in (step, -step, 0.0))
    gradient = (high.radial_stress - low.radial_stress) / (high.position - low.position)
    expected = (power - 1) * (here.hoop_stress - here.radial_stress) / here.position
    np.testing.assert_allclose(gradient, expected, rtol=1e-6)


@every_kind
@every_law
def test_inner_radius_inverts_the_pressure_of_both_signs(law, kind):
    pressure, inner_radius, *_ = KINDS[kind]
    for a in (9.0, 10.0, 10.01, 12.0):
        assert inner_radius(law, A, B, float(pressure(law, A, B, a))) == pytest.approx(a, rel=1e-10)


@every_kind
@every_law
def test_small_pressures_give_the_linear_solution(law, kind):
    _, inner_radius, state, linear, _ = KINDS[kind]
    pressure = 1e-7
    radii = np.linspace(A, B, 5)
    found = state(law, A, B, inner_radius(law, A, B, pressure), radii)
    expected = linear(law.shear_modulus, A, B, pressure, radii)
    for one, other in zip(found[1:], expected[1:], strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-6 * pressure)


@pytest.mark.parametrize("linear", [lame_tube, lame_sphere])
@pytest.mark.parametrize("nu", [0.2, 0.45, 0.5])
def test_linear_stresses_follow_from_the_displacement_by_hookes_law(linear, nu):
    mu, pressure, step = 0.3, 0.01, 1e-4
    radii = np.linspace(A + step, B - step, 4)
    found = linear(mu, A, B, pressure, radii, nu)
    high, low = (linear(mu, A, B, pressure, radii + change, nu).displacement for change in (step, -step))
    radial, hoop = (high - low) / (2.0 * step), found.displacement / radii
    np.testing.assert_allclose(found.hoop_stress - found.radial_stress, 2.0 * mu * (hoop - radial), rtol=1e-6)
    third = np.zeros_like(radii) if linear is lame_tube else hoop
    np.testing.assert_allclose(found.axial_stress - found.radial_stress, 2.0 * mu * (third - radial), rtol=1e-6)
    trace = found.radial_stress + found.hoop_stress + found.axial_stress
    np.testing.assert_allclose(
        (1.0 - 2.0 * nu) * trace, 2.0 * mu * (1.0 + nu) * (radial + hoop + third), rtol=1e-6, atol=1e-10
    )
    assert linear(mu, A, B, pressure, A, nu).radial_stress == pytest.approx(-pressure)
    assert linear(mu, A, B, pressure, B, nu).radial_stress == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: tube_pressure(LAWS[0], 14.0, 10.0, 12.0), "inner = 14 mm, outer = 10 mm, allowed: 0 < inner < outer"),
        (lambda: sphere_pressure(LAWS[0], -1.0, 10.0, 12.0), "inner = -1 mm"),
        (lambda: tube_pressure(LAWS[0], A, B, 0.0), "deformed_inner = 0.0 mm, allowed: finite and more than 0"),
        (lambda: tube_state(LAWS[0], A, B, 12.0, 9.0), "radius = 9.0 mm, allowed: 10 to 14 mm"),
        (lambda: sphere_state(LAWS[0], A, B, 12.0, [11.0, 14.5]), "radius = [11.0, 14.5] mm, allowed: 10 to 14 mm"),
        (lambda: tube_inner_radius(LAWS[0], A, B, 1.0), "pressure = 1 MPa, allowed: 0 to "),
        (lambda: sphere_inner_radius(LAWS[0], A, B, float("nan")), "pressure = nan, allowed: finite"),
        (lambda: lame_tube(0.3, A, B, 0.01, 9.0), "inner = 10, radius = 9.0, outer = 14 mm"),
        (lambda: lame_sphere(0.3, A, B, 0.01, 11.0, 0.6), "poisson_ratio = 0.6, allowed"),
        (lambda: lame_sphere(0.0, A, B, 0.01, 11.0), "shear_modulus = 0 MPa, allowed"),
    ],
)
def test_bad_values_are_refused_by_name(call, message):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
