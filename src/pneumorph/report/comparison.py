"""Reported against computed in a run folder: `comparison.csv`, its table, and values between computed states."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pneumorph.errors import StorageError
from pneumorph.report.tables import Cell, Table
from pneumorph.solution import History
from pneumorph.solution.files import write_atomically
from pneumorph.studies.comparison import COLUMNS, Comparison, to_csv
from pneumorph.units import show

FILE = "comparison.csv"
_GOOD, _FAIR = 0.05, 0.15  # relative differences up to which a row is coloured green, yellow


@dataclass(frozen=True)
class Reading:
    """A computed value at a wanted place: None where the run does not reach it; the note says how it was found."""

    value: float | None
    note: str


def read_at(history: History, key: str, along: str, place: float) -> Reading:
    """Return the column `key` where the column `along` has the value `place` (both in inside units).

    Takes the state that stands there (to 1e-9); else interpolates linearly in the first interval of neighbouring
    states that holds the place; never goes beyond the states. Raises NameNotFoundError for a column.
    """
    x, y = history.values(along), history.values(key)
    kind = history.column(along).kind
    exact = np.isclose(x, place, rtol=1e-9, atol=1e-12)
    if exact.any():
        return Reading(float(y[np.argmax(exact)]), "")
    between = np.flatnonzero((x[:-1] - place) * (x[1:] - place) < 0.0)
    if len(between) == 0:
        low, high = (show(float(value), kind) for value in (x.min(), x.max()))
        return Reading(None, f"not reached: the run covers {low} to {high}")
    first = int(between[0])
    share = (place - x[first]) / (x[first + 1] - x[first])
    ends = " and ".join(show(float(value), kind) for value in x[first : first + 2])
    return Reading(float(y[first] + share * (y[first + 1] - y[first])), f"interpolated between the states at {ends}")


def write_comparison(rows: Sequence[Comparison], folder: Path) -> Path:
    """Write comparison.csv into a folder and return its path; raises StorageError."""
    text = to_csv(rows)
    write_atomically(folder / FILE, lambda path: path.write_text(text, encoding="utf-8") and None)
    return folder / FILE


def read_comparison(folder: Path) -> tuple[Comparison, ...]:
    """Return the rows of a folder's comparison.csv, none where there is no such file; raises StorageError."""
    path = folder / FILE
    if not path.exists():
        return ()
    try:
        with path.open(newline="", encoding="utf-8") as file:
            head, *lines = list(csv.reader(file))
        if tuple(head) != COLUMNS:
            raise ValueError(f"columns {', '.join(head)}, expected {', '.join(COLUMNS)}")
        return tuple(
            Comparison(
                what, where, float(reported) if reported else None, float(computed) if computed else None, unit, note
            )
            for what, where, reported, computed, unit, _, note in lines
        )
    except (OSError, ValueError) as error:
        raise StorageError(f"{path} cannot be read: {error}") from error


def comparison_table(rows: Sequence[Comparison]) -> Table:
    """Return the table of all rows, coloured by how far reported and computed are apart."""
    body = []
    for row in rows:
        apart = row.relative_difference
        shown = "–" if apart is None else f"{100.0 * apart:+.1f} %"
        reported = "–" if row.reported is None else f"{row.reported:.4g}"
        computed = "not reached" if row.computed is None else f"{row.computed:.4g}"
        body.append(
            (
                row.quantity, row.condition, Cell(reported, number=True), Cell(computed, number=True),
                row.unit, Cell(shown, _tone(apart), number=True), row.note,
            )
        )  # fmt: skip
    head = ("Quantity", "Condition", "Reported", "Computed", "Unit", "Difference", "Note")
    note = f"Colours: within {_GOOD:.0%} green, within {_FAIR:.0%} yellow, beyond red, nothing to compare grey."
    return Table("", head, tuple(body), note)


def _tone(apart: float | None) -> str:
    if apart is None:
        return "none"
    return "good" if abs(apart) <= _GOOD else "fair" if abs(apart) <= _FAIR else "off"
