"""JSON schema of the kinds of value that a study file holds: what an editor checks and offers while one types."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic import GetJsonSchemaHandler
from pydantic_core import CoreSchema

from pneumorph.units import printed_unit

JsonSchema = dict[str, Any]

# a number and something that can be a unit; which units fit is for `units.parse` to say
_QUANTITY = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*(\*|/|1/)?\s*[A-Za-zµμΩ°%(]"
_AXIS = r"^[-+]?[xyz]$"
# units that editors offer, besides the one in which a kind is printed
_EXAMPLES = {"length": ("3 mm", "9 cm"), "pressure": ("80 kPa", "0.11 MPa", "-20 kPa"), "volume": ("4 mL", "500 mm3")}


def quantity_schema(kind: str) -> JsonSchema:
    """Return the schema of text with a unit of a kind; plain text for a kind without a unit."""
    unit = printed_unit(kind)
    if not unit:
        return {"type": "string", "description": "a plain number as text", "examples": ["1"]}
    examples = list(_EXAMPLES.get(kind, (f"1 {unit}",)))
    return {"type": "string", "pattern": _QUANTITY, "description": f"{kind} with its unit", "examples": examples}


def any_quantity_schema() -> JsonSchema:
    """Return the schema of text with a unit that depends on what it is given for."""
    return {
        "type": "string",
        "pattern": _QUANTITY,
        "description": "value with the unit of what it drives",
        "examples": ["80 kPa", "4 mL", "1 N", "2 mm"],
    }


def size_schema() -> JsonSchema:
    """Return the schema of the mesh size: a length or a word."""
    return {"anyOf": [{"enum": ["automatic", "coarse"]}, quantity_schema("length")]}


def place_schema(most: int = 3) -> JsonSchema:
    """Return the schema of a point: three lengths, two in plane models; most: how many at most."""
    lengths = [quantity_schema("length")] * most
    return {"type": "array", "prefixItems": lengths, "minItems": 2, "maxItems": most}


def direction_schema() -> JsonSchema:
    """Return the schema of a direction: an axis with its sign, or three numbers."""
    numbers = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
    return {"anyOf": [{"type": "string", "pattern": _AXIS, "examples": ["-z", "x"]}, numbers]}


def runs_schema(names: Sequence[str]) -> JsonSchema:
    """Return the schema of a list of pairs, a number and one of some names."""
    pair = [{"type": "integer", "minimum": 1}, {"enum": list(names)}]
    item = {"type": "array", "prefixItems": pair, "minItems": 2, "maxItems": 2}
    return {"type": "array", "items": item, "examples": [[[6, names[0]], [6, names[1]]]]}


class AloneOrByName:
    """Marks a table of tables in whose place one of the inner tables may stand alone."""

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        table = handler(core)
        return {"anyOf": [table["additionalProperties"], table]}


class NameOrTable:
    """Marks a table in whose place one of some names may stand."""

    def __init__(self, names: Sequence[str]):
        self._names = list(names)

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        return {"anyOf": [{"enum": self._names}, handler(core)]}


def without_null(schema: JsonSchema) -> JsonSchema:
    """Return a property's schema without null, which TOML does not have: such a key is left out instead."""
    schema = {key: value for key, value in schema.items() if not (key == "default" and value is None)}
    options = [item for item in schema.get("anyOf", ()) if item != {"type": "null"}]
    if "anyOf" in schema and len(options) == 1:
        del schema["anyOf"]
        return {**options[0], **schema}
    return schema | {"anyOf": options} if options else schema
