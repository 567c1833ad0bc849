"""Grains and how they touch: four sands as data, their contact laws for LAMMPS, and closed forms of the laws.

Inside units: modulus MPa, surface energy N/mm, damping 1/(mm s), density tonne/mm3.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi, sqrt
from types import MappingProxyType

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.units import show

# inside unit -> SI
_PASCAL, _NEWTON_PER_METRE, _PER_METRE = 1e6, 1e3, 1e3
_SAFE = 0.3  # of the Rayleigh time: beyond it contacts in dense beds are known to gain energy


@dataclass(frozen=True)
class Sand:
    """One granular material by the contact of two of its grains.

    modulus, poisson: Young's modulus (MPa) and Poisson's ratio of the grains. They give the normal stiffness, Hertz's
        4/3 E* sqrt(R*) with E* = E / (2 (1 - nu^2)), and Mindlin's tangential one, 8 G* a on the contact radius a. A
        lower modulus lets grains overlap more under the same load: the bed is compressible.
    restitution: speed after over speed before a central impact of two grains, at 0.5 m/s where it depends on the speed.
    surface_energy: work of adhesion of two grains (JKR), N/mm; 0 is dry. Two grains come apart under
        3/2 pi (2 gamma) R*, R* half the radius of equal grains.
    damping: of a sticky contact, 1/(mm s): force = damping x contact radius x reduced mass x speed of approach. Dry
        contacts have the damping that gives the restitution at any speed, so theirs is 0 here.
    friction: sliding coefficient: the tangential spring slips at this times the normal force.
    rolling: rolling coefficient: a couple of at most this times normal force times R* resists rolling (spring, dashpot
        and slider in series with rolling_stiffness, N/mm, and rolling_damping, N s/mm). On a plane R* is the grain's
        radius, so that a grain holds on a slope of this tangent; between equal grains it is half of the radius.
    density: of a grain, tonne/mm3.

    Raises InputError for values out of range, a sticky sand without damping, or a dry one with it.
    """

    name: str
    title: str
    modulus: float
    restitution: float
    surface_energy: float = 0.0
    damping: float = 0.0
    poisson: float = 0.25
    friction: float = 0.55
    rolling: float = 0.37
    rolling_stiffness: float = 2.0
    rolling_damping: float = 0.01
    density: float = 1.5e-9

    def __post_init__(self) -> None:
        for name, kind in (("modulus", "stress"), ("density", "density")):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise InputError(
                    f"sand '{self.name}': {name} = {show(getattr(self, name), kind)}, expected more than 0"
                )
        for name in ("surface_energy", "damping", "friction", "rolling", "rolling_stiffness", "rolling_damping"):
            if not 0.0 <= getattr(self, name) < float("inf"):
                raise InputError(f"sand '{self.name}': {name} = {getattr(self, name):g}, expected at least 0")
        if not 0.0 < self.restitution < 1.0:
            raise InputError(f"sand '{self.name}': restitution = {self.restitution:g}, expected between 0 and 1")
        if not 0.0 <= self.poisson < 0.5:
            raise InputError(f"sand '{self.name}': poisson = {self.poisson:g}, expected at least 0 and below 0.5")
        if (self.damping > 0.0) != self.sticky:
            raise InputError(
                f"sand '{self.name}': damping = {self.damping:g} /(mm s), expected "
                + ("more than 0, as the sand is sticky" if self.sticky else "0: dry sand has its restitution")
            )

    @property
    def sticky(self) -> bool:
        """Whether grains attract each other."""
        return self.surface_energy > 0.0

    @property
    def effective_modulus(self) -> float:
        """E* of two such grains, MPa: 1/E* = 2 (1 - nu^2) / E. Walls and wheels count as of the same material."""
        return self.modulus / (2.0 * (1.0 - self.poisson**2))

    @property
    def effective_shear_modulus(self) -> float:
        """G* of two such grains, MPa: 1/G* = 4 (2 - nu) (1 + nu) / E."""
        return self.modulus / (4.0 * (2.0 - self.poisson) * (1.0 + self.poisson))

    def law(self) -> str:
        """Return the contact law as LAMMPS's pair style and walls `granular` read it, in SI units."""
        modulus = self.modulus * _PASCAL
        if self.sticky:
            normal = f"jkr {modulus:.9g} {self.damping * _PER_METRE:.9g} {self.poisson:.9g}"
            normal += f" {self.surface_energy * _NEWTON_PER_METRE:.9g}"
        else:
            normal = f"hertz/material {modulus:.9g} {self.restitution:.9g} {self.poisson:.9g}"
        rolling = f"{self.rolling_stiffness * 1e3:.9g} {self.rolling_damping * 1e3:.9g} {self.rolling:.9g}"
        damping = "viscoelastic" if self.sticky else "coeff_restitution"
        return f"{normal} tangential mindlin NULL 1.0 {self.friction:.9g} rolling sds {rolling} damping {damping}"

    def rayleigh_time(self, radius: float) -> float:
        """Return the time, s, in which a Rayleigh wave runs over half of a grain of a radius, mm.

        T = pi r sqrt(rho / G) / (0.1631 nu + 0.8766).
        """
        shear = self.modulus / (2.0 * (1.0 + self.poisson))
        return pi * radius * sqrt(self.density / shear) / (0.1631 * self.poisson + 0.8766)

    def check_step(self, step: float, smallest_radius: float) -> None:
        """Raise InputError for a time step that is over a part of the Rayleigh time of the smallest grain."""
        limit = self.rayleigh_time(smallest_radius)
        if not 0.0 < step <= _SAFE * limit:
            raise InputError(
                f"time step {step:.3g} s is not stable in '{self.name}': expected at most {_SAFE * limit:.3g} s, "
                f"{_SAFE:g} of the Rayleigh time {limit:.3g} s of grains of radius {show(smallest_radius, 'length')}"
            )


def damping_factor(restitution: float) -> float:
    """Return the factor c of a Hertz contact's damping force c sqrt(m* k) delta^(1/4) v that gives a restitution.

    k is Hertz's stiffness 4/3 E* sqrt(R*), m* the reduced mass: c = -sqrt(5) ln e / sqrt(pi^2 + ln^2 e), exact at any
    speed (Antypov and Elliott 2011) where the contact lasts until the grains no longer overlap.
    """
    return -sqrt(5.0) * log(restitution) / sqrt(pi**2 + log(restitution) ** 2)


def hertz_overlap(sand: Sand, radius: float, force: float) -> float:
    """Return the overlap, mm, of two equal grains of a radius, mm, pressed by a force, N: (F / k)^(2/3)."""
    return float((force / (4.0 / 3.0 * sand.effective_modulus * sqrt(0.5 * radius))) ** (2.0 / 3.0))


# restitution falls linearly in the study's order; the rest is assumed
_ORDER = (0.48, 0.44, 0.40, 0.36)
_HARD, _SOFT = 5.0, 0.5
_STICKY = 5e-3
SANDS: MappingProxyType[str, Sand] = MappingProxyType(
    {
        sand.name: sand
        for sand in (
            Sand("dry", "non-compressible, dry", _HARD, _ORDER[0]),
            Sand("sticky", "non-compressible, sticky", _HARD, _ORDER[1], _STICKY, damping=101.7),
            Sand("dry-compressible", "compressible, dry", _SOFT, _ORDER[2]),
            Sand("sticky-compressible", "compressible, sticky", _SOFT, _ORDER[3], _STICKY, damping=20.74),
        )
    }
)


def sand(name: str) -> Sand:
    """Return one of the four sands by name; raises NameNotFoundError with the nearest name."""
    if name not in SANDS:
        raise NameNotFoundError(unknown_name("sand", name, SANDS))
    return SANDS[name]
