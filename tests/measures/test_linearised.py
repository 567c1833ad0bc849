"""Linearised stress against polynomials, and of a body under one uniform stress."""

from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean
from pneumorph.measures import MeanStress, linearise, linearised_stress
from pneumorph.mechanics import Model, Phase, Prescribed, Programme, Roller, march
from pneumorph.mesh import box

XX = np.diag([1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def pulled():
    """A block of 1 mm stretched to 1.5 times its length, free across."""
    supports = Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z"), Prescribed("x1", "x", "pull")
    model = Model(box(1, 1, 1), {"body": NeoHookean(0.1, bulk=1e4)}, supports)
    *_, state = march(model, Programme((Phase("pull", {"pull": 0.5}, first=0.5, largest=0.5),)))
    return state


@pytest.mark.parametrize("points", [3, 5, 11])
def test_a_cubic_has_the_mean_and_the_moment_of_the_rule(points):
    x = np.linspace(0.0, 1.0, points)
    found = linearise(((2.0 + 3.0 * x - 4.0 * x**2 + 5.0 * x**3)[:, None, None] * XX)[None])
    membrane = 2.0 + 3.0 / 2.0 - 4.0 / 3.0 + 5.0 / 4.0
    assert found.membrane[0] == pytest.approx(membrane * XX, abs=1e-12)
    # the rule integrates s (x - 1/2), of one degree more, exactly only if it is composite and fine
    bending = 6.0 * (3.0 / 12.0 - 4.0 / 12.0 + 5.0 * (1.0 / 5.0 - 1.0 / 8.0))
    assert found.bending[0, 0, 0] == pytest.approx(bending, rel=0.6 / (points - 1) ** 2)


def test_a_linear_stress_is_kept_and_its_larger_end_counts():
    x = np.linspace(0.0, 1.0, 5)
    found = linearise((np.array([[1.0], [-1.0]]) * (4.0 * x - 1.0))[:, :, None, None] * XX)
    assert found.membrane[:, 0, 0] == pytest.approx([1.0, -1.0])
    assert found.bending[:, 0, 0] == pytest.approx([2.0, -2.0])
    assert found.equivalent == pytest.approx([3.0, 3.0])


def test_a_uniform_stress_is_all_membrane(pulled):
    found = linearised_stress(pulled, [[0.2, 0.5, 0.0], [0.7, 0.5, 0.1]], [[0.2, 0.5, 1.0], [0.7, 0.5, 0.8]])
    stress = 1.5 * NeoHookean(0.1).uniaxial_tension(1.5)
    assert found.equivalent == pytest.approx([stress, stress], rel=1e-4)
    assert found.bending == pytest.approx(np.zeros((2, 3, 3)), abs=1e-9)


def test_the_equivalent_strain_of_a_pull_is_the_logarithm_of_its_stretch(pulled):
    assert MeanStress("equivalent_strain")(pulled) == pytest.approx(np.log(1.5), rel=1e-4)


@pytest.mark.parametrize("points", [1, 4])
def test_lines_need_an_odd_number_of_points(points):
    with pytest.raises(InputError, match=f"{points} points on a line, allowed: odd numbers from 3"):
        linearise(np.zeros((1, points, 3, 3)))


def test_ends_of_lines_come_in_pairs():
    state = SimpleNamespace(model=SimpleNamespace(mesh=SimpleNamespace(dimension=3)))
    for first, second in (([[0, 0, 0]], [[0, 0, 1], [1, 0, 1]]), ([[0, 0]], [[0, 1]])):
        with pytest.raises(InputError, match=r"ends of shape .* expected \(lines, dimension\)"):
            linearised_stress(state, first, second)
