"""The gas in a cavity: its mass, and how much has come in when pressure and volume have changed.

The energy balance of an ideal gas that exchanges mass, with the exponent n in the place of the ratio of specific heats,
    V dP + n P dV = n R T dm,
(Beater, Pneumatic Drives (2007), for n between isothermal and adiabatic) is integrated over an increment with T that
outside for gas that comes in, and that of the cavity for gas that goes out:
    n = 1:  m = P V / (R T);        in:  P V^n = P0 V0^n + n R T (m - m0) Vm^(n-1),  Vm = (V + V0)/2;
                                   out:  P (V/m)^n = P0 (V0/m0)^n.
Both are exact for a sealed gas and for a rigid vessel.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from pneumorph.mechanics.supplies.atmosphere import Atmosphere


@dataclass(frozen=True)
class Gas:
    """The gas of a state.

    mass:    cavity -> mass, t; for cavities with a supply of gas alone.
    moved:   mass that went through each line in the last increment, t, in the order of the network's lines.
    seconds: length of that increment; 0 where there was none.
    """

    mass: Mapping[str, float] = field(default_factory=dict)
    moved: tuple[float, ...] = ()
    seconds: float = 0.0


@dataclass(frozen=True)
class Contents:
    """The gas of one cavity at the start of an increment.

    mass (t), pressure (absolute, MPa), volume (mm3, with dead volume); exponent: n.
    """

    mass: float
    pressure: float
    volume: float
    exponent: float
    atmosphere: Atmosphere

    def gained(self, pressure: float, volume: float) -> tuple[float, float, float]:
        """Return the mass that has come in at an absolute pressure and a volume, and its two slopes."""
        n, specific = self.exponent, self.atmosphere.specific
        if n == 1.0:
            return pressure * volume / specific - self.mass, volume / specific, pressure / specific
        before, after = self.pressure * self.volume**n, pressure * volume**n
        if after < before:
            left = self.mass * (after / before) ** (1.0 / n)
            return left - self.mass, left / (n * pressure), left / volume
        mean = 0.5 * (volume + self.volume)
        share = n * specific * mean ** (n - 1.0)
        gain = (after - before) / share
        slope = n * pressure * volume ** (n - 1.0) / share
        return gain, volume**n / share, slope - 0.5 * (n - 1.0) * gain / mean

    def temperature(self, pressure: float, volume: float) -> tuple[float, float, float]:
        """Return the temperature, K, at an absolute pressure and a volume, and its two slopes."""
        if self.exponent == 1.0:
            return self.atmosphere.temperature, 0.0, 0.0
        gain, by_pressure, by_volume = self.gained(pressure, volume)
        mass = self.mass + gain
        value = pressure * volume / (mass * self.atmosphere.gas_constant)
        return value, value * (1.0 / pressure - by_pressure / mass), value * (1.0 / volume - by_volume / mass)
