"""The verb: solve a model through a programme, keep every converged state, go on after an interruption."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, is_dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

from pneumorph.errors import InputError, NotConvergedError, StorageError
from pneumorph.mechanics import Model, Programme, Settings, State, march
from pneumorph.mechanics.state import rest
from pneumorph.solution.codec import differences, encode
from pneumorph.solution.history import History, Measure, columns, row
from pneumorph.solution.solution import Solution
from pneumorph.solution.status import Status
from pneumorph.solution.storage import RunFolder, StoredStates, describe, digest
from pneumorph.solution.versions import meta


@dataclass(frozen=True, eq=False)
class Progress:
    """Where a solve stands.

    state: the last converged one; row: its line of the history; fraction: of the programme, 0 to 1; elapsed: wall time,
    s, over all resumes; remaining: estimate, s, None at the start; total_iterations: Newton iterations so far.
    """

    state: State
    row: dict[str, Any]
    fraction: float
    elapsed: float
    remaining: float | None
    total_iterations: int


def solve(
    model: Model,
    programme: Programme,
    *,
    measures: Sequence[Measure] = (),
    folder: str | Path | None = None,
    resume: bool = False,
    settings: Settings | None = None,
    progress: Callable[[Progress], None] | None = None,
    about: dict[str, Any] | None = None,
    raise_on_stop: bool = True,
) -> Solution:
    """Return the solution of a model along a programme.

    measures:      numbers to take from every state; each becomes a column of the history.
    folder:        where to store the run; each state is on the disk as soon as it converges. None keeps it in memory.
    resume:        go on from the last state that the folder holds, or start where it holds none. The outcome is that of
                   a run without the break; a run that is done is returned at once.
    settings:      of Newton's method and the load stepping.
    progress:      called with a `Progress` at the start and after every state; what it raises ends the solve, and the
                   run can be resumed.
    about:         anything JSON can hold, kept in run.json: title, study.
    raise_on_stop: False returns a solution with the status STOPPED instead of raising NotConvergedError.

    Raises InputError for a programme or measure that does not fit the model; StorageError where the folder holds a run
    and `resume` is False, or one of another model, programme, settings or measures (the message names what differs);
    NotConvergedError, with the solution so far, where the load stepping stops before the end.
    """
    started = perf_counter()
    settings = settings or Settings()
    measures = tuple(measures)
    programme.check(model)
    heads = columns(model, programme, measures)
    row(rest(model), measures)  # a measure that does not fit the model fails before anything is written
    if resume and folder is None:
        raise InputError("resume = True needs the folder of the run")
    record: dict[str, Any] = {"status": Status.RUNNING.value, "message": "", "about": _plain(about or {})}
    place: RunFolder | None = None
    rows: list[dict[str, Any]] = []
    before = 0.0
    kept: StoredStates | list[State] = []
    if folder is not None:
        place = RunFolder(folder)
        record |= {
            "programme": encode(programme, "programme"),
            "settings": encode(settings, "settings"),
            "model": describe(model),
            "measures": {measure.name: repr(measure) if is_dataclass(measure) else "" for measure in measures},
            "columns": [asdict(column) for column in heads],
            "mesh_digest": digest(model.mesh),
        }
        if place.holds_run and not resume:
            raise StorageError(f"'{place.path}' already holds a run: resume it (--resume) or choose another folder")
    record["meta"] = meta(model)
    if place is not None:
        if place.run.exists():
            stored = place.read_record()
            _check_same(stored, record, place)
            place.clean()
            history, before = place.read_history(stored)
            rows = history.rows
            history.write_csv(place.history)
            if stored["status"] == Status.DONE.value:
                return replace(Solution.open(place.path), model=model)
            record["about"] = record["about"] or stored["about"]
            place.write_record(record)
        else:
            place.start(model.mesh, record)
        kept = StoredStates(place, model)
    history = History(heads, rows)
    start = kept[-3:]
    first = start[-1].time if start else 0.0
    iterations = sum(int(line["iterations"]) for line in rows)

    def tell(state: State) -> None:
        if progress is None:
            return
        spent, fraction = perf_counter() - started, state.time / len(programme.phases)
        gone = state.time - first
        remaining = (perf_counter() - marching) / gone * (len(programme.phases) - state.time) if gone > 0.0 else None
        progress(Progress(state, rows[-1], fraction, before + spent, remaining, iterations))

    def finish(status: Status, message: str) -> Solution:
        full = record["meta"] | {"wall_time": before + perf_counter() - started, "iterations": iterations}
        if place is not None:
            record.update(status=status.value, message=message, meta=full)
            place.write_record(record)
        path = place.path if place else None
        return Solution(model, programme, kept, history, status, message, full, record["about"], path)

    marching = perf_counter()
    if start:
        tell(start[-1])
    try:
        for state in march(model, programme, settings, start):
            line = row(state, measures)
            rows.append(line)
            iterations += state.iterations
            if place is not None:
                place.write_state(state, line, before + perf_counter() - started)
                history.write_csv(place.history)
            if isinstance(kept, StoredStates):
                kept.add(state)
            else:
                kept.append(state)
            tell(state)
    except NotConvergedError as stop:
        solution = finish(Status.STOPPED, str(stop))
        if raise_on_stop:
            raise NotConvergedError(str(stop), solution) from None
        return solution
    return finish(Status.DONE, "")


def _plain(about: dict[str, Any]) -> dict[str, Any]:
    """Return `about` as JSON keeps it."""
    try:
        return dict(json.loads(json.dumps(about)))
    except (TypeError, ValueError) as error:
        raise InputError(f"about: expected a dictionary that JSON can hold: {error}") from None


def _check_same(stored: dict[str, Any], given: dict[str, Any], place: RunFolder) -> None:
    """Raise StorageError with what differs between the run of a folder and the one that shall go on in it."""
    lines = ["the mesh differs"] if stored.get("mesh_digest") != given["mesh_digest"] else []
    for key in ("model", "programme", "settings", "measures"):
        lines += differences(stored.get(key), json.loads(json.dumps(given[key])), key)
    if lines:
        more = f" and {len(lines) - 3} more" if len(lines) > 3 else ""
        raise StorageError(
            f"'{place.path}' holds another run: {'; '.join(lines[:3])}{more}. "
            "Give the same inputs to resume it, or choose another folder"
        )
