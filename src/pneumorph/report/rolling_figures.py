"""Figures of a sweep over rigid terrain, as SVG: the table of distances, distance over time, and ways on the map."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from math import ceil
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pneumorph.report import style
from pneumorph.studies.rolling import Cell
from pneumorph.terrain import HeightField

Array = NDArray[np.float64]
Ways = Mapping[str, Mapping[str, Array]]  # wheel -> arrays of a trajectory

_METRE = 1e-3
_MARGIN = 1.0  # m of map around the ways


def distance_figure(table: Mapping[str, Mapping[str, Cell]], terrains: Sequence[str]) -> bytes:
    """Return the mean distance (m) of each wheel on each terrain as coloured cells; '×' where nothing was computed."""
    means = [[table[w][t].mean if t in table[w] else None for t in terrains] for w in table]
    values = np.array([[np.nan if value is None else value for value in row] for row in means], dtype=float)
    top = float(np.nanmax(values)) if np.isfinite(values).any() else 1.0
    with matplotlib.rc_context(style.RC | {"axes.grid": False}):
        figure = Figure(figsize=(1.8 + 1.15 * len(terrains), 0.9 + 0.36 * len(table)), layout="constrained")
        axes = figure.subplots()
        shown = axes.imshow(values, cmap=style.colour_map_of("YlGnBu"), vmin=0.0, vmax=top, aspect="auto")
        for (row, column), value in np.ndenumerate(values):
            dark = np.isfinite(value) and value > 0.6 * top
            axes.text(
                column, row, f"{value:.2f}" if np.isfinite(value) else "×", ha="center", va="center",
                color="white" if dark else style.INK,
            )  # fmt: skip
        axes.set_xticks(range(len(terrains)), terrains)
        axes.set_yticks(range(len(table)), list(table))
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        axes.set_title("Mean distance [m]")
        figure.colorbar(shown, ax=axes, shrink=0.8).outline.set_linewidth(0.6)
        return svg(figure)


def progress_figure(ways: Mapping[str, Ways], limits: Sequence[float]) -> bytes:
    """Return the way forward over time on each terrain (terrain -> wheel -> arrays); limits: lines across, m."""

    def draw(axes: Axes, terrain: str) -> None:
        for wheel, way in ways[terrain].items():
            forward = (way["centre"][:, 0] - way["centre"][0, 0]) * _METRE
            axes.plot(way["time"], forward, label=wheel, **_look(wheel))
        for limit in limits:
            axes.axhline(limit, color=style.MUTED, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("forward [m]")

    return _panels(list(ways), draw, 3.0)


def map_figure(ways: Mapping[str, Ways], grounds: Mapping[str, HeightField]) -> bytes:
    """Return the ways seen from above on the shaded relief of each terrain; a ring marks the start."""

    windows = {name: _window(wheels) for name, wheels in ways.items()}
    half = np.max([(high - low) / 2.0 for low, high in windows.values()], axis=0)  # one scale and shape for all

    def draw(axes: Axes, terrain: str) -> None:
        _shade(axes, grounds[terrain])
        for wheel, way in ways[terrain].items():
            axes.plot(way["centre"][:, 0] * _METRE, way["centre"][:, 1] * _METRE, label=wheel, **_look(wheel))
        start = next(iter(ways[terrain].values()))["centre"][0] * _METRE
        axes.plot(start[0], start[1], "o", color=style.INK, markerfacecolor="none", markersize=7)
        middle = (windows[terrain][0] + windows[terrain][1]) / 2.0
        axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
        axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")

    return _panels(list(ways), draw, 4.6 * half[1] / half[0] + 0.8)


def _window(ways: Ways) -> tuple[Array, Array]:
    """Return the lower and the upper corner, m, of the map around the ways."""
    places = np.concatenate([way["centre"][:, :2] for way in ways.values()]) * _METRE
    return places.min(axis=0) - _MARGIN, places.max(axis=0) + _MARGIN


def _shade(axes: Axes, ground: HeightField) -> None:
    """Draw the relief in grey, lit from the upper left; level ground is alike on all terrains."""
    cells = (ground.width / (ground.heights.shape[0] - 1), ground.length / (ground.heights.shape[1] - 1))
    along_y, along_x = np.gradient(ground.heights, *cells)
    ends = (0.5 * ground.length * _METRE, 0.5 * ground.width * _METRE)
    axes.imshow(
        np.clip(0.86 + 0.3 * (along_x - along_y), 0.6, 1.0), cmap="gray", vmin=0.0, vmax=1.0, origin="lower",
        interpolation="bilinear", extent=(-ends[0], ends[0], -ends[1], ends[1]), zorder=0,
    )  # fmt: skip


def _panels(names: Sequence[str], draw: Callable[[Axes, str], None], height: float) -> bytes:
    columns = min(2, len(names))
    rows = ceil(len(names) / columns)
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(5.2 * columns, height * rows + 0.5), layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat[len(names) :]:
            axes.set_visible(False)
        for axes, name in zip(grid.flat, names, strict=False):
            draw(axes, name)
            axes.set_title(name)
        lines, labels = grid.flat[0].get_legend_handles_labels()
        figure.legend(lines, labels, loc="outside lower center", ncols=5)
        return svg(figure)


def _look(wheel: str) -> dict[str, Any]:
    """Return a colour by the number of paddles; curved ones are dashed."""
    if wheel == "plain":
        return {"color": style.LINES[6], "linestyle": ":"}
    colour = style.LINES[int(wheel.rpartition("-")[2]) - 1]
    return {"color": colour, "linestyle": "--" if wheel.startswith("curved") else "-", "linewidth": 1.5}


def svg(figure: Figure) -> bytes:
    """Return a figure as SVG, the same bytes for the same figure."""
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", metadata={"Date": None}, dpi=120)
    return stream.getvalue()
