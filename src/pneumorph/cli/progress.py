"""Progress of a solve: a live display on a terminal, one plain line for each state otherwise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Protocol

from rich.console import Console
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn
from rich.table import Table

from pneumorph.solution import Measure
from pneumorph.solution import Progress as SolveProgress
from pneumorph.units import show


class Listener(Protocol):
    """What `solve` calls after each state."""

    def __call__(self, news: SolveProgress, /) -> None:
        """Take the news."""


@contextmanager
def progress_on(console: Console, measures: tuple[Measure, ...]) -> Iterator[Listener]:
    """Give a listener that shows the state's number, phase, pressures, measures, iterations and the time left."""
    if not console.is_terminal:
        yield lambda news: console.print(plain_line(news, measures), markup=False)
        return
    bar = Progress(TextColumn("{task.percentage:3.0f} %"), BarColumn(bar_width=None), expand=True, console=console)
    task = bar.add_task("", total=1.0)
    with Live(bar, console=console, refresh_per_second=8) as live:

        def listen(news: SolveProgress) -> None:
            bar.update(task, completed=news.fraction)
            grid = Table.grid(padding=(0, 2))
            for name, value in facts(news, measures).items():
                grid.add_row(f"[dim]{name}[/dim]", value)
            outer = Table.grid(expand=True)
            outer.add_row(bar)
            outer.add_row(grid)
            live.update(outer)

        yield listen


def facts(news: SolveProgress, measures: tuple[Measure, ...]) -> dict[str, str]:
    """Return what a reader wants to see of a state, name -> text with units."""
    state = news.state
    result = {"state": str(state.index), "phase": state.phase}
    result |= _pressures(state.pressure)
    result |= {m.name.replace("_", " "): show(float(news.row[m.name]), m.kind) for m in measures}
    result["iterations"] = f"{state.iterations} ({news.total_iterations} in all)"
    if state.unstable_modes:
        result["unstable modes"] = str(state.unstable_modes)
    result["elapsed"] = clock(news.elapsed)
    result["left"] = "about " + clock(news.remaining) if news.remaining is not None else "not known yet"
    return result


def _pressures(pressure: Mapping[str, float]) -> dict[str, str]:
    """Return the pressures; cavities with the same one share an entry."""
    by_text: dict[str, list[str]] = {}
    for name, value in pressure.items():
        by_text.setdefault(show(value, "pressure"), []).append(name)
    if len(by_text) == 1:
        return {"pressure": next(iter(by_text))}
    return {f"pressure {', '.join(names)}": text for text, names in by_text.items()}


def plain_line(news: SolveProgress, measures: tuple[Measure, ...]) -> str:
    """Return one line for a log: '42 %  state 7  phase inflate  pressure 40 kPa ...'."""
    words: list[Any] = [f"{100.0 * news.fraction:3.0f} %"]
    words += [f"{name} {value}" for name, value in facts(news, measures).items()]
    return "  ".join(words)


def clock(seconds: float) -> str:
    """Return a time as 42 s, 3 min 05 s or 1 h 07 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"
