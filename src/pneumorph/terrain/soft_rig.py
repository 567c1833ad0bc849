"""Static load tests of the reduced limb in MuJoCo: a force on its tip, and a wheel pressed on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any
from xml.etree import ElementTree as xml

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain.inflation import Inflation
from pneumorph.terrain.mjcf import GROUND
from pneumorph.terrain.rigid import engine, load
from pneumorph.terrain.rover import GRAVITY
from pneumorph.terrain.si import KILOGRAM, METRE, text
from pneumorph.terrain.soft_wheel import SoftWheel, add_limb
from pneumorph.units import show

Array = NDArray[np.float64]

HUB_BODY = "wheel"
_STEP = 0.001
_PATIENCE = 60.0  # s of simulated time in which a rig must come to rest
_AT_REST = 1e-4  # rad/s or m/s
_LIMB_MASS = 10e-6  # of the rig without gravity: it does not matter for the result


def loaded_tip(wheel: SoftWheel, pressure: float, force: Sequence[float]) -> tuple[Array, float]:
    """Return where a tip force (2,) brings the load point of a single limb (2,), mm, and the last link's turn, rad.

    Axes are the limb's; there is no gravity. Raises InputError for a pressure out of range, EngineError where the limb
    does not come to rest.
    """
    wheel = replace(wheel, mirrored=False)
    root, hub = _root(gravity=0.0)
    add_limb(hub, wheel, _LIMB_MASS, 0.0, f"{HUB_BODY}.1")
    x, y, angle = wheel.limb.mount
    direction = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ np.asarray(force)
    actuators = xml.SubElement(root, "actuator")
    # with a reference site of the world the force keeps its direction
    xml.SubElement(
        actuators,
        "general",
        site=f"{HUB_BODY}.1.load",
        refsite="world",
        gear=text(direction[0], 0, -direction[1], 0, 0, 0),
    )
    model = load(xml.tostring(root, encoding="unicode"), {})
    inflation = Inflation(model, replace(wheel, limbs=1), [HUB_BODY])
    data = _settle(model, inflation, pressure, control=1.0)
    place = data.site(f"{HUB_BODY}.1.load").xpos / METRE
    turned = np.array([place[0] - x, -place[2] - y])
    back = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return back @ turned, float(inflation.bending(data)[0, 0])


@dataclass(frozen=True)
class Stand:
    """A wheel that stands on level ground: height of its axle, mm, unloaded and loaded; force of the ground, N; deepest
    overlap with the ground, mm; whether it touches the ground with feet only."""

    unloaded: float
    loaded: float
    force: float
    overlap: float
    on_foot: bool

    @property
    def sink(self) -> float:
        """How far the load lowers the axle by bending limbs, mm: the overlap is MuJoCo's contact, not the limb's."""
        return self.unloaded - self.loaded - self.overlap


def pressed_wheel(wheel: SoftWheel, pressure: float, weight: float, inwards: float) -> Stand:
    """Return how a wheel stands that does not turn and is pressed on frictionless ground by a weight, N.

    inwards: direction of the ground's force in the axes of the first limb, rad: the wheel is turned until it points
    upwards. Raises InputError for a weight that is not positive and as `loaded_tip`.
    """
    if not 0.0 < weight < float("inf"):
        raise InputError(f"weight on the wheel = {show(weight, 'force')}, expected more than 0")
    wheel = replace(wheel, mirrored=False)
    # the plane's y points down: upwards is -pi / 2
    turned = -0.5 * pi - inwards - wheel.limb.mount[2]
    unloaded = max(
        float((np.sin(a) * outline[:, 0] + np.cos(a) * outline[:, 1]).max())
        for outline in [wheel.outline(pressure)]
        for a in turned + 2.0 * pi * np.arange(wheel.limbs) / wheel.limbs
    )
    root, hub = _root(gravity=GRAVITY * METRE, height=unloaded + 1.0)
    xml.SubElement(hub, "joint", name="axle", type="slide", axis="0 0 1")
    limbs = 0.2 * weight / GRAVITY
    for number in range(wheel.limbs):
        add_limb(hub, wheel, limbs / wheel.limbs, turned + 2.0 * pi * number / wheel.limbs, f"{HUB_BODY}.{number + 1}")
    xml.SubElement(
        hub, "geom", type="sphere", size=text(wheel.hub_radius * METRE), mass=text(0.8 * weight / GRAVITY * KILOGRAM)
    )
    model = load(xml.tostring(root, encoding="unicode"), {})
    inflation = Inflation(model, wheel, [HUB_BODY])
    data = _settle(model, inflation, pressure)
    mujoco, total = engine(), 0.0
    for number in range(data.ncon):
        force = np.zeros(6)
        mujoco.mj_contactForce(model, data, number, force)
        total += float(force[0])
    overlap = -float(data.contact.dist.min()) if data.ncon else 0.0
    feet = [model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CYLINDER for geom in data.contact.geom.max(axis=1)]
    return Stand(unloaded, float(data.body(HUB_BODY).xpos[2]) / METRE, total, overlap / METRE, bool(feet) and all(feet))


def _root(gravity: float, height: float = 0.0) -> tuple[xml.Element, xml.Element]:
    """Return a model with a ground plane at z = 0 that limbs touch without friction, and the body of a hub."""
    root = xml.Element("mujoco", model="static load test")
    xml.SubElement(root, "compiler", angle="radian")
    xml.SubElement(root, "option", timestep=text(_STEP), gravity=text(0, 0, -gravity), integrator="implicitfast")
    default = xml.SubElement(root, "default")
    xml.SubElement(default, "geom", contype="0", conaffinity="1", condim="1")
    xml.SubElement(default, "joint", axis="0 1 0")
    world = xml.SubElement(root, "worldbody")
    xml.SubElement(world, "site", name="world")
    if gravity:
        xml.SubElement(world, "geom", name=GROUND, type="plane", size="1 1 0.1", contype="1", conaffinity="0")
    return root, xml.SubElement(world, "body", name=HUB_BODY, pos=text(0, 0, height * METRE))


def _settle(model: Any, inflation: Inflation, pressure: float, control: float = 0.0) -> Any:
    """Return the state at rest, from the unloaded shape; raises EngineError where it does not come to rest."""
    mujoco = engine()
    pressures = np.full(inflation.joints.shape[:2], pressure)
    inflation.apply(model, pressures)
    data = mujoco.MjData(model)
    data.qpos[inflation.coordinates] = inflation.rest(pressures)
    data.ctrl[:] = control
    while data.time < _PATIENCE:
        inflation.step(model, data, round(0.5 / _STEP))
        if np.abs(data.qvel).max() < _AT_REST and np.isfinite(data.qpos).all():
            mujoco.mj_forward(model, data)
            return data
    raise EngineError(f"the limb did not come to rest in {_PATIENCE:g} s at {show(pressure, 'pressure')}")
