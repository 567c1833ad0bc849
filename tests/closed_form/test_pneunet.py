"""The PneuNet segment's published closed form, with the dimensions of its example."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from pneumorph.closed_form.pneunet import pneunet_curvature, pneunet_pressure
from pneumorph.closed_form.thick_wall import tube_pressure
from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean

MU, R1, R2 = 0.03, 3.0, 5.0
CURVATURES = (1e-4, 0.01, 0.05, 0.1, 0.15)


@pytest.mark.parametrize("curvature", CURVATURES)
def test_pressure_is_the_quadrature_of_radial_equilibrium(curvature):
    r2 = 1.0 / (1.0 / R2 - curvature)
    c1 = 0.5 * (r2**2 - R2**2)
    r1 = math.sqrt(R1**2 + 2.0 * c1)

    def slope(r):
        square = r**2 - 2.0 * c1
        return MU * (r**2 / square - square / r**2) / r

    expected, _ = quad(slope, r1, r2, epsabs=0.0, epsrel=1e-12)
    assert expected > 1e-6
    assert float(pneunet_pressure(MU, R1, R2, curvature)) == pytest.approx(expected, rel=1e-9)


def test_pressure_is_that_of_a_thick_tube():
    curvature = np.array(CURVATURES)
    r2 = 1.0 / (1.0 / R2 - curvature)
    inner = np.sqrt(R1**2 + r2**2 - R2**2)
    np.testing.assert_allclose(
        pneunet_pressure(MU, R1, R2, curvature), tube_pressure(NeoHookean(MU), R1, R2, inner), rtol=1e-9
    )


def test_curvature_inverts_the_pressure_and_starts_at_zero():
    assert pneunet_curvature(MU, R1, R2, 0.0) == 0.0
    for curvature in CURVATURES:
        pressure = float(pneunet_pressure(MU, R1, R2, curvature))
        assert pneunet_curvature(MU, R1, R2, pressure) == pytest.approx(curvature, rel=1e-9)


def test_pressure_stays_below_mu_times_the_logarithm_of_the_radius_ratio():
    limit = MU * math.log(R2 / R1)
    assert float(pneunet_pressure(MU, R1, R2, 0.1999)) == pytest.approx(limit, rel=1e-4)
    with pytest.raises(InputError, match=r"pressure = 0\.0154 MPa, allowed: 0 to 0\.0153248 MPa"):
        pneunet_curvature(MU, R1, R2, 0.0154)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: pneunet_pressure(MU, R1, R2, 0.2), "curvature = 0.2 /mm, allowed: 0 to less than 1/outer = 0.2 /mm"),
        (lambda: pneunet_pressure(MU, R1, R2, -0.1), "curvature = -0.1 /mm"),
        (lambda: pneunet_pressure(MU, R2, R1, 0.1), "inner = 5 mm, outer = 3 mm, allowed: 0 < inner < outer"),
        (lambda: pneunet_curvature(0.0, R1, R2, 0.01), "shear_modulus = 0 MPa, allowed: finite and more than 0"),
    ],
)
def test_bad_values_are_refused_by_name(call, message):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
