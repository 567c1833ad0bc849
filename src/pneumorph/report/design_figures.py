"""Figures of an inverse search, as SVG: the lines that are wanted and found, and how the search converged."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pneumorph.report import style
from pneumorph.report.figure_file import figure_file

Array = NDArray[np.float64]

_LOOKS: dict[str, dict[str, Any]] = {
    "target": {"color": style.INK, "linewidth": 3.5, "alpha": 0.35},
    "surrogate": {"color": style.LINES[0], "linestyle": (0, (5, 3))},
    "full model": {"color": style.LINES[1], "marker": "o", "markersize": 3.0},
}


def lines_figure(lines: Mapping[str, Array], planar: bool) -> bytes:
    """Return centre lines (n, 3), mm, by name ('target', 'surrogate', 'full model') from the side, of space curves also
    from another side and from above.
    """
    views = [(0, 2)] if planar else [(0, 2), (1, 2), (0, 1)]
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(1.6 + 4.0 * len(views), 4.6), layout="constrained")
        for axes, (i, j) in zip(np.atleast_1d(figure.subplots(1, len(views))), views, strict=True):
            for name, points in lines.items():
                axes.plot(points[:, i], points[:, j], label=name, **_LOOKS[name])
            axes.set_aspect("equal", adjustable="datalim")
            axes.set_xlabel(f"{'xyz'[i]} [mm]")
            axes.set_ylabel(f"{'xyz'[j]} [mm]")
        figure.axes[0].legend(loc="best")
        return figure_file(figure)


def convergence_figure(trials: Array) -> bytes:
    """Return the deviation of every trial (n,) and the least so far, mm."""
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(6.4, 3.4), layout="constrained")
        axes = figure.subplots()
        number = np.arange(1, len(trials) + 1)
        axes.plot(number, trials, ".", color=style.GHOST, markersize=2.5, label="trial")
        axes.plot(number, np.minimum.accumulate(trials), color=style.LINES[0], label="least so far")
        axes.set_yscale("log")
        axes.set_xlabel("trial")
        axes.set_ylabel("root-mean-square deviation [mm]")
        axes.legend(loc="upper right")
        return figure_file(figure)
