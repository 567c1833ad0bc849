"""What `pneumorph reproduce soft-wheel --part granular` does, and the report of such a folder."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import typer

from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.rolling import progress_on
from pneumorph.errors import StorageError
from pneumorph.studies.reproductions.soft_wheel import SYSTEM
from pneumorph.studies.rolling import MODELS, SWEEP, TABLE, RollingNews, read_sweep
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.units import show


def reproduce_granular(
    quick: bool,
    out: Path | None,
    resume: bool,
    *,
    beds: int | None = None,
    wheels: Path | None = None,
    scheduler: str | None = None,
) -> None:
    """Run the sweep with progress and write its report; exit code 3 where runs failed, 130 where it was interrupted."""
    from pneumorph.studies.granular import run_granular
    from pneumorph.studies.reproductions.soft_wheel_granular import GranularStudy
    from pneumorph.terrain.granular.engine import engine
    from pneumorph.terrain.rigid import engine as rigid_engine

    study = GranularStudy(quick, 1 if beds is None else beds, wheels)
    runs = study.runs()
    engine(), rigid_engine()  # a missing extra shows before anything is written
    workers = Workers(scheduler=scheduler)
    folder = out or Path("runs") / f"{SYSTEM.name}-granular{'-quick' if quick else ''}"
    words = ["pneumorph", "reproduce", SYSTEM.name, "--part", "granular", *(["--quick"] if quick else [])]
    words += ["--beds", str(beds)] if beds else []
    words += ["--wheels", str(wheels)] if wheels else []
    command = shlex.join([*words, "--out", str(folder)])
    screen = console()
    screen.print(f"{SYSTEM.title}, part granular: {len(runs)} runs, {workers.text}\nfolder: {folder}", markup=False)
    settings = study.settings(runs)
    try:
        with progress_on(screen, _result) as progress:
            rows = run_granular(
                runs, folder, settings, resume=resume, workers=workers, progress=progress, command=command
            )
    except KeyboardInterrupt:
        complain(f"interrupted; the finished runs are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    failed = [name for name, row in rows.items() if row["status"] != "done"]
    if len(failed) < len(runs):
        from pneumorph.report.granular import write_granular_report

        screen.print("writing the report ...")
        page = write_granular_report(
            folder, runs, rows, quick=quick, outlines=str(settings["outlines"]), command=command
        )
        screen.print(f"report: {page}", markup=False)
    if failed:
        complain(f"{len(failed)} of {len(runs)} runs failed; {folder / TABLE} has the reasons: {', '.join(failed)}")
        raise typer.Exit(STOPPED)
    screen.print(f"done: {len(rows)} runs", markup=False)


def is_granular(folder: Path) -> bool:
    """Return whether a folder holds a sweep over beds of grains."""
    return (folder / SWEEP).is_file() and read_sweep(folder)["settings"].get("part") == "granular"


def report_granular(folder: Path) -> Path:
    """Write the report of a sweep's folder anew; return its path. Raises StorageError where it is damaged."""
    from pneumorph.report.granular import write_granular_report
    from pneumorph.studies.granular import COLUMNS
    from pneumorph.studies.reproductions.soft_wheel_granular import GranularStudy
    from pneumorph.studies.run_table import RunTable

    record = read_sweep(folder)
    settings = record["settings"]
    try:
        files = settings["outlines"] == "files"
        study = GranularStudy(settings["quick"], settings["beds"], folder / MODELS if files else None)
        runs = study.runs()
        if json.loads(json.dumps(study.settings(runs))) != settings:
            raise StorageError(f"'{folder}' holds a sweep with settings that this version does not make")
    except (KeyError, TypeError, OSError) as error:
        raise StorageError(f"{folder / SWEEP} is damaged: {error!r}") from error
    rows = RunTable(folder / TABLE, COLUMNS).rows()
    return write_granular_report(
        folder, runs, rows, quick=study.quick, outlines=settings["outlines"], command=record["command"]
    )


def _result(news: RollingNews) -> str:
    row = news.row
    if row["status"] != "done":
        return f"{row['run']}: failed, {row['reason']}"
    if "distance [m]" not in row:
        return f"{row['run']}: settled"
    return f"{row['run']}: {show(1000.0 * float(str(row['distance [m]'])), 'length')}"
