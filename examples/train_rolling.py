"""Drive a robot on soft wheels over undulating ground with a scripted policy, and draw what happened.

The policy stands for one that is learned: it sees the observation and answers with pressures and a speed. Here it
inflates the wheels where the body pitches or slows down, and lets the air out on easy ground.

Needs `pip install 'pneumorph[gym]'`. Ends with the distances with and without air; `python examples/train_rolling.py
rolling.png` names the picture.
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

from pneumorph.terrain import smooth
from pneumorph.terrain.environment import INTERVAL, SoftRover

SPEED = 4.0  # rad/s
GROUND = smooth(seed=4, relief=250.0, wavelength=3_000.0, extent=40_000.0)


def limp(robot, observed):
    """No air at all."""
    return robot.action(0.0, SPEED)


def firm(robot, observed):
    """All the air that the limbs were fitted with."""
    return robot.action(robot.highest_pressure, SPEED)


def adaptive(robot, observed):
    """More air where the body pitches, or falls behind a third of the speed of wheels that roll."""
    seen = dict(zip(robot.observation_names, observed, strict=True))
    behind = seen["velocity x [m/s]"] < 0.3 * abs(seen["wanted speed"]) * SPEED * seen["height [m]"]
    effort = min(1.0, abs(seen["up x"]) / 0.15 + 0.5 * behind)
    return robot.action(effort * robot.highest_pressure, SPEED)


def drive(policy, seed=1, duration=10.0):
    """Return time (s), way (m), height over the ground (mm) and mean pressure (kPa) of an episode."""
    robot = SoftRover(ground=GROUND, duration=duration)
    observed, info = robot.reset(seed=seed, options={"pressure": robot.highest_pressure})
    rows, way, ended = [], 0.0, False
    while not ended:
        rows.append((len(rows) * INTERVAL, way, info["height"], 1e3 * info["pressures"].mean()))
        observed, reward, over, late, info = robot.step(policy(robot, observed))
        way += reward
        ended = over or late
    robot.close()
    return np.array(rows).T


if __name__ == "__main__":
    figure, axes = plt.subplots(3, 1, figsize=(7, 7), sharex=True, layout="constrained")
    for policy in (limp, adaptive, firm):
        time, way, height, pressure = drive(policy)
        for ax, values in zip(axes, (way, height, pressure), strict=True):
            ax.plot(time, values, label=policy.__name__)
        print(f"{policy.__name__}: {way[-1]:.2f} m, mean height {height.mean():.0f} mm, {pressure.mean():.1f} kPa")
    for ax, label in zip(axes, ("way forward [m]", "height over the ground [mm]", "pressure [kPa]"), strict=True):
        ax.set_ylabel(label)
        ax.grid(alpha=0.3)
    axes[-1].set_xlabel("time [s]")
    axes[0].legend()
    picture = sys.argv[1] if len(sys.argv) > 1 else "rolling.png"
    figure.savefig(picture, dpi=120)
    print(f"picture: {picture}")
