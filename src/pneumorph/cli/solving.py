"""What `run` and `reproduce` share: solve with progress, then report; the exit code says how it ended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import typer

from pneumorph.cli.interrupt import Interrupt
from pneumorph.cli.output import INTERRUPTED, STOPPED, complain, console
from pneumorph.cli.progress import progress_on
from pneumorph.solution import Progress, Solution, Status
from pneumorph.studies import Study, run_study
from pneumorph.units import show


def solve_and_report(
    study: Study,
    folder: Path,
    resume: bool,
    command: str,
    report: Callable[[Solution], Path] | None,
    about: dict[str, str] | None = None,
) -> None:
    """Solve a study into a folder and write its report; `command` resumes it.

    Raises typer.Exit with 3 where the solve stopped before its target, 130 where it was interrupted.
    """
    out = console()
    out.print(f"{study.title}\nfolder: {folder}", markup=False)
    try:
        with Interrupt() as interrupt, progress_on(out, study.measures) as progress:

            def told(news: Progress) -> None:
                progress(news)
                interrupt.check()

            solution = run_study(
                study,
                folder,
                resume=resume,
                progress=told,
                about={**(about or {}), "command": command},
                raise_on_stop=False,
            )
    except KeyboardInterrupt:
        complain(f"interrupted; the states so far are kept, go on with: {command} --resume")
        raise typer.Exit(INTERRUPTED) from None
    if report is not None:
        out.print("writing the report ...")
        out.print(f"report: {report(solution)}", markup=False)
    if solution.status is Status.STOPPED:
        complain(f"stopped before the target: {solution.message}\n{len(solution.states)} states are kept in {folder}")
        raise typer.Exit(STOPPED)
    out.print(
        f"done: {len(solution.states)} states, {solution.meta['iterations']} Newton iterations{_margins(solution)}",
        markup=False,
    )


def _margins(solution: Solution) -> str:
    """Return how far a run stayed from turning cells inside out and, with contact, from surfaces that cross."""
    history = solution.history
    text = f", smallest det F {history.smallest('smallest_volume_ratio') or 1.0:.3g}"
    if not solution.model.contacts:
        return text
    least = history.smallest("contact_distance:")
    return f"{text}, smallest distance " + ("none within reach" if least is None else show(least, "length", 3))
