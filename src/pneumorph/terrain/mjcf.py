"""The robot on its terrain as MJCF, MuJoCo's model format, in SI units; MuJoCo's own viewer opens the files."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import PurePath
from xml.etree import ElementTree as xml

import numpy as np

from pneumorph.errors import InputError
from pneumorph.terrain.height_field import HeightField
from pneumorph.terrain.rover import GRAVITY, Drive, Rover
from pneumorph.terrain.si import KILOGRAM, METRE, NEWTON_METRE, text
from pneumorph.terrain.soft_wheel import HUB, SOFT, SoftWheel, add_soft_wheel
from pneumorph.terrain.wheels import Wheel
from pneumorph.units import show

BODY, CENTRE = "rover", "centre"
GROUND = "ground"
GAP = 5.0  # mm between the highest ground under the robot and its lowest point before it drops
_BASE = 1.0  # m of solid ground below the lowest place


def ground_bytes(field: HeightField) -> bytes:
    """Return a height field as the file that MuJoCo reads: rows and columns as int32, then heights as float32.

    An image would do as well, but of an image MuJoCo reads 8 bits only: a ramp of 2 m would become a stair.
    """
    return np.array(field.heights.shape, dtype="<i4").tobytes() + field.heights.astype("<f4").tobytes()


def start_height(rover: Rover, field: HeightField, place: tuple[float, float]) -> float:
    """Return the height of the robot's centre, mm, from which it drops onto the ground at a place (x, y).

    Raises InputError where the robot stands off the terrain.
    """
    reach = rover.reach
    around = ((place[0] - reach[0], place[0] + reach[0]), (place[1] - reach[1], place[1] + reach[1]))
    return field.highest(*around) + rover.wheel.radius + GAP


def check_course(rover: Rover, drive: Drive, field: HeightField, place: tuple[float, float]) -> None:
    """Raise InputError where the terrain is too short for wheels that roll freely for the whole run."""
    start_height(rover, field, place)
    needed = rover.wheel.radius * drive.wanted_turn + rover.reach[0]
    ahead = 0.5 * field.length - place[0]
    if needed > ahead:
        raise InputError(
            f"terrain: {show(ahead, 'length')} lie ahead of the robot, but wheels of radius "
            f"{show(rover.wheel.radius, 'length')} can roll {show(needed, 'length')} in {drive.duration:g} s"
        )


def mjcf(
    rover: Rover, drive: Drive, field: HeightField, ground_file: str, place: tuple[float, float] = (0.0, 0.0)
) -> str:
    """Return the MJCF text of a robot above a place (x, y in mm) of a terrain.

    ground_file: the file with `ground_bytes`, relative to the MJCF file. The control of each hinge is its wanted speed;
    the actuator integrates it to the wanted angle and pulls with `stiffness` times the angle behind. The joint's
    damping is the other half of the controller. Only ground and robot touch, not parts of the robot each other.

    Raises InputError where the robot does not stand on the terrain.
    """
    root = xml.Element("mujoco", model=f"{rover.wheel.name} on {PurePath(ground_file).stem}")
    xml.SubElement(root, "compiler", angle="radian", autolimits="true")
    xml.SubElement(
        root, "option", timestep=text(drive.step), gravity=text(0.0, 0.0, -GRAVITY * METRE),
        integrator="implicitfast", cone="pyramidal", solver="Newton",
    )  # fmt: skip
    visual = xml.SubElement(root, "visual")
    xml.SubElement(visual, "global", offwidth="1920", offheight="1080", fovy="40")
    xml.SubElement(visual, "headlight", ambient="0.35 0.35 0.35", diffuse="0.4 0.4 0.4", specular="0 0 0")
    xml.SubElement(visual, "map", znear="0.005", zfar="60", shadowclip="2.5")
    xml.SubElement(visual, "quality", shadowsize="2048", offsamples="4")
    xml.SubElement(root, "statistic", extent="1.2", center=text(place[0] * METRE, place[1] * METRE, 0.0))
    _defaults(root, drive)
    _assets(root, field, ground_file)
    world = xml.SubElement(root, "worldbody")
    low = float(field.heights.min())
    xml.SubElement(
        world, "geom", {"class": GROUND}, name=GROUND, type="hfield", hfield=GROUND, pos=text(0, 0, low * METRE)
    )
    _robot(world, rover, drive, (*place, start_height(rover, field, place)))
    actuators, sensors = xml.SubElement(root, "actuator"), xml.SubElement(root, "sensor")
    for name, _, _ in rover.corners:
        xml.SubElement(
            actuators, "general", name=name, joint=name, dyntype="integrator", gaintype="fixed", biastype="affine",
            gainprm=text(drive.stiffness * NEWTON_METRE), biasprm=text(0.0, -drive.stiffness * NEWTON_METRE, 0.0),
            ctrlrange=text(0.0, drive.speed),
        )  # fmt: skip
    xml.SubElement(sensors, "framepos", name=CENTRE, objtype="site", objname=CENTRE)
    xml.indent(root)
    return xml.tostring(root, encoding="unicode") + "\n"


def _defaults(root: xml.Element, drive: Drive) -> None:
    contact = {"friction": text(*drive.friction), "condim": str(drive.contact_dimension)}
    outer = xml.SubElement(root, "default")
    ground = xml.SubElement(outer, "default", {"class": GROUND})
    xml.SubElement(ground, "geom", contact, contype="1", conaffinity="0", material=GROUND)
    robot = xml.SubElement(outer, "default", {"class": BODY})
    xml.SubElement(robot, "geom", contact, contype="0", conaffinity="1")
    xml.SubElement(robot, "joint", axis="0 1 0")


def _assets(root: xml.Element, field: HeightField, ground_file: str) -> None:
    assets = xml.SubElement(root, "asset")
    # MuJoCo stretches the heights to 0..1 and multiplies them with the third size, which may not be 0
    size = (0.5 * field.length, 0.5 * field.width, field.relief or 1.0)
    xml.SubElement(
        assets, "hfield", name=GROUND, file=ground_file, content_type="image/vnd.mujoco.hfield",
        size=text(*(value * METRE for value in size), _BASE),
    )  # fmt: skip
    xml.SubElement(
        assets, "texture", name="sky", type="skybox", builtin="gradient", rgb1="0.72 0.82 0.91", rgb2="0.97 0.98 0.99",
        width="64", height="384",
    )  # fmt: skip
    xml.SubElement(
        assets, "texture", name=GROUND, type="2d", builtin="checker", rgb1="0.78 0.75 0.68", rgb2="0.70 0.67 0.60",
        width="256", height="256",
    )  # fmt: skip
    tiles = (field.length * METRE, field.width * METRE)  # one pattern of two by two squares a metre
    xml.SubElement(assets, "material", name=GROUND, texture=GROUND, texrepeat=text(*tiles), specular="0.1")


def _robot(world: xml.Element, rover: Rover, drive: Drive, place: tuple[float, float, float]) -> None:
    body = xml.SubElement(world, "body", name=BODY, childclass=BODY, pos=text(*(v * METRE for v in place)))
    xml.SubElement(body, "freejoint", name=BODY)
    # the light goes with the robot but does not turn with it: shadows are drawn near the light only
    xml.SubElement(
        body, "light", mode="track", directional="true", pos="-1.4 -1 4", dir="0.35 0.25 -1", diffuse="0.6 0.6 0.6",
        castshadow="true",
    )  # fmt: skip
    xml.SubElement(body, "site", name=CENTRE, size="0.005")
    half = (0.5 * rover.length, 0.5 * rover.width, 0.5 * rover.height)
    xml.SubElement(
        body, "geom", name="box", type="box", size=text(*(v * METRE for v in half)), rgba="0.20 0.33 0.49 1",
        mass=text((rover.mass - 4.0 * rover.wheel_mass) * KILOGRAM),
    )  # fmt: skip
    for name, x, y in rover.corners:
        wheel = xml.SubElement(body, "body", name=name, pos=text(x * METRE, y * METRE, 0.0))
        xml.SubElement(wheel, "joint", name=name, type="hinge", damping=text(drive.damping * NEWTON_METRE))
        if isinstance(rover.wheel, SoftWheel):
            add_soft_wheel(wheel, rover.wheel, rover.wheel_mass, name)
        else:
            _wheel(wheel, rover.wheel, rover.wheel_mass)


def _wheel(body: xml.Element, wheel: Wheel, mass: float) -> None:
    """Add the solids of a rigid wheel; each has its share of the wheel's mass by its volume."""
    lying = text(0.5**0.5, 0.5**0.5, 0.0, 0.0)  # a cylinder's axis from z to y
    radius = wheel.hub_radius if wheel.paddles else wheel.radius
    volumes = [pi * radius**2 * wheel.width, *(b.thickness * b.width * b.length for b in wheel.boxes)]
    masses = [mass * KILOGRAM * volume / sum(volumes) for volume in volumes]
    xml.SubElement(
        body, "geom", type="cylinder", size=text(radius * METRE, 0.5 * wheel.width * METRE), quat=lying,
        mass=text(masses[0]), rgba=HUB if wheel.paddles else SOFT,
    )  # fmt: skip
    for box, mass in zip(wheel.boxes, masses[1:], strict=True):
        xml.SubElement(
            body, "geom", type="box", mass=text(mass), rgba=SOFT,
            size=text(*(0.5 * v * METRE for v in (box.thickness, box.width, box.length))),
            pos=text(box.x * METRE, 0.0, box.z * METRE),
            quat=text(cos(0.5 * box.angle), 0.0, sin(0.5 * box.angle), 0.0),
        )  # fmt: skip
