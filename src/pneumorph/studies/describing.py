"""What the keys of a study file mean, read from where they are documented, for editors and for commented files.

A dimension carries its meaning in its metadata. Everything else is described in the docstring of its class, in lines
such as `face: name of the face`, indented further where they go on.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass

# "bulk: bulk modulus, MPa" or "growth, few: an increment that ..."
_ENTRY = re.compile(r"^( *)([a-z]\w*(?:, [a-z]\w*)*):\s+(\S.*)$")


def summary(owner: type) -> str:
    """Return the first paragraph of a class's own docstring on one line, without units of inside and the final stop."""
    text = inspect.cleandoc(owner.__doc__ or "")
    return re.sub(r"\s+", " ", text.split("\n\n")[0]).strip().rstrip(".").removesuffix("; lengths in mm")


def meanings(owner: type) -> dict[str, str]:
    """Return key -> meaning of what a class, or one that it is derived from, says about its fields."""
    found: dict[str, str] = {}
    for base in reversed(owner.__mro__[:-1]):
        found |= _entries(inspect.cleandoc(base.__doc__ or ""))
    if is_dataclass(owner):
        for item in fields(owner):
            if "help" in item.metadata:
                found[item.name] = _with_symbol(item.metadata)
    return found


def _with_symbol(metadata: Mapping[str, str]) -> str:
    symbol = metadata.get("symbol")
    return f"{metadata['help']} ({symbol})" if symbol else str(metadata["help"])


def _entries(text: str) -> dict[str, str]:
    """Return the entries of a docstring; a line that is indented further than its entry goes on with it."""
    found: dict[str, str] = {}
    names: list[str] = []
    depth = 0
    for line in text.splitlines():
        entry = _ENTRY.match(line)
        if entry:
            depth, names = len(entry[1]), entry[2].split(", ")
            found |= dict.fromkeys(names, entry[3].strip())
        elif names and line.strip() and len(line) - len(line.lstrip()) > depth:
            found |= {name: f"{found[name]} {line.strip()}" for name in names}
        else:
            names = []
    return {name: meaning.rstrip(".") for name, meaning in found.items()}
