"""Tension tests of flat sheets: force and lateral strain against strain."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib
from matplotlib.figure import Figure

from pneumorph.errors import InputError
from pneumorph.homogenisation import TensionTest
from pneumorph.report import style
from pneumorph.report.figure_file import check_form, figure_file


def tension_figure(tests: Mapping[str, TensionTest], form: str = "svg") -> bytes:
    """Return the picture of some tests, name -> test, as an SVG or PNG file; raises InputError for another form."""
    check_form(form)
    if not tests:
        raise InputError("tension figure: no tests, expected at least one")
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(7.2, 3.0), layout="constrained")
        force, lateral = figure.subplots(1, 2)
        for name, test in tests.items():
            force.plot(100.0 * test.strain, test.force, label=name)
            lateral.plot(100.0 * test.strain, 100.0 * test.lateral, label=name)
        lateral.axhline(0.0, color=style.EDGE, linewidth=0.5)
        for axes, label in ((force, "force per width [N/mm]"), (lateral, "lateral strain [%]")):
            axes.set_xlabel("strain [%]")
            axes.set_ylabel(label)
        force.legend(frameon=False)
        return figure_file(figure, form)
