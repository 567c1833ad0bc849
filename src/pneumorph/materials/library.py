"""The library: silicones and stiff partners by name, each number with its source.

The data are `library.toml` beside this file; its head explains the format. `read` checks and reads such a text.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import Field, fields
from functools import cache
from importlib import resources
from typing import Any, get_args

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.materials.entry import LibraryEntry, Number, Origin, Reading, Source
from pneumorph.materials.laws import LAWS
from pneumorph.materials.material import Material
from pneumorph.units import parse

# what is published of a material beside the fields of its law -> kind of quantity
PROPERTIES = {
    "young": "stress",
    "modulus_100": "stress",
    "tensile_strength": "stress",
    "elongation": "strain",
    "hardness": "text",
    "valid_to": "number",
}

_BULK = "nearly incompressible: 1000 times the initial shear modulus"

# (number to derive, number it follows from) -> (rule, what it says)
_Rule = tuple[Callable[[float], float], str]
_RULES: dict[tuple[str, str], _Rule] = {
    ("mu", "modulus_100"): (
        lambda stress: stress / (2.0 - 2.0**-2),
        "nominal stress at 100 % strain over 1.75: σ = μ (λ - 1/λ²) at λ = 2",
    ),
    ("mu", "young"): (lambda young: young / 3.0, "a third of Young's modulus, as the solid is incompressible"),
    ("valid_to", "modulus_100"): (lambda _: 2.0, "the stretch of the one point that the constant is from"),
}
_FIT = "fit to a measured uniaxial test at stretches 1.25 to 2.5"


def names() -> tuple[str, ...]:
    """Return the names of all materials of the library, sorted."""
    return tuple(sorted(_library()))


def entry(name: str) -> LibraryEntry:
    """Return a material with its sources and assumptions; upper and lower case are alike.

    Raises NameNotFoundError with the nearest name.
    """
    found = _library().get(name.strip().lower())
    if found is None:
        raise NameNotFoundError(unknown_name("material", name, _library()))
    return found


def material(name: str) -> Material:
    """Return a material by its name in the library; upper and lower case are alike.

    Raises NameNotFoundError with the nearest name.

    >>> material("Shore-A45-platinum").c10
    0.11
    """
    return entry(name).material


def entry_of(solid: Material) -> LibraryEntry | None:
    """Return the entry that a material was taken from; None for a material that is not of the library.

    The very object decides; a copy is recognised where one entry alone has its numbers.
    """
    own = [one for one in _library().values() if one.material is solid]
    alike = own or [one for one in _library().values() if one.material == solid]
    return alike[0] if len(alike) == 1 else None


@cache
def _library() -> dict[str, LibraryEntry]:
    return read(resources.files("pneumorph.materials").joinpath("library.toml").read_text(encoding="utf-8"))


def read(text: str) -> dict[str, LibraryEntry]:
    """Return the entries of a library in TOML, by name.

    Raises InputError for text that is no TOML, and for a material with an unknown key, law, number or source, or with
    constants that its law refuses.
    """
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"library of materials: {error}") from error
    _allow("library of materials", "table", table, ("source", "material"))
    sources = {key: _source(key, value) for key, value in _table("source", table.get("source", {})).items()}
    solids = _table("material", table.get("material", {}))
    return {name: _entry(name, value, sources) for name, value in solids.items()}


def _table(owner: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise InputError(f"{owner} = {value!r}: expected a table")
    return value


def _allow(owner: str, what: str, found: Mapping[str, Any] | list[str], allowed: Any) -> None:
    for key in found:
        if key not in allowed:
            raise InputError(f"{owner}: {unknown_name(what, key, allowed)}")


def _source(key: str, table: Mapping[str, Any]) -> Source:
    owner = f"source '{key}'"
    _allow(owner, "key", _table(owner, table), ("cite", "short", "read"))
    for needed in ("cite", "short", "read"):
        if needed not in table:
            raise InputError(f"{owner}: {needed} is missing")
    _allow(owner, "reading", [table["read"]], get_args(Reading))
    return Source(cite=table["cite"], short=table["short"], read=table["read"])


def _entry(name: str, table: Mapping[str, Any], sources: Mapping[str, Source]) -> LibraryEntry:
    owner = f"material '{name}'"
    origins: tuple[Origin, ...] = get_args(Origin)
    _allow(owner, "key", _table(owner, table), ("about", "note", "law", "source", *origins))
    _allow(owner, "law", [table.get("law", "none")], LAWS)
    _allow(owner, "source", [table.get("source", "none")], sources)
    law = LAWS[table["law"]]
    constants = {item.name: item.metadata["kind"] for item in _own_first(law)}
    numbers: dict[str, Number] = {}
    for origin in origins:
        for key, given in _table(f"{owner}: {origin}", table.get(origin, {})).items():
            if key in numbers:
                raise InputError(f"{owner}: {key} is {numbers[key].origin} and {origin}")
            _allow(owner, "number", [key], constants | PROPERTIES)
            kind = (constants | PROPERTIES)[key]
            item = given if isinstance(given, Mapping) else {"value": given}
            _allow(f"{owner}: {key}", "key", item, ("value", "source", "how", "from"))
            cited = item.get("source", None if origin == "assumed" else table["source"])
            _allow(f"{owner}: {key}", "source", [] if cited is None else [cited], sources)
            source = None if cited is None else sources[cited]
            numbers[key] = _number(owner, key, kind, origin, item, source, numbers)
    # a law that has its own bulk modulus, such as Hooke's, needs none
    if law.bulk_modulus is Material.bulk_modulus and "bulk" not in numbers:
        numbers["bulk"] = Number(None, "stress", "assumed", None, _BULK)
    ordered = {key: numbers[key] for key in (*constants, *PROPERTIES) if key in numbers}
    values: dict[str, Any] = {
        key: ordered[key].value for key in constants if key in ordered and ordered[key].value is not None
    }
    try:
        solid = law(**values)
    except (InputError, TypeError) as error:
        raise InputError(f"{owner}: {error}") from error
    return LibraryEntry(name, solid, ordered, table.get("about", ""), table.get("note", ""))


def _own_first(law: type[Material]) -> list[Field[Any]]:
    """Return the quantities of a law: its own constants, then what all materials have."""
    shared = {item.name for item in fields(Material)}
    quantities = [item for item in fields(law) if "kind" in item.metadata]
    return sorted(quantities, key=lambda item: item.name in shared)


def _number(
    owner: str,
    key: str,
    kind: str,
    origin: Origin,
    item: Mapping[str, Any],
    source: Source | None,
    known: Mapping[str, Number],
) -> Number:
    """Return one number; `known` are those read before it, from which it may follow."""
    value: Any
    origin_of, how = item.get("from"), item.get("how", "")
    if origin_of is not None and origin_of != "fit":
        if (key, origin_of) not in _RULES or origin_of not in known:
            raise InputError(f"{owner}: {key} cannot be derived from {origin_of}")
        rule, how = _RULES[key, origin_of]
        base = known[origin_of]
        # as many digits as `parse` keeps, so that a study file can hold the very value
        value = float(f"{rule(float(base.value)):.15g}")  # type: ignore[arg-type]
        return Number(value, kind, origin, base.source, how)
    if origin_of == "fit":
        how = _FIT
    if origin != "given" and not how:
        raise InputError(f"{owner}: {key} is {origin}, but not how")
    value = item.get("value")
    if value is None and not (key == "bulk" and origin == "assumed"):
        raise InputError(f"{owner}: {key} has no value")
    if kind == "text" and not isinstance(value, str):
        raise InputError(f"{owner}: {key} = {value!r}: expected text")
    if value is not None and kind != "text":
        unit, name = "number" if kind == "strain" else kind, f"{owner}: {key}"
        many = isinstance(value, list)
        value = tuple(parse(one, unit, name) for one in value) if many else parse(value, unit, name)
    return Number(value, kind, origin, source, how)
