"""Loose ground: grains in LAMMPS under a robot in MuJoCo. Needs the extra `granular`."""

from pneumorph.terrain.granular.bed import Bed
from pneumorph.terrain.granular.cosimulation import Energies, Friction, GranularTravel, check_drive, drive_over
from pneumorph.terrain.granular.model import Vehicle, vehicle_mjcf
from pneumorph.terrain.granular.sands import SANDS, Sand, sand
from pneumorph.terrain.granular.settling import Settled, settled
from pneumorph.terrain.granular.wheel_surface import WheelSurface, disc, from_stl, limbed

__all__ = [
    "Sand",
    "SANDS",
    "sand",
    "Bed",
    "Settled",
    "settled",
    "WheelSurface",
    "from_stl",
    "limbed",
    "disc",
    "Vehicle",
    "vehicle_mjcf",
    "Friction",
    "Energies",
    "GranularTravel",
    "check_drive",
    "drive_over",
]
