"""The robot: a box on four wheels, each on a hinge of its own, and how the hinges are driven."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import Generic, TypeVar

from pneumorph.errors import InputError
from pneumorph.terrain.soft_wheel import SoftWheel
from pneumorph.terrain.wheels import Wheel
from pneumorph.units import show

GRAVITY = 9_810.0  # mm/s2
W = TypeVar("W", Wheel, SoftWheel)


@dataclass(frozen=True)
class Rover(Generic[W]):
    """Four equal wheels at the corners of `wheelbase` (x) by `track` (y) around a box; mm and tonne.

    mass is that of the whole robot, of which each wheel has `wheel_mass`; the axles lie at half the box's height.
    Given by the study: mass and number of wheels. Assumed: all other numbers.

    Raises InputError for dimensions and masses that are not positive, wheels that weigh as much as the robot, and
    wheels larger than the track or the wheelbase leave room for.
    """

    wheel: W
    mass: float = 500e-6
    wheel_mass: float = 50e-6
    wheelbase: float = 600.0
    track: float = 400.0
    length: float = 600.0
    width: float = 300.0
    height: float = 60.0

    def __post_init__(self) -> None:
        for name, kind in (
            ("mass", "mass"), ("wheel_mass", "mass"), ("wheelbase", "length"), ("track", "length"),
            ("length", "length"), ("width", "length"), ("height", "length"),
        ):  # fmt: skip
            if not 0.0 < getattr(self, name) < float("inf"):
                raise InputError(f"rover: {name} = {show(getattr(self, name), kind)}, expected more than 0")
        if 4.0 * self.wheel_mass >= self.mass:
            raise InputError(
                f"rover: wheel_mass = {show(self.wheel_mass, 'mass')}, expected less than a quarter of the mass, "
                f"{show(0.25 * self.mass, 'mass')}"
            )
        room = self.track - self.width
        if self.wheel.width >= room:
            raise InputError(
                f"rover: the wheels are larger than the track: width {show(self.wheel.width, 'length')}, expected less "
                f"than {show(room, 'length')} (track {show(self.track, 'length')} less the body between the wheels)"
            )
        if 2.0 * self.wheel.radius >= self.wheelbase:
            raise InputError(
                f"rover: the wheels are larger than the wheelbase: diameter {show(2.0 * self.wheel.radius, 'length')}, "
                f"expected less than {show(self.wheelbase, 'length')}, or front and rear wheels meet"
            )
        if self.height >= 2.0 * self.wheel.radius:
            raise InputError(
                f"rover: height = {show(self.height, 'length')}, expected less than the wheels' diameter, "
                f"{show(2.0 * self.wheel.radius, 'length')}, or the body lies on the ground"
            )

    @property
    def corners(self) -> tuple[tuple[str, float, float], ...]:
        """Name, x and y of each wheel's hinge."""
        x, y = 0.5 * self.wheelbase, 0.5 * self.track
        return (("front_left", x, y), ("front_right", x, -y), ("rear_left", -x, y), ("rear_right", -x, -y))

    @property
    def reach(self) -> tuple[float, float]:
        """How far the robot reaches from its centre along x and y, mm."""
        return (
            max(0.5 * self.wheelbase + self.wheel.radius, 0.5 * self.length),
            0.5 * self.track + 0.5 * self.wheel.width,
        )


@dataclass(frozen=True)
class Drive:
    """How a run is driven and computed; mm, N, s, rad.

    speed, ramp: the hinges' wanted speed grows linearly from 0 to `speed` over `ramp`; duration: simulated time.
    stiffness:   proportional gain of the controller on the angle that the hinge is behind, N mm/rad.
    damping:     of the hinge, N mm s/rad: the controller's derivative part.
    friction:    sliding (-), torsional (m) and rolling (m) coefficient, as MuJoCo takes them; with a contact dimension
                 of 3 only the first one acts.
    step:        time step; record: time between recorded moments, a whole number of steps.

    Given by the study: all but the stiffness. Raises InputError for numbers out of range.
    """

    speed: float = 2.0 * pi
    ramp: float = 1.0
    duration: float = 10.5
    stiffness: float = 10_000.0
    damping: float = 200.0
    friction: tuple[float, float, float] = field(default=(0.6, 0.005, 0.2))
    contact_dimension: int = 3
    step: float = 0.002
    record: float = 0.05

    def __post_init__(self) -> None:
        for name in ("speed", "ramp", "duration", "stiffness", "step", "record"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise InputError(f"drive: {name} = {getattr(self, name):g}, expected more than 0")
        if not 0.0 <= self.damping < float("inf"):
            raise InputError(f"drive: damping = {self.damping:g}, expected at least 0")
        if len(self.friction) != 3 or not all(0.0 <= value < float("inf") for value in self.friction):
            raise InputError(f"drive: friction = {self.friction}, expected three numbers of at least 0")
        if self.contact_dimension not in (1, 3, 4, 6):
            raise InputError(f"drive: contact_dimension = {self.contact_dimension}, expected 1, 3, 4 or 6")
        for name, parts in (("record", self.step), ("duration", self.record)):
            ratio = getattr(self, name) / parts
            if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-6:
                raise InputError(
                    f"drive: {name} = {getattr(self, name):g} s, expected a whole number of times {parts:g} s"
                )

    def wanted_speed(self, time: float) -> float:
        """Return the hinges' wanted speed, rad/s, at a time."""
        return self.speed * min(time / self.ramp, 1.0)

    @property
    def wanted_turn(self) -> float:
        """The angle, rad, by which the wanted speed turns the hinges over the whole run."""
        ramp = min(self.ramp, self.duration)
        return self.speed * (self.duration - ramp + 0.5 * ramp**2 / self.ramp)
