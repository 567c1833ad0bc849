"""The soft wheel in MuJoCo against the statics of its chain, and rolling."""

from dataclasses import replace
from xml.etree import ElementTree as xml

import numpy as np
import pytest
from tests.terrain.limbs import known_limb

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain import Drive, Rover, flat, ground_bytes, load, mjcf, simulate, soft_rig
from pneumorph.terrain.inflation import Inflation
from pneumorph.terrain.soft_rig import loaded_tip, pressed_wheel
from pneumorph.terrain.soft_wheel import SoftWheel, foot_axis, link_boxes

mujoco = pytest.importorskip("mujoco")

WHEEL = SoftWheel(known_limb())
INWARDS = np.arctan2(-WHEEL.limb.load_point[1], -25.0 - WHEEL.limb.load_point[0])
NAMES = ["front_left", "front_right", "rear_left", "rear_right"]


def model_of(wheel=WHEEL, drive=None):
    field = flat(20_000.0)
    return load(mjcf(Rover(wheel), drive or Drive(step=0.001), field, "g.hfield"), {"g.hfield": ground_bytes(field)})


@pytest.mark.parametrize(("pressure", "force"), [(0.0, (-0.8, 0.9)), (0.02, (-1.0, 1.2)), (0.03, (0.5, 0.5))])
def test_mujoco_bends_the_limb_as_the_statics_of_the_chain_say(pressure, force):
    angles = WHEEL.limb.equilibrium(pressure, force)
    tip, turn = loaded_tip(WHEEL, pressure, force)
    np.testing.assert_allclose(tip, WHEEL.limb.shape(angles)[1], atol=1e-3)
    assert turn == pytest.approx(angles.sum(), abs=1e-5)


@pytest.mark.parametrize(("pressure", "force"), [(0.0, (-0.8, 0.9)), (0.0, (0.4, 0.3)), (0.01, (-1.5, 1.8))])
def test_mujoco_closes_the_limb_as_far_as_its_stops_let_it(pressure, force):
    wheel = SoftWheel(known_limb(stops=True))
    angles = wheel.limb.equilibrium(pressure, force)
    tip, turn = loaded_tip(wheel, pressure, force)
    np.testing.assert_allclose(tip, wheel.limb.shape(angles)[1], atol=1e-2)
    assert turn == pytest.approx(angles.sum(), abs=1e-4)


def test_where_the_limb_is_mounted_does_not_change_how_it_bends():
    turned = SoftWheel(replace(WHEEL.limb, mount=(10.0, -20.0, 1.1)))
    here, there = (loaded_tip(wheel, 0.01, (-0.5, 0.8)) for wheel in (WHEEL, turned))
    np.testing.assert_allclose(here[0], there[0], atol=1e-3)
    assert here[1] == pytest.approx(there[1], abs=1e-6)


def test_a_pressed_wheel_stands_on_its_weight_and_sinks_more_when_it_is_soft():
    soft = pressed_wheel(WHEEL, 0.0, 1.25, INWARDS)
    assert soft.force == pytest.approx(1.25, rel=1e-4)
    assert 0.0 < soft.overlap < 1.5
    # the height of the axle over the lowest corner of the loaded chain: of the limb that points down, under its weight
    heavier = pressed_wheel(WHEEL, 0.0, 2.0, INWARDS)
    assert heavier.force == pytest.approx(2.0, rel=1e-4)
    assert heavier.sink > 1.3 * soft.sink > 0.0
    stiff = SoftWheel(replace(WHEEL.limb, compliance=0.1 * WHEEL.limb.compliance))
    assert pressed_wheel(stiff, 0.0, 1.25, INWARDS).sink < 0.2 * soft.sink


def test_the_mirrored_wheel_is_the_other_side_of_the_wheel():
    here, there = (load_points(wheel) for wheel in (WHEEL, replace(WHEEL, mirrored=True)))
    # up and down are swapped: the first and third limb's places, and those of the second and fourth
    np.testing.assert_allclose(there, here[[0, 3, 2, 1]] * [1.0, 1.0, -1.0], atol=1e-6)
    assert np.abs(here[0, 2]) > 50.0


def load_points(wheel):
    """Return the places of the load points of one wheel, opened by 20 kPa, against its axle, mm."""
    model = model_of(wheel)
    inflation = Inflation(model, wheel, NAMES)
    data = mujoco.MjData(model)
    data.qpos[inflation.coordinates] = inflation.rest(np.full((4, 4), 0.02))
    mujoco.mj_forward(model, data)
    axle = data.body(NAMES[0]).xpos
    return 1000.0 * np.array([data.site(f"{NAMES[0]}.{limb}.load").xpos - axle for limb in (1, 2, 3, 4)])


def test_the_height_of_the_wheel_is_that_of_its_solids_in_mujoco():
    model = model_of()
    inflation = Inflation(model, WHEEL, NAMES)
    kinds = mujoco.mjtGeom
    for pressure in (0.0, 0.02):
        data = mujoco.MjData(model)
        data.qpos[inflation.coordinates] = inflation.rest(np.full((4, 4), pressure))
        mujoco.mj_forward(model, data)
        axle, far = data.body(NAMES[0]).xpos, 0.0
        for geom in range(model.ngeom):
            name = model.body(model.geom_bodyid[geom]).name
            if name.startswith(f"{NAMES[0]}.") and model.geom_type[geom] == kinds.mjGEOM_CYLINDER:
                place = data.geom_xpos[geom] - axle
                far = max(far, np.hypot(place[0], place[2]) + model.geom_size[geom][0])
            if name.startswith(f"{NAMES[0]}.") and model.geom_type[geom] == kinds.mjGEOM_BOX:
                signs = np.array([[x, 0, z] for x in (-1, 1) for z in (-1, 1)]) * model.geom_size[geom]
                corners = data.geom_xpos[geom] + signs @ data.geom_xmat[geom].reshape(3, 3).T - axle
                far = max(far, np.hypot(corners[:, 0], corners[:, 2]).max())
        assert WHEEL.height(pressure) == pytest.approx(2000.0 * far, abs=0.1)  # of the foot, points around it
    assert WHEEL.height(0.03) > WHEEL.height(0.0)
    assert pytest.approx(0.5 * WHEEL.height(0.03)) == WHEEL.radius


def test_inflation_sets_springs_rest_angles_and_damping_of_each_limb_alone():
    model = model_of()
    inflation = Inflation(model, WHEEL, NAMES)
    pressures = np.zeros((4, 4))
    pressures[1, 2] = 0.02
    inflation.apply(model, pressures)
    limb = WHEEL.limb
    for place, pressure in (((1, 2), 0.02), ((0, 0), 0.0)):
        joints = inflation.joints[place]
        np.testing.assert_allclose(model.jnt_stiffness[joints], 1e-3 * limb.stiffness(pressure))
        np.testing.assert_allclose(model.qpos_spring[inflation.coordinates[place]], limb.rest_angles(pressure))
        damping = WHEEL.relaxation * 1e-3 * limb.stiffness(pressure)
        np.testing.assert_allclose(model.dof_damping[inflation.speeds[place]], damping)
    with pytest.raises(InputError, match="pressure = 50 kPa: outside the range"):
        inflation.apply(model, np.full((4, 4), 0.05))


def test_the_robot_on_soft_wheels_weighs_500_g_and_drives_its_axles_only():
    model = model_of()
    assert model.body_mass.sum() == pytest.approx(0.5, rel=1e-6)
    assert model.nu == 4
    way = simulate(model, Drive(step=0.001, duration=3.0))
    assert way.turn.shape[1] == 4
    # between rolling on the neutral radius without slip and half of it
    rolled = 0.5 * WHEEL.height(0.0) * way.turn[-1].mean()
    assert 0.5 * rolled < way.distance < 1.1 * rolled


def test_a_foot_touches_at_the_load_point_where_the_last_link_is_level():
    limb = WHEEL.limb
    along = limb.end - limb.hinges[-1]
    outwards = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    np.testing.assert_allclose(np.array(foot_axis(limb)) + limb.foot * outwards, limb.load_point)
    assert len(link_boxes(limb)) == 6
    bare = SoftWheel(replace(limb, foot=0.0))
    assert WHEEL.outline(0.0).shape[0] > bare.outline(0.0).shape[0] == 24


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"limbs": 0}, "limbs = 0, expected 1 to 12"),
        ({"hub_radius": 200.0}, "hub_radius = 200 mm, expected more than 0 and less than the radius of the wheel"),
        ({"limb_share": 1.0}, "limb_share = 1, expected between 0 and 1"),
        ({"relaxation": 0.0}, "relaxation = 0 s, expected more than 0"),
        ({"hinge_time": -1.0}, "hinge_time = -1 s, expected more than 0"),
    ],
)
def test_wheels_that_are_none_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(WHEEL, **change)


def test_a_weight_that_is_none_and_a_limb_that_does_not_rest_are_errors(monkeypatch):
    with pytest.raises(InputError, match="weight on the wheel = 0 N, expected more than 0"):
        pressed_wheel(WHEEL, 0.0, 0.0, INWARDS)
    monkeypatch.setattr(soft_rig, "_AT_REST", 0.0)
    monkeypatch.setattr(soft_rig, "_PATIENCE", 0.1)
    with pytest.raises(EngineError, match=r"the limb did not come to rest in 0.1 s at 10 kPa"):
        loaded_tip(WHEEL, 0.01, (5.0, 0.0))


def test_the_mjcf_names_hinges_by_wheel_limb_and_hinge():
    root = xml.fromstring(mjcf(Rover(WHEEL), Drive(), flat(3_000.0), "g.hfield"))
    names = {joint.get("name") for joint in root.iter("joint")} - {None}
    assert {"front_left", "front_left.1.1", "rear_right.4.5"} <= names
    assert len(names) == 4 + 4 * 4 * 5
