"""Drucker's stability against conditions written out by hand."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import (
    ArrudaBoyce,
    ExtendedTube,
    Gent,
    Instability,
    LinearElastic,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    Yeoh,
    instabilities,
    stability_limit,
)
from pneumorph.materials.tension import MODES, principal_stretches

STABLE = [
    NeoHookean(0.1),
    MooneyRivlin(0.1, 0.05),
    Yeoh(0.1, 0.01, 0.001),
    Gent(0.1, 40.0),
    ArrudaBoyce(0.1, 3.0),
    Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)),
    ExtendedTube(0.2, 0.15, 0.2, 0.1),
    LinearElastic(3000.0, 0.36),
]
MUS, ALPHAS = (0.5, -0.04), (1.5, 3.0)


def tensor(stretches):
    return np.concatenate([np.asarray(stretches) ** 2, np.zeros(3)])[np.newaxis]


def energy_table(law, stretches, step=1e-4):
    """Second derivatives (2, 2) of W in two logarithmic strains, the third follows: by finite differences."""

    def at(a, b):
        return float(law.energy(tensor(np.asarray(stretches) * np.exp([a, b, -a - b])))[0])

    mixed = (at(step, step) - at(step, -step) - at(-step, step) + at(-step, -step)) / (4 * step**2)
    first = (at(step, 0) - 2 * at(0, 0) + at(-step, 0)) / step**2
    second = (at(0, step) - 2 * at(0, 0) + at(0, -step)) / step**2
    return np.array([[first, mixed], [mixed, second]])


@pytest.mark.parametrize("law", STABLE, ids=lambda law: type(law).__name__)
def test_laws_with_positive_terms_are_stable_everywhere(law):
    assert instabilities(law, 0.1, 10.0) == ()


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("end", [0.2, 6.0])
@pytest.mark.parametrize(
    "law",
    [Yeoh(0.1, -0.004), MooneyRivlin(0.2, -0.03), MooneyRivlin(0.1, 0.02, -0.002, 0.001, -0.001), Ogden(MUS, ALPHAS)],
    ids=lambda law: type(law).__name__,
)
def test_the_limit_is_where_the_energy_stops_being_convex(law, mode, end):
    limit = stability_limit(law, mode, end)
    least = [
        np.linalg.eigvalsh(energy_table(law, principal_stretches(mode, s)))[0] / law.shear_modulus
        for s in np.geomspace(1.0, end, 30)
    ]
    if limit is None:
        assert min(least) > 0.0
        return
    assert 1.0 < limit < end or end < limit < 1.0
    table = energy_table(law, principal_stretches(mode, limit))
    assert np.linalg.eigvalsh(table)[0] == pytest.approx(0.0, abs=1e-5 * np.abs(table).max())
    inside = [
        value
        for s, value in zip(np.geomspace(1.0, end, 30), least, strict=True)
        if abs(math.log(s)) < 0.99 * abs(math.log(limit))
    ]
    assert min(inside) > 0.0


def test_ogden_in_uniaxial_tension_fails_where_its_slopes_say():
    """With h(λ) the sum of mu alpha λ^alpha, h1, h2 = h3: stable while h2 > 0 and 2 h1 + h2 > 0."""

    def slope(stretch):
        return sum(m * a * stretch**a for m, a in zip(MUS, ALPHAS, strict=True))

    expected = brentq(lambda s: 2.0 * slope(s) + slope(s**-0.5), 1.5, 6.0)
    assert stability_limit(Ogden(MUS, ALPHAS), "uniaxial", 6.0) == pytest.approx(expected, rel=1e-9)
    (first, *_) = instabilities(Ogden(MUS, ALPHAS), 0.5, 6.0)
    assert first == Instability("uniaxial", pytest.approx(expected, rel=1e-9))


def test_a_law_that_locks_is_stable_up_to_there():
    law = Gent(0.1, 5.0)
    assert np.isnan(law.uniaxial_tension(3.0))
    assert stability_limit(law, "uniaxial", 5.0) is None


def test_both_sides_of_rest_are_searched():
    law = MooneyRivlin(0.2, -0.03)
    found = {(item.mode, item.stretch > 1.0) for item in instabilities(law, 0.1, 10.0)}
    assert ("equibiaxial", True) in found
    assert ("uniaxial", False) in found


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda: stability_limit(STABLE[0], "shear", 2.0), NameNotFoundError, "unknown mode 'shear'"),
        (lambda: stability_limit(STABLE[0], "planar", 0.0), InputError, "end = 0.0, allowed: finite and more than 0"),
        (lambda: stability_limit(STABLE[0], "planar", math.inf), InputError, "end = inf, allowed: finite"),
        (lambda: instabilities(STABLE[0], 1.2, 3.0), InputError, "range of stretches 1.2 to 3, allowed: from between"),
    ],
)
def test_bad_questions_are_refused(call, kind, message):
    with pytest.raises(kind) as caught:
        call()
    assert str(caught.value).startswith(message)


def test_an_instability_says_in_words_where_it_begins():
    assert str(Instability("planar", 1.908)) == "unstable in planar tension from a stretch of 1.91 on"
    assert str(Instability("uniaxial", 0.5)) == "unstable in uniaxial compression from a stretch of 0.5 on"
