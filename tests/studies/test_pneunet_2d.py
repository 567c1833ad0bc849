"""The reproduction of system 2 in plane strain: what is asked, compared and drawn."""

from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.closed_form.pneunet import pneunet_curvature
from pneumorph.errors import InputError
from pneumorph.gaits import Locomotion
from pneumorph.geometry import PlaneCrawler
from pneumorph.materials import library
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


def test_what_the_run_did_not_reach_has_no_computed_number(monkeypatch):
    rows = rows_of(monkeypatch, motion(3))
    assert rows["force of the rear over the front end", "after step v, -PN1"].computed is None
    assert rows["displacement of the centre of mass", "cycle 1"].computed is None
    assert rows["contact force of the rear end", "after step ii, +PN1"].computed is not None


def test_the_reported_forces_are_drawn_at_the_ends_of_their_steps():
    rear, front = pneunet_2d.curves(pneunet_2d.study(quick=True))
    assert rear.x_values == pytest.approx([1.0, 2.0])
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
