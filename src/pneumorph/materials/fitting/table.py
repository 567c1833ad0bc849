"""A text file with columns -> its header and cells; separator and decimal mark are found out, or refused."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path

from pneumorph.errors import InputError

LARGEST_FILE = 64 * 2**20  # bytes; a test of an hour at 1 kHz takes 100 MB and says no more than its every tenth point
_COMMENT = ("#", "%", "//")
_SEPARATORS = ("\t", ";", ",")
_NUMBER = re.compile(r"[+-]?(\d+(?P<mark>[.,])?\d*|(?P<lead>[.,])\d+)([eE][+-]?\d+)?")


@dataclass
class Table:
    """Cells of a file as text.

    lines: line of each row in the file, from 1. comments: comment lines without their sign.
    """

    path: Path
    header: list[str]
    rows: list[list[str]]
    lines: list[int]
    comments: list[str]
    _mark: str = field(default="", repr=False)

    def number(self, row: int, column: int) -> float:
        """Return a cell as a number; raises InputError with line and column where it is none."""
        text = self.rows[row][column].strip()
        found = _NUMBER.fullmatch(text)
        place = f"{self.path} line {self.lines[row]}, column '{self.header[column]}'"
        if found is None:
            shown = f"'{_short(text)}'" if text else "nothing"
            raise InputError(f"{place}: {shown}, allowed: a number such as 1.25 in every row")
        mark = found["mark"] or found["lead"] or ""
        if mark and self._mark and mark != self._mark:
            raise InputError(f"{place}: '{text}' has another decimal mark than the rows before ('{self._mark}')")
        self._mark = self._mark or mark
        value = float(text.replace(",", "."))
        if value in (float("inf"), float("-inf")):
            raise InputError(f"{place}: '{_short(text)}', allowed: a finite number")
        return value


def is_number(text: str) -> bool:
    """Return whether a cell is a number."""
    return _NUMBER.fullmatch(text.strip()) is not None


def read_table(path: Path) -> Table:
    """Return the table in a file.

    The first line that is neither blank nor a comment (#, %, //) is the header. Cells are separated by tabs, semicolons
    or commas, whichever comes first in this order in the header. A decimal comma is understood where commas do not
    separate. Raises InputError, with the line, for what is no such table.
    """
    comments: list[str] = []
    numbered = []
    for number, line in enumerate(_text(path).splitlines(), start=1):
        plain = line.strip()
        if plain.startswith(_COMMENT):
            comments.append(plain.lstrip("#%/ "))
        elif plain.strip(";,\t "):
            numbered.append((number, line))
    if len(numbered) < 2:
        raise InputError(f"{path}: {len(numbered)} lines with data, expected a header with units and rows of numbers")
    separator = next((mark for mark in _SEPARATORS if mark in numbered[0][1]), None)
    if separator is None:
        raise InputError(
            f"{path} line {numbered[0][0]}: one column only in '{_short(numbered[0][1])}', expected at least a "
            "deformation and a stress, separated by commas, semicolons or tabs"
        )
    header = [cell.strip() for cell in _cells(path, *numbered[0], separator)]
    while header and not header[-1]:
        header.pop()
    if all(is_number(cell) for cell in header):
        raise InputError(
            f"{path} line {numbered[0][0]}: '{_short(numbered[0][1])}' are numbers, expected a header with names and "
            "units such as 'stretch [-], nominal stress [MPa]'"
        )
    table = Table(path, header, [], [], comments)
    for number, line in numbered[1:]:
        cells = _cells(path, number, line, separator)
        while len(cells) > len(header) and not cells[-1].strip():
            cells.pop()
        if len(cells) != len(header):
            hint = "; with decimal commas, separate cells by semicolons" if separator == "," else ""
            raise InputError(
                f"{path} line {number}: {len(cells)} cells in '{_short(line)}', allowed: {len(header)} as in the "
                f"header{hint}"
            )
        table.rows.append(cells)
        table.lines.append(number)
    return table


def _text(path: Path) -> str:
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise InputError(
                f"{path} has {size / 2**20:.0f} MB, allowed: {LARGEST_FILE // 2**20} MB; keep every tenth point or so"
            )
        raw = path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read the test data {path}: {error.strerror or error}") from error
    encoding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError:
        text = raw.decode("latin-1")  # exports of older machines; every byte has a meaning there
    if "\0" in text:
        raise InputError(f"{path} is no text file, expected comma-separated values")
    return text


def _cells(path: Path, number: int, line: str, separator: str) -> list[str]:
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True, strict=False))
    except (csv.Error, StopIteration) as error:
        raise InputError(f"{path} line {number}: cannot be read as cells: {error}") from None


def _short(text: str) -> str:
    plain = text.strip()
    return plain if len(plain) <= 40 else plain[:37] + "..."
