"""Periodic cells: patch test against closed forms, derivatives, symmetry, and agreement with a large sheet."""

import numpy as np
import pytest

from pneumorph.errors import InputError, MeshError, NotConvergedError
from pneumorph.geometry.lattice import Cell
from pneumorph.homogenisation.periodic import PeriodicCell
from pneumorph.homogenisation.tension import Sheet, periodic_test, tension_test
from pneumorph.materials import NeoHookean
from pneumorph.mesh.flat_sheet import mesh_unit_cell
from pneumorph.mesh.structured import box

STUDY = (8.116, 14.9, 1.57)
SOFT = NeoHookean(1.85, bulk=92.5)
PLAIN = box(2, 2, 1, "hexahedron27", lengths=(2.0, 3.0, 0.5), distortion=0.2)


def plain(material=None):
    return PeriodicCell(PLAIN, (2.0, 3.0), {"body": NeoHookean(1.0, bulk=1e4) if material is None else material})


def lattice(kind="re-entrant"):
    mesh = mesh_unit_cell(Cell(kind, 0.2), STUDY, [(1.0, "skin", True)], 7.45)
    return PeriodicCell(mesh, STUDY[:2], {"skin": SOFT}, mirrored=True)


def given(f):
    return {"xx": f[0, 0] - 1.0, "xy": f[0, 1], "yx": f[1, 0], "yy": f[1, 1] - 1.0}


def test_a_plain_sheet_answers_as_plane_stress_of_an_incompressible_material():
    """P = mu (F - F^-T / J2^2) of the in-plane F with J2 = det F, whatever the mesh inside; thickness 0.5 mm."""
    f = np.array([[1.3, 0.2], [0.1, 0.9]])
    (state,) = plain().path([given(f)])
    exact = 0.5 * (f - np.linalg.inv(f).T / np.linalg.det(f) ** 2)
    assert state.force == pytest.approx(exact, rel=1e-3, abs=1e-3)
    c = f.T @ f
    assert state.energy == pytest.approx(0.25 * (np.trace(c) + 1.0 / np.linalg.det(c) - 3.0), rel=1e-3)


def test_free_entries_take_no_stress():
    """Uniaxial tension of an incompressible sheet: P = mu (s - 1 / s^2) and the width shrinks by 1 / sqrt(s)."""
    (state,) = plain().path([{"yy": 0.4, "xy": 0.0, "yx": 0.0}])
    assert state.force[1, 1] == pytest.approx(0.5 * (1.4 - 1.4**-2), rel=1e-3)
    assert state.gradient[0, 0] == pytest.approx(1.4**-0.5, rel=1e-3)
    assert abs(state.force[0, 0]) < 1e-6


def one_cell():
    """A cell of the mesh that meets its own images."""
    return PeriodicCell(box(1, 1, 1, "hexahedron27"), (1.0, 1.0), {"body": SOFT})


@pytest.mark.parametrize("make", [lattice, one_cell])
def test_force_and_tangent_are_derivatives_of_the_energy(make):
    cell = make()
    f = np.array([[1.05, 0.02], [0.01, 1.1]])
    (middle,) = cell.path([given(f)])
    assert np.abs(middle.force).min() > 1e-3
    step = 1e-4
    for i in range(4):
        change = np.eye(4)[i].reshape(2, 2) * step
        up, down = (cell.stretched(middle, given(f + sign * change)) for sign in (1.0, -1.0))
        assert (up.energy - down.energy) / (2 * step) == pytest.approx(middle.force.ravel()[i], rel=1e-4, abs=1e-6)
        found = (up.force - down.force).ravel() / (2 * step)
        assert found == pytest.approx(middle.tangent[i], rel=1e-4, abs=1e-4)


def test_a_rotation_turns_the_force_and_keeps_the_energy():
    cell = lattice("honeycomb")
    f, angle = np.array([[1.05, 0.0], [0.0, 1.1]]), 0.3
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    straight, turned = cell.path([given(f)])[0], cell.path([given(turn @ f)])[0]
    assert turned.energy == pytest.approx(straight.energy, rel=1e-6)
    assert turned.force == pytest.approx(turn @ straight.force, abs=1e-6)


def compared(kind, direction, small, large, rows):
    """Stiffness and Poisson's ratio of the columns (rows) that a larger sheet has more, and of the cell.

    The cut edges of a sheet are softer or stiffer than its inside; both sheets have the same ones.
    """
    other = {"columns": rows} if direction == "around" else {"rows": rows}
    name = "rows" if direction == "around" else "columns"
    tests = [tension_test(Sheet(Cell(kind), **other, **{name: n}), direction, 0.02, steps=1) for n in (small, large)]
    inner = (large * tests[1].stiffness - small * tests[0].stiffness) / (large - small)
    cell = periodic_test(Sheet(Cell(kind)), direction, 0.02, steps=1)
    return inner, tests[1].poisson_ratio, cell.stiffness, cell.poisson_ratio


def test_a_cell_agrees_with_the_inside_of_a_sheet():
    stiffness, poisson, cell_stiffness, cell_poisson = compared("honeycomb", "along", 4, 6, 4)
    assert stiffness == pytest.approx(cell_stiffness, rel=0.05)
    assert poisson == pytest.approx(cell_poisson, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["re-entrant", "honeycomb"])
@pytest.mark.parametrize("direction", ["along", "around"])
def test_a_cell_agrees_with_a_large_sheet(kind, direction):
    stiffness, poisson, cell_stiffness, cell_poisson = compared(kind, direction, 4, 8, 8)
    assert stiffness == pytest.approx(cell_stiffness, rel=0.05)
    assert poisson == pytest.approx(cell_poisson, rel=0.05)


def test_what_does_not_make_a_periodic_cell_is_refused():
    with pytest.raises(InputError, match="no material for the domain 'body'"):
        PeriodicCell(PLAIN, (2.0, 3.0), {})
    with pytest.raises(InputError, match=r"lengths = .*, allowed: two finite numbers"):
        PeriodicCell(PLAIN, (0.0, 3.0), {"body": SOFT})
    with pytest.raises(MeshError, match="no nodes are images of each other along y"):
        PeriodicCell(PLAIN, (2.0, 3.7), {"body": SOFT})


def test_what_a_periodic_cell_cannot_be_given_is_refused():
    cell = plain()
    with pytest.raises(InputError, match="'zz' is given, allowed: xx, xy, yx, yy"):
        cell.stretched(cell.rest(), {"zz": 0.1, "xy": 0.0})
    with pytest.raises(InputError, match="free to rotate"):
        cell.stretched(cell.rest(), {"yy": 0.1})


def test_a_cell_that_would_turn_inside_out_is_no_state():
    with pytest.raises(NotConvergedError, match="no equilibrium at H xx = "):
        plain().path([{"xx": -1.5, "yy": 0.0, "xy": 0.0, "yx": 0.0}])
