"""`pneumorph mesh FILE`: what there is in a CAD or mesh file, a study or a template, as tables and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def mesh(
    file: Annotated[
        str, typer.Argument(help="CAD or mesh file (.step .iges .stl .msh .inp .vtu), study file, or template name.")
    ],
    more: Annotated[list[Path] | None, typer.Argument(help="More .stl files of the same body.")] = None,
    unit: Annotated[
        str | None, typer.Option(help="Unit of .stl, .msh, .inp and .vtu files: mm, cm, m, in, ...")
    ] = None,
    size: Annotated[str | None, typer.Option(help="Largest edge of the mesh, such as '2 mm'; or coarse.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder for picture and mesh. Default: runs/mesh/<name>.")] = None,
    study: Annotated[Path | None, typer.Option(help="Write a study file to go on with.")] = None,
    picture: Annotated[bool, typer.Option(help="Draw the picture.")] = True,
) -> None:
    """Show domains, faces and cavities with their names and measures; draw them; save the mesh."""
    from pneumorph.cli.meshing import inspect_file, subject_of

    subject = subject_of(file, more or [], unit, size)
    inspect_file(subject, out or Path("runs") / "mesh" / subject.name, draw=picture, study=study)
