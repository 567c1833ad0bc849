"""The reproduction of the quadruped: what is asked, compared and drawn."""

from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.gaits import Locomotion, crawling
from pneumorph.geometry import PlaneCrawler, Quadruped
from pneumorph.materials import library
from pneumorph.studies import reproductions
from pneumorph.studies.reproductions import pneunet_quadruped as quadruped
from pneumorph.studies.reproductions.quadruped_leg import leg_angles

MATERIALS = {"body": library.material("ecoflex-pneunet"), "base": library.material("pdms-pneunet")}
FEET = [face for pair in quadruped.PAIRS.values() for face in pair]


def names(study):
    return [phase.name for phase in study.programme.phases]


def test_the_quick_study_is_the_published_crawling():
    study = quadruped.study(quick=True)
    assert names(study) == list(quadruped.STEPS.values())
    gait = crawling(("PN1", "PN2", "PN3", "PN4"), "PN5", 0.02)
    for number, phase in enumerate((*gait.settle, *gait.phases), 2):
        assert study.programme.phases[number - 1].name == phase.name
        mine, theirs = study.programme.values(float(number)), gait.programme.values(float(number - 1))
        assert {name: mine[name] for name in theirs} == pytest.approx(theirs)
    assert study.cycle_ends == (3, 7)
    assert study.contacts[0].friction == 0.7
    assert study.actuator == Quadruped()
    assert study.materials["body"].shear_modulus == 0.03
    assert study.materials["base"].shear_modulus == 1.84
    assert reproductions.reproduction("pneunet-quadruped").study is quadruped.study


def test_the_full_study_undulates_first_and_ends_as_it_began():
    study = quadruped.study(quick=False)
    assert names(study) == ["gravity", *quadruped.UNDULATION, *quadruped.CRAWLING]
    assert study.cycle_ends == (9, 13)
    full = study.programme.values(4.0)
    assert all(full[name] == pytest.approx(0.02) for name in quadruped.study(True).actuator.cavities)
    empty = study.programme.values(7.0)
    assert all(value == 0.0 for name, value in empty.items() if name != "gravity")
    assert study.programme.values(13.0) == pytest.approx(study.programme.values(9.0))


def motion(study, reached):
    """Return a made-up run up to a phase: end k of the phases is state k, and the robot goes k squared ahead."""
    time = np.arange(reached + 1, dtype=float)
    force = {face: np.zeros((reached + 1, 3)) for face in FEET}
    for number, face in enumerate(FEET):
        force[face][1:, 2] = 0.01 * (number + 1)
    centre = np.column_stack([time**2, np.zeros(reached + 1), 3.0 + 0.1 * time])
    slip = {face: np.zeros((reached + 1, 3)) for face in FEET}
    return Locomotion(time, centre, force, slip, np.zeros(reached + 1), 0.21, study.cycle_ends, np.array([1.0, 0, 0]))


def rows_of(monkeypatch, study, reached):
    monkeypatch.setattr(quadruped, "motion", lambda solution, study: motion(study, reached))
    solution = SimpleNamespace(history=SimpleNamespace(smallest=lambda prefix: 0.01))
    return {(row.quantity, row.condition): row for row in quadruped.compare(solution, study)}


def test_forces_and_ways_stand_in_the_rows(monkeypatch):
    rows = rows_of(monkeypatch, quadruped.study(True), 7)
    rear = rows["normal force of the rear pair", "after step i, gravity"]
    assert (rear.reported, rear.computed, rear.unit) == (0.12, pytest.approx(0.06), "N")
    assert rows["normal force of the front pair", "after step i, gravity"].computed == pytest.approx(0.15)
    assert rows["ground force over weight at rest", "after step i, gravity"].computed == pytest.approx(1.0)
    way = "way of the centre of mass"
    assert rows[way, "in step iv, +PN3 -PN1"].computed == pytest.approx(16.0 - 9.0)
    assert "markedly forward" in rows[way, "in step vi, +PN4 -PN2"].note
    assert rows[way, "in step v, +PN2 -PN3"].note == ""
    assert rows[way, "one cycle of crawling, iii to vii"].computed == pytest.approx(49.0 - 9.0)
    assert rows["height of the centre of mass, vii over iii", "crawling"].computed == pytest.approx(3.7 / 3.3)
    assert not any("undulation" in condition for _, condition in rows)


def test_a_full_run_has_the_way_of_the_undulation(monkeypatch):
    rows = rows_of(monkeypatch, quadruped.study(False), 13)
    assert rows["way of the centre of mass", "one cycle of undulation"].computed == pytest.approx(49.0 - 1.0)
    assert rows["way of the centre of mass", "one cycle of crawling, iii to vii"].computed == pytest.approx(
        169.0 - 81.0
    )


def test_what_a_stopped_run_did_not_reach_is_empty(monkeypatch):
    rows = rows_of(monkeypatch, quadruped.study(True), 4)
    assert rows["way of the centre of mass", "in step iv, +PN3 -PN1"].computed is not None
    assert rows["way of the centre of mass", "in step v, +PN2 -PN3"].computed is None
    assert rows["height of the centre of mass, vii over iii", "crawling"].computed is None
    rest = rows_of(monkeypatch, quadruped.study(True), 0)
    assert rest["normal force of the rear pair", "after step i, gravity"].computed is None
    assert rest["ground force over weight at rest", "after step i, gravity"].computed is None


def test_legs_and_centre_are_drawn(monkeypatch):
    monkeypatch.setattr(quadruped, "motion", lambda solution, study: motion(study, 7))
    monkeypatch.setattr(quadruped, "leg_angles", lambda *_: [0.1, 0.2, 0.3, 0.4])
    legs, centre, leg = quadruped.profiles(None, quadruped.study(True))
    assert [line.label for line in legs.series] == ["foot_PN1", "foot_PN2", "foot_PN3", "foot_PN4"]
    assert legs.series[1].y[1:] == pytest.approx(np.full(7, 20.0))
    assert centre.series[1].x == pytest.approx(np.arange(1.0, 8.0) ** 2)
    assert leg.series[0].x == pytest.approx([0.0, 5.0, 10.0, 15.0, 20.0])
    assert leg.series[0].y[-1] == pytest.approx(np.degrees(0.4))


def test_only_a_quadruped_has_legs():
    with pytest.raises(InputError, match="expected a study of a quadruped, received a PlaneCrawler"):
        quadruped.profiles(None, SimpleNamespace(actuator=PlaneCrawler()))


def test_a_leg_curls_more_the_more_it_is_inflated():
    small = Quadruped(length=54.0, width=38.0, body_width=24.0, leg_width=15.0)
    low, high = leg_angles(small, MATERIALS, (0.004, 0.008))
    assert 0.0 < 2.0 * low < high  # softening: more than in proportion
