"""Robots on wheels over rigid terrain: wheels, robot and height fields as data, MJCF from them, runs in MuJoCo."""

from pneumorph.terrain.courses import COURSES, course, flat, ramp, smooth, steps, terraced
from pneumorph.terrain.height_field import HeightField, from_image, to_image
from pneumorph.terrain.mjcf import check_course, ground_bytes, mjcf
from pneumorph.terrain.rigid import Travel, load, simulate
from pneumorph.terrain.rover import Drive, Rover
from pneumorph.terrain.wheels import Wheel, all_wheels

__all__ = [
    "Wheel",
    "all_wheels",
    "Rover",
    "Drive",
    "HeightField",
    "from_image",
    "to_image",
    "COURSES",
    "course",
    "flat",
    "steps",
    "ramp",
    "smooth",
    "terraced",
    "mjcf",
    "ground_bytes",
    "check_course",
    "Travel",
    "load",
    "simulate",
]
