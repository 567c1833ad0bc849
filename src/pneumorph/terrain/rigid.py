"""Rigid terrain in MuJoCo: runs a robot's MJCF and records its way; the only module that imports MuJoCo.

MuJoCo works in m, kg, s; what is returned is in mm, s, rad.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain.mjcf import BODY, CENTRE, GROUND
from pneumorph.terrain.rover import Drive

Array = NDArray[np.float64]

EXTRA = "terrain"
_MILLIMETRE = 1e3


@dataclass(frozen=True, eq=False)
class Way:
    """The way of a robot at n recorded moments, on any ground.

    time: (n,), s. centre: (n, 3), mm, the robot's centre. upright: (n,), the vertical part of its upward direction,
    1 level and negative upside down. turn, turn_speed: (n, wheels), rad and rad/s. pose: (n, coordinates), MuJoCo's.
    """

    time: Array
    centre: Array
    upright: Array
    turn: Array
    turn_speed: Array
    pose: Array

    @property
    def distance(self) -> float:
        """How far the centre moved forward, along x, from the first moment to the last, mm."""
        return float(self.centre[-1, 0] - self.centre[0, 0])

    @property
    def sideways(self) -> float:
        """How far the centre moved along y, mm."""
        return float(self.centre[-1, 1] - self.centre[0, 1])


@dataclass(frozen=True, eq=False)
class Travel(Way):
    """The way of a robot on rigid ground; penetration: the deepest overlap of both at these moments, mm."""

    penetration: float

    @property
    def as_the_crow_flies(self) -> float:
        """Horizontal distance, mm, between first and last place of the centre."""
        return float(np.hypot(self.distance, self.sideways))


def engine() -> Any:
    """Return the module mujoco; raises EngineError, with what to install, where it is missing or broken."""
    try:
        import mujoco
    except ImportError as error:
        raise EngineError(f"MuJoCo is missing ({error}): pip install 'pneumorph[{EXTRA}]'") from error
    mujoco.set_mju_user_warning(_ignore)  # else MuJoCo writes MUJOCO_LOG.TXT; `check_state` reads its counters
    return mujoco


def load(source: Path | str, assets: Mapping[str, bytes] | None = None) -> Any:
    """Return the compiled model of an MJCF file, or of an MJCF text with the contents of its files by name.

    Raises EngineError where MuJoCo is missing or refuses the model.
    """
    mujoco = engine()
    try:
        if assets is None:
            return mujoco.MjModel.from_xml_path(str(source))
        return mujoco.MjModel.from_xml_string(str(source), dict(assets))
    except ValueError as error:
        raise EngineError(f"MuJoCo refuses the model: {error}") from error


def simulate(model: Any, drive: Drive) -> Travel:
    """Run a robot's model from its start and return its way.

    The hinges' wanted speed is set in each step while it grows. Raises InputError where the model's time step is not
    that of the drive, EngineError where MuJoCo reports an instability or the robot leaves the ground's rectangle.
    """
    mujoco = engine()
    if abs(model.opt.timestep - drive.step) > 1e-12:
        raise InputError(f"drive: step = {drive.step:g} s, but the model was built for {model.opt.timestep:g} s")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    driven = model.actuator_trnid[:, 0]  # not the hinges inside soft wheels
    hinges, speeds = model.jnt_qposadr[driven], model.jnt_dofadr[driven]
    body = model.body(BODY).id
    size = model.hfield_size[model.geom(GROUND).dataid[0]]
    block, moments = round(drive.record / drive.step), round(drive.duration / drive.record)
    rows: list[tuple[Any, ...]] = []
    deepest = 0.0
    for moment in range(moments + 1):
        if moment > 0:
            first = (moment - 1) * block
            if first * drive.step < drive.ramp:
                for number in range(first, first + block):
                    data.ctrl[:] = drive.wanted_speed(number * drive.step)
                    mujoco.mj_step(model, data)
            else:
                data.ctrl[:] = drive.speed
                mujoco.mj_step(model, data, block)
        time = moment * drive.record
        centre = data.sensor(CENTRE).data
        check_state(data, time)
        if abs(centre[0]) > size[0] or abs(centre[1]) > size[1]:
            raise EngineError(f"left the terrain before {time:g} s")
        if data.ncon:
            deepest = max(deepest, -float(data.contact.dist.min()))
        rows.append(
            (time, centre * _MILLIMETRE, data.xmat[body][8], data.qpos[hinges], data.qvel[speeds], data.qpos.copy())
        )
    time_, centre_, upright, turn, speed, pose = (np.array(column) for column in zip(*rows, strict=True))
    return Travel(time_, centre_, upright, turn, speed, pose, deepest * _MILLIMETRE)


def _ignore(message: str) -> None:
    """Take a warning of MuJoCo; what matters is counted in its data."""


def check_state(data: Any, time: float) -> None:
    """Raise EngineError where the state of a robot at a time (s) is not to be trusted."""
    kinds = engine().mjtWarning
    for kind in (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC, kinds.mjWARN_BADCTRL):
        if data.warning[int(kind)].number:
            raise EngineError(f"unstable before {time:g} s: {kind.name.removeprefix('mjWARN_')} in MuJoCo")
    if not np.isfinite(data.qpos).all():
        raise EngineError(f"unstable before {time:g} s: the robot's place is no number")


def draw(
    model: Any, poses: Iterable[Array], width: int, height: int, view: Mapping[str, float]
) -> Iterator[NDArray[np.uint8]]:
    """Yield a picture (height, width, 3) for each pose; the camera follows the robot.

    view: distance (m), azimuth and elevation (deg). Needs OpenGL: call it by `drawing.pictures`, which sets it up.
    """
    mujoco = engine()
    data, camera = mujoco.MjData(model), mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.distance, camera.azimuth, camera.elevation = view["distance"], view["azimuth"], view["elevation"]
    looked_at = np.full(3, np.nan)
    with mujoco.Renderer(model, height, width) as renderer:
        for pose in poses:
            data.qpos[:] = pose
            mujoco.mj_forward(model, data)
            place = data.body(BODY).xpos
            # sideways and ahead the camera goes with the robot, up and down slowly: else hops would not show
            level = place[2] if np.isnan(looked_at[2]) else 0.9 * looked_at[2] + 0.1 * place[2]
            looked_at = np.array([*place[:2], level])
            camera.lookat[:] = looked_at
            renderer.update_scene(data, camera)
            yield renderer.render().copy()
