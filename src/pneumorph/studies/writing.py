"""Plain data -> TOML text, for the resolved study beside the results."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def to_toml(table: Mapping[str, Any], path: tuple[str, ...] = ()) -> str:
    """Return TOML text of nested tables, lists, text, numbers and booleans; None is left out.

    Tables stand on their own lines down to the level below the arrays of tables, where they are written inline.
    """
    entries = {key: value for key, value in table.items() if value is not None}
    lines = [f"{toml_key(k)} = {toml_value(v)}" for k, v in entries.items() if not _is_table(v) and not _is_array(v)]
    for key, value in entries.items():
        name = ".".join(map(toml_key, (*path, key)))
        if _is_table(value):
            inner = to_toml(value, (*path, key))
            only_tables = value and all(_is_table(v) for v in value.values() if v is not None)
            lines.append((inner if only_tables else f"\n[{name}]\n{inner}").rstrip())
        elif _is_array(value):
            for item in value:
                rows = [f"{toml_key(k)} = {toml_value(v)}" for k, v in item.items() if v is not None]
                lines.append("\n".join(["", f"[[{name}]]", *rows]))
    return "\n".join(lines) + "\n"


def _is_table(value: object) -> bool:
    return isinstance(value, Mapping)


def _is_array(value: object) -> bool:
    return isinstance(value, list | tuple) and len(value) > 0 and all(_is_table(item) for item in value)


def toml_key(key: str) -> str:
    """Return a key as TOML writes it: bare where that is allowed."""
    return key if key.replace("_", "").replace("-", "").isalnum() and key.isascii() else toml_value(key)


def toml_value(value: object) -> str:
    """Return plain data on one line; raises TypeError for what TOML cannot say."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str):  # JSON's escapes are TOML's, but for DEL
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        inner = ", ".join(f"{toml_key(k)} = {toml_value(v)}" for k, v in value.items() if v is not None)
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    raise TypeError(f"no TOML for {value!r}")
