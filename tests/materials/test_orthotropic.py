"""Orthotropic layers and their ridges: derivatives, convexity, the fit of a known function, and the frame."""

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean
from pneumorph.materials.orthotropic import OrthotropicLayer
from pneumorph.materials.ridges import Ridges, basis, fit

KNOTS = np.array([-0.4, -0.1, 0.0, 0.15, 0.5])
ANGLES = np.radians([0.0, 30.0, 90.0, 135.0])
DIRECTIONS = np.vstack(
    [np.column_stack([np.cos(ANGLES), np.sin(ANGLES), 0.0 * ANGLES]), [[0.5, 0.4, 0.7], [0.5, 0.4, -0.7]]]
)
RANDOM = np.random.default_rng(3)
RIDGES = Ridges(DIRECTIONS, KNOTS, RANDOM.random((6, 5)))
LAYER = {"surface": RIDGES, "thickness": 2.0, "transverse": 0.7}
VOIGT = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]


def tensors(count=20, size=0.25):
    """C of random deformation gradients (n, 6)."""
    f = np.eye(3) + size * (2.0 * RANDOM.random((count, 3, 3)) - 1.0)
    c = np.einsum("nki,nkj->nij", f, f)
    return np.stack([c[:, i, j] for i, j in VOIGT], axis=1)


def test_the_curvatures_of_a_ridge_are_interpolated_between_its_knots_and_stay_beyond():
    x = np.array([-0.9, -0.4, -0.25, 0.0, 0.325, 0.5, 2.0])
    _, second = Ridges(np.array([[1.0]]), KNOTS, np.array([[4.0, 1.0, 2.0, 3.0, 5.0]]))._along(x[:, None])
    assert second[:, 0] == pytest.approx([4.0, 4.0, 2.5, 2.0, 4.0, 5.0, 5.0])


def test_a_ridge_of_constant_curvature_is_a_parabola_and_its_basis_agrees_with_it():
    x = np.linspace(-1.0, 1.0, 41)
    one = Ridges(np.array([[1.0]]), KNOTS, np.full((1, 5), 3.0))
    assert one.value(x[:, None]) == pytest.approx(1.5 * x**2)
    assert one.derivatives(x[:, None])[0][:, 0] == pytest.approx(3.0 * x)
    assert basis(KNOTS, x)[1].sum(axis=-1) == pytest.approx(x)


def test_gradient_and_second_derivatives_of_the_ridges_agree_with_finite_differences():
    e = 0.6 * (2.0 * RANDOM.random((40, 3)) - 1.0)
    first, second = RIDGES.derivatives(e)
    assert np.abs(first).min() > 1e-4
    for axis in range(3):
        step = np.eye(3)[axis] * 1e-6
        assert first[:, axis] == pytest.approx((RIDGES.value(e + step) - RIDGES.value(e - step)) / 2e-6, abs=1e-8)
        change = (RIDGES.derivatives(e + step)[0] - RIDGES.derivatives(e - step)[0]) / 2e-6
        assert second[:, axis] == pytest.approx(change, abs=1e-5)


def test_energy_stress_and_tangent_of_a_layer_agree_with_finite_differences_in_both_frames():
    place = np.column_stack([RANDOM.random(20) + 0.5, RANDOM.random(20) - 0.5, RANDOM.random(20)])
    for frame in ("flat", "cylinder"):
        law = OrthotropicLayer(**LAYER, frame=frame).at(place)
        c = tensors()
        stress, tangent = law.stress_and_tangent(c)
        full = np.zeros((20, 6, 6))
        full[:, *np.triu_indices(6)] = tangent
        full = np.maximum(np.abs(full), np.abs(full.transpose(0, 2, 1))) * np.sign(full + full.transpose(0, 2, 1))
        assert np.abs(stress).max() > 0.05
        for column in range(6):
            step = np.eye(6)[column] * 1e-6
            each = 1.0 if column < 3 else 0.5  # a shear stands twice in dW = S : dC / 2
            slope = (law.energy(c + step) - law.energy(c - step)) / 2e-6
            assert stress[:, column] == pytest.approx(2.0 * each * slope, abs=1e-7)
            change = (law.stress_and_tangent(c + step)[0] - law.stress_and_tangent(c - step)[0]) / 2e-6
            assert full[:, :, column] == pytest.approx(2.0 * each * change, abs=1e-5)


def test_shears_count_as_engineering_strains():
    """2 E13 = C13 and 2 E12 = C12: W = g C13² / 2, and a ridge of curvature c along the shear gives c C12² / 2."""
    law = OrthotropicLayer(surface=Ridges(np.eye(3), KNOTS, np.full((3, 5), 3.0)), thickness=2.0, transverse=0.7)
    across, inside = np.array([[1.0, 1.0, 1.0, 0.0, 0.2, 0.0]]), np.array([[1.0, 1.0, 1.0, 0.0, 0.0, 0.2]])
    assert law.energy(across) == pytest.approx(0.35 * 0.04)
    assert law.energy(inside) == pytest.approx(1.5 * 0.04)


def test_a_layer_on_a_cylinder_answers_as_the_flat_one_in_turned_axes():
    """At (0, -1, 0) around is x, along is z and radial is -y."""
    law = OrthotropicLayer(**LAYER, frame="cylinder").at(np.array([[0.0, -1.0, 0.3]]))
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    c = tensors(1)
    full = np.zeros((3, 3))
    for value, (i, j) in zip(c[0], VOIGT, strict=True):
        full[i, j] = full[j, i] = value
    local = turn @ full @ turn.T
    flat = OrthotropicLayer(**LAYER)
    assert law.energy(c) == pytest.approx(flat.energy(np.array([[local[i, j] for i, j in VOIGT]])), rel=1e-12)


def test_the_fit_finds_the_gradient_of_a_convex_function():
    """Plane stress of an incompressible neo-Hookean sheet: W = mu / 2 (tr C + 1 / det C - 3), convex in E."""
    angles = np.radians(np.arange(0, 180, 15))
    directions = np.column_stack([np.cos(angles), np.sin(angles), 0.0 * angles])
    knots = np.array([-0.3, -0.15, 0.0, 0.15, 0.3, 0.5, 0.8])
    grid = np.linspace(-0.1, 0.4, 8)
    e = np.array([[a, b, 0.0] for a in grid for b in grid])
    a, b = 1.0 + 2.0 * e[:, 0], 1.0 + 2.0 * e[:, 1]
    slopes = np.column_stack([1.0 - 1.0 / (a * a * b), 1.0 - 1.0 / (a * b * b), 0.0 * a])
    found = fit(directions, np.arange(12), knots, e, slopes, np.ones_like(e))
    assert (found.curvature >= 0.0).all()
    assert found.derivatives(e)[0] == pytest.approx(slopes, abs=0.02 * np.abs(slopes).max())
    values = 0.5 * (a + b + 1.0 / (a * b) - 3.0)
    assert found.value(e) == pytest.approx(values, abs=0.02 * values.max())


def test_a_material_without_directions_is_the_same_everywhere():
    law = NeoHookean(1.0)
    assert law.at(np.zeros((4, 3))) is law


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"frame": "cone"}, "frame = 'cone', allowed: flat, cylinder"),
        ({"thickness": 0.0}, "thickness = 0 .*, allowed: more than 0"),
        ({"bulk": 1.0}, "bulk or prony is given"),
        ({"surface": Ridges(DIRECTIONS[:, :2], KNOTS, RIDGES.curvature)}, r"expected \(m, 3\) and \(m, 5\)"),
        ({"surface": Ridges(DIRECTIONS, KNOTS, -RIDGES.curvature)}, "curvatures of 0 or more and a knot at 0"),
    ],
)
def test_a_layer_refuses_what_does_not_make_one(changed, message):
    with pytest.raises(InputError, match=message):
        OrthotropicLayer(**(LAYER | changed))


def test_a_layer_on_a_cylinder_needs_places_off_the_axis():
    law = OrthotropicLayer(**LAYER, frame="cylinder")
    with pytest.raises(InputError, match="on the axis of its cylinder"):
        law.at(np.zeros((1, 3)))
    with pytest.raises(InputError, match="depends on the place"):
        law.energy(tensors(1))
    with pytest.raises(InputError, match="principal stretches alone"):
        law.stretch_derivatives([1.0, 1.0, 1.0])
