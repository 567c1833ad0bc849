"""The outcome of a solve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pneumorph.errors import StorageError
from pneumorph.mechanics import Model, Programme, State
from pneumorph.solution.history import History
from pneumorph.solution.status import Status
from pneumorph.solution.storage import RunFolder, StoredStates


@dataclass(frozen=True, eq=False)
class Solution:
    """What a solve found, also where it stopped early.

    model, programme: what was solved.
    states:  converged states from rest on; read from the folder when they are asked for.
    history: one row for each state.
    status:  DONE, STOPPED, or RUNNING for a run that goes on or was killed; message: why it stopped.
    meta:    versions, platform, threads, linear_solver, mesh (counts), iterations, wall_time (s, over all resumes).
    about:   what the caller wanted to keep beside it (title, study).
    folder:  where it is stored, None if it is not.
    """

    model: Model
    programme: Programme
    states: Sequence[State]
    history: History
    status: Status
    message: str
    meta: dict[str, Any]
    about: dict[str, Any]
    folder: Path | None = None

    @staticmethod
    def open(folder: str | Path) -> Solution:
        """Return the solution that a folder holds, whatever its status.

        Raises StorageError, naming the file, where something is missing or damaged.
        """
        place = RunFolder(folder)
        record = place.read_record()
        try:
            status, message = Status(record["status"]), str(record["message"])
            meta, about = dict(record["meta"]), dict(record["about"])
        except (KeyError, ValueError, TypeError) as error:
            raise StorageError(f"{place.run} is damaged: {error}") from error
        model, programme = place.read_model(record), place.read_programme(record)
        history, elapsed = place.read_history(record)
        meta |= {"wall_time": elapsed, "iterations": sum(int(row["iterations"]) for row in history.rows)}
        states = StoredStates(place, model)
        return Solution(model, programme, states, history, status, message, meta, about, place.path)
