"""The surroundings, and the gas that fills cavities."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

from pneumorph.errors import InputError
from pneumorph.units import show


@dataclass(frozen=True)
class Atmosphere:
    """Pressure and temperature outside, and the gas constant inside; the defaults are air at 20 degrees Celsius.

    pressure:     absolute pressure outside, which gauge pressures are counted from, more than 0.
    temperature:  absolute temperature outside, and of all gas that comes in through a line, more than 0.
    gas_constant: specific gas constant, that of dry air by default, more than 0.
    """

    pressure: float = field(default=0.101325, metadata={"kind": "pressure"})
    temperature: float = field(default=293.15, metadata={"kind": "temperature"})
    gas_constant: float = field(default=287.05e6, metadata={"kind": "gas constant"})

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if not 0.0 < value < float("inf"):
                text = show(value, item.metadata["kind"])
                raise InputError(f"atmosphere: {item.name} = {text}, allowed: more than 0")

    @property
    def specific(self) -> float:
        """Pressure times volume of a tonne of gas at the temperature outside, MPa mm3 / t."""
        return self.gas_constant * self.temperature
