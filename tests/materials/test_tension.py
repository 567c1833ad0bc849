"""Nominal stress of each law in the three tests, against formulas written out by hand."""

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import ArrudaBoyce, ExtendedTube, Gent, LinearElastic, MooneyRivlin, NeoHookean, Ogden
from pneumorph.materials.tension import MODES, principal_stretches

S = np.array([0.6, 0.8, 1.0, 1.3, 1.9, 2.6])
# mode -> I1, I2, then λ - λ3²/λ and what multiplies W2 beside W1, for an incompressible specimen
I1 = {"uniaxial": S**2 + 2 / S, "equibiaxial": 2 * S**2 + S**-4, "planar": S**2 + S**-2 + 1}
I2 = {"uniaxial": 2 * S + S**-2, "equibiaxial": S**4 + 2 * S**-2, "planar": S**2 + S**-2 + 1}
PULL = {"uniaxial": S - S**-2, "equibiaxial": S - S**-5, "planar": S - S**-3}
BESIDE = {"uniaxial": 1 / S, "equibiaxial": S**2, "planar": np.ones_like(S)}
# mode -> exponent of the free stretch in that of the pull
FREE = {"uniaxial": -0.5, "equibiaxial": -2.0, "planar": -1.0}

pytestmark = pytest.mark.parametrize("mode", MODES)


def stress(law, mode, stretch=S):
    return getattr(law, f"{mode}_tension")(stretch)


def test_mooney_rivlin_with_five_constants(mode):
    c10, c01, c20, c11, c02 = 0.11, 0.05, 0.003, 0.002, -0.001
    x, y = I1[mode] - 3, I2[mode] - 3
    expected = 2 * PULL[mode] * (c10 + 2 * c20 * x + c11 * y + BESIDE[mode] * (c01 + c11 * x + 2 * c02 * y))
    np.testing.assert_allclose(stress(MooneyRivlin(c10, c01, c20, c11, c02), mode), expected, rtol=1e-12, atol=1e-15)


def test_gent(mode):
    expected = 0.3 * 20 / (20 - (I1[mode] - 3))
    inside = expected > 0
    assert inside.sum() >= 5
    np.testing.assert_allclose(
        stress(Gent(0.3, 20.0), mode)[inside], (expected * PULL[mode])[inside], rtol=1e-12, atol=1e-15
    )
    assert np.isnan(stress(Gent(0.3, 20.0), mode)[~inside]).all()


def test_arruda_boyce(mode):
    squared, i1 = 2.5**2, I1[mode]
    series = (
        1 / 2 + i1 / 10 / squared + 11 * i1**2 / 350 / squared**2
        + 19 * i1**3 / 1750 / squared**3 + 519 * i1**4 / 134750 / squared**4
    )  # fmt: skip
    expected = 2 * PULL[mode] * 0.25 * series
    np.testing.assert_allclose(stress(ArrudaBoyce(0.25, 2.5), mode), expected, rtol=1e-12, atol=1e-15)


def test_ogden(mode):
    mus, alphas = (0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)
    expected = sum(m * (S ** (a - 1) - S ** (FREE[mode] * a - 1)) for m, a in zip(mus, alphas, strict=True))
    np.testing.assert_allclose(stress(Ogden(mus, alphas), mode), expected, rtol=1e-12, atol=1e-15)


def test_extended_tube(mode):
    gc, ge, beta, delta = 0.2, 0.15, 0.3, 0.15
    left = 1 - delta**2 * (I1[mode] - 3)
    network = gc * PULL[mode] * ((1 - delta**2) / left**2 - delta**2 / left)
    tubes = 2 * ge / beta * (S ** (-FREE[mode] * beta - 1) - S ** (-beta - 1))
    expected = np.where(left > 0, network + tubes, np.nan)
    np.testing.assert_allclose(stress(ExtendedTube(gc, ge, beta, delta), mode), expected, rtol=1e-12, atol=1e-15)


def test_linear_elastic_is_hookes_law_of_plane_stress_for_small_strains(mode):
    young, poisson, strain = 3500.0, 0.36, 1e-6
    factor = {"uniaxial": 1.0, "equibiaxial": 1 / (1 - poisson), "planar": 1 / (1 - poisson**2)}[mode]
    small = stress(LinearElastic(young, poisson), mode, 1 + strain)
    assert small == pytest.approx(young * factor * strain, rel=3e-6)


def test_linear_elastic_without_a_change_of_volume_is_henckys_law(mode):
    law = LinearElastic(3.0, 0.5 - 1e-14)
    expected = 2 * law.shear_modulus * (1 - FREE[mode]) * np.log(S) / S
    np.testing.assert_allclose(stress(law, mode), expected, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(
    "law",
    [
        MooneyRivlin(0.15, 0.0),
        Gent(0.3, 1e12),
        ArrudaBoyce(0.3, 1e6),
        Ogden((0.3,), (2.0,)),
        ExtendedTube(0.3, 0, 1, 0),
    ],
    ids=lambda law: type(law).__name__,
)
def test_every_law_has_the_neo_hookean_one_as_a_limit(mode, law):
    np.testing.assert_allclose(stress(law, mode), stress(NeoHookean(0.3), mode), rtol=1e-10, atol=1e-14)


def test_stretches_keep_the_volume_and_refuse_what_is_none(mode):
    np.testing.assert_allclose(principal_stretches(mode, S).prod(axis=-1), 1.0, rtol=1e-14)
    assert principal_stretches(mode, 2.0).shape == (3,)
    with pytest.raises(InputError, match=r"stretch = -1\.0, allowed: finite"):
        principal_stretches(mode, -1.0)
    with pytest.raises(NameNotFoundError, match="did you mean '" + mode):
        principal_stretches(mode[:-1], 1.0)
