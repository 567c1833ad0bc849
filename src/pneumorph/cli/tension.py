"""What `pneumorph run` does with a study of flat sheets, and the report of its folder."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from pneumorph.cli.interrupt import Interrupt
from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.progress import clock
from pneumorph.errors import NotConvergedError, StorageError
from pneumorph.homogenisation import TensionTest
from pneumorph.mechanics import State
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.running import STUDY_FILE
from pneumorph.studies.tension import MODELS, Pull, TensionStudy, is_tension_table, load_tension, tension_from
from pneumorph.studies.toml_file import read_toml

CURVES = "curves"


def run_tension(study: TensionStudy, folder: Path, resume: bool, command: str, *, reported: bool) -> None:
    """Pull the sheets with progress; each curve is on the disk as soon as its test ends, so that a run can be resumed.

    Exit code 3 where a test does not converge, 130 on Ctrl-C; the other tests go on. Raises StorageError for a folder
    that holds a run and is not resumed, or holds another one.
    """
    out = console()
    _keep(study, folder, resume)
    out.print(f"{study.title}: {len(study.pulls)} tests\nfolder: {folder}", markup=False)
    tests, stopped = _read(study, folder), []
    left = [pull for pull in study.pulls if pull not in tests]
    if tests:
        out.print(f"{len(tests)}/{len(study.pulls)}  kept from before", markup=False)
    try:
        with Interrupt() as interrupt, _bar(out, study) as tell:
            for pull in left:
                started = perf_counter()

                def told(state: State, pull: Pull = pull) -> None:
                    tell(pull, state.time)
                    interrupt.check()

                try:
                    tests[pull] = study.test(pull, told)
                except NotConvergedError as error:
                    stopped.append(f"{pull.name}: {error}")
                    continue
                study.curve(pull, tests[pull]).write_csv(folder / CURVES / f"{pull.name}.csv")
                tell(pull, 1.0)
                taken = clock(perf_counter() - started)
                out.print(
                    f"{len(tests)}/{len(study.pulls)}  {_words(pull, tests[pull])}  done in {taken}", markup=False
                )
                interrupt.check()
    except KeyboardInterrupt:
        complain(f"interrupted; the tests that ended are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    if reported and tests:
        from pneumorph.report.tension import write_tension_report

        out.print(f"report: {write_tension_report(study, tests, folder, command)}", markup=False)
    if stopped:
        complain("\n".join(f"stopped: {text}" for text in stopped))
        raise typer.Exit(STOPPED)


def is_tension(folder: Path) -> bool:
    """Return whether a folder holds a run of a study of sheets."""
    path = folder / STUDY_FILE
    return (folder / CURVES).is_dir() and path.is_file() and is_tension_table(read_toml(path, "study file"))


def report_tension(folder: Path) -> Path:
    """Write the report of such a folder anew, of the tests that ended; return its path. Raises StorageError."""
    from pneumorph.report.tension import write_tension_report

    study = load_tension(folder / STUDY_FILE)
    tests = _read(study, folder)
    if not tests:
        raise StorageError(f"'{folder}' holds no test that ended: there is nothing to report")
    return write_tension_report(study, tests, folder, f"pneumorph run {folder / STUDY_FILE} --out {folder}")


def _keep(study: TensionStudy, folder: Path, resume: bool) -> None:
    path, text = folder / STUDY_FILE, study.resolved_text()
    if path.exists():
        if not resume:
            raise StorageError(f"'{folder}' already holds a run: resume it (--resume) or choose another folder")
        # equal studies: names and titles may differ
        table = read_toml(path, "study file")
        if not is_tension_table(table) or _what(tension_from(table, study.name)) != _what(study):
            raise StorageError(f"'{folder}' holds another study, see its {STUDY_FILE}: choose another folder")
    make_folder(folder / CURVES)
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def _what(study: TensionStudy) -> object:
    """Return what a curve depends on, as text; kinds, directions and models may be added to."""
    data = study.file.model_dump(exclude_none=True)
    asked = {"sheet": ("kinds",), "pull": ("directions", "models"), "material": (), "mesh": ()}
    return {name: {k: v for k, v in data[name].items() if k not in free} for name, free in asked.items()}


def _read(study: TensionStudy, folder: Path) -> dict[Pull, TensionTest]:
    places = {pull: folder / CURVES / f"{pull.name}.csv" for pull in study.pulls}
    return {pull: study.read_curve(pull, path) for pull, path in places.items() if path.is_file()}


@contextmanager
def _bar(out: Console, study: TensionStudy) -> Iterator[Callable[[Pull, float], None]]:
    """Give a listener that shows a bar of all tests on a terminal; elsewhere nothing, as each leaves a line."""
    if not out.is_terminal:
        yield lambda pull, share: None
        return
    places = {pull: number for number, pull in enumerate(study.pulls)}
    with Progress(TextColumn("tests"), BarColumn(bar_width=None), TextColumn("{task.description}"), console=out) as bar:
        task = bar.add_task("", total=len(places))
        yield lambda pull, share: bar.update(
            task, completed=places[pull] + share, description=f"{pull.label}, {pull.model}"
        )


def _words(pull: Pull, test: TensionTest) -> str:
    return (
        f"{pull.label}, {MODELS[pull.model]}: stiffness {test.stiffness:.3g} N/mm, "
        f"Poisson's ratio {test.poisson_ratio:.3g}"
    )
