"""The soft limb's closed form against its own energy, limits and finite differences."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from pneumorph.closed_form.soft_limb import (
    LimbSection,
    fibre_strain,
    limb_angle,
    limb_energy,
    limb_pressure,
    limb_section,
    limit_pressure,
    printed_angle,
    yeoh_tangent,
)
from pneumorph.errors import InputError
from pneumorph.geometry import SoftLimb
from pneumorph.materials import Yeoh

SKIN = Yeoh(0.11488, 0.001262)
SECTION = LimbSection(chambers=6, width=6.0, height=14.0, arm=9.5, depth=36.0, chamber_depth=30.0)


@pytest.mark.parametrize("pressure", [0.005, 0.015, 0.03, 0.05])
def test_the_printed_formula_is_the_minimum_of_the_printed_energy_at_a_fixed_modulus(pressure):
    modulus = 0.6
    found = minimize_scalar(
        lambda xi: float(limb_energy(SECTION, modulus, xi, pressure)), bounds=(6.0, 30.0), options={"xatol": 1e-10}
    )
    angle = SECTION.chambers * (found.x - SECTION.width) / SECTION.arm
    assert float(printed_angle(SECTION, modulus, pressure)) == pytest.approx(angle, rel=1e-5)
    assert angle > 0.1


def test_with_a_modulus_that_falls_with_strain_the_energy_is_least_at_a_larger_angle():
    """The printed S takes E for fixed while it minimises: then puts in the E of the state."""

    def energy(xi):
        return float(limb_energy(SECTION, yeoh_tangent(SKIN, fibre_strain(SECTION, xi / SECTION.width)), xi, 0.02))

    found = minimize_scalar(energy, bounds=(6.0, 12.0), options={"xatol": 1e-10})
    least = SECTION.chambers * (found.x - SECTION.width) / SECTION.arm
    printed = limb_angle(SECTION, SKIN, 0.02)
    assert least > 1.05 * printed


def test_small_pressures_bend_in_proportion_with_three_times_the_shear_modulus():
    stiffness = 3.0 * SKIN.shear_modulus * SECTION.second_moment
    slope = SECTION.chambers * SECTION.width * math.pi * 30.0 * 14.0 * SECTION.arm / (4.0 * stiffness)
    assert limb_angle(SECTION, SKIN, 1e-6) == pytest.approx(slope * 1e-6, rel=1e-4)


def test_the_angle_inverts_the_pressure_and_starts_at_zero():
    assert limb_angle(SECTION, SKIN, 0.0) == 0.0
    for angle in (0.1, 0.5, 1.0):
        assert limb_angle(SECTION, SKIN, float(limb_pressure(SECTION, SKIN, angle))) == pytest.approx(angle, rel=1e-9)


def test_at_its_own_modulus_the_inverse_agrees_with_the_printed_formula():
    angle = limb_angle(SECTION, SKIN, 0.02)
    ratio = 1.0 + angle * SECTION.arm / (SECTION.chambers * SECTION.width)
    modulus = float(yeoh_tangent(SKIN, fibre_strain(SECTION, ratio)))
    assert float(printed_angle(SECTION, modulus, 0.02)) == pytest.approx(angle, rel=1e-9)


def test_the_tangent_is_the_slope_of_uniaxial_tension_and_starts_at_three_mu():
    strain, step = np.array([0.0, 0.1, 0.69, 2.0]), 1e-6
    slope = (SKIN.uniaxial_tension(1.0 + strain + step) - SKIN.uniaxial_tension(1.0 + strain - step)) / (2.0 * step)
    np.testing.assert_allclose(yeoh_tangent(SKIN, strain), slope, rtol=1e-7)
    assert float(yeoh_tangent(SKIN, 0.0)) == pytest.approx(3.0 * SKIN.shear_modulus)


def test_near_the_limit_pressure_the_angle_grows_without_bound_and_beyond_it_there_is_none():
    limit = limit_pressure(SECTION, 0.6)
    assert float(printed_angle(SECTION, 0.6, (1.0 - 1e-8) * limit)) > 1e3
    with pytest.raises(InputError, match="allowed: 0 to less than"):
        printed_angle(SECTION, 0.6, limit)


def test_the_section_of_a_limb_is_read_off_its_dimensions():
    limb = SoftLimb(chambers=5, chamber_foot=9.0, chamber_top=5.0, chamber_height=12.0, base=4.0)
    section = limb_section(limb)
    assert (section.chambers, section.width, section.height, section.arm) == (5, 7.0, 12.0, 8.0)
    assert section.chamber_depth == limb.depth - 2.0 * limb.side_wall


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: LimbSection(6, 0.0, 14.0, 9.5, 36.0, 30.0), "limb section: width = 0.0, allowed"),
        (lambda: yeoh_tangent(SKIN, -1.0), "strain = -1.0, allowed: more than -1"),
        (lambda: limb_pressure(SECTION, SKIN, -0.1), "angle = -0.1 rad, allowed: 0 or more"),
        (lambda: printed_angle(SECTION, 0.6, -0.01), "pressure = -0.01 MPa, allowed: 0"),
        (lambda: limb_angle(SECTION, SKIN, 1.0), "pressure = 1 MPa, allowed: 0 to"),
    ],
)
def test_bad_values_are_refused_by_name(call, message):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
