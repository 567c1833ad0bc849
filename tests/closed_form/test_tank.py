"""Filling of a tank by its closed form, against the equation that it solves."""

import numpy as np
import pytest

from pneumorph.closed_form.tank import filling_ratio
from pneumorph.errors import InputError


@pytest.mark.parametrize("start", [0.0, 0.1, 0.3, 0.8])
def test_the_closed_form_solves_its_differential_equation(start):
    b, k = 0.3, 2.0
    time = np.linspace(0.01, 0.6, 60)
    step = 1e-6
    rate = (filling_ratio(start, b, k, time + step) - filling_ratio(start, b, k, time - step)) / (2.0 * step)
    ratio = filling_ratio(start, b, k, time)
    x = np.maximum(ratio - b, 0.0) / (1.0 - b)
    assert ratio[-1] > start
    assert rate == pytest.approx(k * np.sqrt(np.maximum(1.0 - x**2, 0.0)), abs=1e-5)


def test_a_tank_is_full_after_a_finite_time():
    """From empty: b / k choked and then a quarter of a sine, pi/2 (1 - b) / k."""
    full = 0.4 / 2.0 + 0.5 * np.pi * 0.6 / 2.0
    assert filling_ratio(0.0, 0.4, 2.0, [0.0, 0.2, full, 2.0 * full]) == pytest.approx([0.0, 0.4, 1.0, 1.0])
    assert filling_ratio(0.0, 0.4, 2.0, 0.99 * full) < 1.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((1.1, 0.3, 1.0, 0.0), "start = 1.1, allowed: 0 to 1"),
        ((0.0, 1.0, 1.0, 0.0), "critical_ratio = 1, allowed: above 0 and below 1"),
        ((0.0, 0.3, 0.0, 0.0), "rate = 0 1/s, allowed: more than 0"),
        ((0.0, 0.3, 1.0, [1.0, -1.0]), "time, allowed: 0 s or more"),
    ],
)
def test_values_outside_their_range_are_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        filling_ratio(*arguments)
