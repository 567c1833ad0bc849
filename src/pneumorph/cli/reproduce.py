"""`pneumorph reproduce NAME`: rebuild a published system and compare it with what was reported."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer


def reproduce(
    name: Annotated[str | None, typer.Argument(help="Name of the system; leave it out for a list.")] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Coarse mesh, and stops early.")] = False,
    out: Annotated[Path | None, typer.Option(help="Run folder. Default: runs/<name>, with -quick if it is.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the last state in the folder.")] = False,
) -> None:
    """Rebuild a published system, solve it and compare it with the reported data."""
    from pneumorph.studies import reproductions

    if name is None:
        for known in reproductions.names():
            item = reproductions.reproduction(known)
            typer.echo(f"{known}: {item.title}. {item.source}")
        return

    from pneumorph.cli.reporting import report_reproduction
    from pneumorph.cli.solving import solve_and_report

    chosen = reproductions.reproduction(name)
    study = chosen.study(quick)
    folder = out or Path("runs") / (f"{name}-quick" if quick else name)
    command = shlex.join(["pneumorph", "reproduce", name, *(["--quick"] if quick else []), "--out", str(folder)])
    solve_and_report(
        study,
        folder,
        resume,
        command,
        lambda solution: report_reproduction(solution, chosen, study),
        about={"reproduction": name, "source": chosen.source},
    )
