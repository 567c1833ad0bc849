import pytest

from pneumorph.cli import reporting
from pneumorph.errors import EngineError, StorageError
from pneumorph.report import render
from pneumorph.solution import Solution
from pneumorph.studies import reproductions, run_study, study_from
from pneumorph.studies.reproductions import hexagonal_prism


@pytest.fixture
def no_pictures(monkeypatch):
    """Reports without their pictures, which take long and have tests of their own."""

    def fail():
        raise EngineError("pictures cannot be drawn: not in this test")

    monkeypatch.setattr(render, "check", fail)


def test_a_run_is_reported_and_can_be_reported_anew(pneumorph, study, no_pictures, tmp_path):
    out = tmp_path / "out"
    result = pneumorph("run", study, "--out", out)
    assert result.exit_code == 0
    assert f"report: {out / 'report.html'}" in result.stdout
    page = (out / "report.html").read_text()
    assert "Octant of a sphere" in page
    assert f"pneumorph run {study}" in page
    (out / "report.html").unlink()
    again = pneumorph("report", out)
    assert again.exit_code == 0
    assert (out / "report.html").exists()


def test_a_stopped_run_is_reported_too(pneumorph, study, tmp_path, monkeypatch):
    told = []
    monkeypatch.setattr(reporting, "report_study", lambda solution: told.append(solution.status.value) or "page")
    study.write_text(study.read_text().replace("20 kPa", "80 kPa") + "smallest_increment = 0.05\n")
    assert pneumorph("run", study, "--out", tmp_path / "out").exit_code == 3
    assert told == ["stopped"]


@pytest.fixture
def short(monkeypatch):
    """The reproduction with two short chambers a side, to 2 kPa, without a picture."""
    table = hexagonal_prism.study(quick=True).resolved()
    table["actuator"] |= {"length": "20 mm", "chambers": 1}
    table["phase"] = [
        {"targets": dict.fromkeys(hexagonal_prism.DRIVEN, "2 kPa"), "first_increment": 0.5, "largest_increment": 0.5}
    ]
    chosen = reproductions.reproduction("hexagonal-prism")
    object.__setattr__(chosen, "study", lambda quick: study_from(table, "hexagonal-prism"))
    yield
    object.__setattr__(chosen, "study", hexagonal_prism.study)


def test_a_reproduction_writes_its_comparison(pneumorph, short, no_pictures, tmp_path):
    out = tmp_path / "out"
    result = pneumorph("reproduce", "hexagonal-prism", "--part", "bending", "--quick", "--out", out)
    assert result.exit_code == 0, result.stderr
    lines = (out / "comparison.csv").read_text().splitlines()
    assert lines[0] == "quantity,condition,reported,computed,unit,relative_difference,note"
    assert lines[1].startswith('"chord_angle (Table 2, finite elements)",40 kPa,5.5,,deg,,not reached')
    assert Solution.open(out).about["reproduction"] == "hexagonal-prism"
    page = (out / "report.html").read_text()
    assert "act11050125" in page
    assert "All walls may touch" in page
    (out / "comparison.csv").unlink()
    assert pneumorph("report", out).exit_code == 0
    assert (out / "comparison.csv").read_text().splitlines() == lines


def test_reproductions_are_listed(pneumorph):
    result = pneumorph("reproduce")
    assert result.exit_code == 0
    assert "hexagonal-prism: " in result.stdout


def test_a_run_of_an_unknown_reproduction_is_refused(study, tmp_path):
    from pneumorph.studies import load_study

    run_study(load_study(study), tmp_path, about={"reproduction": "flying-carpet"})
    with pytest.raises(StorageError, match="reproduction 'flying-carpet', which this version does not know"):
        reporting.report_folder(tmp_path)
