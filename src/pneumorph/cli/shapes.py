"""What `pneumorph reproduce auxetic-skin --part shapes` does, and the report of such a folder."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import typer

from pneumorph.cli.interrupt import Interrupt
from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.progress import progress_on
from pneumorph.cli.record import keep_record, read_record
from pneumorph.errors import StorageError
from pneumorph.solution import Progress, Solution, Status
from pneumorph.studies import run_study
from pneumorph.studies.reproductions.auxetic_shapes import PART, ShapesStudy, shape_findings
from pneumorph.studies.reproductions.auxetic_skin import SYSTEM

RECORD = "shapes.json"


def reproduce_shapes(quick: bool, out: Path | None, resume: bool) -> None:
    """Inflate the shapes one after the other with progress and write the report.

    Exit code 3 where one stopped before its pressure, 130 on Ctrl-C.
    """
    from pneumorph.report.shapes import write_shapes_report

    study = ShapesStudy(quick)
    folder = out or Path("runs") / f"{SYSTEM.name}-{PART}{'-quick' if quick else ''}"
    words = ["pneumorph", "reproduce", SYSTEM.name, "--part", PART, *(["--quick"] if quick else [])]
    command = shlex.join([*words, "--out", str(folder)])
    keep_record(folder / RECORD, {"quick": quick, "command": command}, ("quick",), resume)
    screen = console()
    screen.print(f"{SYSTEM.title}, part {PART}: {len(study.runs)} runs\nfolder: {folder}", markup=False)
    solutions: dict[str, Solution] = {}
    try:
        with Interrupt() as interrupt:
            for shape in study.runs:
                screen.print(shape.title, markup=False)
                with progress_on(screen, shape.study.measures) as progress:

                    def told(news: Progress, listener: Any = progress) -> None:
                        listener(news)
                        interrupt.check()

                    place = folder / shape.name
                    solutions[shape.name] = run_study(
                        shape.study, place, resume=(place / "run.json").exists(), progress=told, raise_on_stop=False,
                        about={"source": SYSTEM.source},
                    )  # fmt: skip
    except KeyboardInterrupt:
        complain(f"interrupted; the states so far are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    found = shape_findings(study, solutions)
    screen.print("writing the report ...")
    screen.print(f"report: {write_shapes_report(folder, study, solutions, found, command)}", markup=False)
    held = sum(item.holds is True for item in found)
    screen.print(f"{held} of {len(found)} statements of the study hold: {folder / 'comparison.csv'}", markup=False)
    stopped = [name for name, solution in solutions.items() if solution.status is Status.STOPPED]
    if stopped:
        complain("\n".join(f"{name} stopped before its pressure: {solutions[name].message}" for name in stopped))
        raise typer.Exit(STOPPED)


def is_shapes(folder: Path) -> bool:
    """Return whether a folder holds the part `shapes`."""
    return (folder / RECORD).is_file()


def report_shapes(folder: Path) -> Path:
    """Write the report of such a folder anew, of the shapes that are there; return its path. Raises StorageError."""
    from pneumorph.report.shapes import write_shapes_report

    record = read_record(folder / RECORD)
    if not isinstance(record.get("quick"), bool):
        raise StorageError(f"{folder / RECORD} is damaged: no 'quick' that is true or false")
    study = ShapesStudy(record["quick"])
    solutions = {
        shape.name: Solution.open(folder / shape.name)
        for shape in study.runs
        if (folder / shape.name / "run.json").exists()
    }
    return write_shapes_report(
        folder, study, solutions, shape_findings(study, solutions), str(record.get("command", ""))
    )
