"""What a study file says about the filling of cavities: supplies by name or as a table, tubes, the atmosphere."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Union

from pydantic import BeforeValidator, Field, Strict, WrapSerializer
from pydantic.functional_serializers import SerializerFunctionWrapHandler

from pneumorph.errors import InputError
from pneumorph.mechanics import (
    Atmosphere,
    FlowSupply,
    GasSupply,
    PressureSupply,
    SealedSupply,
    Supply,
    Tube,
    VolumeSupply,
)
from pneumorph.studies.json_types import NameOrTable
from pneumorph.studies.section import Section, quantity, section_of

SUPPLIES: dict[str, type] = {
    "pressure": PressureSupply,
    "volume": VolumeSupply,
    "gas": GasSupply,
    "sealed": SealedSupply,
    "flow": FlowSupply,
}
# supplies that need nothing said but their name
_BY_NAME = ("pressure", "volume", "gas", "sealed")

SUPPLY_SECTIONS = {name: section_of(owner, type=name) for name, owner in SUPPLIES.items()}


def _table(value: object) -> object:
    """Return "gas" as {type = "gas"}."""
    return {"type": value} if isinstance(value, str) else value


def _text(value: Section, handler: SerializerFunctionWrapHandler) -> Any:
    """Return a table with nothing but its type as text."""
    table = handler(value)
    return table["type"] if isinstance(table, Mapping) and len(table) == 1 else table


SupplySection: Any = Annotated[
    Union[tuple(SUPPLY_SECTIONS.values())],  # noqa: UP007
    Field(discriminator="type"),
    BeforeValidator(_table),
    WrapSerializer(_text),
    NameOrTable(_BY_NAME),
]
AtmosphereSection: Any = section_of(Atmosphere, "AtmosphereSection")


class TubeSection(Section):
    """A tube between two cavities that are filled with gas."""

    _owner = Tube

    between: Annotated[tuple[str, ...], Strict(False)]
    conductance: quantity("conductance")  # type: ignore[valid-type]
    critical_ratio: float = 0.3


def supply_of(section: Any, cavity: str) -> Supply:
    """Return the supply of a section; raises InputError that names the cavity."""
    values = {name: getattr(section, name) for name in type(section).model_fields if name != "type"}
    try:
        made: Supply = SUPPLIES[section.type](**values)
    except InputError as error:
        raise InputError(f"cavity '{cavity}': supply: {error}") from None
    return made


def tube_of(section: TubeSection, number: int) -> Tube:
    """Return the tube of a section; raises InputError that names it."""
    try:
        return Tube(between=section.between, conductance=section.conductance, critical_ratio=section.critical_ratio)
    except InputError as error:
        raise InputError(f"tube[{number}]: {error}") from None
