"""Constants and refusals of the materials."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean, Yeoh


def test_neo_hookean_uniaxial_stress_is_the_textbook_one():
    stretch = np.linspace(0.5, 3.0, 11)
    np.testing.assert_allclose(NeoHookean(0.4).uniaxial_tension(stretch), 0.4 * (stretch - stretch**-2), rtol=1e-13)


def test_yeoh_uniaxial_stress_is_the_textbook_one():
    stretch = np.linspace(0.5, 3.0, 11)
    x = stretch**2 + 2.0 / stretch - 3.0
    expected = 2.0 * (stretch - stretch**-2) * (0.11 + 2.0 * 0.02 * x + 3.0 * 0.005 * x**2)
    np.testing.assert_allclose(Yeoh(0.11, 0.02, 0.005).uniaxial_tension(stretch), expected, rtol=1e-12)


def test_yeoh_without_higher_constants_is_neo_hookean():
    c = np.array([[1.4, 0.9, 1.1, 0.1, -0.2, 0.3]])
    for one, other in zip(Yeoh(0.11, 0.0).stress_and_tangent(c), NeoHookean(0.22).stress_and_tangent(c), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-14)


def test_shear_modulus_is_mu_and_twice_c10():
    assert NeoHookean(0.037).shear_modulus == 0.037
    assert Yeoh(0.11, 0.02).shear_modulus == 0.22


def test_bulk_modulus_is_a_thousand_shear_moduli_unless_given():
    assert NeoHookean(0.03).bulk_modulus == pytest.approx(30.0)
    assert Yeoh(0.11, 0.02).bulk_modulus == pytest.approx(220.0)
    assert Yeoh(0.11, 0.02, bulk=50.0).bulk_modulus == 50.0


def test_poisson_ratio_follows_from_both_moduli():
    assert NeoHookean(1.0, bulk=2.0 / 3.0).poisson_ratio == pytest.approx(0.0)
    assert NeoHookean(0.03).poisson_ratio == pytest.approx(0.4995, abs=1e-5)


def test_threads_on_slices_give_what_one_call_gives():
    law = Yeoh(0.11, 0.02)
    random = np.random.default_rng(0)
    gradients = np.eye(3) + 0.1 * random.standard_normal((4000, 3, 3))
    tensors = np.einsum("nki,nkj->nij", gradients, gradients)
    c = np.ascontiguousarray(tensors[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]])
    stress, tangent = np.empty((4000, 6)), np.empty((4000, 21))
    parts = [slice(start, start + 500) for start in range(0, 4000, 500)]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda part: law.stress_and_tangent(c[part], out=(stress[part], tangent[part])), parts))
    whole = law.stress_and_tangent(c)
    np.testing.assert_array_equal(stress, whole[0])
    np.testing.assert_array_equal(tangent, whole[1])


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: NeoHookean(0.0), "NeoHookean: mu = 0 MPa, allowed: more than 0"),
        (lambda: NeoHookean(-0.03), "NeoHookean: mu = -0.03 MPa, allowed: more than 0"),
        (lambda: NeoHookean(float("nan")), "NeoHookean: mu = nan, allowed: a finite stress"),
        (lambda: NeoHookean("0.03 MPa"), "NeoHookean: mu = '0.03 MPa', allowed: a finite stress"),
        (lambda: NeoHookean(None), "NeoHookean: mu = None, allowed: a finite stress"),
        (lambda: NeoHookean(True), "NeoHookean: mu = True, allowed: a finite stress"),
        (lambda: Yeoh(-0.11, 0.02), "Yeoh: c10 = -0.11 MPa, allowed: more than 0"),
        (lambda: Yeoh(0.11, float("inf")), "Yeoh: c20 = inf, allowed: a finite stress"),
        (lambda: Yeoh(0.11, 0.02, float("nan")), "Yeoh: c30 = nan, allowed: a finite stress"),
        (lambda: NeoHookean(3.0, bulk=1.0), "NeoHookean: bulk = 1 MPa, allowed: at least 2 MPa, 2/3 of the initial"),
        (lambda: NeoHookean(3.0, bulk=-5.0), "NeoHookean: bulk = -5 MPa, allowed: at least 2 MPa"),
        (lambda: NeoHookean(3.0, bulk=float("inf")), "NeoHookean: bulk = inf, allowed: a finite stress"),
        (lambda: NeoHookean(3.0, density=0.0), "NeoHookean: density = 0 kg/m³, allowed: more than 0"),
        (lambda: NeoHookean(3.0, density=-1e-9), "NeoHookean: density = -1000 kg/m³, allowed: more than 0"),
        (lambda: NeoHookean(3.0).uniaxial_tension([1.0, 0.0]), "stretch = [1.0, 0.0], allowed: finite and more than 0"),
        (lambda: NeoHookean(3.0).planar_tension(np.inf), "stretch = inf, allowed: finite and more than 0"),
        (lambda: NeoHookean(3.0).energy(np.ones((2, 3, 3))), "c has shape (2, 3, 3): expected (n, 6)"),
        (
            lambda: NeoHookean(3.0).stress_and_tangent(np.ones((2, 6)), out=(np.ones((2, 6)), np.ones((2, 36)))),
            "out has shapes (2, 6) and (2, 36): expected (2, 6), (2, 21)",
        ),
    ],
)
def test_bad_values_are_refused_by_name(build, message):
    with pytest.raises(InputError) as caught:
        build()
    assert str(caught.value).startswith(message)


def test_bulk_and_density_are_given_by_name_only():
    with pytest.raises(TypeError):
        NeoHookean(0.03, 30.0)
