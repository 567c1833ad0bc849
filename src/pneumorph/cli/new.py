"""`pneumorph new TEMPLATE`: write a commented study file that runs at once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def new(
    template: Annotated[str | None, typer.Argument(help="Name of the template; leave it out for a list.")] = None,
    file: Annotated[Path | None, typer.Argument(help="Study file to write. Default: <template>.toml.")] = None,
    schema: Annotated[
        bool, typer.Option("--schema", help="Write the JSON schema beside it, so that editors check and complete it.")
    ] = False,
) -> None:
    """Write a commented study file of a template: every dimension, and all else that a study can say."""
    from pneumorph.studies.starting import starters

    if template is None:
        for name, text in starters().items():
            typer.echo(f"{name}: {text}.")
        return

    from pneumorph.studies.starting import write_starter

    path = write_starter(template, file or Path(f"{template}.toml"), schema=schema)
    typer.echo(f"{path}: run it with 'pneumorph run {path}'")
