"""What `pneumorph reproduce soft-wheel --part reduced` does, and the report of such a folder."""

from __future__ import annotations

import shlex
from pathlib import Path

import typer

from pneumorph.cli.interrupt import Interrupt
from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.progress import progress_on
from pneumorph.errors import NotConvergedError, StorageError
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.solution.solve import Progress
from pneumorph.studies.reproductions.soft_wheel import SYSTEM
from pneumorph.terrain.limb_data import LimbData, read_limb_data

DATA, SOLVES = "limb_data.json", "finite-elements"


def reproduce_reduced(quick: bool, out: Path | None, resume: bool) -> None:
    """Reduce the limb and report; a quick one takes the limb data of the package instead of solving.

    Raises typer.Exit with 3 where the solve stopped early, 130 where it was interrupted.
    """
    _check_extras()
    folder = out or Path("runs") / f"{SYSTEM.name}-reduced{'-quick' if quick else ''}"
    words = ["pneumorph", "reproduce", SYSTEM.name, "--part", "reduced", *(["--quick"] if quick else [])]
    command = shlex.join([*words, "--out", str(folder)])
    screen = console()
    screen.print(f"{SYSTEM.title}, part reduced\nfolder: {folder}", markup=False)
    if (folder / DATA).exists() and not resume:
        raise StorageError(f"'{folder}' already holds a run: resume it (--resume) or choose another folder")
    make_folder(folder)
    if quick:
        data = read_limb_data()
        screen.print(f"limb data of the package, from: {data.provenance.get('command')}", markup=False)
    else:
        data = _solved(folder, resume, shlex.join(words), command)
    write_atomically(folder / DATA, lambda path: path.write_text(data.text(), encoding="utf-8"))
    screen.print("fit, static tests and roll in MuJoCo ...")
    screen.print(f"report: {_write(folder, data)}", markup=False)


def is_reduced(folder: Path) -> bool:
    """Return whether a folder holds a reduced wheel."""
    return (folder / DATA).is_file()


def report_reduced(folder: Path) -> Path:
    """Compute and write the report of a folder anew from its limb data; return its path."""
    _check_extras()
    return _write(folder, read_limb_data(folder / DATA))


def _write(folder: Path, data: LimbData) -> Path:
    from pneumorph.report.reduced import write_reduced_report
    from pneumorph.studies.reduced_wheel import reduce_wheel

    result = reduce_wheel(data)
    return write_reduced_report(folder, data, result, SYSTEM.source, str(data.provenance.get("command", "")))


def _check_extras() -> None:
    """Raise EngineError, with what to install, where an extra is missing: before anything is written."""
    from pneumorph.terrain.rigid import engine

    engine()
    import pneumorph.terrain.environment  # noqa: F401


def _solved(folder: Path, resume: bool, words: str, command: str) -> LimbData:
    from pneumorph.studies.limb_reduction import LimbRuns, run_limb

    try:
        with Interrupt() as interrupt, progress_on(console(), ()) as progress:

            def told(news: Progress) -> None:
                progress(news)
                interrupt.check()

            return run_limb(LimbRuns(), folder / SOLVES, resume=resume, progress=told, command=words)
    except NotConvergedError as stop:
        complain(f"stopped before the last force: {stop}\nthe states so far are kept in {folder / SOLVES}")
        raise typer.Exit(STOPPED) from None
    except KeyboardInterrupt:
        complain(f"interrupted; the states so far are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
