"""What `pneumorph fit` shows: progress, the table of the laws, and what to beware of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext

from rich import box
from rich.console import Console
from rich.measure import Measurement
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from pneumorph.materials.fitting import Model, Ranking, SpecimenTest, rank
from pneumorph.report.fit_files import unstable_text
from pneumorph.units import show

_SHORT = {"uniaxial": "uni", "equibiaxial": "equi", "planar": "planar"}


def busy(console: Console, text: str) -> AbstractContextManager[object]:
    """Show a text while something without a known length goes on; nothing where there is no terminal."""
    return console.status(text) if console.is_terminal else nullcontext()


def heading(tests: Sequence[SpecimenTest]) -> Iterator[str]:
    """Give a line for each test: what it is, how far it goes and what was done to it."""
    for test in tests:
        stretch = f"stretch {test.stretch.min():.4g} to {test.stretch.max():.4g}"
        stress = f"{show(float(test.stress.min()), 'stress')} to {show(float(test.stress.max()), 'stress')}"
        yield f"{test.mode}: {test.source}, {len(test.stretch)} points, {stretch}, {stress}"
        for note in test.notes:
            yield f"  {note}"


def fitted(console: Console, tests: Sequence[SpecimenTest], models: Sequence[Model], weights: str) -> Ranking:
    """Return the ranking of the laws, with a bar meanwhile where there is a terminal."""
    columns = (TextColumn("fitting"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"))
    with Progress(
        *columns, TimeElapsedColumn(), console=console, transient=True, disable=not console.is_terminal
    ) as bar:
        task = bar.add_task("", total=len(models))
        done = 0

        def listen(name: str) -> None:
            nonlocal done
            bar.update(task, completed=done, description=name)
            done += 1

        return rank(tests, models, weights, listen)


def print_ranking(console: Console, tests: Sequence[SpecimenTest], ranking: Ranking) -> None:
    """Print the laws, best first, never narrower than its numbers: a pipe of 80 columns must not cut constants."""
    table = ranking_table(tests, ranking)
    needed = Measurement.get(console, console.options.update(width=1000), table).maximum
    Console(file=console.file, highlight=False, width=max(console.width, needed)).print(table)


def ranking_table(tests: Sequence[SpecimenTest], ranking: Ranking) -> Table:
    """Return the laws, best first: constants, R² of all and of each test, largest errors, AICc, stability."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, title="Laws, best first", title_justify="left")
    several = len(tests) > 1
    for name in ("law", "constants", "R²", *(_SHORT[test.mode] for test in tests if several)):
        table.add_column(name, no_wrap=True, justify="right" if name not in ("law", "constants") else "left")
    for name in ("largest error", "relative", "ΔAICc", "stable"):
        table.add_column(name, no_wrap=True, justify="right" if name == "ΔAICc" else "left")
    least = ranking.fits[0].aicc
    for item in ranking.fits:
        error, relative = item.largest_error, item.largest_relative_error
        table.add_row(
            f"[bold]{item.model}[/bold]" if item is ranking.recommended else item.model,
            "\n".join(item.constants_shown()),
            f"{item.r2:.5f}",
            *(f"{value:.4f}" for value in item.r2_of if several),
            f"{show(error.value, 'stress', 3)} at {_SHORT[error.mode]} {error.stretch:.3g}",
            f"{100.0 * relative.value:.3g} % at {_SHORT[relative.mode]} {relative.stretch:.3g}",
            f"{item.aicc - least:.1f}",
            "yes" if item.stable else "in the fit" if not item.inside else "no",
        )
    return table


def findings(tests: Sequence[SpecimenTest], ranking: Ranking) -> Iterator[str]:
    """Give a line for each law that is unstable or was skipped, and for what the tests leave open."""
    for name, reason in ranking.skipped:
        yield f"skipped: {reason}" if reason.startswith(name) else f"skipped: {name}: {reason}"
    for item in ranking.fits:
        if item.inside:
            yield f"warning: {item.model} is unstable inside its fit: {unstable_text(item.inside)}"
        if item.outside:
            yield f"warning: {item.model} is unstable outside its fit: {unstable_text(item.outside)}"
    modes = {test.mode for test in tests}
    if len(modes) == 1:
        yield (
            f"warning: only {modes.pop()} data: what the laws say of the other tests is extrapolated, and laws with "
            "many constants go furthest astray"
        )
    if all(test.stretch.max() <= 1.0 for test in tests):
        yield "warning: only compression: what the laws say of tension is extrapolated"
    best = ranking.recommended
    yield f"recommended: {best.model}" + ("" if best is ranking.fits[0] else ", the best that is stable")
