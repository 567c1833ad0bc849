"""Dotted paths into a study file as plain data: 'actuator.length', 'phase[1].targets.cavity'."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from typing import Any

from pneumorph.errors import StudyError, unknown_name

_PART = re.compile(r"([^.\[\]]+)((?:\[\d+\])*)")


def replaced(table: Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return a deep copy of a study file's data with the value at a path replaced or added.

    Tables of an array are named by their number from 1, `phase[1]`, or by their `name`, `phase.inflate`. Tables on the
    way that the file leaves out are made; whether the study knows the last key is for the study to say.
    Raises StudyError for a path that is not one, or that leads through what is no table.
    """
    result = copy.deepcopy(dict(table))
    steps = _steps(path)
    place: Any = result
    for number, step in enumerate(steps):
        last = number == len(steps) - 1
        if isinstance(place, list):
            step = _index(place, step, path)
        elif not isinstance(place, dict) or isinstance(step, int):
            raise StudyError(f"parameters: '{path}': '{_said(steps[:number])}' is no {_wanted(step)} in the study")
        if last:
            place[step] = copy.deepcopy(value)
        elif isinstance(place, dict):
            place = place.setdefault(step, {})
        else:
            place = place[step]
    return result


def _steps(path: str) -> list[str | int]:
    """Return 'phase[1].targets' as ['phase', 0, 'targets']."""
    steps: list[str | int] = []
    for part in path.split("."):
        match = _PART.fullmatch(part.strip())
        if match is None:
            raise StudyError(
                f"parameters: '{path}': expected a dotted path such as 'actuator.length' or 'phase[1].name'"
            )
        steps += [match[1], *(int(text) - 1 for text in re.findall(r"\d+", match[2]))]
    return steps


def _index(items: list[Any], step: str | int, path: str) -> int:
    """Return the place in an array of a number or of the name of a table."""
    if isinstance(step, int):
        if not 0 <= step < len(items):
            raise StudyError(f"parameters: '{path}': there is no [{step + 1}], allowed: [1] to [{len(items)}]")
        return step
    names = [item.get("name") for item in items if isinstance(item, dict)]
    if names.count(step) != 1:
        known = [name for name in names if isinstance(name, str)]
        raise StudyError(f"parameters: '{path}': {unknown_name('name', step, known)}; or a number such as [1]")
    return next(i for i, item in enumerate(items) if isinstance(item, dict) and item.get("name") == step)


def _said(steps: list[str | int]) -> str:
    return ".".join(str(step) if isinstance(step, str) else f"[{step + 1}]" for step in steps).replace(".[", "[")


def _wanted(step: str | int) -> str:
    return "list" if isinstance(step, int) else "table"
