"""Curves: any columns of the history against another, with reported data, as SVG."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.report import style
from pneumorph.solution import History
from pneumorph.studies.comparison import Profile, ReportedCurve
from pneumorph.units import printed_unit, to_printed

Array = NDArray[np.float64]

_MARKS = ("s", "D", "^", "v", "P", "X")
_DASHES = ((5, 2), (1.5, 1.5), (6, 2, 1.5, 2), (9, 3))


P = ParamSpec("P")


def styled(draw: Callable[P, bytes]) -> Callable[P, bytes]:
    """Let a function draw with the look that all figures share, whatever the caller's settings."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> bytes:
        with matplotlib.rc_context(style.RC):
            return draw(*args, **kwargs)

    return drawn


@dataclass(frozen=True)
class Curve:
    """A figure: columns `y` of the history over the column `x`; reported curves on the same columns are added.

    Raises InputError for columns of different kinds on one axis.
    """

    title: str
    x: str
    y: tuple[str, ...]

    def __post_init__(self) -> None:
        if isinstance(self.y, str) or not self.y:
            raise InputError(f"curve '{self.title}': y = {self.y!r}, expected a tuple of column keys")


@styled
def curve_figure(history: History, curve: Curve, reported: Sequence[ReportedCurve] = ()) -> bytes:
    """Return the figure of a curve; raises NameNotFoundError for a column that the history does not have."""
    columns = [history.column(key) for key in curve.y]
    across = history.column(curve.x)
    if len({column.kind for column in columns}) > 1:
        kinds = ", ".join(f"{column.key} ({column.kind})" for column in columns)
        raise InputError(f"curve '{curve.title}': columns of different kinds on one axis: {kinds}")
    figure, (axes,) = new_figure(curve.title)
    x = printed(history.values(curve.x), across.kind)
    for number, column in enumerate(columns):
        y = printed(history.values(column.key), column.kind)
        label = f"computed: {column.label}" if reported or len(columns) > 1 else column.label
        axes.plot(x, y, "-o", color=style.LINES[number % len(style.LINES)], label=label, markersize=3.6, zorder=4)
    computed = (axes.get_xlim(), axes.get_ylim())
    used = len(columns)
    for number, other in enumerate(reported):
        colour = style.LINES[(used + number) % len(style.LINES)]
        place = printed(other.x_values, across.kind), printed(other.y_values, columns[0].kind)
        if other.marks:
            axes.plot(*place, _MARKS[number % len(_MARKS)], color=colour, label=other.label, markersize=6, zorder=5)
        else:
            axes.plot(*place, color=colour, label=other.label, dashes=_DASHES[number % len(_DASHES)], zorder=3)
    if reported:
        _keep_in_sight(axes, computed)
    axes.set_xlabel(named(across.label, across.kind))
    axes.set_ylabel(named(columns[0].label if len(columns) == 1 else _common(columns[0].kind), columns[0].kind))
    if reported or len(columns) > 1:
        longest = max(len(str(text)) for text in axes.get_legend_handles_labels()[1])
        figure.legend(loc="outside lower center", ncols=1 if longest > 34 else 2)
    return svg(figure)


@styled
def profile_figure(profile: Profile) -> bytes:
    """Return the figure of a profile."""
    figure, (axes,) = new_figure(profile.title)
    for number, item in enumerate(profile.series):
        look: dict[str, Any] = {"color": style.LINES[number % len(style.LINES)], "label": item.label}
        if item.marks:
            axes.plot(item.x, item.y, _MARKS[number % len(_MARKS)], markersize=6, zorder=5, **look)
        else:
            axes.plot(item.x, item.y, "-o" if len(item.x) < 40 else "-", markersize=3.6, zorder=4, **look)
    axes.set_xlabel(profile.x)
    axes.set_ylabel(profile.y)
    if len(profile.series) > 1:
        figure.legend(loc="outside lower center", ncols=1)
    return svg(figure)


@styled
def energy_figure(history: History) -> bytes:
    """Return energies and works over the time of the programme, with the error of their balance below."""
    figure, (axes, below) = new_figure("Energy check", 2.2, 1.0)
    by_clock = "clock" in history.keys
    time = history.values("clock" if by_clock else "time")
    work = history.values("supply_work") + history.values("load_work")
    stored = history.kept_energy
    lines = [("work of supplies and loads", work, "-", 2.6, style.LINES[4])]
    lines += [("stored and lost", stored, "--", 1.6, style.LINES[0])]
    if "kinetic_energy" in history.keys:
        lines.append(("kinetic energy", history.values("kinetic_energy"), "-", 1.4, style.LINES[5]))
    parts = (("supply_work", "work of the supplies", style.LINES[2]), ("load_work", "work of loads", style.LINES[3]))
    for key, label, colour in (*parts, ("viscous_loss", "lost in viscosity", style.LINES[1])):
        values = history.values(key)
        if np.abs(values).max(initial=0.0) > 1e-9 * np.abs(work).max(initial=0.0) and not np.array_equal(values, work):
            lines.append((label, values, ":", 1.4, colour))
    for label, values, dash, width, colour in lines:
        axes.plot(time, printed(values, "energy"), dash, color=colour, label=label, linewidth=width)
    axes.set_ylabel(named("energy", "energy"))
    figure.legend(loc="outside lower center", ncols=2)
    below.plot(time, 100.0 * history.values("energy_error"), "-o", color=style.LINES[0], markersize=3)
    below.axhline(0.0, color=style.MUTED, linewidth=0.8)
    below.set_ylabel("error [%]")
    below.set_xlabel("time [s]" if by_clock else "time of the programme [phases]")
    return svg(figure)


@styled
def convergence_figure(history: History) -> bytes:
    """Return Newton iterations of each increment and the size of the increments."""
    figure, (axes, below) = new_figure("Convergence", 2.2, 1.0)
    index = history.values("index")[1:]
    axes.bar(index, history.values("iterations")[1:], color=style.LINES[0], width=0.75)
    axes.set_ylabel("Newton iterations")
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    below.plot(index, np.diff(history.values("time")), "-o", color=style.LINES[1], markersize=3)
    below.set_yscale("log")
    below.set_ylabel("increment\n[phases]")
    below.set_xlabel("state")
    below.xaxis.set_major_locator(MaxNLocator(integer=True))
    return svg(figure)


@styled
def stability_figure(history: History) -> bytes:
    """Return the unstable modes and the smallest det F of each state."""
    figure, (axes, below) = new_figure("Stability", 2.2, 1.0)
    index = history.values("index")
    axes.step(index, history.values("unstable_modes"), where="mid", color=style.LINES[1])
    axes.set_ylabel("unstable modes")
    axes.set_ylim(-0.1, max(1.0, 1.1 * float(np.nan_to_num(history.values("unstable_modes")).max())))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    below.plot(index, history.values("smallest_volume_ratio"), "-o", color=style.LINES[0], markersize=3)
    below.set_ylabel("smallest\ndet F")
    below.set_xlabel("state")
    below.xaxis.set_major_locator(MaxNLocator(integer=True))
    return svg(figure)


def new_figure(title: str, *heights: float) -> tuple[Figure, list[Axes]]:
    """Return a figure with axes below each other, of these relative heights (default: one)."""
    figure = Figure(figsize=(5.6, 4.0), layout="constrained")
    grid = figure.subplots(max(1, len(heights)), 1, sharex=True, squeeze=False, height_ratios=heights or None)
    axes = list(grid[:, 0])
    axes[0].set_title(title)
    return figure, axes


def svg(figure: Figure) -> bytes:
    """Return a figure as SVG."""
    buffer = io.BytesIO()
    FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None})
    return buffer.getvalue()


def _keep_in_sight(axes: Axes, computed: tuple[tuple[float, float], tuple[float, float]]) -> None:
    """Limit the axes to three times the computed range: a reported curve far off must not flatten the computed one."""
    (left, right), (low, high) = computed
    (least, most), (lowest, highest) = axes.get_xlim(), axes.get_ylim()
    axes.set_xlim(max(least, 2.0 * left - right), min(most, 3.0 * right - 2.0 * left))
    axes.set_ylim(max(lowest, 2.0 * low - high), min(highest, 3.0 * high - 2.0 * low))


def printed(values: Array, kind: str) -> Array:
    """Return inside values in the printed unit of their kind."""
    return values * to_printed(1.0, kind)


def named(label: str, kind: str) -> str:
    """Return a label with the printed unit of a kind."""
    unit = printed_unit(kind)
    return f"{label} [{unit}]" if unit else label


def _common(kind: str) -> str:
    return {"number": "value", "angle": "angle", "length": "length"}.get(kind, kind)
