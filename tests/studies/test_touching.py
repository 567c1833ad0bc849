"""Rigid bodies and contact in study files."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from pneumorph.closed_form.thick_wall import tube_pressure
from pneumorph.errors import InputError, NameNotFoundError, StudyError, UnitError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Block,
    Clamp,
    Contact,
    Cylinder,
    FreeBody,
    HalfSpace,
    Model,
    Motion,
    Phase,
    Pipe,
    Programme,
    SurfaceFile,
)
from pneumorph.mechanics.contact.barrier import barrier
from pneumorph.mechanics.contact.part import Place
from pneumorph.mesh import box
from pneumorph.solution import Status, solve
from pneumorph.studies import load_study, run_study, study_from

EXAMPLES = Path(__file__).parents[2] / "examples"
STL = Path(__file__).parents[1] / "data" / "finger_closed.stl"
FINGER = '[actuator]\ntemplate = "finger"\nlength = "24 mm"\nchambers = 2\n[mesh]\nsize = "coarse"\n'
PHASE = '[[phase]]\ntargets = { cavity = "10 kPa" }\n'
TOUCH = '[[contact]]\nfaces = ["outer"]\nbody = "thing"\n'
BODIES = {
    "half-space": ('point = ["0 mm", "0 mm", "-1 mm"]\nnormal = "z"', HalfSpace((0, 0, -1), (0, 0, 1))),
    "pipe": ('point = ["0 mm", "0 mm", "9 mm"]\nradius = "2 cm"', Pipe((0, 0, 9), 20, (1, 0, 0))),
    "block": (
        'lower = ["0 mm", "0 mm", "-9 mm"]\nupper = ["1 mm", "1 mm", "-1 mm"]',
        Block((0, 0, -9), (1, 1, -1)),
    ),
    "cylinder": (
        'start = ["0 mm", "0 mm", "-9 mm"]\nend = ["1 mm", "0 mm", "-9 mm"]\nradius = "2 mm"\nsegments = 12',
        Cylinder((0, 0, -9), (1, 0, -9), 2, 12),
    ),
    "surface": (f'file = "{STL}"\nshift = ["0 mm", "0 mm", "-90 mm"]', SurfaceFile(str(STL), (0, 0, -90))),
}


def study(text, folder=None):
    return study_from(tomllib.loads(text), "test", folder)


def body(shape, more=""):
    return f'[body.thing]\nshape = "{shape}"\n{BODIES[shape][0]}\n{more}\n'


@pytest.mark.parametrize("shape", BODIES)
def test_every_shape_of_a_rigid_body_is_read_and_written(shape):
    made = study(FINGER + body(shape) + TOUCH + PHASE)
    assert made.contacts == (Contact("contact_1", ("outer",), BODIES[shape][1], body="thing"),)
    assert study(made.resolved_text()).contacts == made.contacts


def test_settings_of_a_contact_are_read_into_inside_units():
    more = 'name = "grip"\nfriction = 0.7\nreach = "20 um"\nstiffness = "50 kPa"\ncreep = "1 cm/s"\n'
    (made,) = study(FINGER + body("block") + TOUCH + more + PHASE).contacts
    assert (made.name, made.friction, made.reach, made.stiffness, made.creep) == ("grip", 0.7, 0.02, 0.05, 10.0)


def test_faces_touch_themselves_or_others_where_no_body_is_named():
    made = study(
        FINGER + '[[contact]]\nfaces = ["cavity"]\n[[contact]]\nfaces = ["tip"]\nagainst = ["outer"]\n' + PHASE
    )
    assert [contact.against for contact in made.contacts] == [None, ("outer",)]
    assert [contact.other for contact in made.contacts] == ["itself", "outer"]


def test_a_body_with_a_direction_is_moved_by_the_phases():
    made = study(FINGER + body("block", 'direction = "-z"') + TOUCH + '[[phase]]\ntargets = { thing = "-5 mm" }\n')
    assert made.contacts[0].motion == Motion("thing", (0, 0, -1))
    assert made.kinds["thing"] == "length"
    assert made.programme.phases[0].targets == {"thing": -5.0}


@pytest.mark.parametrize(
    ("text", "error", "says"),
    [
        (TOUCH, NameNotFoundError, r"contact\[1\]: unknown body 'thing'"),
        (body("block") + TOUCH.replace("outer", "outter"), NameNotFoundError, r"contact\[1\]: .*'outter'.*'outer'"),
        (body("block") + TOUCH + 'against = ["tip"]\n', StudyError, r"contact\[1\]: both body and against"),
        (body("block"), StudyError, "body.thing: no contact names it"),
        (body("block") + TOUCH + "friction = -0.1\n", InputError, "'contact_1': friction = -0.1, allowed: 0 to 5"),
        (body("block") + TOUCH + "friction = 5.1\n", InputError, "friction = 5.1, allowed: 0 to 5"),
        (body("block") + TOUCH + 'reach = "0 mm"\n', InputError, "reach = 0.0 mm, allowed: more than 0"),
        (body("block") + TOUCH + 'reach = "1 kPa"\n', UnitError, r"contact\[1\]: reach = '1 kPa'"),
        (body("block") + 2 * TOUCH.replace("body", 'name = "one"\nbody'), InputError, "'one': the name is taken"),
        (body("block") + TOUCH + 'name = "cavity"\n', InputError, "'cavity': the name is taken"),
        (body("block").replace("block", "ball"), StudyError, r"body.thing: unknown shape 'ball'"),
        (body("block").replace('"-1 mm"]', '"-10 mm"]') + TOUCH, InputError, "body.thing: block: .*lower < upper"),
        (body("block").replace('"1 mm", ', "", 1) + TOUCH, InputError, "body.thing: block: lower = .*"),
        (body("half-space").replace('"z"', "[0, 0, 0]") + TOUCH, InputError, "body.thing: half-space: normal"),
        (body("cylinder").replace("end = ", "# ") + TOUCH, StudyError, "body.thing: end: missing"),
        (body("pipe").replace("2 cm", "0 cm") + TOUCH, InputError, "body.thing: pipe: radius = 0"),
        (body("surface").replace(".stl", ".sl") + TOUCH, InputError, "body.thing: surface file .* cannot be read"),
        (body("block").replace("thing", "cavity") + TOUCH.replace("thing", "cavity"), None, ""),
        (body("block", 'direction = "z"').replace("thing", "cavity") + TOUCH.replace("thing", "cavity"), InputError,
         "the name 'cavity' is given to more than one cavity, load, displacement or body"),
        (body("block", 'direction = "z"') + TOUCH, StudyError, "'thing' is in the study, but no phase drives it"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused_with_its_place(text, error, says):
    if error is None:  # a body that stands still may have any name
        assert study(FINGER + text + PHASE).contacts[0].body == "cavity"
        return
    with pytest.raises(error, match=says):
        study(FINGER + text + PHASE)


def test_a_surface_without_area_is_refused(tmp_path):
    flat = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n"
    (tmp_path / "arm.stl").write_text(f"solid arm\n{flat}endsolid arm\n")
    with pytest.raises(InputError, match=r"body.thing: surface file '.*arm.stl': all its triangles are without area"):
        study(FINGER + '[body.thing]\nshape = "surface"\nfile = "arm.stl"\n' + TOUCH + PHASE, tmp_path)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            body("block").replace('"-1 mm"]', '"0.5 mm"]'),
            r"outer and Block 'thing' intersect at .*; the smallest shift",
        ),
        (body("half-space").replace("-1 mm", "1 mm"), r"outer and HalfSpace 'thing' intersect at .*apart by 1\.\d+ mm"),
        (body("pipe").replace("2 cm", "9 mm"), r"outer and Pipe 'thing' intersect at"),
    ],
)
def test_bodies_that_intersect_at_the_start_are_refused_with_pair_place_and_shift(text, says):
    with pytest.raises(InputError, match=r"contact 'contact_1': " + says):
        study(FINGER + text + TOUCH + PHASE).build()


def test_a_wall_that_is_driven_into_what_cannot_give_way_stops_with_its_states_and_names_the_pair():
    plate = HalfSpace((0, 0, 1.01), (0, 0, -1), motion=Motion("press", (0, 0, -1)))
    contact = Contact("lid", ("z1",), plate, reach=0.01, body="plate")
    model = Model(box(1, 1, 1), {"body": NeoHookean(0.3)}, (Clamp("x0"),), contacts=(contact,))
    solution = solve(
        model, Programme((Phase("press", {"press": 0.1}, first=0.05, smallest=0.02),)), raise_on_stop=False
    )
    assert solution.status is Status.STOPPED
    assert len(solution.states) > 1
    assert solution.history.values("body_force_z:plate")[-1] > 0.0
    assert "'lid' between z1 and HalfSpace 'plate'" in solution.message


def test_the_force_on_a_body_is_that_of_all_contacts_with_it_and_balances_the_clamp():
    solution = run_study(load_study(EXAMPLES / "blocked-finger.toml"))
    history = solution.history
    for a in "xyz":
        parts = [history.values(f"contact_force_{a}:tip on block:{face}") for face in ("outer", "tip")]
        np.testing.assert_allclose(np.sum(parts, axis=0), history.values(f"contact_force_{a}:tip on block"), atol=1e-12)
        np.testing.assert_array_equal(
            history.values(f"body_force_{a}:block"), -history.values(f"contact_force_{a}:tip on block")
        )
    force = np.linalg.norm([history.values(f"body_force_{a}:block") for a in "xyz"], axis=0)
    np.testing.assert_allclose(force[1:], history.values("reaction_force")[1:], rtol=1e-6)
    assert np.all(np.diff(history.values("body_force_z:block")) < 0.0)  # down, rising with pressure
    assert history.smallest("contact_distance:") > 0.0


def test_in_a_pipe_the_wall_bears_what_the_tube_does_not():
    """Incompressible and with fixed ends, the wall of the tube keeps its shape once it fills the pipe."""
    solution = run_study(load_study(EXAMPLES / "tube-in-pipe.toml"))
    state, pair = solution.states[-1], solution.model.contact.pairs[0]
    pressures, weights, gaps = [], [], []
    for group in pair.points:
        gap = pair._gaps(group, Place(state.positions))[0]
        height = np.einsum("mk,mk->m", group.share, solution.model.mesh.points[group.nodes][:, :, 2])
        middle = np.abs(height - 12.0) < 4.0  # away from the caps
        pressures.append(-barrier(gap, pair.reach, pair.stiffness)[1][middle] * group.weight[middle])
        weights.append(group.weight[middle])
        gaps.append(gap[middle])
    radius = 9.0 - float(np.concatenate(gaps).mean())
    inner = np.sqrt(radius**2 - (8.0**2 - 6.0**2))
    wanted = 0.06 - float(tube_pressure(NeoHookean(0.1), 6.0, 8.0, inner))
    # the barrier's pressure is on the undeformed area, which grows as the radius
    found = np.concatenate(pressures).sum() / np.concatenate(weights).sum() * 8.0 / radius
    assert found == pytest.approx(wanted, rel=0.04)
    assert solution.history.values("contact_pressure:wall")[-1] == pytest.approx(wanted, rel=0.3)


FREE = (
    '[gravity]\n[body.thing]\nshape = "block"\nlower = ["40 mm", "0 mm", "-9 mm"]\nupper = ["50 mm", "1 mm", "-1 mm"]\n'
    'mass = "30 g"\n'
)
TABLE = '[body.table]\nshape = "half-space"\npoint = ["0 mm", "0 mm", "-9.01 mm"]\nnormal = "z"\n'
STAND = '[[contact]]\nname = "stand"\nfaces = ["thing"]\nbody = "table"\n'
MOVING = PHASE + 'duration = "1 s"\ninertia = "quasi-static"\n'


def test_a_mass_makes_a_body_free_and_contacts_name_it_as_a_body_or_as_a_face():
    made = study(FINGER + FREE + TABLE + TOUCH + STAND + MOVING)
    block = Block((40, 0, -9), (50, 1, -1))
    assert made.free_bodies == (FreeBody("thing", block, mass=3e-5),)
    grip, stand = made.contacts
    assert (grip.faces, grip.against, grip.body) == (("outer",), ("thing",), "")
    assert (stand.faces, stand.body) == (("thing",), "table")
    again = study(made.resolved_text())
    assert (again.free_bodies, again.contacts) == (made.free_bodies, made.contacts)
    first = made.programme.phases[0]  # gravity comes in a phase of its own, with inertia
    assert (first.name, first.inertia, first.duration) == ("gravity", "quasi-static", 1.0)
    dense = study(FINGER + FREE.replace('mass = "30 g"', 'density = "2 g/cm^3"') + TOUCH + MOVING)
    assert dense.free_bodies == (FreeBody("thing", block, density=2e-9),)


def test_loads_and_supports_take_the_name_of_a_free_body():
    held = '[[support]]\ntype = "clamp"\nface = "clamp"\n'
    held += '[[support]]\ntype = "prescribed"\nface = "thing"\naxis = "z"\nname = "up"\n'
    load = '[[load]]\ntype = "force"\nface = "thing"\ndirection = "-z"\nname = "pull"\n'
    driven = MOVING.replace('cavity = "10 kPa"', 'pull = "1 N", up = "1 mm"')
    problem = study(FINGER + FREE + held + load + TOUCH + driven).build()
    nodes = problem.model.mesh.frames["thing"]
    assert set(3 * nodes + 2) <= set(problem.model.held)
    assert problem.model.load_patterns["pull"].reshape(-1, 3)[nodes].sum(axis=0) == pytest.approx([0, 0, -1])
    assert problem.model.load_patterns["gravity"].reshape(-1, 3)[nodes].sum(axis=0) == pytest.approx([0, 0, -3e-5])


@pytest.mark.parametrize(
    ("text", "error", "says"),
    [
        (FREE.replace("30 g", "0 g") + TOUCH + MOVING, InputError, "mass = 0.0 tonne, allowed: more than 0"),
        (FREE.replace("30 g", "30 mm") + TOUCH + MOVING, UnitError, "mass = '30 mm'"),
        (FREE + 'direction = "z"\n' + TOUCH + MOVING, StudyError, "body.thing: both direction and mass are given"),
        (FREE + 'density = "1 g/cm^3"\n' + TOUCH + MOVING, InputError, "body.thing: .*expected one of the two"),
        (FREE + MOVING, StudyError, "body.thing: no contact names it"),
        (FREE + TOUCH.replace("[[contact]]", '[[contact]]\nname = "thing"') + MOVING, InputError, "the name is taken"),
        (FREE.replace("thing", "tip") + TOUCH.replace("thing", "tip") + MOVING, InputError, "the name is taken"),
        (FREE.replace("[gravity]\n", "") + TOUCH + MOVING, StudyError, r"a mass needs \[gravity\]; .*0 m/s²"),
        (FREE + TOUCH + PHASE, StudyError, "phase 'phase_1': nothing holds the free body 'thing' without inertia"),
        (TABLE + 'mass = "1 g"\n' + TOUCH.replace("thing", "table") + MOVING, StudyError, "unknown key 'mass'"),
        (FREE + TOUCH + STAND.replace("thing", "think") + TABLE + MOVING, NameNotFoundError, "did you mean 'thing'"),
    ],
)  # fmt: skip
def test_free_bodies_that_are_wrong_are_refused_before_anything_is_meshed(text, error, says):
    with pytest.raises(error, match=says):
        study(FINGER + text)


def test_a_free_body_with_an_open_surface_is_refused(tmp_path):
    corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    facet = f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n"
    (tmp_path / "cup.stl").write_text(f"solid cup\n{facet}endsolid cup\n")
    body_text = '[gravity]\n[body.thing]\nshape = "surface"\nfile = "cup.stl"\nmass = "1 g"\n'
    with pytest.raises(InputError, match=r"body\.thing: free body 'thing': its surface is not closed"):
        study(FINGER + body_text + TOUCH + MOVING, tmp_path)


def test_a_free_body_in_the_way_is_refused_with_the_shift():
    with pytest.raises(InputError, match=r"'contact_1': outer and thing intersect at .*; the smallest shift"):
        study(FINGER + FREE.replace('"40 mm"', '"10 mm"').replace('"-1 mm"', '"1 mm"') + TOUCH + MOVING).build()
