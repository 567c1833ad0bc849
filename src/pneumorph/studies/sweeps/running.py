"""Running a sweep: compute the designs that have not ended yet, keep each as it ends, write the table."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from pneumorph.errors import StorageError
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.studies.sweeps.compute import FAILED, STOPPED, Record, compute
from pneumorph.studies.sweeps.designs import Design
from pneumorph.studies.sweeps.store import RUN, SweepFolder
from pneumorph.studies.sweeps.sweep import Sweep
from pneumorph.studies.sweeps.table import SweepTable, table_of

_TABLE_EVERY = 5.0  # s: the table is written anew while designs end, but not for each of many


@dataclass(frozen=True)
class SweepProgress:
    """Where a sweep stands.

    design, record: the one that just ended, None at the start. ended: designs that have, those kept from before and
    equal ones among them; total: designs to compute in all; elapsed: of this call, s; remaining: estimate, s, None at
    the start.
    """

    design: Design | None
    record: Record | None
    ended: int
    total: int
    elapsed: float
    remaining: float | None


def run_sweep(
    sweep: Sweep,
    folder: Path | str,
    *,
    workers: Workers | None = None,
    resume: bool = False,
    retry: bool = False,
    progress: Callable[[SweepProgress], None] | None = None,
) -> SweepTable:
    """Return the table of a sweep; every design is on the disk as soon as it ends.

    folder:   see `SweepFolder`; workers: by default processes of this machine, or the sweep's own [slurm] jobs.
    resume:   compute only the designs that have not ended in the folder. A design is known by its resolved study, so
              the sweep may have changed: results are taken anew from what is stored, new designs are computed.
    retry:    compute again those that failed or stopped.
    progress: called at the start and as each design ends; what it raises ends the sweep, which can be resumed.

    A design that fails is a row with its reason. Raises StorageError where the folder holds a sweep and `resume` is
    False; EngineError where there is no cluster to work with.
    """
    place = SweepFolder(folder)
    if place.holds_sweep and not resume:
        raise StorageError(f"'{place.path}' already holds a sweep: resume it (--resume) or choose another folder")
    if place.sweep.exists() and not place.designs.exists():
        raise StorageError(f"'{place.path}' has a {place.sweep.name} but no designs: choose a folder of its own")
    place.start(sweep.text(), sweep.study_text())
    # equal designs have one identity, and are computed once
    wanted = {design.identity: design for design in sweep.designs if design.study is not None}
    records = {identity: r for identity, design in wanted.items() if (r := place.record(design)) is not None}
    again = (FAILED, STOPPED) if retry else ()
    left = [d for identity, d in wanted.items() if identity not in records or records[identity].status in again]
    started = written = perf_counter()

    def table() -> SweepTable:
        made = table_of(sweep.designs, records, sweep.parameters, sweep.results)
        place.write_table(made)
        return made

    def tell(design: Design | None, ended: int) -> None:
        if progress is None:
            return
        elapsed = perf_counter() - started
        remaining = elapsed / ended * (len(left) - ended) if ended else None
        record = records[design.identity] if design is not None else None
        progress(SweepProgress(design, record, len(wanted) - len(left) + ended, len(wanted), elapsed, remaining))

    tell(None, 0)
    try:
        chosen = workers or Workers(slurm=sweep.file.slurm)
        for ended, (design, outcome) in enumerate(_computed(chosen, left, place, sweep.file.keep_runs), 1):
            records[design.identity] = place.keep(design, outcome)
            tell(design, ended)
            if perf_counter() - written > _TABLE_EVERY:
                table()
                written = perf_counter()
    finally:
        result = table()
    return result


def stored_table(sweep: Sweep, folder: Path | str) -> SweepTable:
    """Return the table of what a folder holds of a sweep; nothing is computed or written.

    Raises StorageError for a folder that holds no sweep, or a damaged design.
    """
    place = SweepFolder(folder)
    if not place.holds_sweep:
        raise StorageError(f"'{place.path}' holds no sweep")
    known = {design.identity: design for design in sweep.designs if design.study is not None}
    records = {identity: r for identity, design in known.items() if (r := place.record(design)) is not None}
    return table_of(sweep.designs, records, sweep.parameters, sweep.results)


def _computed(
    workers: Workers, designs: list[Design], place: SweepFolder, keep: bool
) -> Iterable[tuple[Design, dict[str, object]]]:
    """Yield each design as it ends with its record as plain data."""
    if not designs:
        return
    calls = []
    for design in designs:
        assert design.study is not None
        folder = str((place.of(design) / RUN).resolve()) if keep else None
        calls.append((design.study.resolved(), design.study.name, folder))
    for number, outcome in workers.compute(compute, calls):
        if isinstance(outcome, BaseException):  # the worker itself came to its end
            outcome = Record(FAILED, f"its worker ended: {type(outcome).__name__}: {outcome}").plain()
        yield designs[number], outcome
