"""Figures of the reduced soft wheel, as SVG: hinge laws, shapes, static tests, heights, and a roll."""

from __future__ import annotations

from math import ceil

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pneumorph.report import style
from pneumorph.report.rolling_figures import svg
from pneumorph.studies.reduced_wheel import ALLOWED, INFLATED, NEUTRAL, WEIGHT, ReducedWheel
from pneumorph.terrain.limb import chain

_KPA = 1e3


def laws_figure(result: ReducedWheel) -> bytes:
    """Return the moment over the angle of each hinge: the law as lines, the finite elements as points."""
    fitted, limb = result.fit.fitted, result.fit.limb
    count = len(limb.hinges)
    columns = min(3, count)
    rows = ceil(count / columns)
    levels = [p for p in np.unique(fitted.data.pressures) if np.sum(fitted.data.pressures == p) > 2]
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(3.6 * columns, 2.7 * rows + 0.4), layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False)
        for axes in grid.flat[count:]:
            axes.set_visible(False)
        for hinge, axes in enumerate(grid.flat[:count]):
            for number, pressure in enumerate(levels):
                colour = style.LINES[number % len(style.LINES)]
                chosen = fitted.data.pressures == pressure
                angles, moments = fitted.angles[chosen, hinge], fitted.moments[chosen, hinge]
                line = np.linspace(angles.min(), angles.max(), 50)
                law = limb.springs(pressure).moment(np.tile(line[:, None], count))[:, hinge]
                axes.plot(np.degrees(line), law, color=colour, linewidth=1.2, label=f"{_KPA * pressure:g} kPa")
                axes.plot(np.degrees(angles), moments, "o", color=colour, markersize=3.5)
            axes.set_title(f"hinge {hinge + 1}")
            axes.set_xlabel("angle [deg]")
            axes.set_ylabel("moment [N mm]")
        lines, labels = grid.flat[0].get_legend_handles_labels()
        figure.legend(lines, labels, loc="outside lower center", ncols=min(6, len(labels)))
        return svg(figure)


def shapes_figure(result: ReducedWheel) -> bytes:
    """Return the limb without force and under its largest tip forces, finite elements against chain, in its axes."""
    limb, parts = result.fit.limb, (result.fit.fitted, result.fit.held_out)
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(8.4, 3.9), layout="constrained")
        grid = figure.subplots(1, 2, sharex=True, sharey=True)
        for axes, loaded in zip(grid, (False, True), strict=True):
            for errors in parts:
                if errors is None:
                    continue
                data = errors.data
                sizes = np.linalg.norm(data.forces, axis=1)
                chosen = sizes >= 0.99 * sizes.max() if loaded else sizes < 1e-9
                for case in np.flatnonzero(chosen & (sizes > 0.0 if loaded else True)):
                    angles = limb.equilibrium(data.pressures[case], data.forces[case])
                    hinges, tip = chain(limb.links, angles)
                    axes.plot(*np.vstack([np.zeros(2), hinges, tip]).T, color=style.LINES[0], linewidth=1.0)
                    axes.plot(*data.points[case].T, "o", color=style.LINES[1], markersize=2.5)
                    axes.plot(*data.load_points[case], "s", color=style.LINES[1], markersize=3.5)
            axes.set_title("under the largest tip forces" if loaded else "without tip force")
            axes.set_aspect("equal")
            axes.set_xlabel("x [mm]")
        grid[0].set_ylabel("y [mm]")
        return svg(figure)


def static_figure(result: ReducedWheel) -> bytes:
    """Return the tip deflections of MuJoCo over those of the finite elements, with the allowed difference."""
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(4.6, 4.0), layout="constrained")
        axes = figure.subplots()
        top = 0.0
        for held_out, label, colour, mark in ((False, "fitted", 0, "o"), (True, "held out", 1, "s")):
            chosen = [test for test in result.tests if test.held_out is held_out]
            x = np.array([np.linalg.norm(test.finite_elements) for test in chosen])
            y = np.array([np.linalg.norm(test.multibody) for test in chosen])
            axes.plot(x, y, mark, color=style.LINES[colour], label=label, markersize=5)
            top = max([top, *x, *y])
        ends = np.array([0.0, 1.05 * top])
        axes.plot(ends, ends, color=style.MUTED, linewidth=0.8)
        axes.fill_between(
            ends,
            (1.0 - ALLOWED) * ends,
            (1.0 + ALLOWED) * ends,
            color=style.GRID,
            zorder=0,
            label=f"within {ALLOWED:.0%}",
        )
        axes.set_xlabel("finite elements [mm]")
        axes.set_ylabel("MuJoCo [mm]")
        axes.legend()
        return svg(figure)


def heights_figure(result: ReducedWheel) -> bytes:
    """Return the height of the unloaded wheel and that of its axle under the study's weight, over the pressure."""
    pressures = _KPA * result.pressures
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(5.2, 3.2), layout="constrained")
        axes = figure.subplots()
        axes.plot(pressures, result.heights, "o-", color=style.LINES[0], label="height of the wheel")
        axles = [stand.loaded + stand.overlap for stand in result.stands]
        axes.plot(pressures, axles, "o-", color=style.LINES[1], label=f"axle over the ground, {WEIGHT} N on one limb")
        axes.plot(pressures[[0, -1]], [NEUTRAL, INFLATED], "x", color=style.INK, label="study: neutral, inflated")
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel("pressure [kPa]")
        axes.set_ylabel("[mm]")
        axes.legend()
        return svg(figure)


def roll_figure(result: ReducedWheel) -> bytes:
    """Return pressure, height of the centre, bending of the limbs and way forward over the time of the roll."""
    roll = result.roll
    curves = (
        ("pressure [kPa]", _KPA * roll.pressure),
        ("height of the centre [mm]", roll.height),
        ("mean turn of the limbs' ends [deg]", np.degrees(roll.bending)),
        ("way forward [m]", 1e-3 * (roll.centre[:, 0] - roll.centre[0, 0])),
    )
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(8.4, 5.0), layout="constrained")
        axes: Axes
        for number, (axes, (label, values)) in enumerate(zip(figure.subplots(2, 2).flat, curves, strict=True)):
            axes.plot(roll.time, values, color=style.LINES[number])
            axes.set_title(label)
            axes.set_xlabel("time [s]")
        return svg(figure)
