"""Reported against computed: rows of numbers and curves, with their sources."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from io import StringIO

from numpy.typing import NDArray

COLUMNS = ("quantity", "condition", "reported", "computed", "unit", "relative_difference", "note")


@dataclass(frozen=True)
class Comparison:
    """One row: a reported number and the computed one, both in `unit`.

    reported: None where the study gives none. computed: None where the run did not get there.
    """

    quantity: str
    condition: str
    reported: float | None
    computed: float | None
    unit: str
    note: str = ""

    @property
    def relative_difference(self) -> float | None:
        """(computed - reported) / |reported|, None where one of them is missing or the reported one is zero."""
        if self.computed is None or not self.reported:
            return None
        return (self.computed - self.reported) / abs(self.reported)


@dataclass(frozen=True, eq=False)
class ReportedCurve:
    """Reported values of a column of the history over another one, in inside units.

    label: legend, with the source; x, y: keys of the columns; x_values, y_values (n,); marks: points instead of a line.
    """

    label: str
    x: str
    y: str
    x_values: NDArray
    y_values: NDArray
    marks: bool = False


@dataclass(frozen=True, eq=False)
class Series:
    """One curve of a profile: label, x (n,), y (n,); marks: points instead of a line."""

    label: str
    x: NDArray
    y: NDArray
    marks: bool = False


@dataclass(frozen=True, eq=False)
class Profile:
    """A figure that is not over a column of the history: computed and reported curves, in the units of its labels.

    name: of its files; x, y: labels of the axes with their units.
    """

    name: str
    title: str
    x: str
    y: str
    series: tuple[Series, ...]

    def to_csv(self) -> str:
        """Return a line for each point of each curve."""
        file = StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["curve", self.x, self.y])
        for item in self.series:
            writer.writerows([item.label, f"{x:.6g}", f"{y:.6g}"] for x, y in zip(item.x, item.y, strict=True))
        return file.getvalue()


def to_csv(rows: Iterable[Comparison]) -> str:
    """Return comparison.csv: a header and a line for each row, empty where there is no number."""
    file = StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        values = (getattr(row, name) for name in COLUMNS)
        writer.writerow(["" if v is None else f"{v:.6g}" if isinstance(v, float) else v for v in values])
    return file.getvalue()
