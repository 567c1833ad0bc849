"""What the columns of a table mean: quantity, measure and unit, from their names."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from pneumorph.errors import InputError, UnitError
from pneumorph.units import parse

# word in a column's name -> quantity
_QUANTITIES = {
    "stretch": "stretch", "lambda": "stretch", "λ": "stretch", "strain": "strain", "elongation": "strain",
    "displacement": "displacement", "extension": "displacement", "stress": "stress", "force": "force", "load": "force",
    "test": "test", "mode": "test", "specimen": "specimen", "sample": "specimen",
}  # fmt: skip
_ENGINEERING = {"engineering", "eng", "nominal", "pk1"}
_TRUE = {"true", "cauchy", "logarithmic", "log", "hencky"}
_FILLER = {"tensile", "compressive", "ratio", "axial", "type", "name", "id", "no", "number", "applied", "of"}
_PLAIN_UNITS = {"": 1.0, "-": 1.0, "1": 1.0, "mm/mm": 1.0, "m/m": 1.0, "%": 0.01, "percent": 0.01}
_IN_BRACKETS = re.compile(r"^(?P<name>[^\[(]*)[\[(]\s*(?P<unit>[^\])]*?)\s*[\])]\s*$")


@dataclass(frozen=True)
class Column:
    """A column that is understood.

    index: place in the table. quantity: one of stretch, strain, displacement, stress, force, test, specimen.
    true: whether the name says true (True) or engineering (False); None where it says neither.
    unit: unit in the name, None where there is none.
    """

    index: int
    title: str
    quantity: str
    true: bool | None
    unit: str | None


def understand(header: Sequence[str], units: Sequence[str] | None = None) -> list[Column]:
    """Return the columns whose names are understood; `units` is a row of units below the header, if there is one."""
    columns = []
    for index, title in enumerate(header):
        name, unit = _split(title)
        words = re.findall(r"[^\W\d_]+|pk1", name.lower())
        quantity = next((_QUANTITIES[word] for word in reversed(words) if word in _QUANTITIES), None)
        if quantity is None:
            continue
        true = True if _TRUE & set(words) else False if _ENGINEERING & set(words) else None
        if unit is None and units is not None and units[index].strip():
            unit = units[index].strip().strip("[]() ")
        columns.append(Column(index, title, quantity, true, unit))
    return columns


def _split(title: str) -> tuple[str, str | None]:
    """Return name and unit of 'stress [MPa]', 'stress (MPa)', 'stress / MPa', 'stress_MPa' and 'strain %'."""
    found = _IN_BRACKETS.match(title)
    if found:
        return found["name"], found["unit"]
    name, slash, unit = title.partition(" / ")
    if slash:
        return name, unit.strip()
    words = title.replace("_", " ").split()
    known = set(_QUANTITIES) | _ENGINEERING | _TRUE | _FILLER
    if len(words) > 1 and words[-1].lower() not in known:
        return " ".join(words[:-1]), words[-1]
    return title, None


def plain_factor(unit: str, what: str) -> float:
    """Return the factor of a strain or stretch in '-' or '%'; `what` is blamed for another unit."""
    factor = _PLAIN_UNITS.get(unit.strip().lower())
    if factor is None:
        raise UnitError(f"{what}: unit '{unit}', allowed: '-', 'mm/mm' or '%'")
    return factor


def factor_of(unit: str, kind: str, what: str) -> float:
    """Return the inside value of one unit of a kind; kg/cm2 means kilogram-force. Raises UnitError."""
    plain = re.sub(r"^kg(?=\s*/)", "kgf", unit.strip()) if kind == "stress" else unit.strip()
    if not plain or plain[0] in "-+.0123456789":
        raise UnitError(f"{what}: unit '{unit}', expected a unit of {kind} such as MPa, kPa, psi")
    try:
        return parse(f"1 {plain}", kind, what)
    except UnitError:
        raise UnitError(f"{what}: unit '{unit}', expected a unit of {kind}") from None


def only(columns: Sequence[Column], quantities: Sequence[str], source: str, what: str) -> Column | None:
    """Return the column of the first quantity that is there; raises InputError where two columns give it."""
    for quantity in quantities:
        found = [column for column in columns if column.quantity == quantity]
        if len(found) > 1:
            titles = " and ".join(f"'{column.title}'" for column in found)
            raise InputError(f"{source}: columns {titles} both give the {what}, allowed: one")
        if found:
            return found[0]
    return None
