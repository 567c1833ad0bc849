"""`pneumorph schema`: the JSON schema of study files, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def schema(out: Annotated[Path | None, typer.Option(help="File to write. Default: print it.")] = None) -> None:
    """Print or write the JSON schema of study files, with which editors check and complete them."""
    from pneumorph.studies.json_schema import schema_text, write_schema

    if out is None:
        typer.echo(schema_text(), nl=False)
    else:
        write_schema(out)
        typer.echo(f"schema: {out}")
