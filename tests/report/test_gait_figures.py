"""Gaits in reports: schedule, curves, table of the cycles, and the page of a small run with a cycle."""

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.gaits import Locomotion, undulation
from pneumorph.mechanics import Phase, Programme
from pneumorph.report import gait_figures, write, write_report
from pneumorph.studies import run_study, study_from

TABLE = {
    "title": "Two steps",
    "actuator": {"template": "crawler-2d", "channels": 1, "segments": 2, "rounding": "0 mm"},
    "mesh": {"size": "5 mm"},
    "measures": ["centre_of_mass_x", "centre_of_mass_y"],
    "gravity": {"direction": "-y"},
    "body": {"ground": {"shape": "half-space", "point": ["0 mm", "-0.05 mm"], "normal": "y"}},
    "contact": [
        {"name": "ground", "faces": ["rear_foot", "front_foot"], "body": "ground", "friction": 0.7, "reach": "0.05 mm"}
    ],
    "phase": [
        {"name": name, "targets": targets, "duration": "1 s", "inertia": "quasi-static", "largest_increment": 0.5,
         "first_increment": 0.5}
        for name, targets in (
            ("gravity", {"gravity": "9.81 m/s2"}), ("up", {"PN1": "3 kPa"}), ("down", {"PN1": "0 kPa"})
        )
    ],
    "cycle": {"phases": ["up", "down"], "repeat": 2},
}  # fmt: skip


@pytest.fixture(scope="module")
def solution(tmp_path_factory):
    return run_study(study_from(TABLE, "two-steps"), tmp_path_factory.mktemp("gait") / "run")


def test_the_schedule_has_a_row_for_each_cavity_and_the_names_of_the_phases():
    programme = undulation(("PN1", "PN2"), 0.013, duration=2.0).programme
    picture = gait_figures.schedule_figure(programme, ("PN1", "PN2"))
    assert picture.startswith(b"<?xml")
    # one filled area and one line a cavity
    assert picture != gait_figures.schedule_figure(programme, ("PN1",))
    assert picture == gait_figures.schedule_figure(programme, ("PN1", "PN2"))


def test_the_schedule_of_what_nothing_drives_is_refused():
    with pytest.raises(InputError, match="no phase drives 'PN3'; driven: PN1"):
        gait_figures.schedule_figure(Programme((Phase("up", {"PN1": 0.01}),)), ("PN3",))


def test_cycles_are_those_of_the_study(solution):
    assert gait_figures.cycle_ends(solution) == (1, 3, 5)


def test_feet_and_centre_of_mass_get_a_figure_each(solution):
    curves = gait_figures.gait_curves(solution)
    assert [curve.y for curve in curves] == [
        ("contact_force_y:ground:rear_foot", "contact_force_y:ground:front_foot"),
        ("centre_of_mass_x",),
        ("centre_of_mass_y",),
    ]
    assert all(curve.x == "clock" for curve in curves)


def test_the_table_has_a_row_for_each_finished_cycle(solution):
    table = gait_figures.gait_table(solution)
    assert [row[0] for row in table.rows] == ["1", "2"]
    assert table.head[1:5] == ("Displacement x", "Displacement y", "rear_foot: slip forward", "backward")
    assert all(len(row) == len(table.head) for row in table.rows)
    shown = float(table.rows[0][1].text.split()[0])
    x = solution.history.values("centre_of_mass_x")
    time = solution.history.values("time")
    assert shown == pytest.approx(float(x[time == 3.0][0] - x[time == 1.0][0]), rel=0.01, abs=1e-4)


def test_a_run_that_did_not_finish_a_cycle_has_no_table():
    zero = np.zeros((2, 2))
    found = Locomotion(np.array([0.0, 0.5]), zero, {}, {}, np.zeros(2), 1.0, (1, 3), np.array([1.0, 0.0]))
    assert gait_figures._table(found) is None


def test_the_page_shows_the_gait(solution, monkeypatch):
    monkeypatch.setattr(write, "_add_pictures", lambda *_: None)  # these have tests of their own
    page = write_report(solution).read_text(encoding="utf-8")
    assert "Cycles of the gait" in page
    assert "The gauge pressure that each cavity is given" in page
    assert (solution.folder / "figures" / "schedule.svg").exists()
