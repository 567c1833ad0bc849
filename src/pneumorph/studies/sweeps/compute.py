"""What a worker does: solve one design and hand back its history, whatever happens."""

from __future__ import annotations

import logging
import platform
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any

from pneumorph.errors import PneumorphError
from pneumorph.solution import Column, History
from pneumorph.solution.versions import versions
from pneumorph.studies.running import run_study
from pneumorph.studies.study import study_from

# how a design ended; a row of the table says one of these
DONE, STOPPED, FAILED, REFUSED, WAITING = "done", "stopped", "failed", "refused", "not computed"


@dataclass(frozen=True)
class Record:
    """The outcome of a design.

    status: 'done'; 'stopped', converged only so far; 'failed', with the message of what went wrong.
    history: of the states that converged. wall_time: s. notes: warnings on the way. details: traceback of a failure
    that is a defect. about: versions, computer, unknowns, iterations.
    """

    status: str
    message: str = ""
    history: History = field(default_factory=lambda: History([], []))
    wall_time: float = 0.0
    notes: tuple[str, ...] = ()
    details: str = ""
    about: dict[str, Any] = field(default_factory=dict)

    def plain(self) -> dict[str, Any]:
        """Return the record as data that JSON can hold."""
        data = {name: getattr(self, name) for name in ("status", "message", "wall_time", "details", "about")}
        columns = [asdict(column) for column in self.history.columns]
        return data | {"notes": list(self.notes), "columns": columns, "rows": self.history.rows}

    @classmethod
    def of_plain(cls, data: Mapping[str, Any]) -> Record:
        """Return the record of such data; raises KeyError, TypeError where it is damaged."""
        history = History([Column(**column) for column in data["columns"]], list(data["rows"]))
        given = {name: data[name] for name in ("status", "message", "wall_time", "details", "about")}
        return cls(history=history, notes=tuple(data["notes"]), **given)


def compute(study: Mapping[str, Any], name: str, folder: str | None) -> dict[str, Any]:
    """Return the record of a design as plain data; never raises, as one design must not stop the rest.

    study, name: resolved study as plain data, and its name. folder: run folder to keep, which another computer sees
    under the same path; None: nothing is written. A run that was broken off there goes on.
    """
    started = perf_counter()
    with _warnings() as notes:
        try:
            solution = run_study(study_from(study, name), folder, resume=folder is not None, raise_on_stop=False)
        except PneumorphError as error:
            record = Record(FAILED, str(error))
        except Exception as error:  # a defect in one design: the rest must go on, and the traceback is kept
            record = Record(FAILED, f"{type(error).__name__}: {error}", details=traceback.format_exc())
        else:
            about = {"unknowns": solution.meta["mesh"]["unknowns"], "iterations": solution.meta["iterations"]}
            record = Record(solution.status.value, solution.message, solution.history, about=about)
    place = {"computer": platform.node(), "versions": versions()}
    data = record.plain() | {"wall_time": perf_counter() - started, "notes": notes, "about": record.about | place}
    if folder is not None:
        data["about"]["run"] = str(Path(folder))
    return data


@contextmanager
def _warnings() -> Iterator[list[str]]:
    """Collect what pneumorph warns of, which would break up the progress of the sweep."""
    notes: list[str] = []

    class Collector(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            notes.append(record.getMessage())

    logger, collector = logging.getLogger("pneumorph"), Collector(logging.WARNING)
    passed, logger.propagate = logger.propagate, False
    logger.addHandler(collector)
    try:
        yield notes
    finally:
        logger.removeHandler(collector)
        logger.propagate = passed
