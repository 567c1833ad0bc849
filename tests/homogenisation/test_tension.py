"""Flat tension tests: signs and orders of Pu et al. 2024, and scaling with the modulus."""

from dataclasses import replace

import pytest

from pneumorph.errors import InputError, MeshError, NameNotFoundError
from pneumorph.geometry.lattice import Cell
from pneumorph.homogenisation.tension import Sheet, periodic_test, tension_test
from pneumorph.materials import NeoHookean
from pneumorph.mesh.flat_sheet import mesh_panel

SMALL = Sheet(Cell("re-entrant"), columns=2, rows=2)


@pytest.mark.parametrize("direction", ["along", "around"])
def test_reentrant_sheets_are_softer_and_widen_honeycombs_narrow(direction):
    npr, ppr = (
        periodic_test(Sheet(Cell(kind)), direction, 0.2, steps=2, size=14.9 / 8) for kind in ("re-entrant", "honeycomb")
    )
    assert npr.stiffness < 0.9 * ppr.stiffness
    assert npr.force[-1] < ppr.force[-1]
    assert npr.lateral[-1] > 0.0 > ppr.lateral[-1]
    assert npr.poisson_ratio < -0.1
    assert ppr.poisson_ratio > 0.3


def test_a_sheet_of_a_few_cells_shows_the_same_signs():
    npr = tension_test(SMALL, "along", 0.1, steps=1)
    ppr = tension_test(replace(SMALL, cell=Cell("honeycomb")), "along", 0.1, steps=1)
    assert npr.strain[-1] == pytest.approx(0.1)
    assert npr.force[-1] < ppr.force[-1]
    assert npr.lateral[-1] > 0.0 > ppr.lateral[-1]


@pytest.mark.parametrize("kind", ["re-entrant", "honeycomb"])
def test_more_cells_along_make_it_softer_lengthwise_and_stiffer_across(kind):
    """The sheet keeps its size: 5 or 9 cells on 104.3 mm."""
    few, many = (Sheet(Cell(kind), height=104.3 / rows) for rows in (5, 9))
    for direction, sign in (("along", -1.0), ("around", 1.0)):
        change = (
            periodic_test(many, direction, 0.02, steps=1).stiffness
            - periodic_test(few, direction, 0.02, steps=1).stiffness
        )
        assert sign * change > 0.0


def test_stiffness_goes_with_the_modulus_and_lateral_strain_does_not():
    """alpha = 20 and 80 times the tube's 0.037 MPa, with the same Poisson's ratio."""
    soft, hard = (
        tension_test(SMALL, "along", 0.1, steps=1, material=NeoHookean(0.037 * a, bulk=50 * 0.037 * a))
        for a in (20, 80)
    )
    assert hard.force == pytest.approx(4.0 * soft.force, rel=1e-5)
    assert hard.lateral == pytest.approx(soft.lateral, rel=1e-5)


def test_bad_sheets_and_tests_are_refused():
    with pytest.raises(InputError, match="columns = 3, allowed: an even number of at least 2"):
        Sheet(Cell("brick"), columns=3)
    with pytest.raises(InputError, match="rows = 0, allowed: a whole number of at least 1"):
        Sheet(Cell("brick"), rows=0)
    for test in (tension_test, periodic_test):
        with pytest.raises(NameNotFoundError, match="direction of a tension test"):
            test(SMALL, "across")
        with pytest.raises(InputError, match=r"strain = 0\.0, allowed: more than 0"):
            test(SMALL, "along", 0.0)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"counts": (0, 1)}, "columns = 0: expected a whole number"),
        ({"layers": []}, "expected at least one, of a thickness"),
        ({"size": 0.0}, "size = 0.0: expected a finite number"),
    ],
)
def test_panels_that_cannot_be_meshed_are_refused(changed, message):
    usual = {"counts": (1, 1), "lengths": (8.0, 15.0, 1.5), "layers": [(1.0, "skin", True)], "size": 7.5}
    with pytest.raises(MeshError, match=message):
        mesh_panel(Cell("brick", 0.2), **(usual | changed))
