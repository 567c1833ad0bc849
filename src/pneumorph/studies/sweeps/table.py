"""The table of a sweep: one row for each design with its parameters, its results and how it ended."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.solution.history import TEXT, Column, History
from pneumorph.studies.sweeps.compute import DONE, REFUSED, WAITING, Record
from pneumorph.studies.sweeps.designs import Design
from pneumorph.studies.sweeps.parameters import Parameter
from pneumorph.studies.sweeps.results import Result

DESIGN, STATUS, MESSAGE, TIME, IDENTITY = "design", "status", "message", "wall_time", "identity"


@dataclass(frozen=True, eq=False)
class SweepTable:
    """parameters, results: keys of the columns that vary and that were found; rows: the whole table, inside units."""

    parameters: tuple[str, ...]
    results: tuple[str, ...]
    rows: History

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def statuses(self) -> list[str]:
        """How each design ended: 'done', 'stopped', 'failed', 'refused' or 'not computed'."""
        return [str(row[STATUS]) for row in self.rows.rows]

    def count(self, *statuses: str) -> int:
        """Return how many designs ended in one of these ways."""
        return sum(status in statuses for status in self.statuses)

    def values(self, key: str) -> NDArray[Any]:
        """Return a column (designs,), see `History.values`."""
        return self.rows.values(key)

    def varies(self, key: str) -> bool:
        """Return whether a column holds different values, nan left out."""
        values = self.values(key)
        known = values if values.dtype.kind == "U" else values[np.isfinite(values)]
        return len(np.unique(known)) > 1


def table_of(
    designs: Sequence[Design],
    records: Mapping[str, Record],
    parameters: Sequence[Parameter],
    results: Sequence[Result],
) -> SweepTable:
    """Return the table; records: identity of a design -> how it ended, for those that did."""
    names = [parameter.path for parameter in parameters]
    columns = [Column(DESIGN, "design", "number")]
    columns += [Column(p.path, p.path.rpartition(".")[2].replace("_", " "), p.kind) for p in parameters]
    # a result may be called like a parameter; rows are looked up by key
    keys = [result.name if result.name not in names else f"result:{result.name}" for result in results]
    columns += [Column(key, key.replace("_", " "), r.column.kind) for key, r in zip(keys, results, strict=True)]
    columns += [Column(STATUS, "status", TEXT), Column(MESSAGE, "message", TEXT)]
    columns += [Column(TIME, "wall time", "time"), Column(IDENTITY, "identity", TEXT)]
    rows = []
    for design in designs:
        record = records.get(design.identity) if design.study else Record(REFUSED, design.reason, wall_time=math.nan)
        record = record or Record(WAITING, wall_time=math.nan)
        row: dict[str, Any] = {DESIGN: design.number}
        row |= {p.path: p.inside(value) for p, value in zip(parameters, design.values, strict=True)}
        row |= {key: r.of_run(record.history, record.status == DONE) for key, r in zip(keys, results, strict=True)}
        row |= {STATUS: record.status, MESSAGE: record.message, TIME: record.wall_time, IDENTITY: design.identity[:16]}
        rows.append(row)
    return SweepTable(tuple(names), tuple(keys), History(columns, rows))
