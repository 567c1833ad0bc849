"""The thin balloon."""

import numpy as np
import pytest

from pneumorph.closed_form.balloon import balloon_maximum, balloon_pressure
from pneumorph.closed_form.thick_wall import sphere_pressure
from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean, Yeoh


def test_neo_hookean_balloon_has_its_textbook_curve_and_maximum():
    law = NeoHookean(0.4)
    stretch = np.linspace(0.8, 4.0, 9)
    expected = 2.0 * 0.4 * 0.1 / 10.0 * (1.0 / stretch - stretch**-7)
    np.testing.assert_allclose(balloon_pressure(law, 10.0, 0.1, stretch), expected, rtol=1e-12, atol=1e-18)

    at, top = balloon_maximum(law, 10.0, 0.1)
    assert at == pytest.approx(7.0 ** (1.0 / 6.0), rel=1e-6)
    assert top == pytest.approx(2.0 * 0.4 * 0.01 * 6.0 / 7.0 * 7.0 ** (-1.0 / 6.0), rel=1e-12)


def test_a_thick_sphere_tends_to_the_balloon_with_the_square_of_its_thickness():
    law = Yeoh(0.11, 0.002)
    errors = []
    for thickness in (0.2, 0.1):
        inner, outer = 10.0 - thickness / 2.0, 10.0 + thickness / 2.0
        middle = 1.8
        a = np.cbrt(inner**3 + 10.0**3 * (middle**3 - 1.0))
        errors.append(
            float(sphere_pressure(law, inner, outer, a) / balloon_pressure(law, 10.0, thickness, middle) - 1.0)
        )
    assert abs(errors[1]) < 1e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)


def test_a_balloon_that_stiffens_enough_has_no_maximum_and_says_so():
    with pytest.raises(InputError, match=r"stretch_limit = 5: the pressure of Yeoh\(.*\) has no maximum up to there"):
        balloon_maximum(Yeoh(0.11, 0.03), 10.0, 0.1, stretch_limit=5.0)


@pytest.mark.parametrize("thickness", [0.0, 10.0])
def test_a_wall_outside_the_range_is_refused(thickness):
    with pytest.raises(InputError, match=rf"thickness = {thickness:g} mm, radius = 10 mm, allowed: 0 < thickness < "):
        balloon_pressure(NeoHookean(0.4), 10.0, thickness, 1.2)
