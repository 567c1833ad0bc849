"""`pneumorph design TARGET`: find the skin and the pressure that bend a tube into a wanted centre line."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def design(
    file: Annotated[Path, typer.Argument(metavar="TARGET", help="Target file (TOML).")],
    out: Annotated[Path | None, typer.Option(help="Folder. Default: runs/<name of the target>.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with what is in the folder.")] = False,
    table: Annotated[
        Path | None,
        typer.Option(help="Folder of the runs of uniform tubes, from an earlier search. Default: in --out."),
    ] = None,
    workers: Annotated[int | None, typer.Option(help="Processes on this machine. Default: its cores.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a running Dask scheduler.")] = None,
    no_verify: Annotated[bool, typer.Option("--no-verify", help="Do not run the full model of the winner.")] = False,
    no_report: Annotated[bool, typer.Option("--no-report", help="Write the design only.")] = False,
) -> None:
    """Find the skin and the pressure that bend a tube into a wanted centre line, and verify them on the full model."""
    from pneumorph.cli.designing import run_design
    from pneumorph.studies.design import load_design
    from pneumorph.studies.design.search import optuna
    from pneumorph.studies.sweeps import Workers

    place = Workers(workers, scheduler)
    task = load_design(file)
    optuna()  # a missing extra shows before anything is computed
    folder = out or Path("runs") / task.name
    words = ["pneumorph", "design", str(file), "--out", str(folder), *(["--table", str(table)] if table else [])]
    run_design(task, folder, table, place, resume, words, verified=not no_verify, reported=not no_report)
