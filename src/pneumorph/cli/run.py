"""`pneumorph run STUDY`: solve a study file and report."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer


def run(
    study: Annotated[Path, typer.Argument(help="Study file (TOML).")],
    out: Annotated[Path | None, typer.Option(help="Run folder. Default: runs/<name of the study>.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the last state in the folder.")] = False,
    no_report: Annotated[bool, typer.Option("--no-report", help="Write states and history only.")] = False,
) -> None:
    """Solve the study in a file and write its run folder with a report."""
    from pneumorph.cli import reporting
    from pneumorph.cli.solving import solve_and_report
    from pneumorph.studies import load_study
    from pneumorph.studies.tension import is_tension_table, load_tension
    from pneumorph.studies.toml_file import read_toml

    folder = out or Path("runs") / study.stem
    command = shlex.join(["pneumorph", "run", str(study), "--out", str(folder)])
    if is_tension_table(read_toml(study, "study file")):
        from pneumorph.cli.tension import run_tension

        run_tension(load_tension(study), folder, resume, command, reported=not no_report)
        return
    loaded = load_study(study)
    solve_and_report(loaded, folder, resume, command, None if no_report else reporting.report_study)
