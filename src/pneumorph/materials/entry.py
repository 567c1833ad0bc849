"""An entry of the library: a material and where each of its numbers comes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from pneumorph.materials.material import Material
from pneumorph.units import show

Origin = Literal["given", "derived", "assumed"]
Reading = Literal["original", "transcript", "quoted"]


@dataclass(frozen=True)
class Source:
    """Where numbers come from.

    cite:  authors, title, journal, year; or manufacturer and data sheet.
    short: name in a table.
    read:  "original" where its own text or data were read, "transcript" where rows were that others copied or cited,
           "quoted" where the numbers are general knowledge of the source, not read again.
    """

    cite: str
    short: str
    read: Reading


@dataclass(frozen=True)
class Number:
    """A number of an entry with its provenance.

    value:  in inside units; several for the terms of a series; text for a hardness; None for a bulk modulus that is
            1000 times the shear modulus.
    kind:   kind of quantity in `units.KINDS`, "strain" or "text".
    origin: "given" by the source, "derived" from what it gives, or "assumed" by us.
    source: None for an assumption of our own.
    how:    for a derived or assumed number: from what, or why.
    """

    value: float | tuple[float, ...] | str | None
    kind: str
    origin: Origin
    source: Source | None
    how: str = ""

    def text(self) -> str:
        """Return the value with its printed unit."""
        if self.value is None:
            return "1000 × shear modulus"
        if isinstance(self.value, str):
            return self.value
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        if self.kind == "strain":
            return ", ".join(f"{100.0 * value:.4g} %" for value in values)
        return ", ".join(show(value, self.kind) for value in values)


@dataclass(frozen=True)
class LibraryEntry:
    """A named material with its origin.

    numbers: name -> number: the constants of the law, bulk modulus, density, and what else is published.
    about:   what the material is.
    remark:  what the sources leave open.
    """

    name: str
    material: Material
    numbers: Mapping[str, Number]
    about: str
    remark: str = ""

    def _named(self, origin: Origin) -> tuple[str, ...]:
        return tuple(name for name, number in self.numbers.items() if number.origin == origin)

    @property
    def given(self) -> tuple[str, ...]:
        """Names of the numbers that the sources state."""
        return self._named("given")

    @property
    def derived(self) -> tuple[str, ...]:
        """Names of the numbers that follow from what the sources state."""
        return self._named("derived")

    @property
    def assumed(self) -> tuple[str, ...]:
        """Names of the numbers that we chose; a field of the material in none of the three is not known."""
        return self._named("assumed")

    @property
    def sources(self) -> tuple[Source, ...]:
        """The sources, first that of the constants."""
        return tuple(dict.fromkeys(n.source for n in self.numbers.values() if n.source is not None))

    @property
    def source(self) -> str:
        """The sources as one text."""
        return "; ".join(source.cite for source in self.sources)

    @property
    def note(self) -> str:
        """What the material is and what the sources leave open."""
        return f"{self.about} {self.remark}".strip()

    def _value(self, name: str) -> float | None:
        value = self.numbers[name].value if name in self.numbers else None
        return value if isinstance(value, float) else None

    @property
    def tensile_strength(self) -> float | None:
        """Nominal stress at break in uniaxial tension, MPa; None where not known."""
        return self._value("tensile_strength")

    @property
    def elongation(self) -> float | None:
        """Nominal strain at break in uniaxial tension: 9 is 900 %; None where not known."""
        return self._value("elongation")

    @property
    def modulus_100(self) -> float | None:
        """Published nominal stress at 100 % strain in uniaxial tension, MPa; None where not known."""
        return self._value("modulus_100")

    @property
    def valid_to(self) -> float | None:
        """Largest uniaxial stretch that the constants were fitted to; None where not known."""
        return self._value("valid_to")

    @property
    def hardness(self) -> str | None:
        """Shore hardness as printed: "Shore A 30"; None where not known."""
        return str(self.numbers["hardness"].value) if "hardness" in self.numbers else None
