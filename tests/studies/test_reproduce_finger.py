"""What the reproduction of system 3 asks, and what it says of a run."""

from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.geometry import Finger
from pneumorph.mechanics import Block, Motion
from pneumorph.solution import Column, History
from pneumorph.studies import reproductions
from pneumorph.studies.reproductions import finger

KINDS = {"pressure:cavity": "pressure", "chord_angle": "angle", "tip_rotation": "angle", "mean_von_mises": "stress"}
KINDS |= {"mean_equivalent_strain": "number", "body_force_z:block": "force", "phase": "text"}


def run_with(bend, press):
    """Return what stands for a solution: angles pressure and pressure squared, force 30 N/MPa on the block."""
    rows = [
        {"phase": phase, "pressure:cavity": p, "chord_angle": p, "tip_rotation": p**2, "mean_von_mises": 2.0 * p,
         "mean_equivalent_strain": 3.0 * p, "body_force_z:block": -30.0 * p}
        for phase, pressures in (("bend", bend), ("press", press)) for p in pressures
    ]  # fmt: skip
    return SimpleNamespace(history=History([Column(key, key, kind) for key, kind in KINDS.items()], rows))


@pytest.fixture
def flat(monkeypatch):
    """Six peaks of stress along the finger, without a state."""
    monkeypatch.setattr(finger, "_bent", lambda solution: SimpleNamespace(pressure={"cavity": 0.1}))
    place = np.linspace(0.0, 90.0, 400)
    wave = 1.0 - np.cos(2.0 * np.pi * place / 15.0)
    # the outer two are lower; with bending there are twice as many
    path = wave * np.where(abs(place - 45.0) < 30.0, 1.0, 0.8)
    both = 1.0 - np.cos(2.0 * np.pi * place / 7.5)
    monkeypatch.setattr(finger, "_along", lambda state, study: (place, path, both))


@pytest.mark.parametrize(("quick", "size"), [(True, 8.0), (False, 3.0)])
def test_the_finger_bends_freely_and_then_against_a_block_that_is_raised(quick, size):
    study = finger.study(quick)
    assert study.actuator == Finger()
    assert (study.file.mesh.size, study.file.mesh.hexahedra) == (size, True)
    assert [phase.name for phase in study.programme.phases] == ["gravity", "bend", "release", "raise", "press"]
    walls, tip = study.contacts
    assert (walls.against, walls.friction, tip.friction) == (None, 0.0, 0.0)
    assert isinstance(tip.against, Block)
    assert tip.against.motion == Motion("block", (0.0, 0.0, 1.0))
    assert tip.against.upper[2] + study.programme.phases[3].targets["block"] == pytest.approx(-0.5)
    assert tip.against.lower[0] == pytest.approx(90.0 - Finger().block_length, rel=1e-3)
    for phase in (study.programme.phases[1], study.programme.phases[4]):
        assert 0.05 in [pytest.approx(mark * 0.1) for mark in phase.marks]


def test_forces_stresses_angles_and_peaks_stand_beside_the_reported_ones(flat):
    rows = {
        (r.quantity, r.condition): r
        for r in finger.compare(run_with((0.05, 0.075, 0.1), (0.0, 0.05, 0.1)), finger.study(True))
    }
    force = rows["blocked force (finite elements of the study)", "50 kPa"]
    assert (force.reported, force.computed) == (2.0, pytest.approx(1.5))
    assert rows["blocked force (finite elements of the study)", "100 kPa"].computed == pytest.approx(3.0)
    assert rows["blocked force (measured)", "100 kPa"].reported == 5.0
    assert rows["blocked force at 100 kPa / at 50 kPa", ""].computed == pytest.approx(2.0)
    assert rows["mean equivalent stress", "100 kPa"].computed == pytest.approx(0.2)
    assert rows["linearity of chord_angle", "50 to 100 kPa"].computed == pytest.approx(1.0)
    assert 0.9 < rows["linearity of tip_rotation", "50 to 100 kPa"].computed < 1.0
    # peaks at 7.5, 22.5, 37.5, 52.5, 67.5 and 82.5 mm; passages at 11.8 + 13.3 n mm, 3.5 mm to either side
    membrane, both = (f"{name} stress through the floor" for name in ("membrane", "membrane and bending"))
    free = "free, at 100 kPa"
    assert rows[f"peaks of {membrane}", free].computed == 6.0
    assert rows[f"of them at the passages, {membrane}", free].computed == 4.0
    assert rows["lowest central peak / highest outer", free].computed == pytest.approx(1.25, rel=1e-3)
    assert rows[f"peaks of {both}", free].computed == 12.0


def test_what_was_not_reached_stays_empty():
    rows = finger.compare(run_with((), ()), finger.study(True))
    assert all(row.computed is None for row in rows)
    assert finger.profiles(run_with((), ()), finger.study(True)) == ()


def test_profiles_show_angle_stress_strain_force_and_the_stress_along_the_length(flat):
    profiles = {p.name: p for p in finger.profiles(run_with((0.05, 0.1), (0.05, 0.1)), finger.study(True))}
    assert list(profiles) == ["angle", "mean-stress", "mean-strain", "blocked-force", "stress-along-length"]
    computed, reported, measured = profiles["blocked-force"].series
    assert computed.y == pytest.approx([1.5, 3.0])
    assert (list(reported.x), list(reported.y), list(measured.y)) == ([50.0, 100.0], [2.0, 2.71], [5.0])
    assert profiles["blocked-force"].to_csv().splitlines()[1] == "computed,50,1.5"


def test_another_actuator_is_refused(monkeypatch):
    state = SimpleNamespace(pressure={"cavity": 0.1})
    with pytest.raises(InputError, match="expected a study of a finger, received a HexagonalPrism"):
        finger._along(state, reproductions.hexagonal_prism.study(True))


def test_it_is_known_by_name():
    assert reproductions.reproduction("finger").title.endswith("(system 3)")
