"""What `pneumorph reproduce soft-wheel --part rigid` does, and the report of such a folder."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.progress import clock
from pneumorph.errors import InputError, StorageError, unknown_name
from pneumorph.studies.reproductions.soft_wheel import SYSTEM, RigidStudy
from pneumorph.studies.rolling import SWEEP, TABLE, TERRAINS, Ground, RollingNews, read_sweep, run_rolling
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.terrain import COURSES
from pneumorph.units import parse, show


def reproduce_rigid(
    quick: bool,
    out: Path | None,
    resume: bool,
    *,
    radius: str | None = None,
    image: Path | None = None,
    relief: str | None = None,
    video: str | None = None,
    scheduler: str | None = None,
) -> None:
    """Run the sweep with progress and write its report; exit code 3 where runs failed, 130 where it was interrupted."""
    from pneumorph.report.rolling import write_rolling_report
    from pneumorph.terrain.rigid import engine

    ground = _image(image, relief)
    study = RigidStudy(quick, image=ground)
    if radius is not None:
        study = replace(study, radius=parse(radius, "length", "--radius"))
    runs = study.runs
    _check_video(video, [run.name for run in runs])
    engine()  # a missing extra shows before anything is written
    workers = Workers(scheduler=scheduler)
    folder = out or Path("runs") / f"{SYSTEM.name}-rigid{'-quick' if quick else ''}"
    words = ["pneumorph", "reproduce", SYSTEM.name, "--part", "rigid", *(["--quick"] if quick else [])]
    words += ["--radius", radius] if radius else []
    words += ["--terrain", str(image)] if image else []
    words += ["--relief", relief] if relief else []
    command = shlex.join([*words, "--out", str(folder)])
    screen = console()
    screen.print(f"{SYSTEM.title}, part rigid: {len(runs)} runs, {workers.text}\nfolder: {folder}", markup=False)
    try:
        with progress_on(screen, _result) as progress:
            rows = run_rolling(
                runs, folder, study.settings(), resume=resume, workers=workers, progress=progress, command=command
            )
    except KeyboardInterrupt:
        complain(f"interrupted; the finished runs are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    screen.print("writing the report ...")
    page = write_rolling_report(folder, runs, rows, command=command, films=[video] if video else [])
    screen.print(f"report: {page}", markup=False)
    failed = [name for name, row in rows.items() if row["status"] != "done"]
    if failed:
        complain(f"{len(failed)} of {len(runs)} runs failed; {folder / TABLE} has the reasons: {', '.join(failed)}")
        raise typer.Exit(STOPPED)
    screen.print(f"done: {len(rows)} runs", markup=False)


def is_rolling(folder: Path) -> bool:
    """Return whether a folder holds a sweep over rigid terrain."""
    return (folder / SWEEP).is_file()


def report_rolling(folder: Path) -> Path:
    """Write the report of a sweep's folder anew; return its path. Raises StorageError where it is damaged."""
    from pneumorph.report.rolling import write_rolling_report
    from pneumorph.studies.rolling import COLUMNS
    from pneumorph.studies.run_table import RunTable

    record = read_sweep(folder)
    settings = record["settings"]
    try:
        image = settings["image"]
        ground = None
        if image is not None:
            content = (folder / TERRAINS / f"{image['name']}.png").read_bytes()
            ground = Ground(image["name"], content, image["relief"])
        study = RigidStudy(settings["quick"], settings["radius"], ground)
        if json.loads(json.dumps(study.settings())) != settings:
            raise StorageError(f"'{folder}' holds a sweep with settings that this version does not make")
    except (KeyError, TypeError, OSError) as error:
        raise StorageError(f"{folder / SWEEP} is damaged: {error!r}") from error
    return write_rolling_report(folder, study.runs, RunTable(folder / TABLE, COLUMNS).rows(), command=record["command"])


def _image(path: Path | None, relief: str | None) -> Ground | None:
    """Return the further terrain of an image.

    Raises InputError where the file is no grey-scale image with relief, StorageError where it cannot be read.
    """
    if path is None:
        if relief is not None:
            raise InputError(f"--relief {relief}: only with --terrain, as the height of white in its image")
        return None
    if relief is None:
        raise InputError("--terrain: needs --relief, the height of white in the image, such as '400 mm'")
    try:
        content = path.read_bytes()
    except OSError as error:
        raise StorageError(f"terrain image '{path}' cannot be read: {error.strerror or error}") from error
    name = "".join(c if c.isalnum() else "-" for c in path.stem.lower())
    if name in COURSES:
        name += "-image"
    from pneumorph.terrain.courses import EXTENT
    from pneumorph.terrain.height_field import from_image_bytes

    height = parse(relief, "length", "--relief")
    from_image_bytes(content, str(path), length=EXTENT, width=EXTENT, relief=height)
    return Ground(name, content, height)


def _check_video(name: str | None, known: list[str]) -> None:
    if name is not None and name not in known:
        text = unknown_name("run", name, known)
        near = text.partition(" Allowed:")[0]
        raise InputError(f"--video: {near} Allowed: a wheel, '_' and a terrain, such as {known[0]} or {known[-1]}")


@contextmanager
def progress_on(screen: Console, result: Callable[[RollingNews], str]) -> Iterator[Callable[[RollingNews], None]]:
    """Give a listener that shows a bar on a terminal, and a line for each run elsewhere; result: a run in words."""
    if not screen.is_terminal:
        yield lambda news: screen.print(_line(news, result(news)), markup=False)
        return
    columns = (TextColumn("{task.completed:.0f} of {task.total}"), BarColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=screen) as bar:
        task = bar.add_task("starting", total=None)
        yield lambda news: bar.update(
            task,
            total=news.total,
            completed=news.finished,
            description=f"about {clock(news.remaining)} left  {result(news)}",
        )


def _line(news: RollingNews, result: str) -> str:
    left = f"elapsed {clock(news.elapsed)}  left about {clock(news.remaining)}"
    return f"{100.0 * news.finished / news.total:3.0f} %  {result}  {left}"


def _result(news: RollingNews) -> str:
    row = news.row
    if row["status"] != "done":
        return f"{row['run']}: failed, {row['reason']}"
    return f"{row['run']}: {show(1000.0 * float(str(row['distance [m]'])), 'length')}"
