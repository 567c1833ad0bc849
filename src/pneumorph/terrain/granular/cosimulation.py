"""A vehicle on a bed: MuJoCo moves the vehicle, LAMMPS the grains; they exchange poses and forces in every step.

In each step LAMMPS moves the grains and sums their forces; then the wheels' poses and speeds are read from MuJoCo, the
contacts of grains with the wheels' triangles are added to the forces on the grains, their opposites become the wrenches
on the wheels, and MuJoCo takes a step of the same length. So both always see the other's state of the same moment.
"""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain.granular.broad_phase import cell_lists
from pneumorph.terrain.granular.contact_kernels import shift_moments, wheel_forces
from pneumorph.terrain.granular.engine import Session
from pneumorph.terrain.granular.model import WHEEL_FILE, Vehicle, vehicle_mjcf
from pneumorph.terrain.granular.sands import Sand, damping_factor
from pneumorph.terrain.granular.settling import Settled, wake
from pneumorph.terrain.mjcf import BODY, CENTRE
from pneumorph.terrain.rigid import Way, engine, load
from pneumorph.terrain.rover import GRAVITY, Drive
from pneumorph.terrain.si import METRE

Array = NDArray[np.float64]

GAP = 2.0  # mm between the highest grain under the vehicle and the wheels
_OFF_END = 4.0  # largest radii between the vehicle and the end of the box
_MOST = 4096  # contacts of all wheels at a time
_DEEPEST = 0.5  # overlap of grain and wheel over the grain's radius from which on a run is not to be trusted


@dataclass(frozen=True)
class Friction:
    """Between wheel and grain: sliding and rolling coefficient, both given by the study. Wheels do not stick."""

    sliding: float = 0.55
    rolling: float = 0.37

    def __post_init__(self) -> None:
        for name in ("sliding", "rolling"):
            if not 0.0 <= getattr(self, name) < float("inf"):
                raise InputError(f"friction: {name} = {getattr(self, name):g}, expected at least 0")


@dataclass(frozen=True, eq=False)
class Energies:
    """Where the work goes, mJ, at n moments; each (n,), sums since the start.

    motor: of the controllers on the hinges. vehicle: growth of the vehicle's kinetic and potential energy. to_grains:
    work that the vehicle gives off at the wheels. on_grains: what of it arrives in the grains; the rest was lost by
    sliding, rolling and impacts between wheels and grains, but for a little that their springs hold. grains_kinetic,
    grains_potential: growth of the grains' energy; what is left of on_grains is lost between grains or held in their
    elastic contacts.
    """

    motor: Array
    vehicle: Array
    to_grains: Array
    on_grains: Array
    grains_kinetic: Array
    grains_potential: Array

    @property
    def vehicle_error(self) -> Array:
        """(n,), mJ: motor work that is neither in the vehicle nor given off, which ought to be none."""
        return self.motor - self.vehicle - self.to_grains

    @property
    def lost_at_wheels(self) -> Array:
        """(n,), mJ: lost between wheels and grains."""
        return self.to_grains - self.on_grains

    @property
    def lost_in_grains(self) -> Array:
        """(n,), mJ: lost between grains, or held elastically."""
        return self.on_grains - self.grains_kinetic - self.grains_potential


@dataclass(frozen=True, eq=False)
class GranularTravel(Way):
    """The way of a vehicle over grains; its centre is at the height of the axles.

    load (n,), N, the upward force of the grains on all wheels, mean over the time since the moment before; energies:
    where the work went.
    level: of the bed's surface before the run, mm. radius: of the wheels, mm.
    deepest: overlap of grain and wheel over the grain's radius, the most. places (grains, 3), radii (grains,): the bed
    after the run, mm. wall, steps: time that LAMMPS's run took, s, and its steps.
    """

    load: Array
    energies: Energies
    level: float
    radius: float
    deepest: float
    places: Array
    radii: Array
    wall: float
    steps: int

    def ride_height(self, since: float) -> float:
        """Return the mean height of the axles over the bed's surface as it was, mm, from a time (s) on."""
        return float(self.centre[self.time >= since - 1e-9, 2].mean() - self.level)

    def sinkage(self, since: float) -> float:
        """Return how deep a circle around the wheels reaches into the bed as it was, mm, mean from a time (s) on."""
        return self.radius - self.ride_height(since)


def check_drive(bed_step: float, drive: Drive) -> None:
    """Raise InputError where the drive's step is not that of the bed."""
    if abs(drive.step - bed_step) > 1e-12:
        raise InputError(f"drive: step = {drive.step:g} s, but the bed was settled with {bed_step:g} s: expected equal")


def start_place(still: Settled, vehicle: Vehicle, places: Array, radii: Array) -> tuple[float, float, float]:
    """Return where the vehicle's centre starts, mm: near the box's end, in its middle, the wheels just over grains.

    Wheels count as cylinders. The distance from the end keeps off grains that stick to the wall.
    """
    radius, half = vehicle.surface.radius, 0.5 * vehicle.surface.width
    x, y = vehicle.reach[0] + _OFF_END * still.bed.largest_radius, 0.5 * still.bed.width
    centre = still.level + radius
    for along, aside in vehicle.axles:
        away = np.abs(places[:, 0] - x - along)
        under = (away < radius + radii) & (np.abs(places[:, 1] - y - aside) < half + radii)
        if under.any():
            above = ((radius + radii[under]) ** 2 - away[under] ** 2) ** 0.5
            centre = max(centre, float((places[under, 2] + above).max()))
    return x, y, centre + GAP


def drive_over(
    still: Settled,
    vehicle: Vehicle,
    drive: Drive,
    friction: Friction | None = None,
    listen: Callable[[float], None] | None = None,
) -> GranularTravel:
    """Drive a vehicle over a settled bed and return its way; listen(time) is called at each recorded moment.

    Raises InputError for grains too large for the wheels, a vehicle that the box is too small for, a step that is not
    the bed's; EngineError where an engine is missing, or the run is unstable or leaves the box.
    """
    vehicle.surface.check_grains(still.bed)
    vehicle.check_box(still.bed.length, still.bed.width, drive)
    check_drive(still.bed.step, drive)
    with Session() as session:
        wake(session, still)
        run = _Run(session, still, vehicle, drive, friction or Friction(), listen)
        session.commands("fix wheels all external pf/callback 1 1")
        session.call_each_step("wheels", run.step)
        steps = round(drive.duration / drive.step)
        start = clock.perf_counter()
        session.commands(f"run {steps} post no")
        return run.travel(clock.perf_counter() - start, steps)


class _Run:
    """The two engines in step."""

    def __init__(
        self,
        session: Session,
        still: Settled,
        vehicle: Vehicle,
        drive: Drive,
        friction: Friction,
        listen: Callable[[float], None] | None,
    ) -> None:
        self._session, self._drive, self._still, self._listen = session, drive, still, listen
        self._vehicle = vehicle
        self._mujoco = engine()
        self._mujoco.set_mju_user_warning(_ignore)
        places, radii = session.gathered("x", 3) / METRE, session.gathered("radius", 1) / METRE
        start = start_place(still, vehicle, places, radii)
        text = vehicle_mjcf(vehicle, drive, start)
        self._model = load(text, {WHEEL_FILE: vehicle.surface.stl()})
        self._data = self._mujoco.MjData(self._model)
        self._bodies = [self._model.body(name).id for name in vehicle.wheels]
        joints = [self._model.joint(name) for name in vehicle.wheels]
        self._angles = np.array([joint.qposadr[0] for joint in joints])
        self._speeds = np.array([joint.dofadr[0] for joint in joints])
        self._robot = self._model.body(BODY).id
        self._twist = np.zeros(6)
        self._surface(vehicle, still)
        self._law = law(still.bed.sand, friction)
        wheels = len(self._bodies)
        tags = still.bed.grains + 1
        self._first, self._number = np.zeros((wheels, tags), np.int32), np.zeros((wheels, tags), np.int32)
        self._old, self._new = np.zeros((_MOST, 9)), np.zeros((_MOST, 9))
        self._old_owner, self._new_owner = np.zeros((_MOST, 3), np.int64), np.zeros((_MOST, 3), np.int64)
        self._acting, self._total = np.zeros((_MOST, 6)), 0
        self._wrench = np.zeros((wheels, 6))
        self._centre, self._turn = np.zeros((wheels, 3)), np.zeros((wheels, 3, 3))
        self._velocity, self._spin = np.zeros((wheels, 3)), np.zeros((wheels, 3))
        self._deepest, self._lifted = 0.0, 0.0
        self._motor = self._given = self._taken = 0.0
        self._first_energies: tuple[float, float, float] | None = None
        self._before: tuple[Array, Array, Array] | None = None
        self._rows: list[tuple[Any, ...]] = []
        self._every = round(drive.record / drive.step)
        self._last = round(drive.duration / drive.step)

    def _surface(self, vehicle: Vehicle, still: Settled) -> None:
        corners = np.ascontiguousarray(vehicle.surface.points[vehicle.surface.triangles]) * METRE
        middle = corners.mean(axis=1)
        around = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
        self._corners, self._spheres = corners, np.column_stack([middle, around])
        self._cells = cell_lists(corners, still.bed.largest_radius * METRE)
        self._reach = float(np.linalg.norm(corners, axis=2).max())

    def step(self, step: int) -> None:
        """Exchange and advance MuJoCo, at a moment of which LAMMPS has all other forces."""
        mujoco, model, data, drive = self._mujoco, self._model, self._data, self._drive
        data.ctrl[:] = drive.wanted_speed(step * drive.step)
        mujoco.mj_step1(model, data)
        self._read_wheels()
        self._account()
        grains = {name: self._session.per_grain(name) for name in ("x", "v", "omega", "f", "torque")}
        radii, mass, tag = (self._session.per_grain(name) for name in ("radius", "rmass", "id"))
        self._total, deepest, power, dropped = wheel_forces(
            grains["x"], grains["v"], grains["omega"], radii, mass, tag, grains["f"], grains["torque"],
            self._centre, self._turn, self._velocity, self._spin,
            self._reach, self._corners, self._spheres, self._cells.origin, self._cells.size, self._cells.counts,
            self._cells.starts, self._cells.triangles,
            self._cells.nearest,
            self._law, drive.step, self._first, self._number, self._old, self._old_owner, self._total,
            self._new, self._new_owner, self._acting, self._wrench,
        )  # fmt: skip
        self._old, self._new = self._new, self._old
        self._old_owner, self._new_owner = self._new_owner, self._old_owner
        if dropped:
            raise EngineError(f"more than {_MOST} contacts with the wheels: too fine grains for this program")
        self._deepest = max(self._deepest, deepest)
        if deepest > _DEEPEST or not np.isfinite(self._wrench).all():
            raise EngineError(
                f"unstable before {step * drive.step:g} s: a grain overlaps a wheel by {deepest:.2f} of its radius"
            )
        self._lifted += float(self._wrench[:, 2].sum())
        if step % self._every == 0:
            self._record(step, grains, mass, radii)
        if step == self._last:
            return
        self._taken += power * drive.step
        self._before = (self._wrench.copy(), self._velocity.copy(), self._spin.copy())
        data.xfrc_applied[self._bodies] = self._wrench
        # MuJoCo takes wrenches about the centre of mass of the body
        shift_moments(data.xfrc_applied, data.xipos, data.xpos)
        self._torque = data.actuator_force.copy()
        mujoco.mj_step2(model, data)

    def _read_wheels(self) -> None:
        mujoco, model, data = self._mujoco, self._model, self._data
        for i, body in enumerate(self._bodies):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, self._twist, 0)
            self._spin[i], self._velocity[i] = self._twist[:3], self._twist[3:]
        self._centre[:] = data.xpos[self._bodies]
        self._turn[:] = data.xmat[self._bodies].reshape(-1, 3, 3)
        self._hinge_speed = data.qvel[self._speeds]

    def _account(self) -> None:
        """Add the works of the step that has just ended, with the mean of the speeds before and after it."""
        if self._before is None:
            self._hinge_before = self._hinge_speed
            return
        wrench, velocity, spin = self._before
        dt = self._drive.step
        given = (wrench[:, :3] * (velocity + self._velocity)).sum() + (wrench[:, 3:] * (spin + self._spin)).sum()
        self._given -= 0.5 * dt * float(given)
        mean = 0.5 * (self._hinge_before + self._hinge_speed)
        damping = self._drive.damping * METRE  # N mm s -> N m s
        self._motor += dt * float((self._torque * mean - damping * self._hinge_speed * mean).sum())
        self._hinge_before = self._hinge_speed

    def _record(self, step: int, grains: dict[str, Array], mass: Array, radii: Array) -> None:
        data, time = self._data, step * self._drive.step
        _check(self._mujoco, data, time, self._still, data.sensor(CENTRE).data, self._vehicle)
        speed = (grains["v"] ** 2).sum(axis=1) + 0.4 * radii**2 * (grains["omega"] ** 2).sum(axis=1)
        kinetic = 0.5 * float(mass @ speed)
        potential = GRAVITY * METRE * float(mass @ grains["x"][:, 2])
        energies = (float(data.energy.sum()), kinetic, potential)
        if self._first_energies is None:
            self._first_energies = energies
        grown = np.subtract(energies, self._first_energies)
        steps = 1 if not self._rows else self._every
        self._rows.append(
            (
                time, data.sensor(CENTRE).data / METRE, data.xmat[self._robot][8], data.qpos[self._angles],
                data.qvel[self._speeds], data.qpos.copy(), self._lifted / steps,
                np.array([self._motor, grown[0], self._given, self._taken, grown[1], grown[2]]) * 1e3,
            )
        )  # fmt: skip
        self._lifted = 0.0
        if self._listen is not None:
            self._listen(time)

    def travel(self, wall: float, steps: int) -> GranularTravel:
        """Return what was recorded."""
        time, centre, upright, turn, speed, pose, lifted, energy = (np.array(c) for c in zip(*self._rows, strict=True))
        return GranularTravel(
            time, centre, upright, turn, speed, pose, lifted, Energies(*energy.T), self._still.level,
            self._vehicle.surface.radius, self._deepest, self._session.gathered("x", 3) / METRE,
            self._session.gathered("radius", 1) / METRE, wall, steps,
        )  # fmt: skip


def law(sand: Sand, friction: Friction) -> tuple[float, ...]:
    """Return the numbers of the contact of wheel and grain, SI: the wheel counts as a grain without curvature.

    Its damping is that of the sand's restitution, also for sticky sand.
    """
    return (
        sand.effective_modulus * 1e6, sand.effective_shear_modulus * 1e6, damping_factor(sand.restitution),
        friction.sliding, friction.rolling, sand.rolling_stiffness * 1e3, sand.rolling_damping * 1e3,
    )  # fmt: skip


def write_model(folder: Path, name: str, text: str, surface: bytes) -> None:
    """Write a model and its wheel so that MuJoCo's own viewer opens it."""
    (folder / f"{name}.xml").write_text(text.replace(f'"{WHEEL_FILE}"', f'"{name}.stl"'), encoding="utf-8")
    (folder / f"{name}.stl").write_bytes(surface)


def _ignore(message: str) -> None:
    """Take a warning of MuJoCo; what matters is counted in its data."""


def _check(mujoco: Any, data: Any, time: float, still: Settled, centre: Array, vehicle: Vehicle) -> None:
    for kind in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC):
        if data.warning[int(kind)].number:
            raise EngineError(f"unstable before {time:g} s: {kind.name.removeprefix('mjWARN_')} in MuJoCo")
    x, y = centre[:2] / METRE
    reach = 0.5 * vehicle.surface.radius  # as long as the larger part of the wheels is over the grains
    if not (reach < x < still.bed.length - reach and 0.0 < y < still.bed.width):
        raise EngineError(f"left the bed before {time:g} s")
