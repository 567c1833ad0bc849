"""A direction in a study file: an axis with its sign, or three numbers."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, ValidationInfo, WithJsonSchema

from pneumorph.errors import StudyError
from pneumorph.studies.json_types import direction_schema


def _direction(value: object, info: ValidationInfo) -> tuple[float, ...]:
    """Return the components of "-z", or of a list of numbers."""
    if isinstance(value, str) and value.lstrip("+-") in ("x", "y", "z") and len(value) <= 2:
        sign = -1.0 if value.startswith("-") else 1.0
        return tuple(sign if value[-1] == axis else 0.0 for axis in "xyz")
    if isinstance(value, list | tuple) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in value):
        return tuple(map(float, value))
    raise StudyError(f"{info.field_name} = {value!r}: expected an axis such as '-z', or a list of 3 numbers")


Direction = Annotated[tuple[float, ...], BeforeValidator(_direction), WithJsonSchema(direction_schema())]
