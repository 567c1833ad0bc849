"""Tests of a sand as a laboratory would do them, small and by LAMMPS: impact, tilted bed, confined compression."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from pneumorph.errors import EngineError, InputError
from pneumorph.terrain.granular.bed import KILOGRAM_PER_CUBIC_METRE, SPACE, Bed
from pneumorph.terrain.granular.engine import Session
from pneumorph.terrain.granular.sands import Sand
from pneumorph.terrain.granular.settling import settled, wake
from pneumorph.terrain.rover import GRAVITY
from pneumorph.terrain.si import METRE
from pneumorph.units import show

Array = NDArray[np.float64]

_FINE = 100  # time steps of an impact in a Rayleigh time
_TILT, _TILT_SPEED = 0.5, radians(20.0)  # deg by which gravity is turned at a time, rad/s
_SEATING = 5e-4  # MPa
_BOX = 10.0  # diameters: in narrower boxes sticky grains hang between the walls


def restitution(sand: Sand, speed: float, radius: float = 20.0, *, pull: bool = False) -> float:
    """Return speed after over speed before the central impact of two equal grains of a radius (mm), at a relative
    speed (mm/s); 0 where they stay together.

    pull: return instead the largest force, N, with which they hold each other back while they come apart.
    Raises InputError for a speed that is not positive.
    """
    if not 0.0 < speed < float("inf"):
        raise InputError(f"impact speed = {speed:g} mm/s, expected more than 0")
    r, v, step = radius * METRE, speed * METRE, sand.rayleigh_time(radius) / _FINE
    density, gap = sand.density * KILOGRAM_PER_CUBIC_METRE, 1e-3 * radius * METRE
    with Session() as session:
        session.commands(
            SPACE + f"region space block {-4 * r} {4 * r} {-4 * r} {4 * r} {-4 * r} {4 * r}\n"
            f"create_box 1 space\ncreate_atoms 1 single 0 0 {-r - 0.5 * gap}\n"
            f"create_atoms 1 single 0 0 {r + 0.5 * gap}\n"
            f"set atom * diameter {2.0 * r} density {density}\n"
            f"set atom 1 vz {0.5 * v}\nset atom 2 vz {-0.5 * v}\n"
            f"neighbor {0.5 * r} bin\npair_style granular\npair_coeff * * {sand.law()}\n"
            f"timestep {step}\nfix motion all nve/sphere\nthermo 100000000\nthermo_modify lost error\nrun 0 post no\n"
        )
        most, after, apart = 0.0, 0.0, 0.0
        # a Hertz contact lasts about 2.94 (m*^2 / (k^2 v))^(1/5), tens of Rayleigh times; a sticky one may never end
        for _ in range(40):
            for _ in range(25):
                session.commands("run 20 pre no post no")
                most = max(most, -float(session.per_grain("f")[1, 2]))
            z, after = session.per_grain("x")[:, 2], float(np.diff(session.per_grain("v")[:, 2])[0])
            apart = float(np.diff(z)[0]) - 2.0 * r
            if apart > 2.0 * gap and after > 0.0:
                break
        if pull:
            return most
        return after / v if apart > 0.0 and after > 0.0 else 0.0


def angle_of_slip(sand: Sand, *, grains: int = 500, seed: int = 1, radius: float = 20.0, step: float = 2e-4) -> float:
    """Return the angle, rad, at which a bed slips when its box is tilted: the angle of the steepest slope it bears.

    The box is fourteen grains long and eight wide. It is tilted by 20 degrees a second, by turning gravity, until the
    grains' centre of mass has moved down the slope by half a radius. Raises EngineError for a bed that hangs in its box
    beyond 90 degrees.
    """
    length, width = 14.0 * 2.0 * radius, 8.0 * 2.0 * radius
    bed = Bed(sand, grains, length, width, 1_000.0 * radius / 20.0, radius, 0.1, seed, step)
    still = settled(bed)
    with Session() as session:
        wake(session, still)
        start, angle = float(session.per_grain("x")[:, 0].mean()), 0.0
        while float(session.per_grain("x")[:, 0].mean()) - start < 0.5 * radius * METRE:
            angle += radians(_TILT)
            if angle > radians(90.0):
                raise EngineError(f"the bed of '{sand.name}' hangs in its box at 90 deg")
            session.commands(
                f"unfix weight\nfix weight all gravity {GRAVITY * METRE} vector {sin(angle)} 0 {-cos(angle)}\n"
                f"run {round(radians(_TILT) / _TILT_SPEED / step)} post no"
            )
        return angle


@dataclass(frozen=True, eq=False)
class Compression:
    """A confined compression: strain (n,) since the seating stress, and stress of the lid (n,), MPa.

    initial: solid fraction before.
    """

    strain: Array
    stress: Array
    initial: float

    def modulus(self, low: float = 1e-3, high: float = 5e-3) -> float:
        """Return the secant modulus, MPa, between two stresses, MPa. Raises InputError where they were not reached."""
        if self.stress.max() < high:
            raise InputError(
                f"compression: stress up to {show(float(self.stress.max()), 'pressure')}, expected to pass "
                f"{show(high, 'pressure')}"
            )
        first, last = (int(np.argmax(self.stress >= level)) for level in (low, high))
        return float((self.stress[last] - self.stress[first]) / (self.strain[last] - self.strain[first]))


def confined_compression(
    sand: Sand,
    *,
    grains: int = 500,
    seed: int = 1,
    radius: float = 20.0,
    stress: float = 0.006,
    speed: float = 40.0,
    step: float = 2e-4,
) -> Compression:
    """Return stress against strain of a bed in a box of 10 by 10 grains whose lid goes down at a speed (mm/s).

    It stops when the lid's mean stress reaches `stress` (MPa). As in an oedometer the strain counts from a seating
    stress of 0.5 kPa on, when the lid lies on more than the few highest grains. Raises EngineError where the lid gets
    to a quarter of the height before.
    """
    side = _BOX * 2.0 * radius
    bed = Bed(sand, grains, side, side, 1_500.0 * radius / 20.0, radius, 0.1, seed, step)
    still = settled(bed)
    with Session() as session:
        wake(session, still)
        places, radii = session.gathered("x", 3) / METRE, session.gathered("radius", 1) / METRE
        top = float((places[:, 2] + radii).max())
        session.commands(
            f"variable sink equal -{speed * METRE}*step*{step}\n"
            f"region lid plane 0 0 {top * METRE} 0 0 -1 side in move NULL NULL v_sink units box\n"
            f"fix lid all wall/gran/region granular {sand.law()} region lid contacts\n"
            "compute push all reduce sum f_lid[4]\nvariable push equal c_push\nthermo_style custom step c_push\n"
        )
        heights, found, time = [top], [0.0], 0.0
        pieces = 25
        while found[-1] < stress:
            session.commands(f"run {pieces} post no")
            time += pieces * step
            heights.append(top - speed * time)
            found.append(abs(session.variable("push")) / side**2)
            if heights[-1] < 0.25 * top:
                raise EngineError(f"the lid on '{sand.name}' sank by three quarters without meeting {stress:g} MPa")
    height, measured = np.array(heights), np.array(found)
    seated = int(np.argmax(measured >= _SEATING))
    return Compression(1.0 - height[seated:] / height[seated], measured[seated:], still.solid)


def calibrated_damping(sand: Sand, speed: float = 500.0) -> float:
    """Return the damping, 1/(mm s), that gives a sticky sand its restitution at a relative speed, mm/s.

    Raises InputError for dry sand, or where no damping gives it.
    """
    if not sand.sticky:
        raise InputError(f"sand '{sand.name}': dry sand has its restitution without a damping to find")

    def excess(damping: float) -> float:
        return restitution(replace(sand, damping=damping), speed) - sand.restitution

    low, high = 1e-3, 1e3
    if excess(low) * excess(high) > 0.0:
        raise InputError(
            f"sand '{sand.name}': restitution = {sand.restitution:g}, expected at most "
            f"{sand.restitution + excess(low):.3g}, what adhesion leaves of it at {speed:g} mm/s"
        )
    return float(brentq(excess, low, high, rtol=1e-3))
