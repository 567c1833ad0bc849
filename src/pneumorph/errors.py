"""The exceptions of pneumorph: one small tree under `PneumorphError`."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


class PneumorphError(Exception):
    """Base of every error that pneumorph raises on purpose."""


class InputError(PneumorphError, ValueError):
    """An input is refused before any computing; the message names it, its value and what is allowed."""


class UnitError(InputError):
    """A quantity has no unit, an unknown one, or one of the wrong kind."""


class GeometryError(InputError):
    """Dimensions that make no valid solid: overlapping or negative walls, an open body."""


class MeshError(InputError):
    """A solid that cannot be meshed, or a mesh that cannot be computed with."""


class NameNotFoundError(InputError):
    """A name that is not there, or that means more than one thing."""


class LeakingCavityError(InputError):
    """The faces of a cavity do not close."""


class StudyError(InputError):
    """A study file with an unknown key, a missing entry or a wrong type."""


class StorageError(PneumorphError):
    """A run folder that cannot be written, read or resumed."""


class EngineError(PneumorphError):
    """A library that pneumorph relies on is missing or does not work here."""


class NotConvergedError(PneumorphError):
    """A solve stopped before its target; `solution` keeps every converged state."""

    def __init__(self, message: str, solution: object = None):
        super().__init__(message)
        self.solution = solution


def shortened(text: str, most: int = 60) -> str:
    """Return text for a message, cut where it is longer than `most` characters.

    >>> shortened("abcdef", 4)
    'abc…'
    """
    return text if len(text) <= most else text[: most - 1] + "…"


def quoted(text: str) -> str:
    """Return text in quotes for a message: on one line, and not too long.

    >>> quoted("80 kPa")
    "'80 kPa'"
    """
    return repr(shortened(text))


def unknown_name(kind: str, name: str, known: Iterable[str]) -> str:
    """Return the message for a name that is not known, with the nearest valid one.

    >>> unknown_name("face", "clmp", ["clamp", "tip"])
    "unknown face 'clmp': did you mean 'clamp'? Allowed: clamp, tip"
    """
    names = sorted(known)
    near = get_close_matches(name, names, n=1)
    hint = f" did you mean '{near[0]}'?" if near else ""
    return f"unknown {kind} {quoted(name)}:{hint} Allowed: {', '.join(names) if names else 'none'}"
