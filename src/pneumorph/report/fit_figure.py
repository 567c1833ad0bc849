"""The figure of a fit: one panel for each kind of test, its points and the curves of the laws."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pneumorph.materials.fitting import Fit, SpecimenTest
from pneumorph.materials.fitting.specimen import nominal_stress
from pneumorph.materials.tension import MODES
from pneumorph.report import style
from pneumorph.report.figure_file import check_form, figure_file

# laws drawn in colour; the others are grey lines behind them
_IN_COLOUR = 4
_DASHES: tuple[tuple[float, ...], ...] = ((), (6.0, 2.0), (2.0, 1.6), (7.0, 2.0, 1.6, 2.0))
_MARKS = ("o", "s", "^", "D", "v", "P")
_CURVE_POINTS = 200
_MEASURED, _OTHERS = "measured", "other laws"


def fit_figure(tests: Sequence[SpecimenTest], fits: Sequence[Fit], form: str = "svg") -> bytes:
    """Return the figure of fits, best first, to tests as an SVG or PNG file.

    form: "svg" or "png"; raises InputError for another one.
    """
    check_form(form)
    modes = [mode for mode in MODES if any(test.mode == mode for test in tests)]
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(1.2 + 3.1 * len(modes), 4.3), layout="constrained")
        panels = figure.subplots(1, len(modes), squeeze=False)[0]
        for axes, mode in zip(panels, modes, strict=True):
            _panel(axes, mode, [test for test in tests if test.mode == mode], fits)
        panels[0].set_ylabel("nominal stress [MPa]")
        shown = {
            label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
        }
        # points first, then the laws from the best on, the grey ones last
        labels = [label for label in shown if label.startswith(_MEASURED)]
        labels += [label for label in (*map(_label, fits[:_IN_COLOUR]), _OTHERS) if label in shown]
        figure.legend(
            [shown[label] for label in labels], labels, loc="outside lower center", ncols=min(3, 1 + len(modes))
        )
        return figure_file(figure, form)


def _label(fit: Fit) -> str:
    return f"{fit.model}, R² = {fit.r2:.4f}"


def _panel(axes: Axes, mode: str, tests: Sequence[SpecimenTest], fits: Sequence[Fit]) -> None:
    low = min(1.0, *(float(test.stretch.min()) for test in tests))
    high = max(1.0, *(float(test.stretch.max()) for test in tests))
    stretch = np.linspace(low, high, _CURVE_POINTS)
    for number, fit in reversed(list(enumerate(fits))):
        curve = nominal_stress(fit.material, mode, stretch)
        if number < _IN_COLOUR:
            axes.plot(
                stretch, curve, color=style.LINES[number], dashes=_DASHES[number], label=_label(fit), linewidth=1.7,
                zorder=4 - 0.1 * number,
            )  # fmt: skip
        else:
            axes.plot(stretch, curve, color="#b8c0c9", linewidth=0.8, label=_OTHERS, zorder=2)
    for number, test in enumerate(tests):
        name = _MEASURED if len(tests) == 1 else f"{_MEASURED}, {number + 1}"
        axes.plot(
            test.stretch, test.stress, _MARKS[number % len(_MARKS)], color=style.INK, markerfacecolor="white",
            markeredgewidth=1.1, markersize=5.0 if len(test.stretch) < 60 else 3.0, label=name, zorder=6,
        )  # fmt: skip
    stresses = np.concatenate([[0.0], *(test.stress for test in tests)])
    room = 0.06 * float(np.ptp(stresses))
    axes.set_ylim(float(stresses.min()) - (room if stresses.min() < 0.0 else 0.0), float(stresses.max()) + room)
    axes.set_xlim(low - (0.02 * (high - low) if low < 1.0 else 0.0), high + 0.03 * (high - low))
    axes.set_title(mode)
    axes.set_xlabel("stretch [-]")
