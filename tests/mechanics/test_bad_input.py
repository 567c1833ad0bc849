"""Every refusal of the solver, with the message that names what is wrong."""

import re

import numpy as np
import pytest

from pneumorph.errors import InputError, LeakingCavityError, MeshError, NameNotFoundError, NotConvergedError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Force,
    Gravity,
    Model,
    Phase,
    Prescribed,
    Programme,
    Roller,
    Settings,
    Symmetry,
    Traction,
    march,
)  # fmt: skip
from pneumorph.mechanics.fields import to_nodes
from pneumorph.mechanics.newton import Increment, IncrementFailedError, Newton, Trial
from pneumorph.mechanics.state import rest
from pneumorph.mesh.mesh import CellBlock, Mesh
from pneumorph.mesh.structured import box, rectangle
from pneumorph.threads import thread_count

RUBBER = {"body": NeoHookean(0.3)}
HELD = (Clamp("left"),)


def plane(**changes):
    """Return a valid model of a square but for the changes."""
    given = {"mesh": rectangle(1, 1), "materials": RUBBER, "supports": HELD} | changes
    return Model(**given)


def ring(mirrors=("bottom", "top"), faces=("left",)):
    def bent(x):
        radius, angle = 5.0 + x[:, 0], 0.5 * np.pi * x[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    supports = (Symmetry("bottom"), Symmetry("top"))
    return plane(mesh=rectangle(1, 2, bent), supports=supports, cavities=(Cavity("c", faces, mirrors=mirrors),))


# --- cavities


def test_a_leaking_cavity_is_refused_with_a_point_on_the_gap():
    with pytest.raises(LeakingCavityError, match=r"cavity 'c' leaks: 1 open edges .* left, one at \(.*5\) mm"):
        ring(mirrors=("bottom",))
    cavity = Cavity("c", ("x0", "x1", "y0", "y1", "z0"))
    with pytest.raises(LeakingCavityError, match=r"'c' leaks: 4 open edges in its faces x0, x1, y0, y1, z0, one at"):
        plane(mesh=box(1, 1, 1), supports=(Clamp("x0"),), cavities=(cavity,))


def test_faces_that_close_around_the_solid_are_no_cavity():
    with pytest.raises(LeakingCavityError, match="volume -1 mm3, expected more than 0"):
        plane(cavities=(Cavity("c", ("left", "right", "bottom", "top")),))


def test_a_face_named_twice_is_refused():
    with pytest.raises(InputError, match="cavity 'c': a face is named twice"):
        Cavity("c", ("left", "left"))


@pytest.mark.parametrize("faces", ["left", ()])
def test_faces_must_be_a_tuple_of_names(faces):
    with pytest.raises(InputError, match=r"cavity 'c': faces = .*, expected a tuple of face names"):
        Cavity("c", faces)


def test_a_curved_mirror_is_refused():
    with pytest.raises(InputError, match="cavity 'c': mirror 'right' is not plane"):
        ring(mirrors=("right",))


def test_mirrors_must_meet():
    with pytest.raises(InputError, match=r"its mirrors .* meet in no common point"):
        plane(cavities=(Cavity("c", ("top",), mirrors=("left", "right", "bottom")),))


# --- names and materials


def test_unknown_names_come_back_with_the_nearest_one():
    with pytest.raises(NameNotFoundError, match="unknown domain 'bdy': did you mean 'body'"):
        plane(materials=RUBBER | {"bdy": NeoHookean(0.1)})
    with pytest.raises(NameNotFoundError, match="unknown face 'lft': did you mean 'left'"):
        plane(supports=(Clamp("lft"),))
    with pytest.raises(NameNotFoundError, match="unknown face 'tpo': did you mean 'top'"):
        plane(loads=(Traction("tpo", (0, 1), "pull"),))
    with pytest.raises(NameNotFoundError, match="unknown face 'hole'"):
        plane(cavities=(Cavity("c", ("hole",)),))
    with pytest.raises(NameNotFoundError, match="phase 'p': unknown target 'pul': did you mean 'pull'"):
        Programme((Phase("p", {"pul": 1.0}),)).check(plane(loads=(Force("top", (0, 1), "pull"),)))


def test_a_domain_without_material_is_refused():
    with pytest.raises(InputError, match="no material for the domain 'body'"):
        plane(materials={})


def test_a_name_given_twice_is_refused():
    with pytest.raises(InputError, match="the name 'pull' is given to 2 loads, cavities, displacements or contacts"):
        plane(loads=(Force("top", (0, 1), "pull"),), supports=(*HELD, Prescribed("right", "x", "pull")))


def test_an_unknown_kind_of_pressure_is_refused():
    with pytest.raises(InputError, match="pressure = 'cubic', allowed: linear, constant"):
        plane(pressure="cubic")


# --- supports


@pytest.mark.parametrize(
    ("mesh", "supports", "free"),
    [
        (rectangle(1, 1), (), "translation|rotation"),
        (rectangle(1, 1), (Roller("left", "x"), Roller("right", "x")), "translation y"),
        (rectangle(1, 1, space="axisymmetric"), (Roller("right", "x"),), "translation y .along the axis."),
        (box(1, 1, 1), (Roller("x0", "x"), Roller("y0", "y")), "translation z"),
        (box(1, 1, 1, mapping=lambda x: x), (Roller("z0", "z"), Roller("z1", "z")), "translation|rotation about z"),
    ],
)
def test_a_free_body_is_refused_and_the_free_motion_named(mesh, supports, free):
    with pytest.raises(InputError, match=f"the supports do not hold the body: it is free in ({free})"):
        Model(mesh, RUBBER, supports)


def test_an_axis_that_the_mesh_does_not_have_is_refused():
    with pytest.raises(InputError, match="roller on 'left': axis = 'z', allowed: x, y"):
        plane(supports=(Roller("left", "z"),))
    with pytest.raises(InputError, match="prescribed 'pull': axis = 'r', allowed: x, y"):
        plane(supports=(*HELD, Prescribed("right", "r", "pull")))


def test_symmetry_on_an_oblique_or_curved_face_is_refused():
    sheared = rectangle(1, 1, lambda x: np.column_stack([x[:, 0] + 0.3 * x[:, 1], x[:, 1]]))
    with pytest.raises(InputError, match="symmetry on 'left': expected a plane face normal to x, y or z"):
        plane(mesh=sheared, supports=(Symmetry("left"),))


# --- loads


def test_gravity_without_density_is_refused():
    with pytest.raises(InputError, match="gravity needs a density for the material of 'body'"):
        plane(loads=(Gravity((0, -1)),))


@pytest.mark.parametrize("direction", [(0.0, 0.0), (1.0, 0.0, 0.0), (np.nan, 1.0)])
def test_a_direction_that_does_not_fit_is_refused(direction):
    with pytest.raises(InputError, match=r"force 'pull': direction = .*, expected 2 numbers, not all zero"):
        plane(loads=(Force("right", direction, "pull"),))


# --- meshes


def test_cells_turned_inside_out_are_refused_with_their_place():
    mesh = rectangle(1, 1)
    with pytest.raises(MeshError, match=r"triangle6 0 of 'body' at \(.*\) mm is turned inside out"):
        plane(mesh=Mesh(mesh.points * [-1.0, 1.0], mesh.blocks, mesh.faces, mesh.space))


def test_nodes_without_a_cell_are_refused():
    mesh = rectangle(1, 1)
    points = np.vstack([mesh.points, [[5.0, 5.0], [6.0, 5.0]]])
    with pytest.raises(MeshError, match="2 nodes belong to no cell"):
        plane(mesh=Mesh(points, mesh.blocks, mesh.faces, mesh.space))
    single = (CellBlock("triangle6", "body", mesh.blocks[0].nodes[:1]),)
    with pytest.raises(MeshError, match="3 nodes belong to no cell"):
        plane(mesh=Mesh(mesh.points, single, mesh.faces, mesh.space))


# --- programmes


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"targets": {}}, "phase 'p': no targets"),
        ({"targets": {"c": float("inf")}}, "phase 'p': target c = inf, expected a finite number"),
        ({"targets": {"c": float("nan")}}, "phase 'p': target c = nan, expected a finite number"),
        ({"marks": (0.5, 1.0)}, r"phase 'p': marks = \(0.5, 1.0\), allowed: between 0 and 1"),
        ({"marks": (0.0,)}, "marks"),
        ({"first": 0.5, "largest": 0.2}, "first = 0.5, largest = 0.2, allowed: 0 < smallest <= first <= largest <= 1"),
        ({"smallest": 0.0}, "increments smallest = 0.0"),
        ({"largest": 1.5}, "largest = 1.5"),
    ],
)
def test_a_phase_out_of_range_is_refused(changes, message):
    with pytest.raises(InputError, match=message):
        Phase(**({"name": "p", "targets": {"c": 1.0}} | changes))


def test_a_programme_needs_phases_with_different_names():
    with pytest.raises(InputError, match="programme: no phases"):
        Programme(())
    with pytest.raises(InputError, match=r"programme: phase names \['p', 'p'\], expected each once"):
        Programme((Phase("p", {"c": 1.0}), Phase("p", {"c": 2.0})))


def test_a_load_that_nothing_drives_is_refused():
    model = plane(loads=(Force("top", (0, 1), "pull"), Force("right", (1, 0), "push")))
    with pytest.raises(InputError, match="'push' is in the model, but no phase drives it"):
        next(march(model, Programme((Phase("p", {"pull": 1.0}),))))


# --- increments that fail


def attempt(model, displacement, **settings):
    trial = Trial(displacement, model.body.zero_pressure(), np.zeros(0))
    return Newton(model, Settings(**settings)).solve(trial, {"pull": 0.1}, Increment(rest(model)))


def test_an_increment_that_fails_says_why():
    model = plane(mesh=rectangle(2, 2), loads=(Force("right", (1, 0), "pull"),))
    rest = np.zeros_like(model.mesh.points)
    with pytest.raises(IncrementFailedError, match="no convergence in 1 iterations"):
        attempt(model, rest, iterations=1)
    with pytest.raises(IncrementFailedError, match="the residual is not finite"):
        attempt(model, np.full_like(rest, np.nan))
    with pytest.raises(IncrementFailedError, match="cells turn inside out whatever the step"):
        attempt(model, -2.0 * model.mesh.points * [1.0, 0.0])


def test_a_residual_that_explodes_ends_the_increment(monkeypatch):
    model = plane(loads=(Force("right", (1, 0), "pull"),))
    errors = iter([1e-3, 1.0, 1e6])
    monkeypatch.setattr(Newton, "_error", lambda *_: next(errors))
    with pytest.raises(IncrementFailedError, match=r"the residual grew to 1e\+06 of the applied forces"):
        attempt(model, np.zeros_like(model.mesh.points))


@pytest.mark.parametrize(("settings", "reason"), [({"viscosity": 0.0}, "no convergence"), ({"relaxations": 1}, "slid")])
def test_a_march_that_cannot_go_on_names_phase_state_and_reason(settings, reason):
    model = plane(loads=(Force("right", (1, 0), "pull"),))
    programme = Programme((Phase("stretch", {"pull": 0.2}, first=0.5, smallest=0.2, largest=0.5),))
    with pytest.raises(NotConvergedError, match=f"stopped in phase 'stretch' at 0.0000 of it, state 0: .*{reason}"):
        list(march(model, programme, Settings(iterations=2, **settings)))


def test_averaging_no_blocks_to_nodes_is_refused():
    with pytest.raises(ValueError, match="parts: expected at least one block"):
        to_nodes(rectangle(1, 1), [], lambda part: part.stress)


# --- threads


@pytest.mark.parametrize("text", ["0", "-2", "two", "", "1.5"])
def test_a_number_of_threads_that_is_none_is_refused(text, monkeypatch):
    monkeypatch.setenv("PNEUMORPH_THREADS", text)
    with pytest.raises(InputError, match=f"PNEUMORPH_THREADS = '{text}': expected a whole number of at least 1"):
        thread_count.__wrapped__()


def test_the_number_of_threads_comes_from_the_environment(monkeypatch):
    monkeypatch.setenv("PNEUMORPH_THREADS", "3")
    assert thread_count.__wrapped__() == 3
    monkeypatch.delenv("PNEUMORPH_THREADS")
    assert thread_count.__wrapped__() >= 1


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"tolerance": float("nan")}, "tolerance = nan, allowed: more than 0, less than 0.01"),
        ({"iterations": 0}, "iterations = 0, allowed: 1 or more"),
        ({"growth": -1.0}, "growth = -1.0, allowed: 1 or more"),
        ({"cut": 1.0}, "cut = 1.0, allowed: more than 0, less than 1"),
    ],
)
def test_settings_that_make_no_sense_are_refused(given, message):
    with pytest.raises(InputError, match=re.escape(f"solver: {message}")):
        Settings(**given)
