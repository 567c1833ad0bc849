"""What `pneumorph reproduce NAME` does for a system of studies: one run, or one for each of its parts."""

from __future__ import annotations

import shlex
from pathlib import Path

import typer

from pneumorph.cli.output import STOPPED
from pneumorph.cli.reporting import report_reproduction
from pneumorph.cli.solving import solve_and_report
from pneumorph.errors import InputError, StorageError
from pneumorph.solution import Solution
from pneumorph.solution.storage import RunFolder
from pneumorph.studies import study_from
from pneumorph.studies.reproductions import Reproduction, reproduction


def reproduce_study(chosen: Reproduction, quick: bool, out: Path | None, resume: bool, part: str | None) -> None:
    """Solve a reproduction with all its parts, or one of them, and write the reports.

    Its own run is in the folder, that of a part in a folder of the part's label in it. A part that stops early does not
    keep the others from being run. Raises InputError for an unknown part, StorageError for a folder that holds a run
    already, typer.Exit with 3 where a run stopped before its target, 130 on Ctrl-C.
    """
    parts = dict(chosen.parts) or {"": chosen.name}
    if part is not None and part not in chosen.parts:
        allowed = f"allowed for {chosen.name}: {', '.join(chosen.parts)}; left out, all of them"
        raise InputError(f"--part: {part}, " + (allowed if chosen.parts else f"but {chosen.name} has no parts"))
    options = [*(["--part", part] if part else []), *(["--quick"] if quick else [])]
    if part is not None:
        parts = {part: chosen.parts[part]}
    named = chosen.name if len(parts) > 1 else next(iter(parts.values()))
    folder = out or Path("runs") / (f"{named}-quick" if quick else named)
    command = shlex.join(["pneumorph", "reproduce", chosen.name, *options, "--out", str(folder)])
    folders = {name: folder / label if name != named else folder for label, name in parts.items()}
    for place in folders.values():
        if not resume and RunFolder(place).holds_run:
            raise StorageError(f"'{place}' already holds a run: resume it (--resume) or choose another folder")
    several = len(parts) > 1
    stopped = [
        name
        for name, place in folders.items()
        if not _solved(name, quick, place, resume, command, late=several and name == named)
    ]
    if several:  # written last, so that it has the rows of all parts
        report_whole(folder, chosen)
    if stopped:
        raise typer.Exit(STOPPED)


def report_whole(folder: Path, chosen: Reproduction) -> Path:
    """Write the report of a system's own run, with the rows of its parts, from its folder; return its path."""
    solution = Solution.open(folder)
    return report_reproduction(solution, chosen, study_from(solution.about["study"], solution.about["name"]))


def _solved(name: str, quick: bool, folder: Path, resume: bool, command: str, *, late: bool) -> bool:
    """Solve one run and write its report, unless that comes late; return whether it reached its target."""
    item = reproduction(name)
    if not isinstance(item, Reproduction):
        raise TypeError(f"'{name}' is no reproduction of one study")
    study = item.study(quick)

    def written(solution: Solution) -> Path:
        return report_reproduction(solution, item, study)

    about = {"reproduction": name, "source": item.source}
    try:
        solve_and_report(study, folder, resume, command, None if late else written, about=about)
    except typer.Exit as stop:
        if stop.exit_code != STOPPED:
            raise
        return False
    return True
