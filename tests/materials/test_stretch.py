"""Laws in the principal stretches where stretches are equal, nearly equal or far apart."""

import numpy as np
import pytest

from pneumorph.materials import ExtendedTube, MooneyRivlin, NeoHookean, Ogden, principal

PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
GAPS = [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 3e-6, 5e-6, 1e-5, 1e-4, 1e-3]
# the same material by both kernels: W = 0.2 (Ī1 - 3) + 0.05 (Ī2 - 3)
BY_STRETCHES, BY_INVARIANTS = Ogden((0.4, -0.1), (2.0, -2.0)), MooneyRivlin(0.2, 0.05)
CURVED = Ogden((0.2, 0.1, -0.05, 0.002), (1.5, 4.0, -3.0, 8.0))


def rotation(seed):
    return np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))[0]


def tensors(stretches, seed=4):
    """Tensors C (n, 6) with the principal stretches (n, 3), all turned alike."""
    turned = rotation(seed)
    full = np.einsum("ia,na,ja->nij", turned, np.asarray(stretches) ** 2, turned)
    return np.stack([full[:, i, j] for i, j in PAIRS], axis=-1)


def close_pairs(gap):
    """Two stretches that differ by `gap`, below and above the third, then all three."""
    return tensors([[1.4, 1.4 + gap, 0.6], [0.7, 2.0, 0.7 - gap], [1.2, 1.2 + gap, 1.2 - gap], [1.0, 1.0 + gap, 1.0]])


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("seed", [4, 5])
def test_near_equal_stretches_give_what_the_invariants_give(gap, seed):
    c = close_pairs(gap)
    for one, other in zip(BY_STRETCHES.stress_and_tangent(c), BY_INVARIANTS.stress_and_tangent(c), strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=2e-10)
    np.testing.assert_allclose(BY_STRETCHES.energy(c), BY_INVARIANTS.energy(c), rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("gap", GAPS)
def test_tangent_is_the_slope_of_the_stress_at_near_equal_stretches(gap):
    c, step = close_pairs(gap), 1e-4
    _, tangent = CURVED.stress_and_tangent(c)
    full = np.empty((len(c), 6, 6))
    rows, columns = np.triu_indices(6)
    full[:, rows, columns] = full[:, columns, rows] = tangent
    assert np.abs(full).max(axis=(1, 2)).min() > 0.1
    for pair in range(6):
        change = step * np.eye(6)[pair]
        # central differences of fourth order: 2 d/dC, a shear step changes two entries of C at once
        s = {k: CURVED.stress_and_tangent(c + k * change)[0] for k in (-2, -1, 1, 2)}
        numeric = (8.0 * (s[1] - s[-1]) - (s[2] - s[-2])) / (12.0 * step) * (2.0 if pair < 3 else 1.0)
        np.testing.assert_allclose(full[:, :, pair], numeric, rtol=0.0, atol=1e-9)


def test_tangent_has_no_jump_where_the_slope_takes_over_from_the_difference():
    gaps = np.geomspace(1e-7, 1e-3, 2001)
    c = tensors(np.stack([1.3 + gaps, np.full_like(gaps, 1.3), np.full_like(gaps, 0.6)], axis=-1))
    _, tangent = CURVED.stress_and_tangent(c)
    at_once, _ = np.polynomial.polynomial.polyfit(gaps, tangent, 3, full=True)
    smooth = np.polynomial.polynomial.polyval(gaps, at_once).T
    np.testing.assert_allclose(tangent, smooth, rtol=0.0, atol=1e-9)


def test_far_apart_stretches_keep_their_accuracy():
    c = tensors([[8.0, 0.5, 0.25], [4.0, 4.0, 0.0625]])
    for one, other in zip(BY_STRETCHES.stress_and_tangent(c), BY_INVARIANTS.stress_and_tangent(c), strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-10 * np.abs(other).max())


@pytest.mark.parametrize("spread", [0.0, 1e-14, 1e-10, 1e-5, 0.1, 1.0])
def test_axes_are_orthonormal_and_rebuild_the_tensor(spread):
    random = np.random.default_rng(1)
    gradients = np.eye(3) + spread * random.standard_normal((200, 3, 3))
    full = np.einsum("nki,nkj->nij", gradients, gradients)
    c = np.stack([full[:, i, j] for i, j in PAIRS], axis=-1)
    logs, squares, axes = np.empty((3, 200)), np.empty((3, 200)), np.empty((200, 3, 3))
    principal.spectrum(c, logs, squares, axes)
    np.testing.assert_allclose(
        np.einsum("nia,nib->nab", axes, axes), np.broadcast_to(np.eye(3), (200, 3, 3)), atol=1e-14
    )
    rebuilt = np.einsum("nia,an,nja->nij", axes, squares, axes)
    np.testing.assert_allclose(rebuilt, full, atol=1e-14 * max(1.0, full.max()))
    np.testing.assert_allclose(logs.sum(axis=0), 0.0, atol=1e-14)


def test_shuffled_axes_shuffle_the_stress():
    c = np.zeros((3, 6))
    for row, order in enumerate(([0, 1, 2], [1, 2, 0], [2, 0, 1])):
        c[row, :3] = np.array([2.0, 0.9, 0.5])[order]
    stress = CURVED.stress_and_tangent(c)[0]
    np.testing.assert_allclose(stress[1, :3], stress[0, [1, 2, 0]], rtol=1e-13)
    np.testing.assert_allclose(stress[2, :3], stress[0, [2, 0, 1]], rtol=1e-13)
    np.testing.assert_array_equal(stress[:, 3:], 0.0)


def test_tubes_without_entanglements_or_limit_are_neo_hookean():
    c = tensors([[1.5, 0.9, 0.7], [1.0, 1.0, 1.0]])
    tube = ExtendedTube(gc=0.3, ge=0.0, beta=0.5, delta=0.0)
    for one, other in zip(tube.stress_and_tangent(c), NeoHookean(0.3).stress_and_tangent(c), strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-13)


def test_tubes_alone_are_one_ogden_term():
    c = tensors([[1.5, 0.9, 0.7], [1.0, 1.0, 1.0]])
    tube, ogden = ExtendedTube(gc=0.0, ge=0.2, beta=0.4, delta=0.0), Ogden((-1.0,), (-0.4,))
    for one, other in zip(tube.stress_and_tangent(c), ogden.stress_and_tangent(c), strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(tube.energy(c), ogden.energy(c), rtol=1e-12, atol=1e-15)


def test_moduli_that_add_up_to_the_shear_modulus_are_converted():
    law = Ogden.from_shear_moduli([0.3, 0.1], [1.3, -2.0], density=1e-9)
    assert law.shear_modulus == pytest.approx(0.4)
    assert law.density == 1e-9
    stretch, moduli, alphas = 1.7, np.array([0.3, 0.1]), np.array([1.3, -2.0])
    # nominal uniaxial stress of W = sum of 2 mu/alpha² (...)
    expected = (2.0 * moduli / alphas * (stretch ** (alphas - 1.0) - stretch ** (-alphas / 2.0 - 1.0))).sum()
    assert law.uniaxial_tension(stretch) == pytest.approx(expected)
    assert Ogden([0.4], np.array([2.0])) == Ogden((0.4,), (2.0,))
