"""The command line: `pneumorph run`, `reproduce`, `report` and `doctor`; the entry point is `main`."""

from __future__ import annotations

import logging
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

import pneumorph
from pneumorph.cli import design, doctor, export, fit, materials, mesh, new, report, reproduce, run, schema, sweep
from pneumorph.cli.output import BAD_INPUT, DONE, FAILED, INTERRUPTED, complain
from pneumorph.errors import InputError, PneumorphError, StorageError
from pneumorph.threads import thread_count


class _Commands(TyperGroup):
    """Turns the errors of pneumorph into one message on stderr and an exit code; others are defects and show."""

    def invoke(self, ctx: Any) -> Any:
        try:
            thread_count()  # a bad PNEUMORPH_THREADS is bad input for every command
            return super().invoke(ctx)
        except (InputError, StorageError) as error:
            complain(f"error: {error}")
            raise typer.Exit(BAD_INPUT) from None
        except PneumorphError as error:
            complain(f"error: {error}")
            raise typer.Exit(FAILED) from None
        except KeyboardInterrupt:
            complain("interrupted")
            raise typer.Exit(INTERRUPTED) from None


app = typer.Typer(
    cls=_Commands,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Soft pneumatic actuators from parameters to inflated shape.\n\n"
    "Exit codes: 0 done, 1 an engine does not work, 2 bad input, 3 stopped before the target, states kept.",
)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"pneumorph {pneumorph.__version__}")
        raise typer.Exit(DONE)


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and stop.", callback=_print_version, is_eager=True)
    ] = False,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Say more about the solver's steps.")] = False,
) -> None:
    """Set up what all commands share."""
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    logging.getLogger("pneumorph").setLevel(logging.INFO if verbose else logging.WARNING)


app.command("run")(run.run)
app.command("sweep")(sweep.sweep)
app.command("design")(design.design)
app.command("reproduce")(reproduce.reproduce)
app.command("report")(report.report)
app.command("export")(export.export)
app.command("new")(new.new)
app.command("schema")(schema.schema)
app.command("materials")(materials.materials)
app.command("fit")(fit.fit)
app.command("mesh")(mesh.mesh)
app.command("doctor")(doctor.doctor)


def main() -> None:
    """Run the command line; the entry point of the package."""
    app()
