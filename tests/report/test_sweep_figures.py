"""Figures and the page of a sweep, from tables that are made up."""

import itertools
import math

import numpy as np
import pytest

from pneumorph.report import sweep_figures as module
from pneumorph.report.sweep_figures import sweep_figures
from pneumorph.report.sweep_report import write_sweep_report
from pneumorph.solution.history import Column, History
from pneumorph.studies.sweeps import SweepTable, run_sweep, sweep_from
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.studies.sweeps.compute import Record

KINDS = {"wall": "length", "mu": "stress", "count": "number", "material": "text", "kappa": "curvature", "p": "pressure"}


def table(parameters, results, rows):
    columns = [Column(key, key, KINDS[key]) for key in (*parameters, *results)]
    return SweepTable(tuple(parameters), tuple(results), History(columns, rows))


def grid(**values):
    return [dict(zip(values, line, strict=True)) for line in itertools.product(*values.values())]


@pytest.fixture
def drawn(monkeypatch):
    """Collect the figures as matplotlib's."""
    seen = []
    monkeypatch.setattr(module, "_drawn", lambda draw, *arguments: seen.append(draw(*arguments)) or b"")
    return seen


def test_one_parameter_gives_a_line_in_printed_units(drawn):
    rows = [{"wall": wall, "p": 0.01 * wall} for wall in (3.0, 1.0, 2.0)]
    (figure,) = sweep_figures(table(["wall"], ["p"], rows))
    (axes,) = drawn[0].axes
    assert figure.name == "p"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("wall [mm]", "p [kPa]")
    np.testing.assert_allclose(axes.lines[0].get_xydata(), [[1.0, 10.0], [2.0, 20.0], [3.0, 30.0]])


def test_a_full_grid_of_two_parameters_gives_cells_with_their_values(drawn):
    rows = [row | {"kappa": row["wall"] + 10.0 * row["count"]} for row in grid(wall=[1.0, 2.0, 3.0], count=[5, 7])]
    rows[2]["kappa"] = math.nan  # wall 2, count 5
    figures = sweep_figures(table(["wall", "count"], ["kappa"], rows))
    assert [figure.name for figure in figures] == ["parallel", "kappa"]
    axes = drawn[1].axes[0]
    assert [text.get_text() for text in axes.texts] == ["51", "–", "53", "71", "72", "73"]
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["1", "2", "3"]
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["5", "7"]


def test_samples_of_two_parameters_give_contours_unless_they_lie_on_a_line(drawn):
    shares = np.random.default_rng(1).random((12, 2))
    rows = [{"wall": 1.0 + a, "mu": 0.1 * b, "kappa": a * b} for a, b in shares]
    sweep_figures(table(["wall", "mu"], ["kappa"], rows))
    assert len(drawn[1].axes[0].lines[0].get_xdata()) == 12
    assert [type(item).__name__ for item in drawn[1].axes[0].collections] == ["TriContourSet"]
    rows = [{"wall": 1.0 + a, "mu": 0.1 * a, "kappa": b} for a, b in shares]
    sweep_figures(table(["wall", "mu"], ["kappa"], rows))
    assert [type(item).__name__ for item in drawn[3].axes[0].collections] == ["PathCollection"]


def test_parallel_coordinates_draw_every_design_and_name_the_words_of_a_text(drawn):
    rows = [r | {"kappa": r["wall"] if r["material"] == "soft" else math.nan, "p": r["count"]} for r in grid(
        material=["soft", "hard"], wall=[1.0, 2.0], count=[3, 5])]  # fmt: skip
    figures = sweep_figures(table(["material", "wall", "count"], ["kappa", "p"], rows))
    assert [figure.name for figure in figures] == ["parallel", "kappa", "p"]
    axes = drawn[0].axes[0]
    designs = [line for line in axes.lines if len(line.get_ydata()) == 5]
    assert len(designs) == 8
    assert sum(line.get_color() == "#b8c0c9" for line in designs) == 4
    assert {"soft", "hard", "1", "2", "3", "5"} <= {text.get_text() for text in axes.texts}
    assert len(drawn[1].axes) == 3
    assert [tick.get_text() for tick in drawn[1].axes[0].get_xticklabels()] == ["soft", "hard"]


def test_what_does_not_vary_gives_no_figure():
    assert sweep_figures(table(["wall"], ["p"], [{"wall": 1.0, "p": 1.0}])) == []
    assert sweep_figures(table(["wall"], ["p"], [{"wall": w, "p": math.nan} for w in (1.0, 2.0)])) == []


class Quick(Workers):
    def compute(self, function, calls):
        columns = [Column("added_volume:cavity", "volume added", "volume"), Column("phase", "phase", "text")]
        for number, _ in enumerate(calls):
            rows = [{"added_volume:cavity": 10.0 + number, "phase": "x", "time": 1.0}]
            yield number, Record("failed", "<b>broke</b>").plain() if number == 2 else Record(
                "done", history=History(columns, rows)).plain()  # fmt: skip


def test_the_page_shows_table_figures_and_reasons_and_escapes_them(tmp_path):
    (tmp_path / "sphere.toml").write_text(
        '[actuator]\ntemplate = "thick-sphere"\n[material]\nname = "lsr-finger"\n'
        '[[phase]]\ntargets = { cavity = "1 kPa" }'
    )
    walls = ["9 mm", "13 mm", "14 mm", "15 mm"]
    sweep = sweep_from(
        {"study": "sphere.toml", "title": "A <sweep>", "parameters": {"actuator.outer_radius": walls}}, "s", tmp_path
    )
    done = run_sweep(sweep, tmp_path / "out", workers=Quick())
    page = write_sweep_report(sweep, done, tmp_path / "out", "pneumorph sweep s.toml").read_text()
    for text in ("A &lt;sweep&gt;", "leaves no wall", "&lt;b&gt;broke", "pneumorph sweep s.toml", "data:image/svg+xml"):
        assert text in page
    assert "<b>broke" not in page
    assert (tmp_path / "out" / "figures" / "added_volume_cavity.svg").read_bytes().startswith(b"<?xml")
