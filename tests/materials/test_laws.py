"""Every stored energy: derivatives, invariances and closed forms. A new law joins by one line in LAWS."""

from dataclasses import dataclass

import numpy as np
import pytest

from pneumorph.materials import (
    ArrudaBoyce,
    ExtendedTube,
    Gent,
    InvariantEnergy,
    InvariantMaterial,
    LinearElastic,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    StretchEnergy,
    StretchMaterial,
    Yeoh,
)

PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
ROWS, COLUMNS = np.triu_indices(6)


@dataclass(frozen=True)
class BothInvariants(InvariantMaterial):
    """Exercises every term of the kernel: all five derivatives differ and none is zero."""

    def _check_law(self):
        pass

    def derivatives(self, i1, i2):
        x, y = i1 - 3.0, i2 - 3.0
        return InvariantEnergy(
            w=0.3 * x + 0.2 * y + 0.1 * x * x + 0.15 * x * y + 0.07 * y * y,
            w1=0.3 + 0.2 * x + 0.15 * y,
            w2=0.2 + 0.15 * x + 0.14 * y,
            w11=0.2,
            w12=0.15,
            w22=0.14,
        )


@dataclass(frozen=True)
class CoupledStretches(StretchMaterial):
    """Exercises every term of the kernel: the second derivatives between two stretches are not zero."""

    def _check_law(self):
        pass

    def derivatives(self, logs):
        total = (logs**2).sum(axis=0)
        second = np.empty((6, *logs.shape[1:]))
        second[:3] = 1.0 + 0.4 * total + 0.8 * logs**2
        for row, (a, b) in enumerate(((1, 2), (0, 2), (0, 1)), start=3):
            second[row] = 0.8 * logs[a] * logs[b]
        return StretchEnergy(0.5 * total + 0.1 * total**2, logs * (1.0 + 0.4 * total), second)


LAWS = [
    NeoHookean(0.037),
    MooneyRivlin(0.16, 0.04),
    MooneyRivlin(0.11, 0.05, 0.003, 0.002, -0.001),
    Yeoh(0.11, 0.03),
    Yeoh(0.11, -0.002, 0.004),
    Gent(0.3, 30.0),
    ArrudaBoyce(0.25, 2.5),
    Ogden((0.4,), (2.7,)),
    Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)),
    Ogden((0.2, 0.1, -0.05, 0.002), (1.5, 4.0, -3.0, 8.0)),
    ExtendedTube(gc=0.2, ge=0.15, beta=0.2, delta=0.1),
    # the closed forms below are incompressible
    LinearElastic(3.0, 0.5 - 1e-14),
    BothInvariants(),
    CoupledStretches(),
]
pytestmark = pytest.mark.parametrize("law", LAWS, ids=repr)


def voigt(tensors):
    return np.stack([tensors[:, i, j] for i, j in PAIRS], axis=-1)


def tensor(components):
    full = np.empty((len(components), 3, 3))
    for n, (i, j) in enumerate(PAIRS):
        full[:, i, j] = full[:, j, i] = components[:, n]
    return full


def table(upper):
    """The symmetric 6 x 6 table of the 21 stored numbers."""
    full = np.empty((len(upper), 6, 6))
    full[:, ROWS, COLUMNS] = full[:, COLUMNS, ROWS] = upper
    return full


def fourth_order(upper):
    """CC_IJKL (n, 3, 3, 3, 3) of the 21 stored numbers, with all its symmetries."""
    pair = np.empty((3, 3), dtype=int)
    for n, (i, j) in enumerate(PAIRS):
        pair[i, j] = pair[j, i] = n
    flat = pair.ravel()
    return table(upper)[:, flat[:, np.newaxis], flat[np.newaxis, :]].reshape(-1, 3, 3, 3, 3)


def random_tensors(count=40, spread=0.25, seed=7):
    """Right Cauchy-Green tensors of random gradients, det F > 0.3, far from C = I and not unimodular."""
    random = np.random.default_rng(seed)
    gradients = np.eye(3) + spread * random.standard_normal((10 * count, 3, 3))
    gradients = gradients[np.linalg.det(gradients) > 0.3][:count]
    return np.einsum("nki,nkj->nij", gradients, gradients)


def points():
    """C = I, C a little off it and at random."""
    near = np.eye(3) + 1e-3 * (random_tensors(5) - np.eye(3))
    return voigt(np.concatenate([np.eye(3)[np.newaxis], near, random_tensors()]))


def slope(function, c, pair, step=1e-5):
    """2 d/dC over one Voigt pair, central differences; a shear step changes two entries of C at once."""
    change = np.zeros(6)
    change[pair] = step
    factor = 2.0 if pair < 3 else 1.0
    return factor * (function(c + change) - function(c - change)) / (2.0 * step)


def test_stress_is_the_derivative_of_the_energy(law):
    c = points()
    stress, _ = law.stress_and_tangent(c)
    assert (np.abs(stress[1:]).max(axis=1) > 1e-4 * law.shear_modulus).all()
    for pair in range(6):
        np.testing.assert_allclose(stress[:, pair], slope(law.energy, c, pair), rtol=2e-6, atol=1e-8)


def test_tangent_is_the_derivative_of_the_stress(law):
    c = points()
    _, tangent = law.stress_and_tangent(c)
    full = table(tangent)
    assert (np.abs(full).max(axis=(1, 2)) > 0.1 * law.shear_modulus).all()
    for pair in range(6):
        numeric = slope(lambda c: law.stress_and_tangent(c)[0], c, pair)
        np.testing.assert_allclose(full[:, :, pair], numeric, rtol=2e-6, atol=2e-7)


def test_numeric_tangent_is_symmetric_so_that_a_triangle_is_enough(law):
    c = voigt(random_tensors(10))
    numeric = np.stack([slope(lambda c: law.stress_and_tangent(c)[0], c, pair) for pair in range(6)], axis=-1)
    np.testing.assert_allclose(numeric, np.swapaxes(numeric, 1, 2), rtol=1e-5, atol=1e-7)


def variables(law):
    """Invariants (2, m), or logarithms of stretches (3, m), over a wide range."""
    if isinstance(law, InvariantMaterial):
        return np.stack(np.meshgrid(np.linspace(3.0, 9.0, 7), np.linspace(3.0, 12.0, 7))).reshape(2, -1)
    return np.random.default_rng(2).uniform(-0.6, 0.6, (3, 40))


def gradient_and_table(law, at):
    """First derivatives (k, m) and second ones (k, k, m) of a law in its own variables."""
    if isinstance(law, InvariantMaterial):
        d = law.derivatives(*at)
        w1, w2, w11, w12, w22 = np.broadcast_arrays(*d[1:], at[0])[:5]
        return np.stack([w1, w2]), np.stack([w11, w12, w12, w22]).reshape(2, 2, -1)
    _, first, second = law.derivatives(at)
    return first, second[[[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def energy_slope(law, at, change, step):
    """Slope (m,) of the energy along a change of the variables by `step`."""
    pair = (
        law.derivatives(*x) if isinstance(law, InvariantMaterial) else law.derivatives(x)
        for x in (at + change, at - change)
    )
    up, down = pair
    return (np.asarray(up.w) - down.w) / (2.0 * step)


def test_law_derivatives_agree_with_finite_differences_in_its_variables(law):
    at, step = variables(law), 1e-5
    first, second = gradient_and_table(law, at)
    assert np.abs(first[0]).min() > 0.0
    for number in range(len(at)):
        change = np.zeros_like(at)
        change[number] = step
        slope = energy_slope(law, at, change, step)
        if isinstance(law, StretchMaterial):  # which may leave out a pressure, the same in all three
            slope += gradient_and_table(law, 0.0 * at)[0][number] - energy_slope(law, 0.0 * at, change, step)
        np.testing.assert_allclose(first[number], slope, rtol=1e-7, atol=1e-9)
        up, down = gradient_and_table(law, at + change)[0], gradient_and_table(law, at - change)[0]
        np.testing.assert_allclose(second[number], (up - down) / (2.0 * step), rtol=1e-7, atol=1e-9)


def test_reference_has_no_energy_and_no_stress(law):
    identity = voigt(np.eye(3)[np.newaxis])
    assert law.energy(identity) == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(law.stress_and_tangent(identity)[0], 0.0, atol=1e-15)


def test_tangent_in_the_reference_is_that_of_linear_elasticity(law):
    _, tangent = law.stress_and_tangent(voigt(np.eye(3)[np.newaxis]))
    delta = np.eye(3)
    shears = np.einsum("ik,jl->ijkl", delta, delta) + np.einsum("il,jk->ijkl", delta, delta)
    deviatoric = shears - 2.0 / 3.0 * np.einsum("ij,kl->ijkl", delta, delta)
    np.testing.assert_allclose(fourth_order(tangent)[0], law.shear_modulus * deviatoric, atol=1e-14)


def test_a_pure_change_of_volume_stores_nothing(law):
    c = voigt(np.array([0.5, 1.0, 1.7])[:, np.newaxis, np.newaxis] * np.eye(3))
    np.testing.assert_allclose(law.energy(c), 0.0, atol=1e-14)
    np.testing.assert_allclose(law.stress_and_tangent(c)[0], 0.0, atol=1e-14)


def test_energy_does_not_feel_a_change_of_volume(law):
    c = points()
    np.testing.assert_allclose(law.energy(1.3 * c), law.energy(c), rtol=1e-12, atol=1e-14)


def test_stress_is_deviatoric(law):
    c = voigt(random_tensors())
    stress, _ = law.stress_and_tangent(c)
    power = np.einsum("nij,nij->n", tensor(stress), tensor(c))
    np.testing.assert_allclose(power, 0.0, atol=1e-13 * np.abs(stress).max())


def test_rotating_c_rotates_the_stress_and_keeps_the_energy(law):
    tensors = random_tensors()
    random = np.random.default_rng(3)
    rotation, _ = np.linalg.qr(random.standard_normal((3, 3)))
    turned = voigt(np.einsum("ia,nab,jb->nij", rotation, tensors, rotation))
    np.testing.assert_allclose(law.energy(turned), law.energy(voigt(tensors)), rtol=1e-12)

    stress, tangent = law.stress_and_tangent(voigt(tensors))
    turned_stress, turned_tangent = law.stress_and_tangent(turned)
    expected = np.einsum("ia,nab,jb->nij", rotation, tensor(stress), rotation)
    np.testing.assert_allclose(tensor(turned_stress), expected, rtol=1e-10, atol=1e-12)
    expected = np.einsum(
        "ia,jb,kc,ld,nabcd->nijkl", rotation, rotation, rotation, rotation, fourth_order(tangent), optimize=True
    )
    np.testing.assert_allclose(fourth_order(turned_tangent), expected, rtol=1e-9, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("mode", "stretches"),
    [
        ("uniaxial_tension", lambda s: (s, s**-0.5, s**-0.5)),
        ("equibiaxial_tension", lambda s: (s, s, s**-2)),
        ("planar_tension", lambda s: (s, 1.0, 1.0 / s)),
    ],
)
def test_tension_modes_agree_with_the_stress_from_c(law, mode, stretches):
    stretch = np.array([0.6, 0.9, 1.1, 1.5, 2.5])
    principal = np.stack(np.broadcast_arrays(*stretches(stretch)), axis=-1)
    c = np.zeros((len(stretch), 6))
    c[:, :3] = principal**2
    stress = law.stress_and_tangent(c)[0][:, :3]
    # Cauchy stress of a volume-preserving stretch is s_a = l_a² S_a up to the pressure that frees the third face
    cauchy = principal**2 * stress
    np.testing.assert_allclose(getattr(law, mode)(stretch), (cauchy[:, 0] - cauchy[:, 2]) / stretch, rtol=1e-12)


def test_uniaxial_tension_starts_with_three_times_the_shear_modulus(law):
    assert law.uniaxial_tension(1.0) == pytest.approx(0.0, abs=1e-15)
    assert law.uniaxial_tension(1.0 + 1e-6) == pytest.approx(3.0 * law.shear_modulus * 1e-6, rel=1e-5)


def test_out_arrays_are_filled_and_returned(law):
    c = points()
    out = np.full((len(c), 6), np.nan), np.full((len(c), 21), np.nan)
    stress, tangent = law.stress_and_tangent(c, out=out)
    assert stress is out[0]
    assert tangent is out[1]
    np.testing.assert_array_equal(stress, law.stress_and_tangent(c)[0])
    np.testing.assert_array_equal(tangent, law.stress_and_tangent(c)[1])


def test_an_impossible_deformation_gives_nan_in_its_own_row_only(law):
    c = voigt(np.stack([np.diag([1.0, 1.0, -1.0]), np.diag([1.0, 0.0, 1.0]), np.diag([1.2, 1.0, 1.0])]))
    stress, tangent = law.stress_and_tangent(c)
    assert np.isnan(law.energy(c)[:2]).all()
    assert np.isnan(stress[:2]).all()
    assert np.isfinite(stress[2]).all()
    assert np.isfinite(tangent[2]).all()
