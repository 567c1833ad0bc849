"""`pneumorph doctor`: does everything that pneumorph relies on work here?"""

from __future__ import annotations

import typer


def doctor() -> None:
    """Check engines, threads, rendering and video, and solve a tiny problem; exit code 1 if something fails."""
    from rich.table import Table

    from pneumorph.cli.checks import CHECKS
    from pneumorph.cli.output import console

    table = Table("check", "", "found, or what to do", box=None, pad_edge=False)
    failed = 0
    for check in CHECKS:
        try:
            table.add_row(check.name, "ok", check.look())
        except Exception as error:  # an engine that is broken may raise anything
            failed += 1
            table.add_row(check.name, "problem", f"{error or type(error).__name__}\n-> {check.advice}")
    console().print(table)
    if failed:
        raise typer.Exit(1)
