"""A source of pressure behind a valve or tube."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from pneumorph.mechanics.supplies.gas import GasFilled
from pneumorph.mechanics.supplies.orifice import Orifice


@dataclass(frozen=True, kw_only=True)
class FlowSupply(GasFilled):
    """A regulator or vacuum pump behind a valve or tube: the target is the gauge pressure of the source.

    Gas flows in or out as the pressures tell (`Orifice`), so that phases need a duration.

    conductance:    sonic conductance C of ISO 6358, more than 0.
    critical_ratio: ratio of outlet to inlet pressure below which the flow is choked, above 0 and below 1.
    """

    conductance: float = field(metadata={"kind": "conductance"})
    critical_ratio: float = field(default=0.3, metadata={"kind": "number"})

    kind: ClassVar[str | None] = "pressure"

    def __post_init__(self) -> None:
        super().__post_init__()
        _ = self.orifice

    @property
    def orifice(self) -> Orifice:
        """What the gas flows through."""
        return Orifice(self.conductance, self.critical_ratio)
