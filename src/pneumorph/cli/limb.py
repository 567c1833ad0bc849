"""What `pneumorph reproduce soft-wheel --part limb` does, and the report of such a folder."""

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
from pneumorph.geometry import SoftLimb
from pneumorph.solution import Progress, Solution, Status, solve
from pneumorph.studies.reproductions.soft_wheel import SYSTEM
from pneumorph.studies.reproductions.soft_wheel_limb import CASES, LimbStudy

RECORD = "limb.json"


def reproduce_limb(quick: bool, out: Path | None, resume: bool) -> None:
    """Solve the cases with progress and write the report; exit code 3 where one stopped early, 130 on Ctrl-C."""
    from pneumorph.report.limb import write_limb_report

    study = LimbStudy(quick)
    folder = out or Path("runs") / f"{SYSTEM.name}-limb{'-quick' if quick else ''}"
    words = ["pneumorph", "reproduce", SYSTEM.name, "--part", "limb", *(["--quick"] if quick else [])]
    command = shlex.join([*words, "--out", str(folder)])
    keep_record(folder / RECORD, study.settings(command), ("quick", "limb"), resume)
    screen = console()
    screen.print(f"{SYSTEM.title}, part limb: {len(CASES)} runs\nfolder: {folder}", markup=False)
    mesh = study.mesh()
    solutions: dict[str, Solution] = {}
    try:
        with Interrupt() as interrupt:
            for name in CASES:
                case = study.case(name, mesh)
                screen.print(f"{case.title}, {mesh.cell_count:,} cells", markup=False)
                with progress_on(screen, case.measures) as progress:

                    def told(news: Progress, listener: Any = progress) -> None:
                        listener(news)
                        interrupt.check()

                    about = {"title": case.title, "source": SYSTEM.source, "limb": study.settings("")["limb"]}
                    solutions[name] = solve(
                        case.model, case.programme, measures=case.measures, folder=folder / name,
                        resume=(folder / name / "run.json").exists(), progress=told, about=about, raise_on_stop=False,
                    )  # fmt: skip
    except KeyboardInterrupt:
        complain(f"interrupted; the states so far are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    screen.print("writing the report ...")
    screen.print(f"report: {write_limb_report(folder, study, solutions, command=command)}", markup=False)
    stopped = [name for name, solution in solutions.items() if solution.status is Status.STOPPED]
    if stopped:
        complain("\n".join(f"{name} stopped before its end: {solutions[name].message}" for name in stopped))
        raise typer.Exit(STOPPED)
    screen.print(f"done: {sum(len(solution.states) for solution in solutions.values())} states", markup=False)


def is_limb(folder: Path) -> bool:
    """Return whether a folder holds the part `limb`."""
    return (folder / RECORD).is_file()


def report_limb(folder: Path) -> Path:
    """Write the report of such a folder anew; return its path. Raises StorageError where it is damaged."""
    from pneumorph.report.limb import write_limb_report

    record = read_record(folder / RECORD)
    try:
        study = LimbStudy(bool(record["quick"]), SoftLimb(**record["limb"]))
        command = str(record["command"])
    except (KeyError, TypeError) as error:
        raise StorageError(f"{folder / RECORD} is damaged: {error!r}") from error
    solutions = {name: Solution.open(folder / name) for name in CASES if (folder / name / "run.json").exists()}
    return write_limb_report(folder, study, solutions, command=command)
