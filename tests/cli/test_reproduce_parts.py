"""`pneumorph reproduce` of a system of several runs: folders, the comparison of all, one part alone, resuming."""

import pytest

from pneumorph.report.comparison import read_comparison
from pneumorph.studies import study_from
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions import Reproduction
from pneumorph.studies.reproductions import reproduction as registered
from pneumorph.studies.reproductions.reproduction import _KNOWN, register

HALVES = {"first_increment": 0.5, "largest_increment": 0.5}
PARTS = {"inflating": "spheres", "more": "spheres-more"}


def sphere(pressure, **phase):
    table = {
        "title": "Octant of a sphere",
        "actuator": {"template": "thick-sphere", "octant": True},
        "material": {"law": "neo-hookean", "mu": "100 kPa"},
        "mesh": {"size": "coarse"},
        "phase": [{"name": "inflate", "targets": {"cavity": pressure}, **HALVES, **phase}],
    }
    return lambda quick: study_from(table, "sphere")


@pytest.fixture
def spheres(monkeypatch):
    """A system of two runs; the second one stops where `stop` is set."""

    def registering(stop=False):
        def rows(name):
            return lambda solution, study: (Comparison(name, "", 1.0, float(len(solution.states)), ""),)

        hard = sphere("10 MPa", smallest_increment=0.5) if stop else sphere("15 kPa")
        common = {"title": "Spheres", "source": "none", "curves": lambda study: ()}
        register(Reproduction("spheres", study=sphere("10 kPa"), compare=rows("main"), parts=PARTS, **common))
        register(Reproduction("spheres-more", study=hard, compare=rows("further"), **common))

    monkeypatch.setattr("pneumorph.report.write._add_pictures", lambda *given: None)
    yield registering
    for name in PARTS.values():
        _KNOWN.pop(name, None)


def test_all_parts_are_run_and_their_rows_stand_in_one_comparison(pneumorph, spheres, tmp_path):
    spheres()
    out = tmp_path / "run"
    assert pneumorph("reproduce", "spheres", "--quick", "--out", out).exit_code == 0
    assert [row.quantity for row in read_comparison(out)] == ["main", "more: further"]
    assert [row.quantity for row in read_comparison(out / "more")] == ["further"]
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "see more/report.html" in page
    assert f"pneumorph reproduce spheres --quick --out {out}" in (out / "more" / "report.html").read_text("utf-8")

    written = pneumorph("report", out)
    assert written.exit_code == 0
    assert [row.quantity for row in read_comparison(out)] == ["main", "more: further"]

    again = pneumorph("reproduce", "spheres", "--quick", "--out", out)
    assert again.exit_code == 2
    assert "already holds a run" in again.output
    assert pneumorph("reproduce", "spheres", "--quick", "--out", out, "--resume").exit_code == 0


@pytest.mark.parametrize(("part", "row"), [("more", "further"), ("inflating", "main")])
def test_a_part_is_run_alone(pneumorph, spheres, tmp_path, part, row):
    spheres()
    out = tmp_path / "run"
    result = pneumorph("reproduce", "spheres", "--part", part, "--out", out)
    assert result.exit_code == 0, result.output
    assert [found.quantity for found in read_comparison(out)] == [row]
    assert (out / "report.html").exists()
    assert not (out / "more").exists()


def test_a_part_that_stops_does_not_keep_the_others_from_being_run(pneumorph, spheres, tmp_path):
    spheres(stop=True)
    out = tmp_path / "run"
    assert pneumorph("reproduce", "spheres", "--out", out).exit_code == 3
    assert (out / "report.html").exists()
    assert [row.quantity for row in read_comparison(out)] == ["main", "more: further"]


def test_unknown_parts_and_options_are_refused(pneumorph, spheres):
    spheres()
    for words, message in (
        (("spheres", "--part", "less"), "--part: less, allowed for spheres: inflating, more; left out, all of them"),
        (("spheres-more", "--part", "more"), "--part: more, but spheres-more has no parts"),
        (("spheres", "--scheduler", "tcp://x:1"), "--scheduler: spheres does not take this option"),
    ):
        result = pneumorph("reproduce", *words)
        assert result.exit_code == 2
        assert message in " ".join(result.output.split())


def test_a_finger_bends_grips_and_massages():
    parts = registered("finger").parts
    assert list(parts) == ["bending", "gripper", "massage"]
    assert parts["bending"] == "finger"
    assert all(registered(name).title.endswith("(system 3)") for name in parts.values())
