"""Large deflections of a cantilever."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pneumorph.closed_form.cantilever import end_load, end_moment
from pneumorph.errors import InputError

EI, L = 40.0, 20.0


def test_a_small_load_gives_linear_beam_theory():
    force = 1e-6 * EI / L**2
    tip = end_load(EI, L, force)
    assert tip.transverse == pytest.approx(force * L**3 / (3.0 * EI), rel=1e-9)
    assert tip.rotation == pytest.approx(force * L**2 / (2.0 * EI), rel=1e-9)
    assert tip.axial == pytest.approx(L, rel=1e-9)


@pytest.mark.parametrize(
    ("load", "deflection", "shortening", "rotation"),
    # Mattiasson, Int. J. Numer. Methods Eng. 17 (1981) 145, Table 1: P L²/EI, w/L, u/L, rotation of the tip
    [(1, 0.30172, 0.05643, 0.46135), (2, 0.49346, 0.16064, 0.78175), (10, 0.81061, 0.55500, 1.43029)],
)
def test_large_loads_give_the_published_table(load, deflection, shortening, rotation):
    tip = end_load(EI, L, load * EI / L**2)
    assert tip.transverse / L == pytest.approx(deflection, abs=6e-6)
    assert 1.0 - tip.axial / L == pytest.approx(shortening, abs=6e-6)
    assert tip.rotation == pytest.approx(rotation, abs=6e-6)


@pytest.mark.parametrize("load", [0.3, 5.0, 60.0])
def test_the_tip_found_integrates_back_to_the_clamp(load):
    tip = end_load(1.0, 1.0, load)

    def slopes(s, y):
        return [y[1], -load * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]

    # from the tip, where the curvature is zero, backwards along the beam
    start = [tip.rotation, 0.0, tip.axial, tip.transverse]
    end = solve_ivp(slopes, (1.0, 0.0), start, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    growth = math.cosh(math.sqrt(load))
    np.testing.assert_allclose(end[[0, 2, 3]], 0.0, atol=1e-11 * growth)


def test_the_beam_bends_to_the_side_of_the_force_and_rests_without_it():
    up, down = end_load(EI, L, 0.5), end_load(EI, L, -0.5)
    assert down == (up.axial, -up.transverse, -up.rotation)
    assert end_load(EI, L, 0.0) == (L, 0.0, 0.0)


def test_a_huge_load_stretches_the_beam_out_along_the_force():
    tip = end_load(1.0, 1.0, 1e4)
    assert tip.rotation == pytest.approx(math.pi / 2.0)
    assert tip.axial == pytest.approx(math.sqrt(2e-4), rel=1e-6)
    assert tip.transverse == pytest.approx(1.0, abs=0.01)


def test_an_end_moment_gives_an_arc_of_a_circle():
    moment = 0.5 * math.pi * EI / L
    tip = end_moment(EI, L, moment)
    radius = EI / moment
    assert tip.rotation == pytest.approx(math.pi / 2.0)
    assert tip.axial == pytest.approx(radius)
    assert tip.transverse == pytest.approx(radius)
    full = end_moment(EI, L, 2.0 * math.pi * EI / L)
    np.testing.assert_allclose(full[:2], 0.0, atol=1e-14)


def test_the_chord_of_an_arc_turns_by_half_of_the_tip():
    tip = end_moment(EI, L, 3.0)
    assert math.atan2(tip.transverse, tip.axial) == pytest.approx(0.5 * tip.rotation)
    assert end_moment(EI, L, 0.0) == (L, 0.0, 0.0)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: end_load(0.0, L, 1.0), "bending_stiffness = 0 N mm², length = 20 mm, allowed: finite and more than 0"),
        (lambda: end_moment(EI, -1.0, 1.0), "bending_stiffness = 40 N mm², length = -1 mm"),
        (lambda: end_load(EI, L, float("inf")), "force = inf, allowed: finite"),
        (lambda: end_moment(EI, L, float("nan")), "moment = nan, allowed: finite"),
        (lambda: end_load(EI, L, 1e5), "force * length² / bending_stiffness = 1e+06, allowed: up to 10000"),
    ],
)
def test_bad_values_are_refused_by_name(call, message):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
