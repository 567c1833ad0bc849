"""Supplies: what fills a cavity, each a scalar equation g(p, V) = 0 that borders the system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol


class Supply(Protocol):
    """A source with one number that the programme drives, its target.

    kind: unit kind of the target; works: whether the supplied fluid has the potential -p V at a fixed target.
    """

    kind: ClassVar[str]
    sets_pressure: ClassVar[bool]

    def equation(
        self, pressure: float, volume: float, start_volume: float, target: float
    ) -> tuple[float, float, float]:
        """Return (g, dg/dp, dg/dV) at a gauge pressure (MPa) and a volume (mm3)."""


@dataclass(frozen=True)
class PressureSupply:
    """A regulator: the target is the gauge pressure, MPa; negative ones are a vacuum."""

    kind: ClassVar[str] = "pressure"
    sets_pressure: ClassVar[bool] = True

    def equation(
        self, pressure: float, volume: float, start_volume: float, target: float
    ) -> tuple[float, float, float]:
        """Return p - target and its derivatives."""
        return pressure - target, 1.0, 0.0


@dataclass(frozen=True)
class VolumeSupply:
    """A syringe with an incompressible fluid: the target is the volume added to the initial one, mm3."""

    kind: ClassVar[str] = "volume"
    sets_pressure: ClassVar[bool] = False

    def equation(
        self, pressure: float, volume: float, start_volume: float, target: float
    ) -> tuple[float, float, float]:
        """Return V - V0 - target and its derivatives."""
        return volume - start_volume - target, 0.0, 1.0
