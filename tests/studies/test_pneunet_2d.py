"""The reproduction of system 2 in plane strain: what is asked, compared and drawn."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.closed_form.pneunet import pneunet_curvature
from pneumorph.errors import InputError, NotConvergedError
from pneumorph.gaits import Locomotion
from pneumorph.geometry import PlaneCrawler
from pneumorph.materials import library
from pneumorph.measures import CentreOfMass
from pneumorph.measures.centre_of_mass import nodal_mass
from pneumorph.mechanics import Programme, march
from pneumorph.studies import reproductions, study_from
from pneumorph.studies.reproductions import pneunet_2d
from pneumorph.studies.reproductions.pneunet_segment import segment_curvatures

MATERIALS = {"body": library.material("ecoflex-pneunet"), "base": library.material("pdms-pneunet")}


def test_the_study_is_the_published_undulation():
    study = pneunet_2d.study(quick=True)
    names = [phase.name for phase in study.programme.phases]
    assert names == list(pneunet_2d.STEPS.values())
    ground = study.contacts[0]
    assert ground.friction == 0.7
    assert study.programme.values(4.0) == pytest.approx(
        {"gravity": 9810.0} | dict.fromkeys(("PN1", "PN2", "PN3"), 0.013)
    )
    assert study.materials["body"].shear_modulus == 0.03
    assert study.materials["base"].shear_modulus == 1.84
    assert study.actuator == PlaneCrawler()
    assert pneunet_2d.study(quick=False).cycle_ends == (1, 7, 13)
    assert reproductions.reproduction("pneunet-2d").study is pneunet_2d.study


def motion(states):
    """Return a made-up run: end k of the phases is state k."""
    time = np.arange(states, dtype=float)
    force = {"rear_foot": np.zeros((states, 2)), "front_foot": np.zeros((states, 2))}
    force["rear_foot"][:, 1] = np.array([0.0, 4.0, 3.0, 4.0, 4.0, 6.0, 5.0, 4.0])[:states] * 1e-3
    force["front_foot"][:, 1] = np.array([0.0, 4.0, 5.0, 4.0, 4.0, 3.0, 3.0, 4.0])[:states] * 1e-3
    slip = {name: np.zeros((states, 2)) for name in force}
    slip["front_foot"][min(4, states - 1)] = (-0.7, 0.0)
    centre = np.column_stack([np.arange(states) * 1.5, np.array([5, 5, 7, 9, 10, 9, 7, 5.0])[:states]])
    return Locomotion(time, centre, force, slip, np.zeros(states), 8e-3, (1, 7), np.array([1.0, 0.0]))


def rows_of(monkeypatch, found):
    monkeypatch.setattr(pneunet_2d, "motion", lambda solution, study: found)
    monkeypatch.setattr(pneunet_2d, "segment_curvatures", lambda *_: [0.001] * len(pneunet_2d.CLOSED_FORM))
    solution = SimpleNamespace(history=SimpleNamespace(smallest=lambda prefix: 0.01))
    return {(row.quantity, row.condition): row for row in pneunet_2d.compare(solution, pneunet_2d.study(quick=True))}


def test_forces_and_motion_stand_in_the_rows(monkeypatch):
    rows = rows_of(monkeypatch, motion(8))
    rear = rows["contact force of the rear end", "after step ii, +PN1"]
    assert (rear.reported, rear.computed, rear.unit) == (2.5, pytest.approx(3.0), "mN")
    assert rows["contact force of the front end", "after step ii, +PN1"].reported == 7.5
    assert rows["force of the rear over the front end", "after step v, -PN1"].computed == pytest.approx(2.0)
    assert rows["ground force over weight at rest", "after step i, gravity"].computed == pytest.approx(1.0)
    assert rows["displacement of the centre of mass", "cycle 1"].computed == pytest.approx(9.0)
    assert rows["way of the front end", "in step iv, +PN3"].computed == pytest.approx(-0.7)
    height = "height of the centre of mass over that at rest"
    assert rows[height, "after step iv, +PN3"].computed == pytest.approx(2.0)
    assert rows[height, "after step vii, -PN3"].computed == pytest.approx(1.0)
    assert rows["smallest distance of surfaces", "all states"].computed == 0.01
    bending = rows["curvature of one segment without weight", "13 kPa"]
    assert bending.reported == pytest.approx(pneunet_curvature(0.03, 3.0, 5.0, 0.013))


def test_a_full_run_goes_through_its_first_cycle_again_in_increments_twice_as_large(monkeypatch):
    asked = []

    def march(model, programme, settings, start):
        asked.append((programme, start))
        yield SimpleNamespace(x=20.0)
        yield SimpleNamespace(x=24.0)

    study = pneunet_2d.study(quick=False)
    monkeypatch.setattr(pneunet_2d, "march", march)
    monkeypatch.setattr(pneunet_2d, "CentreOfMass", lambda axis: lambda state: state.x)
    states = [SimpleNamespace(x=15.0, model=None)] * 8
    (row,) = pneunet_2d._step_size(SimpleNamespace(states=states), study, motion(8))
    assert row.computed == pytest.approx((24.0 - 15.0) / (6 * 1.5))
    ((programme, start),) = asked
    assert start == [states[1]]
    assert [phase.name for phase in programme.phases] == list(pneunet_2d.STEPS.values())
    for wide, phase in zip(programme.phases, study.programme.phases, strict=False):
        assert (wide.largest, wide.targets) == (2.0 * phase.largest, phase.targets)
    assert pneunet_2d._step_size(SimpleNamespace(states=states), study, motion(3)) == []
    assert pneunet_2d._step_size(SimpleNamespace(states=states), pneunet_2d.study(quick=True), motion(8)) == []

    def stops(model, programme, settings, start):
        raise NotConvergedError("no state")
        yield

    monkeypatch.setattr(pneunet_2d, "march", stops)
    (row,) = pneunet_2d._step_size(SimpleNamespace(states=states), study, motion(8))
    assert row.computed is None


@pytest.mark.slow
def test_the_way_of_a_cycle_depends_little_on_the_increments_and_nothing_intersects():
    """The quick run, and the same in increments half as large."""
    study = pneunet_2d.study(quick=True)
    problem, centre, ways = study.build(), CentreOfMass("x"), []
    for factor in (1.0, 0.5):
        phases = tuple(
            replace(phase, first=factor * phase.first, largest=factor * phase.largest)
            for phase in problem.programme.phases
        )
        states = list(march(problem.model, Programme(phases), problem.settings))
        rest = next(state for state in states if state.time == 1.0)
        ways.append(centre(states[-1]) - centre(rest))
        assert all(min(touch.distance for touch in state.touches.values()) > 0.0 for state in states[1:])
        for state in (rest, states[-1]):
            weight = 9810.0 * nodal_mass(problem.model).sum()
            assert state.touches["ground"].force[1] == pytest.approx(weight, rel=0.02)
    assert ways[0] > 1.0
    assert ways[1] == pytest.approx(ways[0], rel=0.05)


def test_what_the_run_did_not_reach_has_no_computed_number(monkeypatch):
    rows = rows_of(monkeypatch, motion(3))
    assert rows["force of the rear over the front end", "after step v, -PN1"].computed is None
    assert rows["displacement of the centre of mass", "cycle 1"].computed is None
    assert rows["contact force of the rear end", "after step ii, +PN1"].computed is not None


def test_the_reported_forces_are_drawn_at_the_ends_of_their_steps():
    rear, front = pneunet_2d.curves(pneunet_2d.study(quick=True))
    assert rear.x_values == pytest.approx([10.0, 20.0])  # s
    assert rear.y_values == pytest.approx([5e-3, 2.5e-3])
    assert front.y == "contact_force_y:ground:front_foot"


def test_only_a_plane_crawler_is_compared():
    table = {"actuator": {"template": "finger"}, "phase": [{"targets": {"cavity": "1 kPa"}}]}
    with pytest.raises(InputError, match="expected a study of a plane crawler, received a Finger"):
        pneunet_2d._bending(study_from(table, "finger"))


def test_a_row_of_tubes_bends_as_the_closed_form_says_while_their_joints_are_small():
    pressures = (0.002, 0.005)
    tubes = PlaneCrawler(rounding=4.6)
    computed = segment_curvatures(tubes, MATERIALS, pressures, 1.25)
    exact = np.array([pneunet_curvature(0.03, 3.0, 5.0, pressure) for pressure in pressures])
    assert computed == pytest.approx(exact, rel=0.12)  # joints and layer stiffen it: it bends less


def test_wider_joints_make_it_stiffer():
    block, tubes = (
        segment_curvatures(PlaneCrawler(rounding=rounding, channels=3), MATERIALS, (0.004,), 2.0)[0]
        for rounding in (0.0, 4.0)
    )
    assert 0.0 < block < 0.5 * tubes


def test_too_few_channels_have_no_curvature():
    with pytest.raises(InputError, match="2 channels, expected at least 3"):
        segment_curvatures(PlaneCrawler(channels=2), MATERIALS, (0.004,))
