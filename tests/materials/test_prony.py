"""The Prony series: closed forms of linear viscoelasticity, and the step against them."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from pneumorph.errors import InputError
from pneumorph.materials import LinearElastic, NeoHookean, Prony, Yeoh

SERIES = Prony((0.2, 0.15, 0.1), (0.05, 1.0, 30.0))


def test_long_term_constants_are_what_is_left_of_the_instantaneous_ones():
    assert SERIES.long_term_share == pytest.approx(0.55)
    assert SERIES.relaxation(0.0) == pytest.approx(1.0 / 0.55)
    assert SERIES.relaxation(1e6) == pytest.approx(1.0)


def test_relaxation_is_the_printed_series():
    time = np.array([0.0, 0.01, 0.3, 5.0, 100.0])
    instantaneous = 1.0 - sum(g * (1.0 - np.exp(-time / tau)) for g, tau in zip(SERIES.g, SERIES.tau, strict=True))
    np.testing.assert_allclose(SERIES.relaxation(time), instantaneous / 0.55, rtol=1e-14)


@pytest.mark.parametrize("frequency", [0.02, 1.0, 20.0])
def test_dynamic_moduli_are_the_transforms_of_the_relaxation(frequency):
    """G' = G∞ + ω ∫ (G - G∞) sin ωt dt, G'' = ω ∫ (G - G∞) cos ωt dt (Ferry, Viscoelastic Properties (1980), ch. 3)."""

    def transform(weight):
        fading = lambda time: float(SERIES.relaxation(time)) - 1.0  # noqa: E731
        return frequency * quad(fading, 0.0, np.inf, weight=weight, wvar=frequency, limit=400, limlst=200)[0]

    assert SERIES.storage_modulus(frequency) == pytest.approx(1.0 + transform("sin"), rel=1e-6)
    assert SERIES.loss_modulus(frequency) == pytest.approx(transform("cos"), rel=1e-6)


def test_dynamic_moduli_tend_to_those_of_the_slow_and_the_sudden_solid():
    assert SERIES.storage_modulus(0.0) == 1.0
    assert SERIES.storage_modulus(1e9) == pytest.approx(1.0 / 0.55)
    assert SERIES.loss_modulus([0.0, 1e12]) == pytest.approx([0.0, 0.0], abs=1e-9)


def marched(series, times, stress):
    """Stresses (steps + 1, n, 6) of a history of elastic stresses (steps + 1, n, 6) that starts at rest."""
    overstress, result = series.at_rest(stress.shape[1]), [stress[0]]
    for number, dt in enumerate(np.diff(times), start=1):
        step = series.step(dt, overstress, stress[number - 1], stress[number])
        overstress = step.overstress
        result.append(step.factor * stress[number] + step.history)
        np.testing.assert_allclose(result[-1], stress[number] + overstress.sum(axis=0), rtol=1e-12, atol=1e-15)
    return np.array(result)


def test_a_held_stretch_relaxes_by_the_closed_form():
    """A ramp of 1e-6 s, then steps of very different length: each is exact, because the elastic stress rests."""
    elastic = Yeoh(0.11, 0.02).stress_and_tangent(np.array([[1.8, 0.8, 0.7, 0.1, 0.05, -0.1]]))[0]
    ramp = 1e-6
    held = np.array([0.001, 0.01, 0.05, 0.3, 0.31, 2.0, 50.0, 500.0])
    times = np.concatenate([[0.0, ramp], ramp + held])
    stress = np.concatenate([np.zeros((1, 1, 6)), np.broadcast_to(elastic, (len(times) - 1, 1, 6))])
    result = marched(SERIES, times, stress)
    assert np.abs(elastic).min() > 0.0
    for time, value in zip(held, result[2:], strict=True):
        np.testing.assert_allclose(value, SERIES.relaxation(time) * elastic, rtol=2e-5)


def history(times):
    """Smooth elastic stresses (steps + 1, 1, 6) that start at zero."""
    return np.sin(1.3 * times)[:, np.newaxis, np.newaxis] * np.array([[1.0, -0.4, 0.2, 0.1, -0.3, 0.05]])


def convolution(series, time):
    """Closed convolution of G(t - s)/G∞ with d/ds sin(1.3 s), by quadrature."""
    slope = lambda s: float(series.relaxation(time - s)) * 1.3 * math.cos(1.3 * s)  # noqa: E731
    return quad(slope, 0.0, time, epsabs=1e-12, epsrel=1e-12, limit=400)[0]


def test_the_step_is_of_second_order_against_the_convolution():
    errors, exact = [], convolution(SERIES, 2.0)
    for steps in (20, 40, 80, 160):
        times = np.linspace(0.0, 2.0, steps + 1)
        result = marched(SERIES, times, history(times))[-1, 0, 0]
        errors.append(abs(result - exact))
    assert errors[-1] < 1e-5
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (orders > 1.9).all(), orders
    assert (orders < 2.1).all(), orders


def test_uneven_steps_of_a_linear_history_are_exact():
    times = np.array([0.0, 0.01, 0.5, 0.6, 4.0])
    stress = times[:, np.newaxis, np.newaxis] * np.ones((1, 2, 6))
    beta = np.array(SERIES.g) / 0.55
    tau = np.array(SERIES.tau)
    expected = times + (beta * tau * (1.0 - np.exp(-times[:, np.newaxis] / tau))).sum(axis=1)
    np.testing.assert_allclose(marched(SERIES, times, stress)[:, 1, 3], expected, rtol=1e-12)


def test_the_factor_is_the_slope_of_the_stress_in_the_elastic_one():
    random = np.random.default_rng(0)
    overstress, before, after = random.standard_normal((3, 4, 6)), *random.standard_normal((2, 4, 6))
    first, second = (SERIES.step(0.1, overstress, before, x) for x in (after, after + 0.5))
    np.testing.assert_allclose(first.history, second.history)
    stress = [x + step.overstress.sum(axis=0) for x, step in ((after, first), (after + 0.5, second))]
    np.testing.assert_allclose(stress[1] - stress[0], 0.5 * SERIES.step_factor(0.1), rtol=1e-12)
    assert first.factor == SERIES.step_factor(0.1)


def test_a_sudden_step_is_instantaneous_and_a_slow_one_elastic():
    assert SERIES.step_factor(1e-9) == pytest.approx(1.0 / 0.55, rel=1e-6)
    assert SERIES.step_factor(1e9) == pytest.approx(1.0, rel=1e-6)


def test_a_closed_cycle_takes_work():
    times = np.linspace(0.0, 2.0 * np.pi / 1.3, 400)
    result = marched(SERIES, times, history(times))[:, 0, 0]
    strain = np.sin(1.3 * times)
    assert np.sum(0.5 * (result[1:] + result[:-1]) * np.diff(strain)) > 0.1


def test_a_material_carries_its_series():
    assert NeoHookean(0.1).prony is None
    assert NeoHookean(0.1, prony=SERIES).prony is SERIES
    assert NeoHookean(0.1, prony=SERIES).shear_modulus == 0.1


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: Prony((), ()), "Prony: g = (), allowed: a list of one or more numbers"),
        (lambda: Prony(0.3, 1.0), "Prony: g = 0.3, allowed: a list of one or more numbers"),
        (lambda: Prony("0.3", "1"), "Prony: g = '0.3', allowed: a list of one or more numbers"),
        (lambda: Prony((0.3, 0.1), (1.0,)), "Prony: 2 g and 1 tau, allowed: as many of one as of the other"),
        (lambda: Prony((0.3, math.nan), (1.0, 2.0)), "Prony: g[2] = nan, allowed: a finite number"),
        (lambda: Prony((0.3,), (math.inf,)), "Prony: tau[1] = inf, allowed: a finite time"),
        (lambda: Prony((0.3, 0.0), (1.0, 2.0)), "Prony: g[2] = 0, allowed: between 0 and 1"),
        (lambda: Prony((1.5,), (1.0,)), "Prony: g[1] = 1.5, allowed: between 0 and 1"),
        (lambda: Prony((0.3,), (0.0,)), "Prony: tau[1] = 0 s, allowed: more than 0"),
        (lambda: Prony((0.6, 0.4), (1.0, 2.0)), "Prony: the sum of g = 1, allowed: less than 1"),
        (lambda: NeoHookean(0.1, prony=0.3), "NeoHookean: prony = 0.3, allowed: a Prony or None"),
        (lambda: LinearElastic(3.0, 0.3, prony=(0.3,)), "LinearElastic: prony = (0.3,), allowed: a Prony or None"),
        (lambda: SERIES.relaxation([-1.0]), "time = [-1.0], allowed: 0 or more"),
        (lambda: SERIES.loss_modulus(-1.0), "frequency = -1.0, allowed: 0 or more"),
        (lambda: SERIES.storage_modulus(math.nan), "frequency = nan, allowed: 0 or more"),
        (lambda: SERIES.step_factor(0.0), "dt = 0.0 s, allowed: finite and more than 0"),
        (
            lambda: SERIES.step(0.1, np.zeros((2, 4, 6)), np.zeros((4, 6)), np.zeros((4, 6))),
            "overstress, before and after have shapes (2, 4, 6), (4, 6) and (4, 6): expected (3, 4, 6)",
        ),
    ],
)
def test_bad_values_are_refused_by_name(build, message):
    with pytest.raises(InputError) as caught:
        build()
    assert str(caught.value).startswith(message)
