"""What `pneumorph sweep` shows: a bar with the time left on a terminal, else one plain line for each design.

And the report of its folder, written anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from pneumorph.cli.progress import clock
from pneumorph.studies.sweeps import Design, Sweep, SweepFolder, SweepProgress, SweepTable, load_sweep, stored_table


@contextmanager
def progress_of(console: Console, sweep: Sweep) -> Iterator[Callable[[SweepProgress], None]]:
    """Give a listener for `run_sweep`; designs that are not done leave a line above the bar."""
    if not console.is_terminal:
        yield lambda news: console.print(plain_line(news, sweep), markup=False)
        return
    columns = (TextColumn("designs"), BarColumn(bar_width=None), MofNCompleteColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=console, expand=True) as bar:
        task = bar.add_task("", total=None)

        def listen(news: SweepProgress) -> None:
            bar.update(task, completed=news.ended, total=news.total, description=_times(news))
            if news.record is not None and news.record.status != "done":
                bar.console.print(plain_line(news, sweep), markup=False)

        yield listen


def plain_line(news: SweepProgress, sweep: Sweep) -> str:
    """Return one line for a log: '5/12  design 7  actuator.wall 2 mm  done in 12 s  elapsed 40 s  left about 50 s'."""
    words = [f"{news.ended}/{news.total}"]
    if news.design is not None and news.record is not None:
        words += [f"design {news.design.number}", values_of(news.design, sweep)]
        words.append(f"{news.record.status} in {clock(news.record.wall_time)}")
        words += [news.record.message] if news.record.message else []
    else:
        words.append("kept from before" if news.ended else "starting workers")
    return "  ".join([*words, _times(news)])


def values_of(design: Design, sweep: Sweep) -> str:
    """Return 'actuator.wall 2 mm, material.mu 0.1 MPa' of a design."""
    return ", ".join(f"{p.path} {value}" for p, value in zip(sweep.parameters, design.values, strict=True))


def _times(news: SweepProgress) -> str:
    left = "" if news.remaining is None else f"  left about {clock(news.remaining)}"
    return f"elapsed {clock(news.elapsed)}{left}"


def summary(table: SweepTable) -> str:
    """Return '10 done, 1 failed, 1 refused of 12 designs'."""
    counts = {status: table.count(status) for status in dict.fromkeys(table.statuses)}
    return f"{', '.join(f'{count} {status}' for status, count in counts.items())} of {len(table)} designs"


def is_sweep(folder: Path) -> bool:
    """Return whether a folder holds a sweep."""
    return SweepFolder(folder).sweep.is_file() and SweepFolder(folder).designs.is_dir()


def report_sweep(folder: Path) -> Path:
    """Write the report of a sweep's folder anew, of the designs that ended; return its path.

    Raises StorageError for damaged files, InputErrors for a sweep.toml that was changed to something wrong.
    """
    from pneumorph.report.sweep_report import write_sweep_report

    sweep = load_sweep(SweepFolder(folder).sweep)
    command = f"pneumorph sweep {SweepFolder(folder).sweep} --out {folder}"
    return write_sweep_report(sweep, stored_table(sweep, folder), folder, command)
