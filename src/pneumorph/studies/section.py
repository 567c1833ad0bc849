"""What the sections of a study file share: quantities as text with a unit, and messages that name the key."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Annotated, Any, ClassVar, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    GetJsonSchemaHandler,
    PlainSerializer,
    Strict,
    ValidationError,
    ValidationInfo,
    WithJsonSchema,
    create_model,
    model_validator,
)
from pydantic_core import CoreSchema

from pneumorph.errors import InputError, StudyError, UnitError, shortened, unknown_name
from pneumorph.studies.describing import meanings, summary
from pneumorph.studies.json_types import quantity_schema, runs_schema, without_null
from pneumorph.units import parse, show

# tag of the material section that has no law of its own
LIBRARY = "library"
# tag of the actuator section that has no template
IMPORTED = "imported"


class Section(BaseModel):
    """A table of a study file: frozen, and every key must be known."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, hide_input_in_errors=True)
    # the class whose fields and docstring this section takes over
    _owner: ClassVar[type | None] = None

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, table: Any) -> Any:
        if isinstance(table, Mapping):
            for key in table:
                if key not in cls.model_fields:
                    raise StudyError(unknown_name("key", str(key), cls.model_fields))
        return table

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return the JSON schema with the meaning of every key, and defaults as they stand in a file."""
        reference = handler(core)
        schema = handler.resolve_ref_schema(reference)
        schema["description"] = summary(cls._owner or cls)
        says = meanings(cls._owner or cls)
        defaults = cls.model_construct().model_dump(mode="json", exclude_none=True, warnings=False)
        for key, given in schema["properties"].items():
            item = without_null(given)
            kind = item.get("description")
            if "const" in item:  # tells the sections of a union apart
                item["description"] = schema["description"]
            if key in says:
                item["description"] = f"{says[key]}; {kind}" if kind else says[key]
            if key in defaults:
                item["default"] = defaults[key]
            schema["properties"][key] = item
        return reference


@cache
def quantity(kind: str) -> Any:
    """Return the type of a quantity of a unit kind: text with a unit in the file, a float in inside units here."""

    def read(value: object, info: ValidationInfo) -> float:
        # a number is inside already: defaults, and sections made in Python
        if isinstance(value, float) and info.context is None:
            return value
        return parse(value, kind, info.field_name or "value")  # type: ignore[arg-type]

    return Annotated[
        float,
        BeforeValidator(read),
        PlainSerializer(lambda value: write(value, kind)),
        WithJsonSchema(quantity_schema(kind)),
    ]


def write(value: float, kind: str) -> str:
    """Return an inside value as text that `units.parse` reads back: 0.08 MPa -> '80 kPa'."""
    return show(value, kind, digits=15)


def section_of(owner: type, name: str | None = None, **tag: str) -> type[Section]:
    """Return the section whose keys are the fields of a dataclass, typed by the unit `kind` in their metadata.

    A field with `many` in its metadata is a list, one that holds a dataclass is a table of its own, one that holds a
    tuple of dataclasses an array of tables. A `tag` such as
    template="finger" adds a key with this one value, which tells the sections of a union apart.
    """
    keys: dict[str, Any] = {key: (Literal[value], ...) for key, value in tag.items()}
    hints = get_type_hints(owner)
    for item in fields(owner):
        if item.init:
            keys[item.name] = (_type_of(item, hints[item.name]), ... if item.default is MISSING else item.default)
    section = create_model(name or owner.__name__, __base__=Section, **keys)
    section._owner = owner
    return section


def _type_of(item: Field[Any], hint: Any) -> Any:
    kind = item.metadata.get("kind")
    if item.metadata.get("many"):
        one: Any = float if kind == "number" else quantity(str(kind))
        return Annotated[tuple[one, ...], Strict(False)]
    if kind == "runs":
        return runs(item.metadata["names"]) | None
    if kind is None:
        parts = get_args(hint)
        if get_origin(hint) is tuple and is_dataclass(parts[0]) and isinstance(parts[0], type):
            return Annotated[tuple[section_of(parts[0]), ...], Strict(False)]  # type: ignore[misc]
        sections = (section_of(part) if is_dataclass(part) and isinstance(part, type) else part for part in parts)
        return Union[tuple(sections)] if any(map(is_dataclass, parts)) else hint  # noqa: UP007
    if kind in ("count", "number"):
        return hint
    optional = get_origin(hint) in (Union, UnionType) and type(None) in get_args(hint)
    return quantity(kind) | None if optional else quantity(kind)


@cache
def runs(names: tuple[str, ...]) -> Any:
    """Return the type of a list of pairs, a number and one of some names: [[6, "re-entrant"], [6, "honeycomb"]]."""

    def read(value: object) -> tuple[tuple[int, str], ...]:
        pairs: Any = value if isinstance(value, list | tuple) else [None]
        for pair in pairs:
            known = isinstance(pair, list | tuple) and len(pair) == 2 and type(pair[0]) is int
            if not known or not isinstance(pair[1], str):
                example = f'[[6, "{names[0]}"], [6, "{names[-1]}"]]'
                raise StudyError(f"{shortened(repr(value))}: expected pairs of a whole number and a name, as {example}")
            if pair[1] not in names:
                raise StudyError(unknown_name("kind", pair[1], names))
        return tuple((pair[0], pair[1]) for pair in pairs)

    return Annotated[tuple[tuple[int, str], ...], BeforeValidator(read), WithJsonSchema(runs_schema(names))]


def built(value: Any) -> Any:
    """Return what a value of a section stands for: for a section of a dataclass an object of it, so in a tuple too."""
    if isinstance(value, tuple):
        return tuple(built(item) for item in value)
    if isinstance(value, Section) and value._owner is not None:
        return value._owner(**{name: built(getattr(value, name)) for name in type(value).model_fields})
    return value


def refusal(error: ValidationError, tags: Iterable[str]) -> InputError:
    """Return the error to raise: one line for each wrong input, with its path; `tags` are not part of a path.

    It is a UnitError if units are all that is wrong, else a StudyError.
    """
    hidden, items = set(tags), error.errors()
    units = all(isinstance(item.get("ctx", {}).get("error"), UnitError) for item in items)
    return (UnitError if units else StudyError)("\n".join(_line(item, hidden) for item in items))


def _line(item: Any, hidden: set[str]) -> str:
    # names that the user gave may be those of tags
    path = list(zip(item["loc"], ("", *item["loc"]), strict=False))
    bodies = item["loc"][:1] in (("body",), ("part",))
    given = [before in ("faces", "caps") or (bodies and n == 1) for n, (_, before) in enumerate(path)]
    place = _path([part for (part, _), own in zip(path, given, strict=True) if own or part not in hidden])
    kind, context, value = item["type"], item.get("ctx", {}), item.get("input")
    if kind == "value_error":  # raised by ourselves: the message is complete
        text = str(context["error"])
        owner, _, key = place.rpartition(".")
        where = owner if text.startswith(f"{key} = ") else place
        return f"{where}: {text}" if where else text
    if kind == "missing":
        return f"{place}: missing"
    if kind == "union_tag_not_found":
        key = context["discriminator"].strip("'()")
        return f"{place}: missing '{key}'" + (" or 'file'" if key == "template" else "")
    if kind == "union_tag_invalid":
        key = context["discriminator"].strip("'()")
        expected = [name.strip("' ") for name in context["expected_tags"].split(",")]
        expected = [name for name in expected if name not in (LIBRARY, IMPORTED)]
        return f"{place}: " + unknown_name(key, str(context["tag"]), expected)
    message = item["msg"].replace("a valid tuple", "a list")
    return f"{place or 'study'} = {shortened(repr(value))}: {message[0].lower()}{message[1:]}"


def _path(parts: list[str | int]) -> str:
    """Return ('load', 0, 'face') as 'load[1].face': tables of an array count from 1, as a reader does."""
    text = ""
    for part in parts:
        text += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if text else str(part)
    return text
