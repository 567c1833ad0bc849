"""`pneumorph report FOLDER`: write the report of a run folder anew."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(folder: Annotated[Path, typer.Argument(help="Run folder.")]) -> None:
    """Write the report of a run folder anew, whatever its status."""
    from pneumorph.cli.reporting import report_folder

    typer.echo(f"report: {report_folder(folder)}")
