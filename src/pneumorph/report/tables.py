"""Tables of a report as plain data; the page gives them their form."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Cell:
    """Text with a tone ('good', 'fair', 'off', 'none' or no tone); numbers stand to the right."""

    text: str
    tone: str = ""
    number: bool = False


@dataclass(frozen=True)
class Table:
    """A titled table: head, rows of as many cells, and a note below."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[Cell | str, ...], ...]
    note: str = ""
