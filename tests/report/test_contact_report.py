"""What a report shows of contact: settings, checks, forces, and the rigid bodies in its pictures."""

import numpy as np
import pytest

from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Block,
    Clamp,
    Contact,
    FreeBody,
    Gravity,
    HalfSpace,
    Model,
    Motion,
    Phase,
    Pipe,
    Programme,
)
from pneumorph.mechanics.contact.outlines import outline
from pneumorph.mesh import box, inspect
from pneumorph.report import write_report
from pneumorph.report.asked import asked_tables
from pneumorph.report.bodies import RigidBodies
from pneumorph.report.curves import default_curves
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import displacement
from pneumorph.report.findings import checks_table, results_table
from pneumorph.report.view import face_on
from pneumorph.solution import solve
from pneumorph.studies.comparison import Profile, Series

LOW, HIGH = np.array([-1.0, -2.0, -3.0]), np.array([1.0, 2.0, 3.0])


@pytest.fixture(scope="module")
def pressed():
    """A block 1 x 1 x 1 mm on its clamped side, pressed down by a stamp that is larger than it."""
    stamp = Block((-1.0, -1.0, 1.02), (2.0, 2.0, 9.0), motion=Motion("stamp", (0.0, 0.0, -1.0)))
    contact = Contact("top on stamp", ("z1", "x1"), stamp, reach=0.01, body="stamp")
    model = Model(box(1, 1, 1), {"body": NeoHookean(0.3)}, (Clamp("z0"),), contacts=(contact,))
    return solve(model, Programme((Phase("press", {"stamp": 0.1}, first=0.5, largest=0.5),)))


def test_a_plane_is_a_patch_of_itself_under_the_box():
    plane = HalfSpace((5.0, 0.0, -2.0), (0.0, 0.6, 0.8), motion=Motion("lift", (0.0, 0.0, 2.0)))
    points, facets = outline(plane, LOW, HIGH, way=1.0)
    assert (points - [5.0, 0.0, -1.0]) @ [0.0, 0.6, 0.8] == pytest.approx(np.zeros(4))
    assert points[:, 0].min() == pytest.approx(-1.0)
    assert points[:, 0].max() == pytest.approx(1.0)
    assert facets.shape == (2, 3)
    line, edges = outline(HalfSpace((0.0, -1.0), (0.0, 1.0)), LOW[:2], HIGH[:2])
    assert line[:, 1] == pytest.approx([-1.0, -1.0])
    assert sorted(line[:, 0]) == pytest.approx([-1.0, 1.0])
    assert edges.tolist() == [[0, 1]]


def test_a_pipe_is_a_tube_as_long_as_the_box():
    points, facets = outline(Pipe((0.0, 1.0, 0.0), 4.0, (0.0, 0.0, 1.0)), LOW, HIGH)
    assert np.hypot(points[:, 0], points[:, 1] - 1.0) == pytest.approx(np.full(len(points), 4.0))
    assert np.unique(points[:, 2]) == pytest.approx([-3.0, 3.0])
    assert facets.max() == len(points) - 1
    circle, _ = outline(Pipe((0.0, 1.0), 4.0), LOW[:2], HIGH[:2])
    assert np.hypot(circle[:, 0], circle[:, 1] - 1.0) == pytest.approx(np.full(len(circle), 4.0))


def test_a_body_is_drawn_where_the_programme_has_moved_it(pressed):
    bodies = RigidBodies(list(pressed.states))
    points = pressed.model.mesh.points
    (before,), (after,) = bodies.layers({}, points), bodies.layers({"stamp": 0.1}, points)
    assert before.points[:, 2].min() == pytest.approx(1.02)
    assert after.points - before.points == pytest.approx(np.array([[0.0, 0.0, -0.1]]).repeat(8, axis=0))
    assert 0.0 < after.opacity < 1.0


def test_pictures_show_what_a_body_touches_but_not_all_of_a_large_one(pressed):
    states = list(pressed.states)
    alone, with_stamp = face_on(states), Drawing(states).view
    assert alone.height < with_stamp.height < 1.5 * alone.height


def test_contacts_are_asked_checked_and_drawn_as_one_figure_each(pressed):
    table = next(table for table in asked_tables(pressed) if table.title == "Contact")
    assert table.rows[0][:3] == ("top on stamp", "z1, x1", "Block 'stamp', driven as 'stamp'")
    checks = {row[0]: row for row in checks_table(pressed, inspect(pressed.model.mesh)).rows}
    assert checks["Smallest distance in contact"][1].endswith(" mm")
    assert checks["Smallest distance in contact"][3].text == "pass"
    curves = {curve.title: curve.y for curve in default_curves(pressed)}
    assert curves["Force in contact top on stamp"] == tuple(f"contact_force_{a}:top on stamp" for a in "xyz")
    assert "body_force_z:stamp" in curves["Force on body stamp"]
    heads = results_table(pressed, [0], "").head
    assert not any("on z1" in head for head in heads)


@pytest.fixture(scope="module")
def dropped():
    """A brick of 2 g that falls through nothing beside a clamped block."""
    brick = FreeBody("brick", Block((2.0, 0.0, 0.0), (3.0, 1.0, 2.0)), mass=2e-6)
    floor = Contact("floor", ("brick",), HalfSpace((0.0, 0.0, -9e3), (0.0, 0.0, 1.0)))
    mesh, loads = box(1, 1, 1), (Gravity((0.0, 0.0, -1.0)),)
    material = NeoHookean(0.3, density=1e-9)
    model = Model(mesh, {"body": material}, (Clamp("z0"),), loads, free_bodies=(brick,), contacts=(floor,))
    phase = Phase("fall", {"gravity": 9810.0}, first=0.5, largest=0.5, duration=0.01, inertia="quasi-static")
    return solve(model, Programme((phase,)))


def test_a_free_body_is_drawn_where_it_has_come_to(dropped):
    states = list(dropped.states)
    drawn = RigidBodies(states).layers(states[-1].values, states[-1].positions)
    body = next(layer for layer in drawn if layer.points[:, 2].min() > -100.0)
    fallen = states[-1].body_motion("brick").centre[2] - 1.0
    assert fallen < -0.1
    assert [body.points[:, 2].min(), body.points[:, 2].max()] == pytest.approx([fallen, fallen + 2.0])
    assert Drawing(states).view.height > face_on(states[:1]).height
    assert displacement(states[-1]).max() < 0.1  # the colours are those of the soft body
    rim = next(layer for layer in drawn if layer.segments is not None)  # of the floor, which is seen along itself
    assert rim.points[:, 2] == pytest.approx(np.full(4, -9e3))


def test_free_bodies_are_asked_checked_and_have_a_figure_for_each_vector(dropped):
    table = next(table for table in asked_tables(dropped) if table.title == "Free bodies")
    name, surface, mass, centre = table.rows[0]
    assert (name, surface, mass.text, centre) == ("brick", "Block", "2 g", "(2.5, 0.5, 1) mm")
    checks = {row[0]: row for row in checks_table(dropped, inspect(dropped.model.mesh)).rows}
    assert checks["Strain of the rigid body brick"][3].text == "pass"
    curves = {curve.title: curve.y for curve in default_curves(dropped)}
    assert curves["Centre of brick"] == ("body_x:brick", "body_y:brick", "body_z:brick")
    assert curves["Velocity of brick"] == tuple(f"body_velocity_{a}:brick" for a in "xyz")
    assert "Force on body brick" not in curves  # nothing touches it


def test_a_profile_is_drawn_and_its_numbers_are_kept(pressed, tmp_path, monkeypatch):
    from pneumorph.errors import EngineError
    from pneumorph.report import render

    def none():
        raise EngineError("no pictures")

    monkeypatch.setattr(render, "check", none)
    line = Series("computed", np.array([0.0, 1.0]), np.array([2.0, 3.0]))
    profile = Profile("along", "Stress along the length", "place [mm]", "stress [MPa]", (line,))
    page = write_report(pressed, tmp_path, profiles=(profile,))
    assert "Stress along the length." in page.read_text()
    assert (tmp_path / "figures" / "along.svg").exists()
    assert (tmp_path / "figures" / "along.csv").read_text().splitlines() == [
        "curve,place [mm],stress [MPa]", "computed,0,2", "computed,1,3",
    ]  # fmt: skip
