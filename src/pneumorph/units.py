"""Units at the edges: text such as "80 kPa" in and out; plain numbers in mm, N, MPa, s, tonne inside."""

from __future__ import annotations

import re
from functools import cache

import pint

from pneumorph.errors import UnitError, quoted, shortened, unknown_name

# one number, then units: pint alone would also take "1 mm; 2" as 2 mm, "1 m±2" as 2 m, "mm" as 1 mm, and would
# compute towers of powers. Quantifiers that give nothing back (++) keep the time linear.
_NUMBER = r"[-+]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[eE][-+]?[0-9]++)?+"
_UNIT = r"(?:[^\W\d]\w*+|[°%])(?:\s*+(?:\*\*|\^)\s*+[-+]?[0-9]{1,2}(?![0-9.]))?+"
_QUANTITY = re.compile(rf"{_NUMBER}(?:\s*+(?:[*/]\s*+)?+(?:1\s*+/\s*+)?+(?:\(\s*+)?+{_UNIT}(?:\s*+\))?+)*+")

EARTH = 9810.0  # mm/s2, gravity where nothing else is said

# kind of quantity -> (unit used inside, unit used when printed)
KINDS: dict[str, tuple[str, str]] = {
    "length": ("mm", "mm"),
    "area": ("mm**2", "mm²"),
    "volume": ("mm**3", "mL"),
    "pressure": ("MPa", "kPa"),
    "stress": ("MPa", "MPa"),
    "force": ("N", "N"),
    "moment": ("N*mm", "N·mm"),
    "angle": ("rad", "deg"),
    "curvature": ("1/mm", "1/mm"),
    "density": ("tonne/mm**3", "kg/m³"),
    "speed": ("mm/s", "mm/s"),
    "acceleration": ("mm/s**2", "m/s²"),
    "energy": ("mJ", "mJ"),
    "time": ("s", "s"),
    "mass": ("tonne", "mg"),
    "temperature": ("K", "K"),
    "conductance": ("mm**3/(s*MPa)", "L/(min·bar)"),
    "gas constant": ("mm**2/(s**2*K)", "J/(kg·K)"),
    "number": ("", ""),
}


@cache
def _registry() -> pint.UnitRegistry:
    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)  # reads "20 degC"


@cache
def _factor(kind: str) -> float:
    """Return how many printed units make one inside unit."""
    inside, printed = KINDS[kind]
    return float(_registry().Quantity(1.0, inside or "dimensionless").to(_plain(printed) or "dimensionless").magnitude)


def _plain(unit: str) -> str:
    """Return a printed unit in the form that pint reads."""
    return unit.replace("³", "**3").replace("²", "**2").replace("·", "*")


def printed_unit(kind: str) -> str:
    """Return the unit in which a kind of quantity is printed: 'kPa' for 'pressure'."""
    return _kind(kind)[1]


def _kind(kind: str) -> tuple[str, str]:
    if kind not in KINDS:
        raise UnitError(unknown_name("kind of quantity", kind, KINDS))
    return KINDS[kind]


def parse(text: str, kind: str, name: str = "value") -> float:
    """Return a quantity in inside units from text with a unit.

    `kind` is one of `KINDS`; `name` is the input that the message of a `UnitError` blames.

    >>> parse("80 kPa", "pressure")
    0.08
    >>> parse("1130 kg/m3", "density")
    1.13e-09
    """
    inside, printed = _kind(kind)
    example = f"{kind} with its unit, such as '1 {printed}'" if printed else "a plain number"
    if not isinstance(text, str):
        raise UnitError(f"{name} = {shortened(repr(text))}: expected {example}")
    plain = re.sub(r"([A-Za-z])([23])\b", r"\1**\2", _plain(text.strip()))
    if not _QUANTITY.fullmatch(plain):
        raise UnitError(f"{name} = {quoted(text)}: expected {example}")
    try:
        quantity: pint.Quantity = _registry().Quantity(plain)
        value = float(quantity.to(inside or "dimensionless").magnitude)
    except (pint.PintError, TypeError, ValueError, AttributeError, AssertionError, ArithmeticError) as error:
        reason = f" ({shortened(str(error), 100)})" if isinstance(error, pint.PintError) else ""
        raise UnitError(f"{name} = {quoted(text)}: expected {example}{reason}") from None
    except Exception as error:  # pint's tokenizer raises its own parser errors on odd text
        raise UnitError(f"{name} = {quoted(text)}: expected {example}") from error
    if value != value or value in (float("inf"), float("-inf")):
        raise UnitError(f"{name} = {quoted(text)}: expected a finite {kind}")
    return float(f"{value:.15g}")


def to_printed(value: float, kind: str) -> float:
    """Return an inside value in the unit in which its kind is printed: 0.08 MPa -> 80.0 kPa."""
    _kind(kind)
    return value * _factor(kind)


def plain(number: float, digits: int = 4) -> str:
    """Return a number as text with so many digits; up to a million all those before the point are shown.

    >>> plain(1400.0, 3), plain(0.12345, 3)
    ('1400', '0.123')
    """
    return f"{number:.0f}" if 10.0**digits <= abs(number) < 1e6 else f"{number:.{digits}g}"


def show(value: float, kind: str, digits: int = 4) -> str:
    """Return an inside value as text with its printed unit, see `plain`.

    >>> show(0.08, "pressure")
    '80 kPa'
    """
    unit = printed_unit(kind)
    text = plain(to_printed(value, kind), digits)
    return f"{text} {unit}" if unit else text
