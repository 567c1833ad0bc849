"""The values of a model as JSON and back: frozen dataclasses by the name of their class, from a fixed registry.

No code is ever run from a file: a class that is not in the registry is refused.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from inspect import isabstract
from typing import Any

import numpy as np

from pneumorph import materials, mechanics
from pneumorph.errors import PneumorphError, StorageError, unknown_name

CLASS = "$class"

REGISTRY: dict[str, type] = {}


def register(item: type) -> type:
    """Let a frozen dataclass be stored: for materials, loads or supplies of your own. Also a decorator."""
    REGISTRY[item.__name__] = item
    return item


def _register_all() -> None:
    """Register the materials and their parts, the supplies, supports, loads, cavities and programmes of mechanics."""
    for name in materials.__all__:
        item = getattr(materials, name)
        if is_dataclass(item) and isinstance(item, type) and not isabstract(item):
            register(item)
    for name in mechanics.__all__:
        item = getattr(mechanics, name)
        if is_dataclass(item) and isinstance(item, type) and item.__name__ not in ("Model", "State"):
            register(item)


_register_all()


def encode(value: object, name: str = "value") -> Any:
    """Return a value as what JSON can hold; raises StorageError, naming it, for anything that cannot be restored."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if is_dataclass(value) and not isinstance(value, type):
        kind = type(value).__name__
        if REGISTRY.get(kind) is not type(value):
            raise StorageError(
                f"{name}: {kind} cannot be stored in a run folder; register its class with "
                "pneumorph.solution.register, or solve without a folder"
            )
        return {CLASS: kind} | {f.name: encode(getattr(value, f.name), f"{name}.{f.name}") for f in fields(value)}
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str) or key.startswith("$"):
                raise StorageError(f"{name}: key {key!r} cannot be stored, expected text that does not start with '$'")
        return {key: encode(item, f"{name}.{key}") for key, item in value.items()}
    if isinstance(value, Sequence | np.ndarray):
        return [encode(item, f"{name}[{number}]") for number, item in enumerate(value)]
    raise StorageError(f"{name}: a {type(value).__name__} cannot be stored in a run folder")


def decode(value: Any) -> Any:
    """Return the value that `encode` turned into `value`; lists come back as tuples. Raises StorageError."""
    if isinstance(value, list):
        return tuple(decode(item) for item in value)
    if not isinstance(value, dict):
        return value
    if CLASS not in value:
        return {key: decode(item) for key, item in value.items()}
    name = value[CLASS]
    if name not in REGISTRY:
        raise StorageError(unknown_name("class in a run folder", str(name), REGISTRY))
    try:
        return REGISTRY[name](**{key: decode(item) for key, item in value.items() if key != CLASS})
    except (TypeError, PneumorphError) as error:
        raise StorageError(f"{name} cannot be restored: {error}") from error


def differences(stored: Any, given: Any, name: str) -> list[str]:
    """Return what differs between two encoded values, one line for each place."""
    if isinstance(stored, dict) and isinstance(given, dict) and stored.get(CLASS) == given.get(CLASS):
        lines = []
        for key in dict.fromkeys((*stored, *given)):
            if key not in given or key not in stored:
                lines.append(f"{name}.{key} {'is new' if key in given else 'is gone'}")
            else:
                lines += differences(stored[key], given[key], f"{name}.{key}")
        return lines
    if isinstance(stored, list) and isinstance(given, list) and len(stored) == len(given):
        pairs = enumerate(zip(stored, given, strict=True))
        return [line for i, (a, b) in pairs for line in differences(a, b, f"{name}[{i}]")]
    if stored == given or (stored != stored and given != given):
        return []
    return [f"{name} = {_short(given)}, the folder holds {_short(stored)}"]


def _short(value: Any) -> str:
    if isinstance(value, dict) and CLASS in value:
        inner = ", ".join(f"{key}={_short(item)}" for key, item in value.items() if key != CLASS)
        return f"{value[CLASS]}({inner})"
    return repr(value)
