"""The steps of `pneumorph design`: table of uniform tubes, search, full model, report; each can be resumed."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from pneumorph.cli.interrupt import Interrupt
from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.progress import clock, progress_on
from pneumorph.cli.record import read_record
from pneumorph.cli.sweeping import progress_of
from pneumorph.errors import StorageError
from pneumorph.solution import History, Solution, Status
from pneumorph.solution import Progress as SolveProgress
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.design import (
    DesignTask,
    SearchProgress,
    Verified,
    found_in,
    load_design,
    search,
    verified_by,
    verify,
)
from pneumorph.studies.design.law import Lattice
from pneumorph.studies.design.search import Found
from pneumorph.studies.design.task import MEASURES, POINTS
from pneumorph.studies.sweeps import Workers, run_sweep
from pneumorph.units import show

TARGET, TABLE, JOURNAL, RUN, RECORD = "target.toml", "table", "search.journal", "verification", "search.json"


def run_design(
    task: DesignTask,
    folder: Path,
    table: Path | None,
    workers: Workers,
    resume: bool,
    words: Sequence[str],
    *,
    verified: bool,
    reported: bool,
) -> None:
    """Run all steps with progress; exit code 3 where the full model stopped early, 130 where it was interrupted.

    A folder that holds another search is refused (StorageError), one that holds this search unless `resume`.
    """
    out, command = console(), shlex.join(words)
    _keep(task, folder, resume)
    record = {"command": command, "table": None if table is None else str(table.resolve())}
    _write(folder / RECORD, json.dumps(record, indent=1) + "\n")
    out.print(f"{task.title}\nfolder: {folder}", markup=False)
    try:
        law = task.law(_runs(task, table or folder / TABLE, workers, out))
        with Interrupt() as interrupt, _search_progress(out, task) as listen:

            def searched(news: SearchProgress) -> None:
                listen(news)
                interrupt.check()

            found = search(task, law, folder / JOURNAL, searched)
        out.print(_words(task, found), markup=False)
        result = _verified(task, found, folder, out) if verified else None
    except KeyboardInterrupt:
        complain(f"interrupted; what ended is kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    if reported:
        from pneumorph.report.design import write_design_report

        out.print(f"report: {write_design_report(task, law, found, result, folder, command)}", markup=False)
    if result is not None:
        out.print(f"full model: {_distance(task, result.deviation.rms, result.deviation.largest)}", markup=False)
        if result.solution.status is Status.STOPPED:
            complain(f"the full model stopped before its pressure: {result.solution.message}")
            raise typer.Exit(STOPPED)


def is_design(folder: Path) -> bool:
    """Return whether a folder holds an inverse search."""
    return (folder / RECORD).is_file()


def report_design(folder: Path) -> Path:
    """Write the report of such a folder anew from its table, journal and run; return its path.

    Raises StorageError for files that are missing or damaged, or a search that was broken off; EngineError without
    Optuna.
    """
    from pneumorph.report.design import write_design_report

    record = read_record(folder / RECORD)
    try:
        command, table = str(record["command"]), record["table"]
    except KeyError as error:
        raise StorageError(f"{folder / RECORD} is damaged: no {error}") from error
    task = load_design(folder / TARGET)
    law = task.law(task.runs(folder / TABLE if table is None else Path(table)))
    found = found_in(task, law, folder / JOURNAL)
    checked = (folder / RUN / "run.json").exists()
    verified = verified_by(task, found.design, Solution.open(folder / RUN)) if checked else None
    return write_design_report(task, law, found, verified, folder, command)


def _keep(task: DesignTask, folder: Path, resume: bool) -> None:
    """Write the target, with its points, into a folder; raises StorageError for one that holds another search."""
    texts = {TARGET: task.text(), POINTS: task.points_text()}
    kept = (folder / TARGET).exists()
    if kept and not resume:
        raise StorageError(f"'{folder}' already holds a search: resume it (--resume) or choose another folder")
    for name, text in texts.items():
        path = folder / name
        if path.exists() and path.read_text(encoding="utf-8") != (text or ""):
            raise StorageError(f"'{folder}' holds another search, see its {name}: choose another folder")
    make_folder(folder)
    for name, text in texts.items():
        if text is not None:
            _write(folder / name, text)


def _write(path: Path, text: str) -> None:
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def _runs(task: DesignTask, place: Path, workers: Workers, out: Console) -> Mapping[tuple[Lattice, float], History]:
    """Return the runs of the table, of which those that are in the folder are not computed again."""
    out.print(f"uniform tubes: {len(task.table.designs)} runs, {workers.text}, kept in {place}", markup=False)
    with progress_of(out, task.table) as told:
        run_sweep(task.table, place, workers=workers, resume=True, progress=told)
    return task.runs(place)


def _verified(task: DesignTask, found: Found, folder: Path, out: Console) -> Verified:
    study = task.verification(found.design)
    assert len(study.measures) == len(MEASURES)
    with Interrupt() as interrupt, progress_on(out, study.measures) as listen:

        def told(news: SolveProgress) -> None:
            listen(news)
            interrupt.check()

        return verify(task, found.design, folder / RUN, resume=True, progress=told)


@contextmanager
def _search_progress(out: Console, task: DesignTask) -> Iterator[Callable[[SearchProgress], None]]:
    """Give a listener that shows a bar on a terminal, and ten lines elsewhere."""
    total = task.file.search.trials
    if not out.is_terminal:
        every = max(1, total // 10)

        def plain(news: SearchProgress) -> None:
            if news.ended % every == 0 or news.ended == total:
                out.print(f"{news.ended}/{total}  {_news(news)}", markup=False)

        yield plain
        return
    columns = (TextColumn("search"), BarColumn(bar_width=None), MofNCompleteColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=out, expand=True) as bar:
        shown = bar.add_task("", total=total)
        yield lambda news: bar.update(shown, completed=news.ended, description=_news(news))


def _news(news: SearchProgress) -> str:
    best = show(news.best, "length", 3)
    return f"nearest {best}  elapsed {clock(news.elapsed)}  left about {clock(news.remaining)}"


def _words(task: DesignTask, found: Found) -> str:
    design = found.design
    lines = [f"found: {show(design.pressure, 'pressure')}, {design.along} cells along, {design.around} around"]
    for number, part in enumerate(design.parts, 1):
        middle = 180.0 * part.middle / design.around
        columns = f"{part.reentrant} re-entrant columns about {middle:g} deg"
        lines.append(f"  segment {number}: {part.rows} rows, cg {part.cg:.3g}, {columns}")
    return "\n".join([*lines, f"surrogate: {_distance(task, found.deviation.rms, found.deviation.largest)}"])


def _distance(task: DesignTask, rms: float, largest: float) -> str:
    share = f"{rms / task.target.length:.1%} and {largest / task.target.length:.1%} of its length"
    return f"{show(rms, 'length', 3)} from the target in the mean square, {show(largest, 'length', 3)} at most: {share}"
