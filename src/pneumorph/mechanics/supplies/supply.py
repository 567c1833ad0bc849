"""Supplies whose equation needs nothing but pressure and volume: a regulator and a syringe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol


class Supply(Protocol):
    """What fills a cavity, as an equation g(p, V) = 0, with at most one number that the programme drives, its target.

    kind: unit kind of the target, None where there is none; sets_pressure: whether the target is the cavity's pressure.
    """

    kind: ClassVar[str | None]
    sets_pressure: ClassVar[bool]


class DirectSupply(Supply, Protocol):
    """A supply that knows its equation from the present pressure and volume alone."""

    def equation(
        self, pressure: float, volume: float, start_volume: float, target: float
    ) -> tuple[float, float, float]:
        """Return (g, dg/dp, dg/dV) at a gauge pressure (MPa) and a volume (mm3)."""


@dataclass(frozen=True)
class PressureSupply:
    """A regulator: the target is the gauge pressure, MPa; negative ones are a vacuum, down to that of empty space."""

    kind: ClassVar[str | None] = "pressure"
    sets_pressure: ClassVar[bool] = True

    def equation(
        self, pressure: float, volume: float, start_volume: float, target: float
    ) -> tuple[float, float, float]:
        """Return p - target and its derivatives."""
        return pressure - target, 1.0, 0.0


@dataclass(frozen=True)
class VolumeSupply:
    """A syringe with an incompressible fluid: the target is the volume added to the initial one, mm3."""

    kind: ClassVar[str | None] = "volume"
    sets_pressure: ClassVar[bool] = False

    def equation(
        self, pressure: float, volume: float, start_volume: float, target: float
    ) -> tuple[float, float, float]:
        """Return V - V0 - target and its derivatives."""
        return volume - start_volume - target, 0.0, 1.0
