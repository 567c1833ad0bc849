import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.report import figures
from pneumorph.report.curves import default_curves, driver
from pneumorph.report.figures import Curve, curve_figure
from pneumorph.studies.comparison import ReportedCurve

OVER, ADDED = "pressure:cavity", "added_volume:cavity"


def test_a_curve_with_reported_data_is_an_svg_that_comes_out_the_same_again(balloon):
    reported = (
        ReportedCurve("table <1>", OVER, ADDED, np.array([0.01, 0.02]), np.array([500.0, 900.0]), marks=True),
        ReportedCurve("formula", OVER, ADDED, np.array([0.0, 9.0]), np.array([0.0, 1e9])),
    )
    first, second = (curve_figure(balloon.history, Curve("Volume", OVER, (ADDED,)), reported) for _ in range(2))
    assert first.startswith(b"<?xml")
    assert b"</svg>" in first
    assert first == second


def test_a_reported_curve_far_off_does_not_flatten_the_computed_one(monkeypatch, balloon):
    seen = []
    monkeypatch.setattr(figures, "svg", lambda figure: seen.append(figure) or b"")
    far = ReportedCurve("far", OVER, ADDED, np.array([0.0, 9.0]), np.array([0.0, 1e9]))
    curve_figure(balloon.history, Curve("Volume", OVER, (ADDED,)), (far,))
    (axes,) = seen[0].axes
    assert axes.get_ylim()[1] < 3.5 * 4.0  # mL; 4 mL were added
    assert "[kPa]" in axes.get_xlabel()
    assert "[mL]" in axes.get_ylabel()


def test_columns_of_different_kinds_are_refused_on_one_axis(balloon):
    with pytest.raises(InputError, match="different kinds"):
        curve_figure(balloon.history, Curve("Mix", "time", (OVER, ADDED)))


def test_a_curve_without_columns_is_refused():
    with pytest.raises(InputError, match="expected a tuple"):
        Curve("Nothing", "time", "strain_energy")


def test_an_unknown_column_is_refused_with_the_nearest_one(balloon):
    with pytest.raises(NameNotFoundError, match="strain_energy"):
        curve_figure(balloon.history, Curve("Typo", "time", ("strain_enrgy",)))


@pytest.mark.parametrize("draw", [figures.energy_figure, figures.convergence_figure, figures.stability_figure])
def test_the_figures_of_the_checks_are_drawn(balloon, draw):
    assert b"</svg>" in draw(balloon.history)


def test_curves_go_over_the_pressure_or_else_the_load(balloon, beam):
    assert driver(balloon) == OVER
    assert driver(beam) == "value:push"
    assert any(curve.x == ADDED for curve in default_curves(balloon))
    assert default_curves(beam) == []
