"""The equations of all supplies together, g(p, V) = 0: one a cavity, coupled where tubes join cavities.

Of a cavity filled with gas, g is the mass that pressure and volume say has come in, less what the target and the lines
have brought. Through a line with the mass flow w went, in an increment of h seconds after one of h0 with r = h/h0,
    dm = (1 + r)/(1 + 2 r) h w + r^2/(1 + 2 r) dm0
(the second-order backward differentiation formula), or dm = h w where there is no increment of like length before it.
What leaves one end comes in at the other, so that mass is kept to rounding.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.supplies.atmosphere import Atmosphere
from pneumorph.mechanics.supplies.contents import Contents, Gas
from pneumorph.mechanics.supplies.flow import FlowSupply
from pneumorph.mechanics.supplies.gas import GasFilled, GasSupply
from pneumorph.mechanics.supplies.orifice import LAMINAR, Orifice
from pneumorph.mechanics.supplies.supply import DirectSupply
from pneumorph.mechanics.supplies.tube import Tube

if TYPE_CHECKING:
    from pneumorph.mechanics.cavity import CavitySurface
    from pneumorph.mechanics.state import State

Array = NDArray[np.float64]

# the second-order formula is stable for steps that grow by less than 1 + sqrt(2)
_LARGEST_GROWTH = 2.0
# an iteration takes at most this share of the absolute pressure away
_LARGEST_DROP = 0.8


@dataclass(frozen=True)
class Line:
    """A way for gas into the cavity `into` from the cavity `start`, or from its own source where that is None."""

    into: int
    start: int | None
    orifice: Orifice


@dataclass(frozen=True, eq=False)
class Equations:
    """value (c,): g; by_pressure, by_volume (c, c): its slopes; scale (c,): size that an error in g is compared with.

    softness (c,): dV/dp that the fluid in a cavity allows at fixed contents, mm3/MPa: 0 for a liquid, inf where the
    supply holds the pressure.
    """

    value: Array
    by_pressure: Array
    by_volume: Array
    scale: Array
    softness: Array


class Network:
    """The supplies of a model's cavities and the tubes between them.

    surfaces: name -> cavity, in the order of all arrays; typical: a pressure of the size of the body's stiffness, MPa.
    """

    def __init__(
        self, surfaces: Mapping[str, CavitySurface], tubes: Sequence[Tube], atmosphere: Atmosphere, typical: float
    ):
        self.names = list(surfaces)
        self.surfaces = list(surfaces.values())
        self.supplies = [surface.cavity.supply for surface in self.surfaces]
        self.atmosphere = atmosphere
        self.typical = typical
        flows = [(i, s) for i, s in enumerate(self.supplies) if isinstance(s, FlowSupply)]
        self.lines = [Line(i, None, supply.orifice) for i, supply in flows] + [
            Line(self.names.index(tube.between[1]), self.names.index(tube.between[0]), tube.orifice) for tube in tubes
        ]

    def increment(self, start: State, seconds: float, values: Mapping[str, float]) -> NetworkIncrement:
        """Return the equations of an increment that starts from a state and ends at values of the programme."""
        return NetworkIncrement(self, start, seconds, values)


class NetworkIncrement:
    """The equations of one increment; pressures p (c,) are gauge, MPa, volumes V (c,) those of the cavities, mm3."""

    def __init__(self, network: Network, start: State, seconds: float, values: Mapping[str, float]):
        self._network = network
        self._outside = network.atmosphere.pressure
        self._targets = [values.get(name, 0.0) for name in network.names]
        before = [start.values.get(name, 0.0) for name in network.names]
        self._start: list[Contents | None] = []
        self._given = np.zeros(len(network.names))
        self._dead = np.zeros(len(network.names))
        for i, (name, supply) in enumerate(zip(network.names, network.supplies, strict=True)):
            if not isinstance(supply, GasFilled):
                self._start.append(None)
                continue
            self._dead[i] = supply.dead_volume
            self._start.append(
                Contents(
                    start.gas.mass[name],
                    start.pressure[name] + self._outside,
                    start.volume[name] + supply.dead_volume,
                    supply.exponent,
                    network.atmosphere,
                )
            )
            if isinstance(supply, GasSupply):
                self._given[i] = self._targets[i] - before[i]
        self._seconds, self._weight, self._past = seconds, seconds, np.zeros(len(network.lines))
        ratio = seconds / start.gas.seconds if start.gas.seconds else np.inf
        if ratio <= _LARGEST_GROWTH:
            self._weight = (1.0 + ratio) / (1.0 + 2.0 * ratio) * seconds
            self._past = ratio**2 / (1.0 + 2.0 * ratio) * np.array(start.gas.moved)
        pressure = np.array([start.pressure[name] for name in network.names])
        volume = np.array([start.volume[name] for name in network.names])
        self._first = [self._flow(line, pressure, volume, before)[0] for line in network.lines]

    def equations(self, pressure: Array, volume: Array) -> Equations:
        """Return g and all that Newton's method needs of it."""
        network, count = self._network, len(pressure)
        value, scale, softness = np.zeros(count), np.zeros(count), np.zeros(count)
        by_pressure, by_volume = np.zeros((count, count)), np.zeros((count, count))
        for i, (surface, contents) in enumerate(zip(network.surfaces, self._start, strict=True)):
            p, v = pressure[i], volume[i]
            if contents is None:
                supply = cast(DirectSupply, network.supplies[i])
                g, by_p, by_v = supply.equation(p, v, surface.reference_volume, self._targets[i])
                value[i], by_pressure[i, i], by_volume[i, i] = g, by_p, by_v
                scale[i] = abs(by_p) * network.typical + abs(by_v) * v
                softness[i] = by_p / by_v if by_v else np.inf
                continue
            absolute, whole = p + self._outside, v + self._dead[i]
            gained, by_pressure[i, i], by_volume[i, i] = contents.gained(absolute, whole)
            value[i] = gained - self._given[i]
            scale[i] = contents.mass + abs(gained)
            softness[i] = whole / (contents.exponent * absolute)
        for line, past in zip(network.lines, self._past, strict=True):
            flow, slopes = self._flow(line, pressure, volume, self._targets)
            moved = self._weight * flow + past
            ends = [(line.into, -1.0)] + ([] if line.start is None else [(line.start, 1.0)])
            for row, sign in ends:
                value[row] += sign * moved
                for column, by_p, by_v in slopes:
                    by_pressure[row, column] += sign * self._weight * by_p
                    by_volume[row, column] += sign * self._weight * by_v
        return Equations(value, by_pressure, by_volume, scale, softness)

    def share(self, pressure: Array, step: Array) -> float:
        """Return the share of a step in the pressures to take.

        No absolute pressure drops to nothing, and no flow changes its direction in one iteration, but stops where the
        pressures at both ends are equal: flow goes with the root of a small pressure difference, on which Newton's
        method would jump to and fro.
        """
        result = 1.0
        for i, contents in enumerate(self._start):
            lowest = -_LARGEST_DROP * (pressure[i] + self._outside)
            if contents is not None and step[i] < lowest:
                result = min(result, lowest / step[i])
        for line in self._network.lines:
            source = self._targets[line.into] if line.start is None else pressure[line.start]
            change = (0.0 if line.start is None else step[line.start]) - step[line.into]
            drop = source - pressure[line.into]
            if abs(drop) > 0.5 * LAMINAR * (source + self._outside) and drop * (drop + change) < 0.0:
                result = min(result, -drop / change)
        return float(result)

    def gas(self, pressure: Array, volume: Array) -> Gas:
        """Return the gas at the end of the increment."""
        network = self._network
        moved = self._moved(pressure, volume)
        change = self._given.copy()
        for line, mass in zip(network.lines, moved, strict=True):
            change[line.into] += mass
            if line.start is not None:
                change[line.start] -= mass
        masses = {
            name: contents.mass + float(more)
            for name, contents, more in zip(network.names, self._start, change, strict=True)
            if contents is not None
        }
        return Gas(masses, tuple(moved), self._seconds if network.lines else 0.0)

    def error(self, pressure: Array, volume: Array) -> float:
        """Return the largest error of a cavity's mass in this increment, as a share of it.

        It is what the trapezoidal rule, of the same order, says otherwise.
        """
        worst = 0.0
        for line, first, moved in zip(self._network.lines, self._first, self._moved(pressure, volume), strict=True):
            last = self._flow(line, pressure, volume, self._targets)[0]
            difference = abs(moved - 0.5 * self._seconds * (first + last))
            for end in (line.into, line.start):
                contents = None if end is None else self._start[end]
                worst = max(worst, difference / contents.mass if contents is not None else 0.0)
        return worst

    def _moved(self, pressure: Array, volume: Array) -> list[float]:
        flows = [self._flow(line, pressure, volume, self._targets)[0] for line in self._network.lines]
        return [float(self._weight * w + past) for w, past in zip(flows, self._past, strict=True)]

    def _flow(
        self, line: Line, pressure: Array, volume: Array, targets: Sequence[float]
    ) -> tuple[float, list[tuple[int, float, float]]]:
        """Return the mass flow of a line, t/s, and for each cavity at its ends: number, slopes by p and V."""
        into, into_t = self._end(line.into, pressure, volume)
        if line.start is None:
            atmosphere = self._network.atmosphere
            start, start_t = targets[line.into] + self._outside, (atmosphere.temperature, 0.0, 0.0)
        else:
            start, start_t = self._end(line.start, pressure, volume)
        flow, by_start, by_into, by_start_t, by_into_t = line.orifice.flow(start, into, start_t[0], into_t[0])
        slopes = [(line.into, by_into + by_into_t * into_t[1], by_into_t * into_t[2])]
        if line.start is not None:
            slopes.append((line.start, by_start + by_start_t * start_t[1], by_start_t * start_t[2]))
        return flow, slopes

    def _end(self, i: int, pressure: Array, volume: Array) -> tuple[float, tuple[float, float, float]]:
        """Return absolute pressure and temperature, with its slopes, in a cavity."""
        contents = cast(Contents, self._start[i])
        absolute = float(pressure[i]) + self._outside
        return absolute, contents.temperature(absolute, float(volume[i]) + float(self._dead[i]))


def gas_at_rest(surfaces: Mapping[str, CavitySurface], atmosphere: Atmosphere) -> Gas:
    """Return the gas in cavities at the pressure and temperature outside."""
    masses = {}
    for name, surface in surfaces.items():
        supply = surface.cavity.supply
        if isinstance(supply, GasFilled):
            volume = surface.reference_volume + supply.dead_volume
            masses[name] = atmosphere.pressure * volume / atmosphere.specific
    return Gas(masses)
