"""What `pneumorph reproduce auxetic-skin` does, and the report of such a folder."""

from __future__ import annotations

import shlex
from pathlib import Path

import typer

from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.record import keep_record, read_record
from pneumorph.cli.sweeping import progress_of, summary
from pneumorph.errors import StorageError
from pneumorph.studies.reproductions.auxetic_skin import NAME, SYSTEM, SkinStudy, findings
from pneumorph.studies.reproductions.auxetic_tension import tension_findings
from pneumorph.studies.sweeps import Workers, run_sweep, stored_table

RECORD = "skins.json"


def reproduce_skin(quick: bool, out: Path | None, resume: bool, *, scheduler: str | None = None) -> None:
    """Run the sweep with progress and write its report; exit code 3 where designs failed or stopped."""
    from pneumorph.report.skins import write_skin_report

    study, workers = SkinStudy(quick), Workers(scheduler=scheduler)
    sweep = study.sweep
    folder = out or Path("runs") / (f"{NAME}-quick" if quick else NAME)
    words = ["pneumorph", "reproduce", NAME, *(["--quick"] if quick else []), "--out", str(folder)]
    command = shlex.join(words)
    keep_record(folder / RECORD, {"quick": quick, "command": command}, ("quick",), resume)
    screen = console()
    screen.print(f"{SYSTEM.title}: {len(sweep.designs)} designs, {workers.text}\nfolder: {folder}", markup=False)
    try:
        with progress_of(screen, sweep) as progress:
            table = run_sweep(sweep, folder, workers=workers, resume=resume, progress=progress)
    except KeyboardInterrupt:
        complain(f"interrupted; the designs that ended are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    screen.print("flat sheets in tension ...", markup=False)
    found = (*findings(study, table), *tension_findings())
    screen.print(f"report: {write_skin_report(study, table, found, folder, command)}", markup=False)
    held = sum(item.holds is True for item in found)
    screen.print(f"{held} of {len(found)} statements of the study hold: {folder / 'comparison.csv'}", markup=False)
    screen.print(summary(table), markup=False)
    if table.count("failed", "stopped"):
        raise typer.Exit(STOPPED)


def is_skins(folder: Path) -> bool:
    """Return whether a folder holds the sweep of this reproduction."""
    return (folder / RECORD).is_file()


def report_skins(folder: Path) -> Path:
    """Write the report of such a folder anew, of the designs that ended; return its path. Raises StorageError.

    Flat sheets are computed anew: that takes seconds.
    """
    from pneumorph.report.skins import write_skin_report

    record = read_record(folder / RECORD)
    if not isinstance(record.get("quick"), bool):
        raise StorageError(f"{folder / RECORD} is damaged: no 'quick' that is true or false")
    study = SkinStudy(record["quick"])
    table = stored_table(study.sweep, folder)
    found = (*findings(study, table), *tension_findings())
    return write_skin_report(study, table, found, folder, str(record.get("command", "")))
