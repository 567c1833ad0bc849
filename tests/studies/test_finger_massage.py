"""The massage: the study's numbers in it, and the comparison on a small finger and arm."""

import copy

import numpy as np
import pytest

from pneumorph.geometry import Finger, Forearm
from pneumorph.materials import LinearElastic
from pneumorph.measures import contact_pressure
from pneumorph.solution import Status
from pneumorph.studies import run_study, study_from
from pneumorph.studies.reproductions import finger_massage, reproduction

MASSAGE = reproduction("finger-massage")


def small(top):
    """Return the same study of a short finger and a small arm, up to a pressure in kPa."""
    table = copy.deepcopy(MASSAGE.study(True).resolved())
    table["actuator"] |= {"length": "20 mm", "chambers": 1}
    table["part"]["arm"]["actuator"] |= {"length": "40 mm", "pressed": "20 mm"}
    table["part"]["arm"]["actuator"] |= {
        f"{e}_{s}": "20 mm" for e in ("wrist", "elbow") for s in ("width", "thickness")
    }
    turn = [{"axis": "z", "angle": "90 deg"}]
    table["part"]["arm"] |= {"turn": turn, "shift": ["14 mm", "-20 mm", "-10.4 mm"], "mesh": {"size": "8 mm"}}
    table["phase"][-1] |= {"targets": {"cavity": f"{top} kPa"}, "states_at": {}}
    return study_from(table, "small")


@pytest.fixture(scope="module")
def done():
    study = small(90)
    return run_study(study), study


@pytest.mark.parametrize("quick", [True, False])
def test_the_study_has_the_given_numbers(quick):
    study = MASSAGE.study(quick)
    arm = study.assembly.parts["arm"]
    assert study.actuator == Finger()
    assert isinstance(arm, Forearm)
    assert arm.pressed == 30.0
    found = study.materials["arm.body"]
    assert isinstance(found, LinearElastic)
    assert (found.young, found.poisson) == (270.0, 0.47)
    assert study.programme.phases[-1].targets == {"cavity": 0.09}
    assert [support.face for support in study.supports] == ["clamp", "arm.wrist", "arm.elbow"]
    assert {contact.friction for contact in study.contacts} == {0.0}


def test_the_finger_lies_level_over_the_pressed_place_without_touching_it():
    mesh = MASSAGE.study(True).mesh()
    skin, wrist, elbow = (mesh.points[mesh.face_nodes(f"arm.{name}")] for name in ("skin", "wrist", "elbow"))
    top = skin[skin[:, 2] > skin[:, 2].max() - 1e-3]
    assert skin[:, 2].max() == pytest.approx(-1.0, abs=1e-5)  # mm below the finger
    assert np.ptp(top[:, 1]) > 240.0  # the whole line on its top is level
    axis = elbow.mean(axis=0) - wrist.mean(axis=0)
    under = top[np.abs(top[:, 1]).argmin()]
    assert under[1] == pytest.approx(0.0, abs=1e-3)
    assert (under - wrist.mean(axis=0)) @ axis / np.linalg.norm(axis) == pytest.approx(30.0, abs=1e-3)


def test_the_comparison_says_what_the_states_say(done):
    solution, study = done
    assert solution.status is Status.DONE
    rows = {row.quantity: row for row in MASSAGE.compare(solution, study)}
    history, state = solution.history, solution.states[-1]
    peak, mean = (1e3 * history.values(f"{k}contact_pressure:massage")[-1] for k in ("", "mean_"))
    assert rows["largest contact pressure"].computed == pytest.approx(peak)
    assert rows["largest contact pressure"].reported == 90.0
    on_arm = contact_pressure(state)[state.model.mesh.face_nodes("arm.skin")].max()
    assert rows["the same, of the nodes of the arm"].computed == pytest.approx(1e3 * on_arm)
    assert rows["mean contact pressure"].computed == pytest.approx(mean)
    assert 0.0 < mean < peak
    assert rows["safety factor, threshold over largest pressure"].computed == pytest.approx(180.0 / peak)
    assert rows["safety factor, threshold over largest pressure"].reported == 2.0
    force = np.linalg.norm(state.touches["massage"].force)
    assert rows["contact force"].computed == pytest.approx(force)
    # the finger's push goes through the arm to its ends, beside the arm's weight
    reactions = state.reactions.reshape(-1, 3)
    ends = sum(reactions[state.model.mesh.face_nodes(f"arm.{end}")].sum(axis=0) for end in ("wrist", "elbow"))
    weight = 9810.0 * 1.1e-9 * study.assembly.parts["arm"].volume
    np.testing.assert_allclose(ends - [0.0, 0.0, weight], state.touches["massage"].force, atol=2e-3 * force)
    # the arm's sag under its own weight is not the finger's doing
    skin, hung = state.model.mesh.face_nodes("arm.skin"), list(history.values("phase")).count("gravity")
    sag = solution.states[hung].displacement[skin]
    assert solution.states[hung].phase == "gravity"
    assert np.abs(sag).max() > 0.0
    moved = rows["largest displacement of the arm"]
    assert moved.unit == "µm"
    by_finger = 1e3 * np.linalg.norm(state.displacement[skin] - sag, axis=1).max()
    assert moved.computed == pytest.approx(by_finger, rel=1e-12)


def test_the_profiles_hold_force_and_pressure_beside_the_threshold(done):
    force, pressure = MASSAGE.profiles(*done)
    assert (force.name, pressure.name) == ("contact-force", "contact-pressure")
    assert force.series[0].x[-1] == pytest.approx(90.0)
    assert force.series[0].y[-1] > force.series[0].y[0]
    assert [line.label for line in pressure.series][2:] == [
        "threshold of discomfort",
        "threshold over the safety factor 2",
    ]
    assert (pressure.series[2].y == 180.0).all()


def test_a_run_that_stopped_before_has_rows_without_a_number():
    solution = run_study(small(5))
    rows = MASSAGE.compare(solution, small(5))
    assert len(rows) == 8
    assert all(row.computed is None for row in rows)
    assert finger_massage.profiles(solution, small(5))[0].series[0].x[-1] == pytest.approx(5.0)
