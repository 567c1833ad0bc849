"""The robot on a bed as MJCF: the rover with meshes as wheels, or one wheel in a rig; only grains touch them.

The models are in SI units, MuJoCo's own viewer opens them.
"""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as xml

import numpy as np

from pneumorph.errors import InputError
from pneumorph.terrain.granular.wheel_surface import WheelSurface
from pneumorph.terrain.height_field import HeightField
from pneumorph.terrain.mjcf import BODY, GROUND, mjcf
from pneumorph.terrain.rover import Drive, Rover
from pneumorph.terrain.si import KILOGRAM, METRE, text
from pneumorph.terrain.wheels import Wheel
from pneumorph.units import show

WHEEL_FILE = "wheel.stl"
_SLIP = 1.25  # a wheel that rolls freely goes at most this much farther than one on grains is taken to


@dataclass(frozen=True)
class Vehicle:
    """What drives over a bed: wheels of one surface under a body, mm and tonne.

    single: only one wheel under a quarter of the robot's mass, that slides forward and up and down but does not turn
    aside or tip: a rig for small beds. Else four wheels at the corners of wheelbase and track.

    Given by the study: 500 g with four wheels. Assumed: all other numbers; the rover is as short as the wheels allow,
    so that it can travel far in a box of 4 m.

    Raises InputError where wheels and body do not fit each other (see `Rover`).
    """

    surface: WheelSurface
    single: bool = False
    mass: float = 500e-6
    wheel_mass: float = 50e-6
    wheelbase: float = 300.0
    track: float = 320.0
    length: float = 300.0
    width: float = 200.0
    height: float = 40.0

    def __post_init__(self) -> None:
        _ = self.rover

    @property
    def rover(self) -> Rover:
        """The rover with plain wheels of the size of the surface."""
        stand_in = Wheel(0, radius=self.surface.radius, width=self.surface.width)
        return Rover(
            stand_in, self.mass, self.wheel_mass, self.wheelbase, self.track, self.length, self.width, self.height
        )

    @property
    def wheels(self) -> tuple[str, ...]:
        """Names of the wheels' bodies and hinges."""
        corners = tuple(name for name, _, _ in self.rover.corners)
        return corners[:1] if self.single else corners

    @property
    def axles(self) -> tuple[tuple[float, float], ...]:
        """Where the wheels stand (x, y) about the vehicle's centre, mm."""
        return ((0.0, 0.0),) if self.single else tuple((x, y) for _, x, y in self.rover.corners)

    @property
    def reach(self) -> tuple[float, float]:
        """How far it reaches from its centre along x and y, mm."""
        if self.single:
            return self.surface.radius, 0.5 * self.surface.width
        return self.rover.reach

    def check_box(self, length: float, width: float, drive: Drive) -> None:
        """Raise InputError for a box, mm, that the vehicle does not fit into or could roll out of."""
        x, y = self.reach
        if 2.0 * y >= width or 2.0 * x >= length:
            raise InputError(
                f"wheels '{self.surface.name}': the vehicle of {show(2.0 * x, 'length')} x {show(2.0 * y, 'length')} "
                f"is larger than the bed of {show(length, 'length')} x {show(width, 'length')}"
            )
        free = length - 2.0 * x
        needed = self.surface.radius * drive.wanted_turn
        if needed > _SLIP * free:
            raise InputError(
                f"bed: {show(length, 'length')} leave the vehicle a way of {show(free, 'length')}, but wheels "
                f"'{self.surface.name}' of radius {show(self.surface.radius, 'length')} can roll "
                f"{show(needed, 'length')} in {drive.duration:g} s: expected a longer bed or a shorter run"
            )


def vehicle_mjcf(vehicle: Vehicle, drive: Drive, place: tuple[float, float, float]) -> str:
    """Return the MJCF text of a vehicle whose centre is at a place (mm); the wheels' file is WHEEL_FILE, in mm.

    It is the model of rigid terrain without ground and contacts; the wheels' inertia is that of their surface, filled.
    """
    extent = 1_000.0  # of a ground that is taken out again
    flat = HeightField(np.zeros((2, 2)), 10.0 * extent, 10.0 * extent)
    root = xml.fromstring(mjcf(vehicle.rover, drive, flat, "none", (0.0, 0.0)))
    root.set("model", f"{vehicle.surface.name} on grains")
    option, world, assets = (_one(root, name) for name in ("option", "worldbody", "asset"))
    xml.SubElement(option, "flag", contact="disable", energy="enable")
    for parent, tag in ((world, "geom"), (assets, "hfield"), (assets, "texture"), (assets, "material")):
        for item in list(parent.findall(tag)):
            if GROUND in (item.get("name"), item.get("class")):
                parent.remove(item)
    defaults = _one(root, "default")
    defaults.remove(next(item for item in defaults if item.get("class") == GROUND))
    xml.SubElement(assets, "mesh", name="wheel", file=WHEEL_FILE, scale=text(METRE, METRE, METRE))
    body = next(item for item in world.findall("body") if item.get("name") == BODY)
    body.set("pos", text(*(value * METRE for value in place)))
    if vehicle.single:
        _onto_rails(root, body, vehicle)
    centre, inertia = vehicle.surface.mass_properties(vehicle.wheel_mass)
    tensor = inertia * KILOGRAM * METRE**2
    for wheel in body.findall("body"):
        for geom in wheel.findall("geom"):
            wheel.remove(geom)
        xml.SubElement(
            wheel, "inertial", pos=text(*(centre * METRE)), mass=text(vehicle.wheel_mass * KILOGRAM),
            fullinertia=text(*tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]),
        )  # fmt: skip
        xml.SubElement(wheel, "geom", type="mesh", mesh="wheel", mass="0", rgba="0.84 0.37 0.0 1")
    xml.indent(root)
    return xml.tostring(root, encoding="unicode") + "\n"


def _onto_rails(root: xml.Element, body: xml.Element, vehicle: Vehicle) -> None:
    """Leave one wheel below the middle of the body, a quarter of the robot's mass, and slides instead of freedom."""
    free = _one(body, "freejoint")
    body.remove(free)
    body.insert(0, xml.Element("joint", name="ahead", type="slide", axis="1 0 0", damping="0"))
    body.insert(1, xml.Element("joint", name="up", type="slide", axis="0 0 1", damping="0"))
    kept = vehicle.wheels[0]
    for wheel in body.findall("body"):
        if wheel.get("name") == kept:
            wheel.set("pos", "0 0 0")
        else:
            body.remove(wheel)
    actuators = _one(root, "actuator")
    for item in list(actuators):
        if item.get("name") != kept:
            actuators.remove(item)
    box = _one(body, "geom")
    box.set("mass", text((0.25 * vehicle.mass - vehicle.wheel_mass) * KILOGRAM))
    box.set("size", text(0.03, 0.02, 0.02))


def _one(parent: xml.Element, tag: str) -> xml.Element:
    found = parent.find(tag)
    assert found is not None, tag
    return found
