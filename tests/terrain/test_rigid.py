"""MuJoCo against statics, Coulomb friction, rolling and the first-order lag of the controller."""

import sys
from math import cos, exp, pi, radians, sin
from xml.etree import ElementTree as xml

import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain import (
    Drive,
    HeightField,
    Rover,
    Wheel,
    all_wheels,
    check_course,
    flat,
    ground_bytes,
    load,
    mjcf,
    simulate,
    smooth,
)
from pneumorph.terrain.mjcf import start_height

mujoco = pytest.importorskip("mujoco")

PLAIN = Rover(Wheel(0))
FIELD = flat(30_000.0)


def model_of(rover=PLAIN, drive=None, field=FIELD, place=(0.0, 0.0)):
    text = mjcf(rover, drive or Drive(), field, "ground.hfield", place)
    return load(text, {"ground.hfield": ground_bytes(field)})


def stepped(model, seconds):
    """Return the state after standing with wheels that hold still."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, round(seconds / model.opt.timestep))
    return data


def ground_force(model, data):
    """Return the force of the ground on the robot, N, in the world's axes."""
    total = np.zeros(3)
    for number in range(data.ncon):
        contact, force = data.contact[number], np.zeros(6)
        mujoco.mj_contactForce(model, data, number, force)
        sign = 1.0 if contact.geom[0] == model.geom("ground").id else -1.0
        total += sign * contact.frame.reshape(3, 3).T @ force[:3]
    return total


@pytest.fixture(scope="module")
def rolled():
    """The plain wheels over 10.5 s on the flat."""
    return simulate(model_of(), Drive())


def test_plain_wheels_roll_without_slipping(rolled):
    rolling = 140.0 * (rolled.turn[-1] - rolled.turn[0]).mean()
    assert rolled.distance == pytest.approx(rolling, rel=2e-3)
    assert rolled.distance == pytest.approx(140.0 * Drive().wanted_turn, rel=5e-3)
    assert abs(rolled.sideways) < 5.0
    assert rolled.as_the_crow_flies == pytest.approx(rolled.distance, rel=1e-6)
    assert rolled.upright.min() > 0.999


def test_hinges_follow_the_ramp_with_the_lag_of_damping_over_stiffness_and_then_hold(rolled):
    # a hinge without inertia: damping w = stiffness (wanted angle - angle), so w = a (t - lag (1 - exp(-t / lag)))
    drive = Drive()
    lag = drive.damping / drive.stiffness
    for moment in (0.25, 0.5, 0.75, 1.0):
        row = int(np.argmin(np.abs(rolled.time - moment)))
        expected = drive.speed / drive.ramp * (moment - lag * (1.0 - exp(-moment / lag)))
        np.testing.assert_allclose(rolled.turn_speed[row], expected, atol=0.02 * drive.speed)
    np.testing.assert_allclose(rolled.turn_speed[rolled.time > 1.5], drive.speed, rtol=0.01)
    behind = drive.wanted_turn - rolled.turn[-1].mean()
    assert behind == pytest.approx(drive.damping * drive.speed / drive.stiffness, rel=0.1)


def test_a_standing_robot_is_carried_by_its_weight_and_sinks_in_by_less_than_a_millimetre():
    model = model_of()
    data = stepped(model, 2.0)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(ground_force(model, data), [0.0, 0.0, 0.5 * 9.81], atol=0.005 * 0.5 * 9.81)
    assert 0.0 < -1000.0 * data.contact.dist.min() < 1.0


def test_a_robot_with_held_wheels_stays_on_a_slope_below_the_angle_of_friction():
    model = model_of()
    slope = radians(25.0)  # tan 0.47 < 0.6
    model.opt.gravity = 9.81 * np.array([-sin(slope), 0.0, -cos(slope)])
    data = stepped(model, 1.0)
    before = data.qpos[0]
    mujoco.mj_step(model, data, 500)
    assert abs(data.qpos[0] - before) < 0.005


def test_a_robot_with_held_wheels_slides_down_a_steeper_slope_as_coulomb_says():
    model = model_of()
    slope = radians(40.0)  # tan 0.84 > 0.6
    model.opt.gravity = 9.81 * np.array([-sin(slope), 0.0, -cos(slope)])
    data = stepped(model, 0.5)
    before = data.qvel[0]
    mujoco.mj_step(model, data, 250)
    acceleration = (before - data.qvel[0]) / 0.5
    # 3 %: the edges between the prisms of the ground add a little
    assert np.tan(slope) - acceleration / (9.81 * cos(slope)) == pytest.approx(0.6, rel=0.03)


@pytest.mark.parametrize("wheel", [Wheel(0), Wheel(3), Wheel(2, curved=True)], ids=lambda w: w.name)
def test_a_dropped_robot_keeps_its_energy_in_the_air_and_gains_none_on_the_ground(wheel):
    model = model_of(Rover(wheel))
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start = data.energy.sum()
    for _ in range(600):
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        energy = data.energy.sum()
        if data.time < 0.03:  # 5 mm take 32 ms
            assert data.ncon == 0
            # the semi-implicit step of a free fall is off by m g^2 t dt / 2
            assert energy == pytest.approx(start, abs=0.5 * 9.81**2 * 0.03 * 0.002)
        assert energy < start + 1e-3
    assert energy < start


@pytest.mark.parametrize("wheel", all_wheels(), ids=lambda w: w.name)
def test_every_robot_weighs_500_g_and_starts_clear_of_the_ground(wheel):
    model = model_of(Rover(wheel))
    assert model.body_mass.sum() == pytest.approx(0.5, rel=1e-6)
    assert model.nu == 4
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    for friction in model.geom_friction:
        np.testing.assert_allclose(friction, [0.6, 0.005, 0.2])
    assert set(model.geom_condim) == {3}
    hinges = model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE
    np.testing.assert_allclose(model.dof_damping[model.jnt_dofadr[hinges]], 0.2)


def test_the_ground_that_mujoco_sees_has_the_heights_of_the_field_at_its_places():
    rows, columns = np.mgrid[0:9, 0:13]
    heights = 20.0 * np.sin(1.3 * rows) + 3.0 * columns + 50.0
    field = HeightField(heights, 6_000.0, 4_000.0)
    model = model_of(field=field)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for row, column in ((1, 1), (1, 11), (7, 1), (4, 6), (6, 10)):
        above = np.array([field.x[column] / 1000.0, field.y[row] / 1000.0, 3.0])
        hit = np.array([-1], np.int32)
        robot = model.body("rover").id
        length = mujoco.mj_ray(model, data, above + 1e-9, np.array([0.0, 0.0, -1.0]), None, 1, robot, hit)
        if model.geom(int(hit[0])).name == "ground":
            assert 1000.0 * (3.0 - length) == pytest.approx(heights[row, column], abs=1e-3)
        else:
            pytest.fail("the ray met the robot")


def test_saved_files_open_by_themselves_from_anywhere(tmp_path, monkeypatch):
    folder = tmp_path / "models"
    folder.mkdir()
    (folder / "run.xml").write_text(mjcf(PLAIN, Drive(), FIELD, "flat.hfield"))
    (folder / "flat.hfield").write_bytes(ground_bytes(FIELD))
    monkeypatch.chdir(tmp_path)
    model = mujoco.MjModel.from_xml_path(str(folder / "run.xml"))
    assert model.opt.timestep == 0.002
    xml.parse(folder / "run.xml")


def test_a_run_is_the_same_every_time():
    field = smooth(1, extent=20_000.0)
    drive = Drive(duration=2.0)
    ways = [simulate(model_of(Rover(Wheel(3)), drive, field), drive) for _ in range(2)]
    np.testing.assert_array_equal(ways[0].pose, ways[1].pose)
    assert ways[0].time[-1] == 2.0
    assert ways[0].pose.shape == (41, 7 + 4)


def test_a_robot_on_three_paddles_goes_farther_than_on_one():
    ways = [simulate(model_of(Rover(Wheel(n))), Drive(duration=5.0)) for n in (1, 3)]
    # one paddle of 140 mm drags the body, whose axles lie 30 mm high, by at most a chord in each turn
    chord = 2.0 * (140.0**2 - 30.0**2) ** 0.5
    turns = Drive(duration=5.0).wanted_turn / (2.0 * pi)
    assert 0.0 < ways[0].distance < 1.2 * chord * turns
    assert ways[1].distance > 1.5 * ways[0].distance


def test_a_robot_that_stands_or_drives_off_the_terrain_is_refused():
    with pytest.raises(InputError, match="off the terrain, which covers -1 to 1 m"):
        start_height(PLAIN, flat(2_000.0), (800.0, 0.0))
    with pytest.raises(InputError, match=r"terrain: 2000 mm lie ahead of the robot.*radius 140 mm can roll 9236 mm"):
        check_course(PLAIN, Drive(), flat(4_000.0), (0.0, 0.0))
    check_course(PLAIN, Drive(), flat(20_000.0), (0.0, 0.0))


def test_a_run_that_leaves_the_ground_fails():
    field = flat(3_000.0)
    with pytest.raises(EngineError, match="left the terrain before"):
        simulate(model_of(field=field), Drive())


def test_an_unstable_run_fails_and_leaves_no_log_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = model_of()
    model.opt.gravity = np.array([0.0, 0.0, 1e13])
    with pytest.raises(EngineError, match="unstable before"):
        simulate(model, Drive())
    assert list(tmp_path.iterdir()) == []


def test_another_time_step_than_the_models_is_refused():
    with pytest.raises(InputError, match=r"step = 0.001 s, but the model was built for 0.002 s"):
        simulate(model_of(), Drive(step=0.001))


def test_a_model_that_mujoco_refuses_says_why():
    with pytest.raises(EngineError, match="MuJoCo refuses the model"):
        load("<mujoco><worldbody><geom/></worldbody></mujoco>", {})


def test_without_mujoco_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(EngineError, match=r"pip install 'pneumorph\[terrain\]'"):
        load("<mujoco/>", {})
