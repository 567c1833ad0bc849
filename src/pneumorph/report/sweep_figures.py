"""Figures of a sweep: lines over one parameter, maps over two, parallel coordinates and scatter for any number."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation
from numpy.typing import NDArray

from pneumorph.report import style
from pneumorph.solution.history import TEXT
from pneumorph.studies.sweeps import SweepTable
from pneumorph.units import printed_unit, to_printed

Array = NDArray[np.float64]
MOST = 12  # results that get figures of their own
_AXES = 8  # results beside the parameters in parallel coordinates
_WRITTEN = 100  # cells of a map, up to which their values are written into them
_MAP = "YlGnBu"


@dataclass(frozen=True)
class SweepFigure:
    """name: of the file, without its ending; caption: below it; svg: its content."""

    name: str
    caption: str
    svg: bytes


@dataclass(frozen=True)
class _Axis:
    """A column as it is drawn.

    values: (designs,) in printed units, or numbers of the words; words: of a text column.
    """

    label: str
    values: Array
    words: tuple[str, ...] = ()

    @property
    def known(self) -> Array:
        """Distinct finite values, rising."""
        return np.unique(self.values[np.isfinite(self.values)])

    def ticks(self, axes: Any) -> None:
        """Write the words of a text column at an axis of matplotlib."""
        if self.words:
            axes.set_ticks(range(len(self.words)), labels=self.words)
            axes.set_view_interval(-0.5, len(self.words) - 0.5, ignore=True)


def sweep_figures(table: SweepTable) -> list[SweepFigure]:
    """Return the figures of a sweep whose parameters and results are not all the same.

    One parameter that varies: each result over it. Two: a map of each result, by cells where the designs are a full
    grid, else by contours between them. More: each result over each parameter. From two on, parallel coordinates too.
    """
    varied = [key for key in table.parameters if table.varies(key)]
    results = [key for key in table.results if table.varies(key)]
    if not varied or not results:
        return []
    over = [_axis(table, key) for key in varied]
    figures = []
    if len(varied) > 1:
        shown = [_axis(table, key) for key in results[:_AXES]]
        caption = f"Every line is a design, coloured by its {shown[0].label}; grey where it has none."
        figures.append(SweepFigure("parallel", caption, _drawn(_parallel, over, shown)))
    draw: Callable[..., Figure] = {1: _lines, 2: _map}.get(len(varied), _scatter)
    for key in results[:MOST]:
        result = _axis(table, key)
        caption = f"{result.label} over {', '.join(axis.label for axis in over)}"
        name = "".join(letter if letter.isalnum() else "_" for letter in key)
        figures.append(SweepFigure(name, caption, _drawn(draw, over, result)))
    return figures


def _axis(table: SweepTable, key: str) -> _Axis:
    column, values = table.rows.column(key), table.values(key)
    if column.kind == TEXT:
        words = tuple(dict.fromkeys(values.tolist()))
        return _Axis(column.label, np.array([words.index(word) for word in values], dtype=np.float64), words)
    unit = printed_unit(column.kind)
    return _Axis(f"{column.label} [{unit}]" if unit else column.label, values * to_printed(1.0, column.kind))


def _drawn(draw: Callable[..., Figure], *arguments: Any) -> bytes:
    """Return a figure as SVG, with the look that all figures share, whatever the caller's settings."""
    with matplotlib.rc_context(style.RC):
        buffer = io.BytesIO()
        FigureCanvasSVG(draw(*arguments)).print_svg(buffer, metadata={"Date": None})
    return buffer.getvalue()


def _lines(over: Sequence[_Axis], result: _Axis) -> Figure:
    figure = Figure(figsize=(5.6, 4.0), layout="constrained")
    axes = figure.subplots()
    order = np.argsort(over[0].values, kind="stable")
    order = order[np.isfinite(result.values[order])]
    axes.plot(over[0].values[order], result.values[order], "o" if over[0].words else "-o", color=style.LINES[0])
    over[0].ticks(axes.xaxis)
    axes.set_xlabel(over[0].label)
    axes.set_ylabel(result.label)
    return figure


def _map(over: Sequence[_Axis], result: _Axis) -> Figure:
    across, up = over
    figure = Figure(figsize=(5.6, 4.2), layout="constrained")
    axes = figure.subplots()
    known = np.isfinite(result.values)
    cells = _cells(across, up, result)
    mesh: ScalarMappable
    if cells is not None:
        mesh = axes.pcolormesh(cells, cmap=_MAP, edgecolors="white", linewidth=1.0)
        for axis, place in ((across, axes.xaxis), (up, axes.yaxis)):
            words = axis.words or tuple(f"{value:.4g}" for value in axis.known)
            place.set_ticks(np.arange(len(words)) + 0.5, labels=words)
        if cells.size <= _WRITTEN:
            _write(axes, cells)
        axes.grid(False)
    elif known.sum() >= 4 and not across.words and not up.words and _spread(across.values[known], up.values[known]):
        # triangles of equal scale: units must not decide which designs are neighbours
        x, y = across.values[known], up.values[known]
        triangles = Triangulation(_scaled(x), _scaled(y)).triangles
        mesh = axes.tricontourf(Triangulation(x, y, triangles), result.values[known], levels=10, cmap=_MAP)
        axes.plot(x, y, "o", color=style.INK, markersize=3.0)
    else:
        mesh = axes.scatter(across.values[known], up.values[known], c=result.values[known], cmap=_MAP, edgecolors="k")
        across.ticks(axes.xaxis)
        up.ticks(axes.yaxis)
    figure.colorbar(mesh, ax=axes, label=result.label)
    axes.set_xlabel(across.label)
    axes.set_ylabel(up.label)
    return figure


def _cells(across: _Axis, up: _Axis, result: _Axis) -> np.ma.MaskedArray | None:
    """Return the result (ny, nx) on a full grid of designs, None where the designs are none."""
    x, y = across.known, up.known
    pairs = set(zip(across.values.tolist(), up.values.tolist(), strict=True))
    if len(pairs) < len(x) * len(y) or len(x) < 2 or len(y) < 2:
        return None
    cells = np.full((len(y), len(x)), np.nan)
    cells[np.searchsorted(y, up.values), np.searchsorted(x, across.values)] = result.values
    return np.ma.masked_invalid(cells)


def _write(axes: Axes, cells: np.ma.MaskedArray) -> None:
    """Write each value into its cell, white on the dark ones."""
    low, high = float(cells.min()), float(cells.max())
    for (row, column), value in np.ndenumerate(cells.filled(np.nan)):
        dark = (value - low) > 0.6 * (high - low)
        text = f"{value:.3g}" if np.isfinite(value) else "–"
        axes.text(column + 0.5, row + 0.5, text, ha="center", va="center", color="white" if dark else style.INK)


def _spread(x: Array, y: Array) -> bool:
    """Return whether points span an area, as contours need."""
    points = np.column_stack([_scaled(x), _scaled(y)])
    return bool(np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-6) == 2)


def _scaled(values: Array) -> Array:
    width = float(np.ptp(values))
    return (values - values.min()) / width if width > 0.0 else np.zeros_like(values)


def _scatter(over: Sequence[_Axis], result: _Axis) -> Figure:
    figure = Figure(figsize=(1.2 + 2.6 * len(over), 3.4), layout="constrained")
    panels = figure.subplots(1, len(over), sharey=True, squeeze=False)[0]
    for axes, axis in zip(panels, over, strict=True):
        axes.plot(axis.values, result.values, "o", color=style.LINES[0], alpha=0.7)
        axis.ticks(axes.xaxis)
        axes.set_xlabel(axis.label)
    panels[0].set_ylabel(result.label)
    return figure


def _parallel(over: Sequence[_Axis], results: Sequence[_Axis]) -> Figure:
    every = [*over, *results]
    figure = Figure(figsize=(2.0 + 1.35 * len(every), 4.4), layout="constrained")
    axes = figure.subplots()
    colour = results[0].values
    scale = Normalize(float(np.nanmin(colour)), float(np.nanmax(colour)))
    shades = style.colour_map_of(_MAP)
    lines = np.column_stack([_share(axis) for axis in every])
    for line, value in zip(lines, colour, strict=True):
        known = bool(np.isfinite(value))
        axes.plot(line, color=shades(scale(value)) if known else "#b8c0c9", linewidth=1.4, zorder=3 if known else 2)
    for place, axis in enumerate(every):
        axes.axvline(place, color=style.MUTED, linewidth=0.9, zorder=4)
        if axis.words:
            marks = [(share, word) for share, word in zip(_share_of_words(axis), axis.words, strict=True)]
        else:
            marks = [(0.0, f"{axis.known[0]:.4g}"), (1.0, f"{axis.known[-1]:.4g}")]
        for height, text in marks:
            box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8}
            axes.text(place, height, text, fontsize=8.5, ha="center", va="center", bbox=box, zorder=5)
    labels = [axis.label.replace(" [", "\n[") for axis in every]
    axes.set_xticks(range(len(every)), labels=labels)
    axes.set_yticks([])
    axes.set_ylim(-0.06, 1.06)
    axes.spines["left"].set_visible(False)
    axes.grid(False)
    figure.colorbar(ScalarMappable(scale, shades), ax=axes, label=results[0].label)
    return figure


def _share(axis: _Axis) -> Array:
    """Return values as shares of their range, 0 to 1."""
    low, high = float(axis.known[0]), float(axis.known[-1])
    return (axis.values - low) / (high - low)


def _share_of_words(axis: _Axis) -> Array:
    return np.linspace(0.0, 1.0, len(axis.words))
