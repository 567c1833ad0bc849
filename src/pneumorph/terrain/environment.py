"""The robot on soft wheels as a Gymnasium environment; the only module that imports Gymnasium.

`gymnasium.make("pneumorph.terrain.environment:pneumorph/SoftRover-v0")` makes it by name.
"""

from __future__ import annotations

import tempfile
from math import exp, hypot, pi
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain import rigid
from pneumorph.terrain.courses import flat
from pneumorph.terrain.drawing import Painter
from pneumorph.terrain.height_field import HeightField
from pneumorph.terrain.inflation import Inflation
from pneumorph.terrain.limb_data import read_limb_data
from pneumorph.terrain.limb_fit import fit_limb
from pneumorph.terrain.mjcf import BODY, GAP, ground_bytes, mjcf
from pneumorph.terrain.rover import Drive, Rover
from pneumorph.terrain.si import METRE
from pneumorph.terrain.soft_wheel import SoftWheel

try:
    import gymnasium
except ImportError as missing:
    raise EngineError(f"Gymnasium is missing ({missing}): pip install 'pneumorph[gym]'") from missing

Array = NDArray[np.float64]

NAME = "pneumorph/SoftRover-v0"
INTERVAL = 0.05  # s between actions
STEP = 0.001  # s, of the simulation
_SUBSTEP = 0.01  # s between changes of the springs
_GROUND_FILE = "ground.hfield"
_SPEED_SCALE = 2.0  # of the drive's speed: largest observed speed of a wheel


class SoftRover(gymnasium.Env):
    """A robot on four soft wheels over rigid ground; a new action every 0.05 s.

    Action, (n + 1,), each -1 to 1: n wanted pressures, from none (-1) to the highest that the limb was fitted at (1),
    then the wanted speed of all wheels as a share of `drive.speed`, negative backwards. n is 4, one a wheel in the
    order front left, front right, rear left, rear right; with `per_limb` 16, the four limbs of the first wheel first.
    The pressures follow with the time constant `lag`; the speed changes by at most drive.speed / drive.ramp a second.

    Observation, float32, clipped to the bounds of the space; `observation_names` has a name for each entry:
    height of the body's centre over the ground below it, m (1); velocity of the centre, m/s, and angular velocity,
    rad/s, in the body's axes (3 + 3); upward direction in the body's axes (3); cosine and sine of each wheel's angle
    (8); speed of each wheel, rad/s (4); wanted speed, share (1); pressures, shares of the highest (n); how far each
    limb's end has turned against its unloaded shape, rad, wheel by wheel (16).

    Reward: how far the centre moved along x, m. Terminated: the robot lies on its side or back. Truncated: after
    `duration`, or where the robot gets to the edge of the ground. info: place (mm, 3), height (mm), pressures (MPa).

    wheel: default: the limb that comes with the package. ground: default: 30 m of level ground. drive: default: that of
    the rigid wheels with steps of 1 ms. render_mode: 'rgb_array' or None. seed of `reset`: angle of the wheels, heading
    within 5 degrees, place within 0.1 m.
    options of `reset`: 'pressure', MPa, of all limbs at the start, none by default.

    Raises InputError for numbers out of range, EngineError where MuJoCo is missing or the simulation gets unstable.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": round(1.0 / INTERVAL)}  # noqa: RUF012 - Gymnasium's name

    def __init__(
        self,
        wheel: SoftWheel | None = None,
        ground: HeightField | None = None,
        *,
        drive: Drive | None = None,
        per_limb: bool = False,
        duration: float = 10.0,
        lag: float = 0.1,
        render_mode: str | None = None,
    ):
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise InputError(f"render_mode = {render_mode!r}, expected 'rgb_array' or None")
        if not INTERVAL <= duration < float("inf"):
            raise InputError(f"duration = {duration:g} s, expected at least {INTERVAL:g} s")
        if not 0.0 < lag < float("inf"):
            raise InputError(f"lag = {lag:g} s, expected more than 0")
        self.wheel = SoftWheel(fit_limb(read_limb_data()).limb) if wheel is None else wheel
        self.ground = flat(30_000.0) if ground is None else ground
        self.drive = drive or Drive(step=STEP)
        if abs(_SUBSTEP / self.drive.step - round(_SUBSTEP / self.drive.step)) > 1e-6:
            raise InputError(f"drive: step = {self.drive.step:g} s, expected a whole part of {_SUBSTEP:g} s")
        if self.drive.step > self.wheel.hinge_time:
            raise InputError(
                f"drive: step = {self.drive.step:g} s, expected at most the hinge_time of the wheels, "
                f"{self.wheel.hinge_time:g} s, or their springs are unstable"
            )
        self.rover = Rover(self.wheel)
        self.render_mode, self.per_limb, self.duration, self.lag = render_mode, per_limb, duration, lag
        self._names = [name for name, _, _ in self.rover.corners]
        self._text = mjcf(self.rover, self.drive, self.ground, _GROUND_FILE)
        self._model = rigid.load(self._text, {_GROUND_FILE: ground_bytes(self.ground)})
        self._model.actuator_ctrlrange[:, 0] = -self.drive.speed
        self._data = rigid.engine().MjData(self._model)
        self._inflation = Inflation(self._model, self.wheel, self._names)
        self._axles = np.array([self._model.joint(name).id for name in self._names])
        self._painter: Painter | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._pressures = np.zeros((len(self._names), self.wheel.limbs))
        self._speed, self._started = 0.0, False
        names, bounds = self._entries()
        self.observation_names = tuple(names)
        bound = np.array(bounds, dtype=np.float32)
        self._bound = bound
        self.observation_space = gymnasium.spaces.Box(-bound, bound, dtype=np.float32)
        self._wanted = self._pressures.size if per_limb else len(self._names)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (self._wanted + 1,), np.float32)

    @property
    def highest_pressure(self) -> float:
        """The pressure of the action 1, MPa."""
        return self.wheel.limb.pressures[1]

    def action(self, pressures: Any, speed: float) -> NDArray[np.float32]:
        """Return the action for wanted pressures (n,) or one for all, MPa, and a speed, rad/s.

        Raises InputError for a pressure below 0 or outside the fitted range, and for a speed beyond the drive's.
        """
        wanted = np.broadcast_to(np.asarray(pressures, dtype=float), (self._wanted,))
        self.wheel.limb.check_pressure(wanted)
        if wanted.min() < 0.0:
            raise InputError(f"pressure = {wanted.min() * 1e3:g} kPa, expected at least 0")
        if abs(speed) > self.drive.speed * (1.0 + 1e-9):
            raise InputError(f"speed = {speed:g} rad/s, expected at most {self.drive.speed:g} rad/s either way")
        shares = 2.0 * wanted / self.highest_pressure - 1.0
        return np.clip([*shares, speed / self.drive.speed], -1.0, 1.0).astype(np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Put the robot on the ground; return observation and info. Raises InputError for unknown options."""
        super().reset(seed=seed)
        unknown = sorted(set(options or {}) - {"pressure"})
        if unknown:
            raise InputError(f"reset: unknown options {', '.join(unknown)}, allowed: pressure")
        pressure = float((options or {}).get("pressure", 0.0))
        self._pressures[:] = pressure
        self._inflation.apply(self._model, self._pressures)
        rigid.engine().mj_resetData(self._model, self._data)
        x, y = self.np_random.uniform(-100.0, 100.0, 2)
        heading, turn = np.radians(self.np_random.uniform(-5.0, 5.0)), self.np_random.uniform(0.0, 2.0 * pi)
        far = hypot(*self.rover.reach)
        level = self.ground.highest((x - far, x + far), (y - far, y + far))
        z = level + 0.5 * self.wheel.height(pressure) + GAP
        data = self._data
        data.qpos[:3] = np.array([x, y, z]) * METRE
        data.qpos[3:7] = np.cos(0.5 * heading), 0.0, 0.0, np.sin(0.5 * heading)
        data.qpos[self._inflation.coordinates] = self._inflation.rest(self._pressures)
        data.qpos[self._model.jnt_qposadr[self._axles]] = turn
        data.act[:] = turn
        self._speed, self._started = 0.0, True
        rigid.engine().mj_forward(self._model, data)
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Go on by 0.05 s; return observation, reward, terminated, truncated and info.

        Raises InputError for an action of another shape, out of range or before `reset`, EngineError as the class says.
        """
        if not self._started:
            raise InputError("step: the environment is not started, call reset first")
        values = np.asarray(action, dtype=float)
        if values.shape != self.action_space.shape or not (np.abs(values) <= 1.0 + 1e-6).all():
            raise InputError(f"action = {action}: expected {self._wanted + 1} numbers from -1 to 1")
        wanted = 0.5 * (np.clip(values[:-1], -1.0, 1.0) + 1.0) * self.highest_pressure
        target = wanted.reshape(len(self._names), -1)
        drive, data, mujoco = self.drive, self._data, rigid.engine()
        before = data.qpos[0]
        share = 1.0 - exp(-_SUBSTEP / self.lag)
        steps = round(_SUBSTEP / drive.step)
        most = drive.speed / drive.ramp * _SUBSTEP
        for _ in range(round(INTERVAL / _SUBSTEP)):
            self._pressures += share * (target - self._pressures)
            self._inflation.apply(self._model, self._pressures)
            self._speed += float(np.clip(values[-1] * drive.speed - self._speed, -most, most))
            data.ctrl[:] = self._speed
            self._inflation.step(self._model, data, steps)
        rigid.check_state(data, data.time)
        mujoco.mj_forward(self._model, data)
        over = bool(data.xmat[self._model.body(BODY).id][8] < 0.0)
        far = hypot(*self.rover.reach)
        edge = np.array([0.5 * self.ground.length - far, 0.5 * self.ground.width - far])
        outside = bool((np.abs(data.qpos[:2]) / METRE > edge).any())
        late = data.time > self.duration - 0.5 * drive.step
        return self._observation(), float(data.qpos[0] - before), over, bool(outside or late), self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture (360, 640, 3) of the robot in the mode 'rgb_array', drawn in a process of its own.

        Raises EngineError where nothing can be drawn.
        """
        if self.render_mode is None:
            return None
        if self._painter is None:
            self._folder = tempfile.TemporaryDirectory(prefix="pneumorph-")
            model_file = Path(self._folder.name) / "robot.xml"
            model_file.write_text(self._text, encoding="utf-8")
            model_file.with_name(_GROUND_FILE).write_bytes(ground_bytes(self.ground))
            self._painter = Painter(model_file)
        self._painter.ask(self._data.qpos)
        return self._painter.take()

    def close(self) -> None:
        """End the process that draws."""
        if self._painter is not None and self._folder is not None:
            self._painter.close()
            self._folder.cleanup()
            self._painter = self._folder = None

    def _entries(self) -> tuple[list[str], list[float]]:
        """Return names and bounds of the observation's entries."""
        names, bounds = ["height [m]"], [10.0]
        names += [f"{kind} {axis} [{unit}]" for kind, unit in (("velocity", "m/s"), ("angular velocity", "rad/s"))
                  for axis in "xyz"]  # fmt: skip
        bounds += [20.0] * 3 + [100.0] * 3
        names += [f"up {axis}" for axis in "xyz"]
        bounds += [1.0] * 3
        names += [f"{part} of angle, {name}" for name in self._names for part in ("cosine", "sine")]
        bounds += [1.0] * 8
        names += [f"speed, {name} [rad/s]" for name in self._names] + ["wanted speed"]
        bounds += [_SPEED_SCALE * self.drive.speed] * 4 + [1.0]
        limbs = [f"{name} {number + 1}" for name in self._names for number in range(self.wheel.limbs)]
        pressures = [f"pressure, {name}" for name in (limbs if self.per_limb else self._names)]
        names += [*pressures, *(f"bending, {name} [rad]" for name in limbs)]
        return names, [*bounds, *[1.0] * len(pressures), *[2.0 * pi] * len(limbs)]

    def _observation(self) -> NDArray[np.float32]:
        data = self._data
        turned = data.qpos[self._model.jnt_qposadr[self._axles]]
        body = data.xmat[self._model.body(BODY).id].reshape(3, 3)
        pressures = self._pressures if self.per_limb else self._pressures[:, 0]
        values = np.concatenate(
            [
                [self._height() * METRE],
                body.T @ data.qvel[:3],
                data.qvel[3:6],  # of a free joint: already in the body's axes
                body[2],
                np.stack([np.cos(turned), np.sin(turned)], axis=1).ravel(),
                data.qvel[self._model.jnt_dofadr[self._axles]],
                [self._speed / self.drive.speed],
                pressures.ravel() / self.highest_pressure,
                self._inflation.bending(data).ravel(),
            ]
        )
        return np.clip(values.astype(np.float32), -self._bound, self._bound)

    def _height(self) -> float:
        """Return the height of the centre over the ground below, mm."""
        x, y, z = self._data.qpos[:3] / METRE
        return float(z - self.ground.at(x, y))

    def _info(self) -> dict[str, Any]:
        return {
            "place": self._data.qpos[:3] / METRE, "height": self._height(), "pressures": self._pressures.copy(),
        }  # fmt: skip


gymnasium.register(NAME, entry_point=f"{__name__}:SoftRover")
