"""`pneumorph sweep SWEEP`: compute one study with many values of its parameters into one table."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer


def sweep(
    file: Annotated[Path, typer.Argument(metavar="SWEEP", help="Sweep file (TOML).")],
    out: Annotated[Path | None, typer.Option(help="Folder. Default: runs/<name of the sweep>.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Compute only the designs that are missing.")] = False,
    retry: Annotated[bool, typer.Option("--retry", help="With --resume: those that failed or stopped too.")] = False,
    workers: Annotated[int | None, typer.Option(help="Processes on this machine. Default: its cores.")] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a running Dask scheduler, such as tcp://10.0.0.1:8786.")
    ] = None,
    no_report: Annotated[bool, typer.Option("--no-report", help="Write the tables only.")] = False,
) -> None:
    """Compute a study with many values of its parameters; a design that fails is a row with its reason."""
    from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
    from pneumorph.cli.sweeping import progress_of, summary
    from pneumorph.errors import InputError
    from pneumorph.studies.sweeps import SweepFolder, Workers, load_sweep, run_sweep

    if retry and not resume:
        raise InputError("--retry goes with --resume")
    place = Workers(workers, scheduler)
    loaded = load_sweep(file)
    if loaded.file.slurm is not None and workers is None and scheduler is None:
        place = Workers(slurm=loaded.file.slurm)
    folder = SweepFolder(out or Path("runs") / loaded.name)
    out_to = console()
    out_to.print(f"{loaded.title}: {len(loaded.designs)} designs, {place.text}\nfolder: {folder.path}", markup=False)
    command = shlex.join(["pneumorph", "sweep", str(file), "--out", str(folder.path)])
    try:
        with progress_of(out_to, loaded) as progress:
            table = run_sweep(loaded, folder.path, workers=place, resume=resume, retry=retry, progress=progress)
    except KeyboardInterrupt:
        complain(f"interrupted; the designs that ended are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    out_to.print(f"table: {folder.table}, {folder.parquet}", markup=False)
    if not no_report:
        from pneumorph.report.sweep_report import write_sweep_report

        out_to.print(f"report: {write_sweep_report(loaded, table, folder.path, command)}", markup=False)
    out_to.print(summary(table), markup=False)
    if table.count("failed", "stopped"):  # a design that is refused is an answer
        raise typer.Exit(STOPPED)
