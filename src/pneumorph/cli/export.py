"""`pneumorph export SOURCE --to FILE`: a study or a run, or one of its states, as a file for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def export(
    source: Annotated[Path, typer.Argument(help="Run folder, or study file (its undeformed model).")],
    to: Annotated[Path, typer.Option("--to", help="File to write: .inp, .stl, .step, .stp, .csv or .vtu.")],
    state: Annotated[
        str, typer.Option(help="State of a run: 'last', its number, or the pressure of a cavity, such as '60 kPa'.")
    ] = "last",
    what: Annotated[
        str | None, typer.Option(help="mesh (undeformed), state, pv (pressure-volume curve) or history.")
    ] = None,
    part: Annotated[
        str,
        typer.Option(
            help="In .stl and .step: whole, outer (no cavities); .stl: bodies (rigid ones), wheel (of a limb)."
        ),
    ] = "whole",
    dialect: Annotated[str, typer.Option(help="Program that reads the .inp file: calculix or abaqus.")] = "calculix",
    pressures: Annotated[
        bool, typer.Option("--pressures", help="In .inp: the pressures of the run in the place of its supplies.")
    ] = False,
    printed: Annotated[
        list[str] | None, typer.Option("--print", help="In .inp: a face whose displacements go to the .dat file.")
    ] = None,
    cavity: Annotated[list[str] | None, typer.Option(help="In a pressure-volume curve: which cavity.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there.")] = False,
) -> None:
    """Write a study or a run for other programs: CalculiX, Abaqus, CAD, 3-D printing, tables."""
    from pneumorph.cli.exporting import Wanted, export_file

    wanted = Wanted(to, state, what, part, dialect, pressures, tuple(printed or ()), tuple(cavity or ()), force)
    for line in export_file(source, wanted):
        typer.echo(line)
