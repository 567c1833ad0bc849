"""The terrains that robots are sent over, as height fields: flat, steps, ramp, and undulating ground from noise.

The study gives their kinds and the extent, 50 m by 50 m. Heights, wavelengths and slopes are assumed here.
"""

from __future__ import annotations

from collections.abc import Callable
from math import radians, tan
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.terrain.height_field import HeightField
from pneumorph.terrain.perlin import perlin
from pneumorph.units import show

Array = NDArray[np.float64]

EXTENT = 50_000.0  # mm, given by the study
CELL = 50.0  # mm between heights: a third of the wheel's radius
START = 1_000.0  # mm of level ground ahead of the origin before steps and ramp begin
RISE, TREAD, STEPS = 40.0, 600.0, 20
SLOPE, CLIMB = radians(10.0), 12_000.0  # the ramp's angle and its length on the map
SMOOTH_RELIEF, TERRACED_RELIEF, WAVELENGTH = 400.0, 400.0, 2_500.0
TERRACE = 40.0  # height of a terrace


def flat(extent: float = EXTENT) -> HeightField:
    """Return level ground; everything in mm. Raises InputError, as all here, for an extent of fewer than two cells."""
    return _along(np.zeros_like(_places(extent)), extent)


def steps(rise: float = RISE, tread: float = TREAD, count: int = STEPS, extent: float = EXTENT) -> HeightField:
    """Return a stair upwards along x: `count` steps of height `rise` every `tread`; a riser is one cell long.

    Raises InputError for steps that are not higher than 0 or not longer than a cell, or fewer than one.
    """
    _positive("steps", rise=rise)
    if tread <= CELL:
        raise InputError(f"steps: tread = {show(tread, 'length')}, expected more than {show(CELL, 'length')}, one cell")
    if count < 1:
        raise InputError(f"steps: count = {count}, expected at least 1")
    x = _places(extent)
    climbed = np.clip(np.floor((x - START) / tread + 1.0), 0, count)
    return _along(rise * climbed, extent)


def ramp(slope: float = SLOPE, climb: float = CLIMB, extent: float = EXTENT) -> HeightField:
    """Return a ramp upwards along x of angle `slope` (rad) over `climb` of the map, level before and after.

    Raises InputError for an angle that is not between 0 and 45 degrees or a length that is not positive.
    """
    _positive("ramp", climb=climb)
    if not 0.0 < slope < radians(45.0):
        raise InputError(f"ramp: slope = {show(slope, 'angle')}, expected between 0 and 45 deg")
    return _along(tan(slope) * np.clip(_places(extent) - START, 0.0, climb), extent)


def smooth(
    seed: int = 1, relief: float = SMOOTH_RELIEF, wavelength: float = WAVELENGTH, extent: float = EXTENT
) -> HeightField:
    """Return undulating ground from two octaves of Perlin noise, scaled to span `relief`.

    Raises InputError for a relief or wavelength that is not positive.
    """
    _positive("undulating terrain", relief=relief, wavelength=wavelength)
    places = _places(extent) / wavelength
    noise = perlin(places, places, seed) + 0.5 * perlin(2.0 * places, 2.0 * places, seed + 1)
    return HeightField(relief * (noise - noise.min()) / np.ptp(noise), extent, extent)


def terraced(
    seed: int = 2,
    relief: float = TERRACED_RELIEF,
    wavelength: float = WAVELENGTH,
    terrace: float = TERRACE,
    extent: float = EXTENT,
) -> HeightField:
    """Return the undulating ground of `smooth`, each height rounded down to a multiple of `terrace`.

    Raises InputError as `smooth`, and for terraces that are not between 0 and the relief.
    """
    ground = smooth(seed, relief, wavelength, extent)
    if not 0.0 < terrace < relief:
        raise InputError(
            f"terraced terrain: terrace = {show(terrace, 'length')}, expected between 0 and {show(relief, 'length')}"
        )
    return HeightField(terrace * np.floor(ground.heights / terrace + 1e-9), extent, extent)


COURSES: MappingProxyType[str, Callable[[], HeightField]] = MappingProxyType(
    {"flat": flat, "steps": steps, "ramp": ramp, "smooth": smooth, "terraced": terraced}
)


def course(name: str) -> HeightField:
    """Return a terrain by name with its default dimensions; raises NameNotFoundError with the nearest name."""
    if name not in COURSES:
        raise NameNotFoundError(unknown_name("terrain", name, COURSES))
    return COURSES[name]()


def _places(extent: float) -> Array:
    """Return the places of the heights along one side."""
    if not 2.0 * CELL <= extent < np.inf:
        raise InputError(f"extent = {show(extent, 'length')}, expected at least {show(2.0 * CELL, 'length')}")
    return np.linspace(-0.5 * extent, 0.5 * extent, round(extent / CELL) + 1)


def _along(profile: Array, extent: float) -> HeightField:
    return HeightField(np.tile(profile, (len(profile), 1)), extent, extent)


def _positive(kind: str, **lengths: float) -> None:
    for name, value in lengths.items():
        if not 0.0 < value < np.inf:
            raise InputError(f"{kind}: {name} = {show(value, 'length')}, expected more than 0")
