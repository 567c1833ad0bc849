"""Writes the list of keys in docs/studies.md from the JSON schema of study files: python docs/drawings/studies.py."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from pneumorph.studies.json_schema import study_schema
from pneumorph.studies.writing import toml_value

PAGE = Path(__file__).parents[1] / "studies.md"
START, END = "<!-- keys -->\n", "<!-- end -->\n"
Schema = Mapping[str, Any]


def keys_text() -> str:
    """Return the tables of all keys, section by section, in the order of a study file."""
    schema = study_schema()
    definitions = schema["$defs"]
    parts = ["### Top level\n", _rows(_plain(schema, definitions))]
    done: set[str] = set()
    for key, item in schema["properties"].items():
        names = [name for name in _tables(item, definitions) if name not in done]
        if not names:
            continue
        array = item.get("type") == "array"
        named = ".NAME" if _tables(item.get("additionalProperties", {}), definitions) else ""
        parts += [
            f"\n### `{'[[' if array else '['}{key}{named}{']]' if array else ']'}`\n",
            _sentence(item["description"]) + "\n",
        ]
        for name in names:
            done.add(name)
            table = definitions[name]
            if len(names) > 1:
                tags = [f"`{tag} = {toml_value(table['properties'][tag]['const'])}`: " for tag in _tags(table)]
                parts.append(f"\n{''.join(tags)}{_sentence(table['description'])}\n")
            parts.append("\n" + _rows((k, i) for k, i in table["properties"].items() if k not in _tags(table)))
    return "".join(parts)


def _plain(schema: Schema, definitions: Schema) -> Iterable[tuple[str, Schema]]:
    return [(key, item) for key, item in schema["properties"].items() if not _tables(item, definitions)]


def _tables(item: Any, definitions: Schema) -> list[str]:
    """Return the names of all tables that may stand in a value, and in these, in order."""
    found: list[str] = []
    if isinstance(item, Mapping):
        name = str(item.get("$ref", "")).rpartition("/")[2]
        if name in definitions:
            found += [name, *_tables(definitions[name]["properties"], definitions)]
        for value in item.values():
            found += _tables(value, definitions)
    elif isinstance(item, list):
        for value in item:
            found += _tables(value, definitions)
    return list(dict.fromkeys(found))


def _tags(table: Schema) -> list[str]:
    """Return the keys that tell the tables of one place apart."""
    return [key for key in table.get("required", ()) if "const" in table["properties"][key]]


def _rows(items: Iterable[tuple[str, Schema]]) -> str:
    rows = "".join(
        f"| `{key}` | {_cell(item.get('description', ''))}{_choices(item)} | {_default(item)} |\n"
        for key, item in items
    )
    return f"| key | meaning | left out |\n|---|---|---|\n{rows}" if rows else ""


def _default(item: Schema) -> str:
    given = item.get("default")
    return "" if given in (None, [], {}) else f"`{toml_value(given)}`"


def _choices(item: Schema) -> str:
    inner = item.get("items") or {}
    options = [item, inner, *inner.get("anyOf", ()), *item.get("anyOf", ())]
    words = [f"`{word}`" for option in options for word in option.get("enum", ())]
    return f"; of {', '.join(words)}" if words else ""


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."


def main() -> None:
    """Write the list into the page, between its marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.split(START)[0], text.split(END)[1]
    PAGE.write_text(f"{before}{START}{keys_text()}{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
