"""The inchworm gait of system 1: study, height at which the robot lies, when a prism is wedged, comparison rows."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.geometry import PipeRobot
from pneumorph.materials.library import material as material_named
from pneumorph.mechanics import Contact, Model, Pipe, Symmetry
from pneumorph.mechanics.state import rest
from pneumorph.mesh import generate
from pneumorph.solution import solve
from pneumorph.studies import reproductions, study_from
from pneumorph.studies.reproductions import hexagonal_inchworm as inchworm


def test_the_study_is_known_by_name_and_can_be_written_and_read_again():
    known = reproductions.reproduction("hexagonal-prism-inchworm")
    assert "act11050125" in known.source
    for quick in (True, False):
        study = known.study(quick)
        assert study_from(study.resolved(), study.name).resolved() == study.resolved()


def test_gravity_comes_first_then_one_end_holds_while_the_other_is_moved():
    quick, full = inchworm.study(True), inchworm.study(False)
    names = [phase.name for phase in quick.programme.phases]
    assert names == ["gravity", "hold", "+middle", "+front", "-rear", "-middle", "+rear", "-front"]
    assert (quick.cycle_ends, full.cycle_ends) == ((2, 8), (2, 8))
    driven = {name for phase in quick.programme.phases for name in phase.targets}
    assert driven == {"gravity", "rear_6", "middle", "front_6"}
    assert quick.loads[0].direction == (0.0, -1.0, 0.0)
    steps = [[phase.largest for phase in study.programme.phases[1:]] for study in (quick, full)]
    assert all(a == 2.0 * b for a, b in zip(*steps, strict=True))


def test_only_the_plane_of_symmetry_and_the_pipe_hold_the_robot():
    study = inchworm.study(True)
    assert study.supports == (Symmetry("symmetry_x"),)
    (contact,) = study.contacts
    assert contact.faces == ("rear", "front")
    assert (contact.against.radius, contact.friction) == (57.5, 0.7)


def test_the_robot_lies_a_reach_above_the_bottom_of_the_pipe():
    study = inchworm.study(True)
    mesh, pipe = generate(study.actuator, 20.0), study.contacts[0].against
    for end in ("rear", "front"):
        x = mesh.points[mesh.face_nodes(end)]
        gap, inward, _ = pipe.gap(x)
        assert gap.min() == pytest.approx(inchworm.REACH, abs=1e-3)
        assert inward[gap.argmin(), 1] > 0.9


RING = PipeRobot(modules=1, half=True, chambers=1, length=12.0)
LYING = math.sqrt((57.5 - 0.4) ** 2 - (RING.apothem + 22.0 - 10.0 * math.sqrt(3.0)) ** 2 / 4.0)


@pytest.mark.parametrize(
    ("radius", "height", "pressed"),
    [(RING.reach + 0.4, 0.0, True), (57.5, 1.0, False), (57.5, -1.0, True)],
    ids=["all around", "from below", "from above"],
)
def test_a_prism_is_wedged_where_the_pipe_pushes_it_down(radius, height, pressed):
    lowest = (RING.apothem + RING.block_height) * math.sqrt(0.75) + RING.block_width / 4.0
    axis = height * (LYING - lowest)
    contact = Contact(inchworm.PIPE, ("outer",), Pipe((0, axis, 0), radius, (0, 0, 1)), reach=0.8)
    material = {"body": material_named("shore-a45-platinum")}
    model = Model(generate(RING, 20.0), material, (Symmetry("symmetry_x"),), contacts=(contact,))
    assert inchworm.pressed_from_above(rest(model), "outer") == pressed


def test_the_wedging_pressure_is_that_of_the_first_state_pressed_from_above(monkeypatch):
    monkeypatch.setattr(inchworm, "pressed_from_above", lambda state, end: state.pressure["rear_6"] > 0.08)
    states = [SimpleNamespace(touches={"pipe": 1}, pressure={"rear_6": p}) for p in (0.0, 0.05, 0.09, 0.12)]
    states[0].touches = {}
    assert inchworm.wedging_pressure(SimpleNamespace(states=states)) == 0.09
    assert inchworm.wedging_pressure(SimpleNamespace(states=states[:2])) is None


@pytest.mark.parametrize("done", [True, False])
def test_wedging_ways_slips_and_cost_stand_in_the_rows(monkeypatch, done):
    cycles = int(done)
    found = SimpleNamespace(
        ends=(2, 8),
        displacements=np.array([[0.0, 0.5, 12.0]])[:cycles],
        backward_slip={"rear": np.array([0.5])[:cycles], "front": np.array([0.25])[:cycles]},
        cost_of_transport=np.array([40.0])[:cycles],
    )
    monkeypatch.setattr(inchworm, "motion", lambda solution, study: found)
    monkeypatch.setattr(inchworm, "wedging_pressure", lambda solution: 0.1 if done else None)
    run = SimpleNamespace(history=SimpleNamespace(smallest=lambda prefix: 0.05))
    rows = inchworm.compare(run, inchworm.study(True))
    computed = [pytest.approx(100.0), 12.0, 0.5, 0.25, 40.0, 0.05] if done else [*[None] * 5, 0.05]
    assert [row.computed for row in rows] == computed


@pytest.mark.slow
def test_a_bent_prism_holds_and_the_robot_moves_forward():
    study = inchworm.study(True)
    problem = study.build()
    solution = solve(problem.model, problem.programme, measures=problem.measures, settings=problem.settings)
    rows = {row.quantity: row.computed for row in inchworm.compare(solution, study)}
    assert rows["displacement of the centre of mass"] > 1.0
    assert rows["smallest distance to the pipe"] > 0.0
    normal = solution.history.values(f"normal_force:{inchworm.PIPE}")
    phases = [state.phase for state in solution.states]
    lying, held = (normal[len(phases) - 1 - phases[::-1].index(name)] for name in ("gravity", "hold"))
    assert held > 2.0 * lying
