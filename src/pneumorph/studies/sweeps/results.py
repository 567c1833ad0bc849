"""What of a design's history goes into the table: a column at the end, at an extreme, or where another has a value."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import cast

import numpy as np

from pneumorph.errors import StudyError, UnitError, unknown_name
from pneumorph.mechanics import Model
from pneumorph.solution.history import TEXT, Column, History, columns
from pneumorph.studies.study import Study
from pneumorph.studies.sweeps.schema import ResultSection
from pneumorph.units import parse

PHASE = "phase"
END, MAXIMUM, MINIMUM, CROSSING = "end", "maximum", "minimum", "crossing"


@dataclass(frozen=True)
class Result:
    """name: of the table's column; column: key, label and kind of the history's.

    where: 'end', 'maximum', 'minimum', 'phase' (its end) or 'crossing'; of: name of the phase, or key of the column
    that crosses; value: that it crosses, in inside units.
    """

    name: str
    column: Column
    where: str = END
    of: str = ""
    value: float = math.nan

    def of_run(self, history: History, done: bool) -> float:
        """Return the value of a run; nan where the run did not get there, or has no such column.

        done: the run reached its end. A run that stopped has phase ends and crossings up to there, but neither an end
        nor extremes.
        """
        if self.column.key not in history.keys or not len(history):
            return math.nan
        values = history.values(self.column.key)
        if self.where == CROSSING:
            return _crossing(history, self.of, self.value, values)
        if self.where == PHASE:
            # the time counts phases: n where the n-th ends
            ends = [
                r for r in history.rows if r["phase"] == self.of and float(r["time"]).is_integer() and r["time"] > 0
            ]
            return float(ends[-1][self.column.key]) if ends else math.nan
        if not done:
            return math.nan
        if self.where == END:
            return float(values[-1])
        known = values[np.isfinite(values)]
        if not known.size:
            return math.nan
        return float(known.max() if self.where == MAXIMUM else known.min())


def _crossing(history: History, key: str, wanted: float, values: np.ndarray) -> float:
    """Return `values` where the column `key` first has a value, linear between states; nan where it never has."""
    if key not in history.keys:
        return math.nan
    over = history.values(key)
    # a target that is reached is reached to rounding only
    near = 1e-9 * max(abs(wanted), float(np.nanmax(np.abs(over), initial=0.0)))
    for i in range(len(over)):
        if abs(over[i] - wanted) <= near:
            return float(values[i])
        if i + 1 < len(over) and (over[i] - wanted) * (over[i + 1] - wanted) < 0.0 and abs(over[i + 1] - wanted) > near:
            share = (wanted - over[i]) / (over[i + 1] - over[i])
            return float(values[i] + share * (values[i + 1] - values[i]))
    return math.nan


def results_of(sections: Mapping[str, ResultSection], studies: Iterable[Study]) -> tuple[Result, ...]:
    """Return the results that a sweep file asks for, or those that it gets unasked.

    Raises StudyError for a column or phase that no design has, UnitError for a value of the wrong kind.
    """
    known: dict[str, Column] = {}
    phases: dict[str, None] = {}
    for study in studies:
        known = {column.key: column for column in history_columns(study)} | known
        phases |= dict.fromkeys(phase.name for phase in study.programme.phases)
    if not sections:
        return _unasked(known, list(phases))
    return tuple(_result(name, section, known, phases) for name, section in sections.items())


def history_columns(study: Study) -> list[Column]:
    """Return the columns that the history of a study's run will have; no mesh is made."""
    return columns(cast(Model, _Unmeshed(study)), study.programme, study.measures)


class _Unmeshed:
    """As much of a model as the columns of a history depend on."""

    bodies = Model.bodies

    def __init__(self, study: Study):
        self.supplies = {cavity.name: cavity.supply for cavity in study.cavities}
        self.surfaces = self.supplies
        self.kinds = study.kinds
        self.contacts = getattr(study, "contacts", ())
        self.frames = getattr(study, "free_bodies", ())  # as in a model, they are named
        self.mesh = SimpleNamespace(dimension=3)


def _unasked(known: Mapping[str, Column], phases: list[str]) -> tuple[Result, ...]:
    kinds = ("pressure:", "added_volume:")
    beside = ("volume:", "gas_mass:", "temperature:", "source:", "value:", "contact_")
    keys = list(known)
    measures = [key for key in keys[: keys.index("strain_energy")] if not key.startswith((*kinds, *beside))]
    wanted = [known[key] for key in measures if key not in ("index", "phase", "time", "clock")]
    wanted += [column for key, column in known.items() if key.startswith(kinds)]
    if len(phases) == 1:
        return tuple(Result(column.key, column) for column in wanted)
    return tuple(Result(f"{column.key} after {phase}", column, PHASE, phase) for phase in phases for column in wanted)


def _result(name: str, section: ResultSection, known: Mapping[str, Column], phases: Iterable[str]) -> Result:
    where = f"results: '{name}'"
    column = _numbers(where, section.column, known)
    if isinstance(section.at, str):
        return Result(name, column, section.at)
    if len(section.at) != 1:
        raise StudyError(f"{where}: at = {section.at}: expected one entry, a phase or a column with its value")
    (of, text), *_ = section.at.items()
    if of == PHASE:
        if text not in phases:
            raise StudyError(f"{where}: {unknown_name('phase', text, phases)}")
        return Result(name, column, PHASE, text)
    over = _numbers(f"{where}: at", of, known)
    try:
        value = parse(text, over.kind, of)
    except UnitError as error:
        raise UnitError(f"{where}: at: {error}") from None
    return Result(name, column, CROSSING, of, value)


def _numbers(where: str, key: str, known: Mapping[str, Column]) -> Column:
    numbers = {name: column for name, column in known.items() if column.kind != TEXT}
    if key not in numbers:
        raise StudyError(f"{where}: {unknown_name('column', key, numbers)}")
    return numbers[key]
