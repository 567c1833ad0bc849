"""Flow through an orifice by ISO 6358."""

from math import sqrt

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.mechanics.supplies.orifice import LAMINAR, Orifice
from pneumorph.units import parse

VALVE = Orifice(parse("1e-8 m3/(s Pa)", "conductance"), 0.3)
WARM, COLD = 310.0, 280.0


def test_choked_flow_goes_with_the_upstream_pressure_alone():
    """1e-8 m3/(s Pa) times 1.185 kg/m3 times 6e5 Pa is 7.11 g/s at the reference temperature."""
    for downstream in (0.0, 0.1, 0.18):
        flow, _, by_second, *_ = VALVE.flow(0.6, downstream, 293.15, COLD)
        assert flow / 7.11e-6 == pytest.approx(1.0, rel=1e-12)
        assert by_second == 0.0
    assert VALVE.flow(0.6, 0.1, 4.0 * 293.15, COLD)[0] / 7.11e-6 == pytest.approx(0.5, rel=1e-12)


def test_subsonic_flow_lies_on_the_ellipse():
    """At r = 0.65 and b = 0.3 the ellipse is at sqrt(1 - 0.5^2)."""
    assert VALVE.flow(0.6, 0.39, 293.15, COLD)[0] / 7.11e-6 == pytest.approx(sqrt(0.75), rel=1e-12)


@pytest.mark.parametrize("downstream", [0.05, 0.17, 0.19, 0.4, 0.58, 0.5995, 0.5999, 0.6, 0.6001, 0.61, 0.9, 3.0])
def test_slopes_match_differences(downstream):
    at = np.array([0.6, downstream, WARM, COLD])
    slopes = np.array(VALVE.flow(*at)[1:])
    assert np.abs(slopes).max() > 0.0
    for i, size in enumerate((1e-8, 1e-8, 1e-3, 1e-3)):
        step = size * np.eye(4)[i]
        if downstream == 0.6 and i > 1:
            continue
        change = VALVE.flow(*(at + step))[0] - VALVE.flow(*(at - step))[0]
        # at equal pressures the two directions differ by the temperatures upstream
        tolerance = 0.05 if downstream == 0.6 else 1e-5
        assert change / (2.0 * size) == pytest.approx(slopes[i], rel=tolerance, abs=1e-5 * np.abs(slopes[:2]).max())


@pytest.mark.parametrize("border", [0.3, 1.0 - LAMINAR])
def test_flow_and_slope_are_continuous_at_the_borders(border):
    low, high = (VALVE.flow(0.6, 0.6 * (border + shift), WARM, COLD) for shift in (-1e-10, 1e-10))
    assert low[0] == pytest.approx(high[0], rel=1e-6, abs=0.0)
    assert low[2] == pytest.approx(high[2], rel=1e-5, abs=1e-5 * VALVE.flow(0.6, 0.5, WARM, COLD)[2] ** 2)


def test_flow_turns_round_with_the_pressures():
    forth, back = VALVE.flow(0.5, 0.3, WARM, COLD), VALVE.flow(0.3, 0.5, COLD, WARM)
    assert forth[0] == -back[0] > 0.0
    assert (forth[1], forth[2], forth[3], forth[4]) == (-back[2], -back[1], -back[4], -back[3])
    assert VALVE.flow(0.4, 0.4, WARM, COLD)[0] == 0.0


@pytest.mark.parametrize("value", [0.0, -1.0, float("inf"), float("nan")])
def test_a_conductance_that_is_not_positive_is_refused(value):
    with pytest.raises(InputError, match=r"conductance = .* L/\(min·bar\), allowed: more than 0"):
        Orifice(value, 0.3)


@pytest.mark.parametrize("value", [0.0, -0.1, 1.0, 1.5, float("nan")])
def test_a_critical_ratio_outside_its_range_is_refused(value):
    with pytest.raises(InputError, match=r"critical_ratio = .*, allowed: above 0 and below 0\.999"):
        Orifice(1.0, value)
