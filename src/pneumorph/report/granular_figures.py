"""Figures of a sweep over beds of grains, as SVG: distances and ride heights, ways over time, and energies."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pneumorph.report import style
from pneumorph.studies.granular import Means

Array = NDArray[np.float64]
_METRE, _JOULE = 1e-3, 1e-3


def bar_figure(
    table: Mapping[str, Mapping[str, Means]],
    sands: Sequence[str],
    reported: Mapping[str, Mapping[str, float]],
) -> bytes:
    """Return distance (m) and ride height (mm) of each wheel on each sand; dots are single beds.

    reported: 'distance' and 'ride height' -> wheel -> mean over the sands that the study reports, drawn as lines.
    """
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(10.4, 3.6), layout="constrained")
        for axes, (key, unit) in zip(figure.subplots(1, 2), (("distance", "m"), ("ride height", "mm")), strict=True):
            for i, (wheel, cells) in enumerate(table.items()):
                values = [cells.get(sand, Means()) for sand in sands]
                points = [v.distances if key == "distance" else v.ride_heights for v in values]
                middle = [float(np.mean(p)) if p else 0.0 for p in points]
                at = np.arange(len(sands)) + 0.27 * (i - 0.5 * (len(table) - 1))
                axes.bar(at, middle, 0.25, color=style.LINES[i], label=wheel)
                for x, many in zip(at, points, strict=True):
                    if len(many) > 1:
                        axes.plot([x] * len(many), many, ".", color=style.INK, markersize=4)
                if wheel in reported.get(key, {}):
                    axes.axhline(reported[key][wheel], color=style.LINES[i], linewidth=0.9, linestyle=(0, (4, 3)))
            axes.set_xticks(range(len(sands)), [sand.replace("-", "-\n") for sand in sands])
            axes.set_title(f"{key.capitalize()} [{unit}]")
            axes.grid(axis="x", visible=False)
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
        return _svg(figure)


def way_figure(ways: Mapping[str, Mapping[str, Mapping[str, Array]]]) -> bytes:
    """Return forward way (m) and height of the axles over the bed (mm) over time: sand -> wheel -> arrays."""
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(2.7 * len(ways) + 0.6, 4.6), layout="constrained")
        grid = figure.subplots(2, len(ways), squeeze=False, sharex=True, sharey="row")
        for column, (sand, wheels) in enumerate(ways.items()):
            for i, (wheel, way) in enumerate(wheels.items()):
                centre = way["centre"]
                grid[0, column].plot(
                    way["time"], (centre[:, 0] - centre[0, 0]) * _METRE, color=style.LINES[i], label=wheel
                )
                grid[1, column].plot(way["time"], centre[:, 2] - float(way["level"]), color=style.LINES[i])
            grid[0, column].set_title(sand)
            grid[1, column].set_xlabel("time [s]")
        grid[0, 0].set_ylabel("forward [m]")
        grid[1, 0].set_ylabel("axles over the bed [mm]")
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
        return _svg(figure)


def energy_figure(way: Mapping[str, Array]) -> bytes:
    """Return where the motors' work of one run went, J, over time."""
    parts = (
        ("vehicle", way["vehicle"]),
        ("lost between wheels and grains", way["to_grains"] - way["on_grains"]),
        ("lost between grains", way["on_grains"] - way["grains_kinetic"] - way["grains_potential"]),
        ("grains lifted", way["grains_potential"]),
        ("grains moving", way["grains_kinetic"]),
    )
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(6.4, 3.4), layout="constrained")
        axes = figure.subplots()
        axes.plot(way["time"], way["motor"] * _JOULE, color=style.INK, linewidth=2.4, label="motors' work")
        for i, (name, values) in enumerate(parts):
            axes.plot(way["time"], values * _JOULE, color=style.LINES[i], label=name)
        total = np.sum([values for _, values in parts], axis=0)
        axes.plot(way["time"], total * _JOULE, color=style.MUTED, linestyle=(0, (3, 2)), label="sum of the parts")
        axes.set_xlabel("time [s]")
        axes.set_ylabel("energy [J]")
        axes.legend(loc="upper left")
        return _svg(figure)


def _svg(figure: Figure) -> bytes:
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", metadata={"Date": None}, dpi=120)
    return stream.getvalue()
