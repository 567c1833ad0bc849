"""The hexagonal prism's published closed form and data."""

import math

import numpy as np
import pytest

from pneumorph.closed_form.hexagonal_prism import (
    REPORTED_BENDING,
    measured_bending_angle,
    measured_moment,
    prism_bending_angle,
    prism_pressure,
    prism_volumes,
)
from pneumorph.errors import InputError
from pneumorph.geometry.hexagonal_prism import HexagonalPrism
from pneumorph.materials import NeoHookean, library

PRISM = HexagonalPrism()
SILICONE = library.material("shore-a45-platinum")
ANGLES = np.array([angle for _, angle in REPORTED_BENDING])


def test_volumes_are_those_of_the_printed_formulas():
    volumes = prism_volumes(PRISM)
    # N = 11, La Wa Ha = 8 * 20 * 22, l2 w2 h2 = 4 * 14 * 19, l3 h3 = 2 * 3
    assert volumes.assembly == pytest.approx(11 * (3520 - 1064) + 6 * 20 * 10)
    assert volumes.column == pytest.approx((600.0 * math.sqrt(3.0) - 196.0 * math.pi) * 112.0)
    assert volumes.envelope == pytest.approx(11 * 3520 + 6 * 3 * 10)
    assert volumes.deformed == pytest.approx(2.0 * volumes.assembly + volumes.column)


def test_pressure_is_equation_12_as_printed():
    def energy(angle):
        stretch = angle / np.sin(angle)
        x = (stretch - 1.0 / stretch) ** 2
        return 0.11 * x + 0.02 * x**2

    volumes = prism_volumes(PRISM)
    step = 1e-5
    slope = (energy(ANGLES + step) - energy(ANGLES - step)) / (2.0 * step)
    fraction = np.sin(ANGLES) ** 2 / (2.0 * volumes.envelope * (np.sin(ANGLES) - ANGLES * np.cos(ANGLES)))
    np.testing.assert_allclose(prism_pressure(PRISM, SILICONE, ANGLES), fraction * volumes.deformed * slope, rtol=1e-6)


def test_pressures_at_the_reported_angles_are_those_found_before():
    # another evaluation of the printed formula with the dimensions of Table 1, told as 'about' these; half of the angle
    # would give 37 kPa at the last, so Phi is the whole bending angle
    expected = np.array([2.0, 12.0, 30.0, 62.0, 99.0, 128.0, 144.0])
    np.testing.assert_allclose(1e3 * prism_pressure(PRISM, SILICONE, ANGLES), expected, atol=1.0, rtol=0.015)


def test_pressure_grows_with_the_square_of_a_small_angle():
    small = prism_pressure(PRISM, SILICONE, np.array([0.0, 0.01, 0.02]))
    assert small[0] == 0.0
    assert small[2] / small[1] == pytest.approx(4.0, rel=1e-3)


def test_bending_angle_inverts_the_pressure():
    for angle in (0.05, 0.5, 1.5):
        pressure = float(prism_pressure(PRISM, SILICONE, angle))
        assert prism_bending_angle(PRISM, SILICONE, pressure) == pytest.approx(angle, rel=1e-10)


def test_reported_data_are_those_of_table_2():
    assert [(round(1e3 * p), round(math.degrees(a), 6)) for p, a in REPORTED_BENDING] == [
        (40, 5.5),
        (80, 13.7),
        (120, 22.6),
        (160, 32.5),
        (200, 41.5),
        (240, 47.4),
        (280, 50.5),
    ]


def test_measured_polynomial_runs_close_to_the_reported_results():
    pressures = np.array([pressure for pressure, _ in REPORTED_BENDING])
    # the study shows experiment and simulation together: within 3 degrees over the whole range
    assert np.abs(np.degrees(measured_bending_angle(pressures) - ANGLES)).max() < 3.0
    assert math.degrees(float(measured_bending_angle(0.0))) == pytest.approx(1.2143)
    assert float(measured_moment(0.1)) == pytest.approx(-14.254 + 18.295 + 163.0 - 97.34 + 107.2)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: prism_pressure(PRISM, SILICONE, math.pi), "bending_angle = 3.14159"),
        (lambda: prism_pressure(PRISM, SILICONE, [-0.1]), "bending_angle = [-0.1] rad, allowed: 0 to less than pi"),
        (lambda: prism_bending_angle(PRISM, NeoHookean(0.22), -0.1), "pressure = -0.1 MPa, allowed: 0 to "),
        (lambda: measured_bending_angle(0.3), "pressure = 0.3 MPa, allowed: 0 to 0.28 MPa"),
        (lambda: measured_moment(-0.01), "pressure = -0.01 MPa, allowed: 0 to 0.28 MPa"),
    ],
)
def test_bad_values_are_refused_by_name(call, message):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
