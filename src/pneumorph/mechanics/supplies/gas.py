"""Cavities filled with a given mass of gas."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from pneumorph.errors import InputError
from pneumorph.units import show


@dataclass(frozen=True)
class GasFilled:
    """What all supplies of gas share; the cavity is filled with gas at the pressure outside when a run starts.

    exponent:    polytropic exponent n of p V^n: 1 for changes so slow that the gas keeps the temperature outside,
                 1.4 for air without exchange of heat, allowed: 1 to 5/3.
    dead_volume: rigid volume of lines and reservoirs at the cavity's pressure, 0 or more. In a model cut at mirrors it
                 is the part's share, like mass and conductance.
    """

    exponent: float = field(default=1.0, kw_only=True, metadata={"kind": "number"})
    dead_volume: float = field(default=0.0, kw_only=True, metadata={"kind": "volume"})

    sets_pressure: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not 1.0 <= self.exponent <= 5.0 / 3.0:
            raise InputError(f"exponent = {self.exponent:g}, allowed: 1 (constant temperature) to 5/3 (1.4 for air)")
        if not 0.0 <= self.dead_volume < float("inf"):
            raise InputError(f"dead_volume = {show(self.dead_volume, 'volume')}, allowed: 0 or more")


@dataclass(frozen=True)
class SealedSupply(GasFilled):
    """A plug: the gas stays what it was at the start, and answers to every change of volume. It has no target."""

    kind: ClassVar[str | None] = None


@dataclass(frozen=True)
class GasSupply(GasFilled):
    """A metering pump: the target is the mass of gas added, t; held at a value, the cavity is sealed with it."""

    kind: ClassVar[str | None] = "mass"
