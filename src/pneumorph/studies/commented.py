"""A study file with everything that can be said in it: what is said as it is, the rest as comments."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any

from pneumorph.studies.json_schema import study_schema
from pneumorph.studies.writing import toml_key, toml_value

WIDTH = 120
# the same for all templates, so that nobody has to look up what a line without '#' would have been
_HOW_TO_READ = (
    'Every quantity is text with its unit, such as "80 kPa". Lines that begin with "# " and a key show what else can '
    "be said: behind it stands the value that holds without the line, or an example. Nothing else is needed."
)
Schema = Mapping[str, Any]


def commented_study(data: Mapping[str, Any], head: Iterable[str] = (), words: Mapping[str, str] | None = None) -> str:
    """Return the text of a study file with the meaning of every key.

    data: a study as plain data, such as `Study.resolved`. Keys of the actuator, and whatever differs from its default,
    are written; everything else that the schema knows stands there as a comment.
    head: paragraphs above the study. words: key -> word that its example shows, such as {"face": "tip"}.
    """
    return _Writer(study_schema(), words or {}).text(data, (*head, _HOW_TO_READ))


class _Writer:
    """Walks a JSON schema beside the data of a study."""

    def __init__(self, schema: Schema, words: Mapping[str, str]) -> None:
        self.schema = schema
        self.words = words
        self.definitions = schema["$defs"]

    def text(self, data: Mapping[str, Any], head: Iterable[str]) -> str:
        lines = [line for paragraph in head for line in _comment(paragraph)]
        for key, item in self.schema["properties"].items():
            lines += self.entry(key, item, data.get(key), key in self.schema["required"])
        return "\n".join(lines).rstrip() + "\n"

    def entry(self, key: str, item: Schema, value: Any, required: bool) -> list[str]:
        """Return the lines of a key of the file: plain, a table, tables by domain or name, or an array of tables."""
        inner = self.variants(item.get("items", {}))
        if inner:
            return self.tables(f"[[{key}]]", item["description"], inner, value or [])
        if item.get("anyOf") and (inner := self.variants(item["anyOf"][0])):
            return self.domains(key, item["description"], inner, value)
        inner = self.variants(item.get("additionalProperties", {}))
        if inner and value:
            return self.domains(key, item["description"], inner, value)
        if inner:
            return self.tables(f"[{key}.{self.words.get(key, 'name')}]", item["description"], inner, [])
        inner = self.variants(item)
        if inner:
            return self.tables(f"[{key}]", item["description"], inner, [] if value is None else [value])
        return self.line(key, item, value, required)

    def domains(self, key: str, description: str, variants: list[Schema], values: Mapping[str, Any]) -> list[str]:
        """Return one written table a domain, and what else there is to choose from after the first."""
        lines: list[str] = []
        for domain, value in values.items():
            header = f"[{key}.{toml_key(domain)}]"
            lines += (
                ["", header, *self.body(_fitting(variants, value), value, whole=False)]
                if lines
                else self.tables(header, description, variants, [value])
            )
        return lines

    def variants(self, item: Schema) -> list[Schema]:
        """Return the tables that may stand in a place: none if it holds no table."""
        options = item.get("oneOf", [item])
        return [self.definitions[option["$ref"].rpartition("/")[2]] for option in options if "$ref" in option]

    def tables(self, header: str, description: str, variants: list[Schema], values: list[Any]) -> list[str]:
        """Return written tables, the first of each variant with all that it can say, then the others as comments."""
        lines = ["", *_sentence(description)]
        left = list(variants)
        for value in values:
            variant = _fitting(variants, value)
            lines += [header, *self.body(variant, value, whole=variant in left, name=header.strip("[]")), ""]
            left = [v for v in left if v is not variant]
        for variant in [] if values and header == "[actuator]" else left:
            if len(variants) > 1:
                lines += _sentence(variant["description"])
            lines += [f"# {header}", *self.body(variant, None, whole=True, name=header.strip("[]")), ""]
        return lines[:-1]

    def body(self, variant: Schema, value: Mapping[str, Any] | None, whole: bool, name: str = "") -> list[str]:
        """Return the keys of one table; without a value all are comments, without `whole` only what is said stands.

        name: of the table; its arrays of tables, which have to follow all its keys, begin with it.
        """
        lines, tail = [], []
        required = variant.get("required", ())
        dimensions = value is not None and "template" in value
        properties: Mapping[str, Schema] = variant["properties"]
        for key in properties if dimensions else sorted(properties, key=lambda key: key not in required):
            item, said = properties[key], (value or {}).get(key)
            inner = self.variants(item.get("items", {}))
            if inner and whole:
                tail += self.tables(f"[[{name}.{key}]]", item["description"], inner, said or [])
            elif said not in (None, [], ()) and (whole or key in required or said != item.get("default")):
                keep = dimensions or key in required
                lines += self.line(key, item, said, keep) if whole else [f"{toml_key(key)} = {toml_value(said)}"]
            elif whole:
                lines += self.line(key, item, None, False)
        return lines + tail

    def line(self, key: str, item: Schema, value: Any, keep: bool) -> list[str]:
        """Return `key = value  # meaning`, or the same as a comment if there is no value but the default."""
        written = value is not None and (keep or value != item.get("default"))
        shown = value if written else self.example(item, key)
        text = f"{'' if written else '# '}{toml_key(key)} = {toml_value(shown)}"
        # the unit stands in the value
        meaning = "" if "const" in item else re.sub(r"; [a-z ]+ with its unit$", "", item.get("description", ""))
        meaning = re.sub(r"\bNone\b", "left out", meaning)
        choices = self.choices(item)
        if choices:
            meaning += f"; of {', '.join(choices)}"
        together = f"{text:<34}  # {meaning}" if meaning else text
        lines = [together] if len(together) <= WIDTH else [*_comment(f"{key}: {meaning}"), text]
        tables = [self.example(variant) for variant in self.tables_in_line(item)]
        return lines + [f"# {toml_key(key)} = {toml_value(t)}" for t in tables if len(t) > 1 and t != shown]

    def tables_in_line(self, item: Schema) -> list[Schema]:
        """Return the tables that may be the value of a key, unless the schema has an example of it."""
        if "examples" in item:
            return []
        return [table for option in (item, *item.get("anyOf", ())) for table in self.variants(option)]

    def choices(self, item: Schema) -> list[str]:
        """Return the words among which a value is chosen, if it is."""
        if "items" in item:
            return self.choices(item["items"])
        options = [item, *item.get("anyOf", ())]
        return [toml_value(word) for option in options for word in option.get("enum", ())]

    def example(self, item: Schema, key: str = "") -> Any:
        """Return the default of a value that is not empty, or an example of it."""
        for given in (item.get("default"), item.get("const"), *item.get("enum", ())[:1], self.words.get(key)):
            if given not in (None, [], {}):
                return given
        if any(isinstance(given, Mapping) for given in item.get("examples", ())):
            return item["examples"][0]
        if "$ref" in item:
            item = self.variants(item)[0]
        if "properties" in item:
            return {name: self.example(inner, name) for name, inner in item["properties"].items()}
        if "anyOf" in item:
            return self.example(item["anyOf"][0])
        if item.get("type") == "array":
            return [self.example(entry, key) for entry in item.get("prefixItems", [item.get("items", {})])]
        if item.get("type") == "object":
            return {self.words.get("cavity", "cavity"): self.example(item["additionalProperties"])}
        plain = {"string": "name", "number": 0.5, "integer": 1, "boolean": False}
        return item["examples"][0] if "examples" in item else plain[item.get("type", "string")]


def _fitting(variants: Iterable[Schema], value: Mapping[str, Any]) -> Schema:
    """Return the variant whose keys and tag a table has."""

    def fits(properties: Mapping[str, Schema]) -> bool:
        tags = {key: item["const"] for key, item in properties.items() if "const" in item}
        return value.keys() <= properties.keys() and all(value.get(key) == tag for key, tag in tags.items())

    return next(variant for variant in variants if fits(variant["properties"]))


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(text, WIDTH - 2, break_on_hyphens=False)]


def _sentence(text: str) -> list[str]:
    return _comment(f"{text[0].upper()}{text[1:]}.")
