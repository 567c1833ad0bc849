"""Pressures of soft wheels in a compiled MuJoCo model: they change the springs of the limbs' hinges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.terrain.rigid import engine
from pneumorph.terrain.si import NEWTON_METRE
from pneumorph.terrain.soft_wheel import SoftWheel

Array = NDArray[np.float64]


class Inflation:
    """Sets the pressures of the limbs of a compiled model, none at first, by changing the springs of their hinges.

    wheels: prefixes of the wheels' hinges in the model. Arrays of pressures have the shape (wheels, limbs), MPa.
    """

    def __init__(self, model: Any, wheel: SoftWheel, wheels: Sequence[str]):
        count = len(wheel.limb.hinges)
        joints = np.array(
            [
                [[model.joint(f"{name}.{k + 1}.{h + 1}").id for h in range(count)] for k in range(wheel.limbs)]
                for name in wheels
            ]
        )
        self.wheel, self.joints = wheel, joints
        self._mujoco = engine()
        self.coordinates, self.speeds = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
        self._side = -1.0 if wheel.mirrored else 1.0
        self.apply(model, np.zeros(joints.shape[:2]))

    def rest(self, pressures: Array) -> Array:
        """Return the coordinates (wheels, limbs, n) of the hinges without load, rad; raises InputError."""
        return self._side * self.wheel.limb.rest_angles(pressures)

    def apply(self, model: Any, pressures: Array) -> None:
        """Change the springs of a model; raises InputError for a pressure outside the fitted range."""
        self._springs = self.wheel.limb.springs(pressures)
        self._touching = np.zeros(self.joints.shape, bool)
        self._write(model, self._springs.rest)

    def step(self, model: Any, data: Any, count: int) -> None:
        """Make time steps; before each, hinges whose pleats begin or cease to touch get the spring that then holds."""
        if not self.wheel.limb.stop_stiffness.any():
            self._mujoco.mj_step(model, data, count)
            return
        for _ in range(count):
            angles = self._side * data.qpos[self.coordinates]
            touching = angles < self._springs.stop
            if (touching != self._touching).any():
                self._touching = touching
                self._write(model, angles)
            self._mujoco.mj_step(model, data)

    def _write(self, model: Any, angles: Array) -> None:
        """Write the straight lines of the laws on which angles lie."""
        stiffness, rest = self._springs.as_lines(angles)
        model.qpos_spring[self.coordinates] = self._side * rest
        model.jnt_stiffness[self.joints] = NEWTON_METRE * stiffness
        model.dof_damping[self.speeds] = self.wheel.relaxation * NEWTON_METRE * stiffness

    def bending(self, data: Any) -> Array:
        """Return how far each limb's end has turned against its unloaded shape, (wheels, limbs), rad."""
        return np.asarray(self._side * data.qpos[self.coordinates].sum(axis=-1))
