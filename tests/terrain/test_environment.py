"""The Gymnasium environment: its own checker, repeatable runs, and what pressures do to the robot."""

import importlib
import runpy
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from tests.terrain.limbs import known_limb

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain import Drive, HeightField
from pneumorph.terrain.soft_wheel import SoftWheel

pytest.importorskip("mujoco")
gymnasium = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402

from pneumorph.terrain.environment import INTERVAL, NAME, SoftRover  # noqa: E402

BY_NAME = f"pneumorph.terrain.environment:{NAME}"
WHEEL = SoftWheel(known_limb())
KPA = 1e-3


def driven(robot, pressure, speed, seconds, start=0.0, seed=1):
    """Return observations, rewards and infos of a drive with one pressure in all wheels."""
    robot.reset(seed=seed, options={"pressure": start})
    rows = [robot.step(robot.action(pressure, speed)) for _ in range(round(seconds / INTERVAL))]
    return np.array([row[0] for row in rows]), [row[1] for row in rows], [row[4] for row in rows]


@pytest.mark.parametrize("per_limb", [False, True])
def test_gymnasium_finds_nothing_to_complain_about(per_limb):
    robot = gymnasium.make(BY_NAME, wheel=WHEEL, per_limb=per_limb, duration=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(robot.unwrapped, skip_render_check=True)


def test_gymnasium_finds_nothing_to_complain_about_in_pictures():
    robot = gymnasium.make(BY_NAME, wheel=WHEEL, duration=1.0, render_mode="rgb_array")
    robot.reset(seed=1)
    try:
        picture = robot.render()
    except EngineError as error:
        pytest.skip(str(error))
    assert picture.shape == (360, 640, 3)
    orange = (picture[..., 0] > 1.6 * picture[..., 2]) & (picture[..., 0] > 60)
    assert orange.mean() > 0.005
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(robot.unwrapped)
    robot.close()
    assert SoftRover(WHEEL).render() is None


def test_the_same_seed_gives_the_same_run_and_another_one_another():
    runs = [driven(SoftRover(WHEEL), 10 * KPA, 4.0, 1.0, seed=seed)[0] for seed in (7, 7, 8)]
    np.testing.assert_array_equal(runs[0], runs[1])
    assert np.abs(runs[0] - runs[2]).max() > 1e-3


def test_pressure_lifts_the_robot_and_opens_its_limbs():
    low, high = (driven(SoftRover(WHEEL), p, 0.0, 1.5, seed=4) for p in (0.0, 30 * KPA))
    assert high[2][-1]["height"] > low[2][-1]["height"] + 5.0
    robot = SoftRover(WHEEL)
    bending = [name.startswith("bending") for name in robot.observation_names]
    opened = WHEEL.limb.rest_angles(0.03).sum()
    assert high[0][-1][bending].mean() - low[0][-1][bending].mean() == pytest.approx(opened, rel=0.25)
    np.testing.assert_allclose(high[2][-1]["pressures"], 0.03, rtol=1e-5)


def test_pressures_follow_with_the_lag():
    robot = SoftRover(WHEEL, lag=0.2)
    _, _, infos = driven(robot, 20 * KPA, 0.0, 0.4)
    expected = 20 * KPA * (1.0 - np.exp(-0.4 / 0.2))
    np.testing.assert_allclose(infos[-1]["pressures"], expected, rtol=1e-6)


def test_a_limb_alone_is_inflated_with_per_limb():
    robot = SoftRover(WHEEL, per_limb=True)
    robot.reset(seed=1)
    pressures = np.zeros(16)
    pressures[6] = 20 * KPA  # third limb of the second wheel
    for _ in range(20):
        _, _, _, _, info = robot.step(robot.action(pressures, 0.0))
    assert info["pressures"][1, 2] == pytest.approx(0.02, rel=1e-3)
    assert np.count_nonzero(info["pressures"]) == 1


def test_the_rewards_add_up_to_the_way_forward_both_ways():
    for speed in (5.0, -5.0):
        robot = SoftRover(WHEEL)
        _, start = robot.reset(seed=2)
        total = 0.0
        for _ in range(50):
            observed, reward, over, late, info = robot.step(robot.action(15 * KPA, speed))
            assert not over
            assert not late
            assert observed in robot.observation_space
            total += reward
        assert total == pytest.approx(1e-3 * (info["place"][0] - start["place"][0]), abs=1e-9)
        assert np.sign(total) == np.sign(speed)
        assert abs(total) > 0.5


def test_the_wheel_changes_shape_while_it_rolls():
    robot = SoftRover(WHEEL)
    robot.reset(seed=3)
    bending = [name.startswith("bending") for name in robot.observation_names]
    means = []
    for number in range(120):
        pressure = 30 * KPA if 40 <= number < 80 else 0.0
        observed, _, _, _, _ = robot.step(robot.action(pressure, 4.0))
        means.append(observed[bending].mean())
    opened = WHEEL.limb.rest_angles(0.03).sum()
    assert np.mean(means[60:80]) - np.mean(means[20:40]) > 0.5 * opened
    assert abs(np.mean(means[100:120]) - np.mean(means[20:40])) < 0.25 * opened


def test_a_run_is_truncated_at_its_end_and_at_the_edge_and_terminated_on_its_back():
    robot = SoftRover(WHEEL, duration=0.1)
    robot.reset(seed=1)
    rest = robot.action(0.0, 0.0)
    assert [robot.step(rest)[2:4] for _ in range(2)] == [(False, False), (False, True)]
    small = SoftRover(WHEEL, HeightField(np.zeros((3, 3)), 2_400.0, 2_400.0))
    small.reset(seed=1)
    ends = [small.step(small.action(0.0, 6.0))[2:4] for _ in range(60)]
    assert (False, True) in ends
    robot.reset(seed=1)
    robot._data.qpos[3:7] = [0.0, 1.0, 0.0, 0.0]
    assert robot.step(rest)[2]


def test_observed_height_counts_from_the_ground_below():
    heights = np.tile(np.linspace(0.0, 500.0, 11), (11, 1))
    robot = SoftRover(WHEEL, HeightField(heights, 10_000.0, 10_000.0))
    observed, info = robot.reset(seed=1)
    x, _, z = info["place"]
    assert 1000.0 * observed[0] == pytest.approx(z - (250.0 + 0.05 * x), abs=1e-2)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: SoftRover(WHEEL, render_mode="human"), "render_mode = 'human', expected 'rgb_array' or None"),
        (lambda: SoftRover(WHEEL, duration=0.0), "duration = 0 s, expected at least 0.05 s"),
        (lambda: SoftRover(WHEEL, lag=0.0), "lag = 0 s, expected more than 0"),
        (lambda: SoftRover(WHEEL, drive=Drive(step=0.00625)), "step = 0.00625 s, expected a whole part of 0.01 s"),
        (
            lambda: SoftRover(WHEEL, drive=Drive(step=0.002)),
            "expected at most the hinge_time of the wheels, 0.001 s",
        ),
    ],
)
def test_settings_out_of_range_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_actions_out_of_range_and_before_the_start_are_refused():
    robot = SoftRover(WHEEL)
    with pytest.raises(InputError, match="call reset first"):
        robot.step(np.zeros(5))
    robot.reset(seed=1)
    with pytest.raises(InputError, match="expected 5 numbers from -1 to 1"):
        robot.step(np.zeros(4))
    with pytest.raises(InputError, match="expected 5 numbers from -1 to 1"):
        robot.step(np.full(5, 1.5))
    with pytest.raises(InputError, match=r"pressure = 40 kPa: outside the range"):
        robot.action(40 * KPA, 0.0)
    with pytest.raises(InputError, match=r"speed = 10 rad/s, expected at most 6.28319 rad/s either way"):
        robot.action(0.0, 10.0)
    with pytest.raises(InputError, match="unknown options presure, allowed: pressure"):
        robot.reset(options={"presure": 0.0})
    with pytest.raises(InputError, match="pressure = 90 kPa: outside the range"):
        robot.reset(options={"pressure": 0.09})


def test_without_gymnasium_the_message_says_what_to_install(monkeypatch):
    monkeypatch.delitem(sys.modules, "pneumorph.terrain.environment")
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    with pytest.raises(EngineError, match=r"Gymnasium is missing .* pip install 'pneumorph\[gym\]'"):
        importlib.import_module("pneumorph.terrain.environment")


def test_the_example_drives_with_each_of_its_policies():
    pytest.importorskip("matplotlib")
    example = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "train_rolling.py"))
    for policy in ("limp", "adaptive", "firm"):
        time, way, height, pressure = example["drive"](example[policy], duration=0.5)
        assert len(time) == len(way) == len(height) == 10
        assert pressure[-1] < 30.0 if policy == "limp" else pressure[-1] <= 30.0 + 1e-9


def test_the_default_robot_stands_on_the_limb_of_the_package():
    robot = SoftRover()
    _, info = robot.reset(seed=1, options={"pressure": robot.highest_pressure})
    for _ in range(20):
        *_, info = robot.step(robot.action(robot.highest_pressure, 0.0))
    assert info["height"] > 0.5 * robot.wheel.radius
