"""Constants and refusals of the materials."""

from concurrent.futures import ThreadPoolExecutor
from inspect import isabstract

import numpy as np
import pytest

from pneumorph import materials
from pneumorph.errors import InputError
from pneumorph.materials import (
    LAWS,
    ArrudaBoyce,
    ExtendedTube,
    Gent,
    LinearElastic,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    Yeoh,
)


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


def test_shear_moduli_of_the_other_laws_are_the_printed_ones():
    assert MooneyRivlin(0.16, 0.04, 1.0, 2.0, 3.0).shear_modulus == pytest.approx(0.4)
    assert Gent(0.3, 20.0).shear_modulus == pytest.approx(0.3)
    squared = 2.5**2
    series = 1 + 3 / (5 * squared) + 99 / (175 * squared**2) + 513 / (875 * squared**3) + 42039 / (67375 * squared**4)
    assert ArrudaBoyce(0.25, 2.5).shear_modulus == pytest.approx(0.25 * series)
    # Treloar's rubber by Ogden (1972): 6.3, 0.012 and -0.1 kg/cm²
    assert Ogden((6.3, 0.012, -0.1), (1.3, 5.0, -2.0)).shear_modulus == pytest.approx(4.225)
    assert ExtendedTube(0.2, 0.15, 0.2, 0.1).shear_modulus == pytest.approx(0.2 * 0.98 + 0.15)


def test_linear_elastic_has_the_moduli_of_young_and_poisson():
    law = LinearElastic(3500.0, 0.36)
    assert law.shear_modulus == pytest.approx(3500.0 / 2.72)
    assert law.bulk_modulus == pytest.approx(3500.0 / 0.84)
    assert law.poisson_ratio == pytest.approx(0.36)
    assert LinearElastic(3500.0, 0.0).poisson_ratio == pytest.approx(0.0)


def test_every_public_law_has_a_name():
    public = [getattr(materials, name) for name in materials.__all__]
    laws = {item for item in public if isinstance(item, type) and issubclass(item, materials.Material)}
    fitted = {materials.OrthotropicLayer}  # to the cells of a skin, never written in a study
    assert {law for law in laws if not isabstract(law)} - fitted == set(LAWS.values())


def test_a_law_that_locks_has_no_state_beyond():
    c = np.array([[9.0, 0.3, 0.37, 0.0, 0.0, 0.0], [1.2, 1.0, 0.9, 0.0, 0.0, 0.0]])
    for law in (Gent(0.3, 2.0), ExtendedTube(0.3, 0.1, 0.3, 0.6)):
        stress, tangent = law.stress_and_tangent(c)
        assert np.isnan(law.energy(c)).tolist() == [True, False]
        assert np.isnan(stress).all(axis=1).tolist() == [True, False]
        assert np.isnan(tangent).any(axis=1).tolist() == [True, False]


def test_a_wild_iterate_overflows_without_a_warning():
    c = np.array([[1e12, 1e-12, 1e-12, 0.0, 0.0, 0.0]])
    for law in (Ogden((0.1,), (40.0,)), ExtendedTube(0.3, 0.1, 0.3, 0.1), ArrudaBoyce(0.3, 3.0)):
        law.energy(c)
        law.stress_and_tangent(c)


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
        (lambda: MooneyRivlin(0.1, -0.1), "MooneyRivlin: c10 + c01 = 0 MPa, allowed: more than 0"),
        (lambda: MooneyRivlin(0.1, float("nan")), "MooneyRivlin: c01 = nan, allowed: a finite stress"),
        (lambda: Gent(0.0, 20.0), "Gent: mu = 0 MPa, allowed: more than 0"),
        (lambda: Gent(0.1, 0.0), "Gent: jm = 0, allowed: more than 0"),
        (lambda: Gent(0.1, "20"), "Gent: jm = '20', allowed: a finite number"),
        (lambda: ArrudaBoyce(-1.0, 3.0), "ArrudaBoyce: c_r = -1 MPa, allowed: more than 0"),
        (lambda: ArrudaBoyce(0.1, 1.0), "ArrudaBoyce: locking_stretch = 1, allowed: more than 1"),
        (lambda: Ogden(0.1, 2.0), "Ogden: mus = 0.1, allowed: a list of one or more numbers"),
        (lambda: Ogden((), ()), "Ogden: mus = (), allowed: a list of one or more numbers"),
        (lambda: Ogden((0.1, 0.2), (2.0,)), "Ogden: 2 mus and 1 alphas, allowed: as many of one as of the other"),
        (
            lambda: Ogden((0.1,) * 5, (2.0,) * 5),
            "Ogden: 5 mus and 5 alphas, allowed: as many of one as of the other, up",
        ),
        (lambda: Ogden((0.1, 0.1), (2.0, 0.0)), "Ogden: alphas[2] = 0, allowed: not 0"),
        (lambda: Ogden((0.1, float("nan")), (2.0, 1.0)), "Ogden: mus[2] = nan, allowed: a finite stress"),
        (lambda: Ogden((0.1,), (-2.0,)), "Ogden: half the sum of mus times alphas = -0.1 MPa, allowed: more than 0"),
        (lambda: Ogden.from_shear_moduli([0.1], [0.0]), "Ogden: alphas[1] = 0, allowed: not 0"),
        (lambda: Ogden.from_shear_moduli([0.1], [1.0, 2.0]), "Ogden: 1 mus and 2 alphas, allowed: as many"),
        (lambda: ExtendedTube(-0.1, 0.2, 0.3, 0.1), "ExtendedTube: gc = -0.1 MPa, allowed: 0 or more"),
        (lambda: ExtendedTube(0.1, -0.2, 0.3, 0.1), "ExtendedTube: ge = -0.2 MPa, allowed: 0 or more"),
        (lambda: ExtendedTube(0.0, 0.0, 0.3, 0.1), "ExtendedTube: gc = ge = 0 MPa, allowed: one of them more than 0"),
        (lambda: ExtendedTube(0.1, 0.2, 0.0, 0.1), "ExtendedTube: beta = 0, allowed: more than 0, up to 1"),
        (lambda: ExtendedTube(0.1, 0.2, 1.1, 0.1), "ExtendedTube: beta = 1.1, allowed: more than 0, up to 1"),
        (
            lambda: ExtendedTube(0.1, 0.2, 0.3, -0.1),
            "ExtendedTube: delta = -0.1, allowed: 0 or more, less than 1/sqrt(2)",
        ),
        (
            lambda: ExtendedTube(0.1, 0.2, 0.3, 0.71),
            "ExtendedTube: delta = 0.71, allowed: 0 or more, less than 1/sqrt(2)",
        ),
        (lambda: LinearElastic(0.0, 0.3), "LinearElastic: young = 0 MPa, allowed: more than 0"),
        (lambda: LinearElastic(3.0, 0.5), "LinearElastic: poisson = 0.5, allowed: 0 or more, less than 0.5"),
        (lambda: LinearElastic(3.0, -0.1), "LinearElastic: poisson = -0.1, allowed: 0 or more, less than 0.5"),
        (lambda: LinearElastic(3.0, 0.3, bulk=5.0), "LinearElastic: bulk is given, allowed: young and poisson, from"),
        (lambda: Ogden((0.1,), (2.0,)).energy(np.ones((2, 3, 3))), "c has shape (2, 3, 3): expected (n, 6)"),
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
