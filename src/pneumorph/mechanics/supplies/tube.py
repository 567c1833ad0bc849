"""A tube between two cavities."""

from __future__ import annotations

from dataclasses import dataclass, field

from pneumorph.errors import InputError
from pneumorph.mechanics.supplies.orifice import Orifice


@dataclass(frozen=True, kw_only=True)
class Tube:
    """A tube or valve through which two gas-filled cavities exchange gas; phases then need a duration.

    between:        names of the two cavities.
    conductance:    sonic conductance C of ISO 6358, more than 0.
    critical_ratio: ratio of outlet to inlet pressure below which the flow is choked, above 0 and below 1.
    """

    between: tuple[str, ...]
    conductance: float = field(metadata={"kind": "conductance"})
    critical_ratio: float = field(default=0.3, metadata={"kind": "number"})

    def __post_init__(self) -> None:
        if isinstance(self.between, str) or len(self.between) != 2 or self.between[0] == self.between[1]:
            raise InputError(f"between = {self.between!r}, expected the names of two different cavities")
        _ = self.orifice

    @property
    def orifice(self) -> Orifice:
        """What the gas flows through."""
        return Orifice(self.conductance, self.critical_ratio)
