"""Studies of flat sheets: what the file says, what comes out, and what is refused."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from pneumorph.errors import NameNotFoundError, NotConvergedError, StorageError, StudyError
from pneumorph.geometry.lattice import Cell
from pneumorph.homogenisation import Sheet, TensionTest
from pneumorph.materials import NeoHookean
from pneumorph.studies.tension import Pull, TensionStudy, is_tension_table, load_tension, tension_from

EXAMPLE = Path(__file__).parents[2] / "examples" / "sheets" / "tension.toml"
SMALL = """
[sheet]
kinds = ["honeycomb"]
columns = 2
rows = 2
[pull]
strain = 0.1
steps = 1
[mesh]
size = "coarse"
"""


def study(text=SMALL, **changed):
    table = tomllib.loads(text)
    for path, value in changed.items():
        section, key = path.split("__")
        table.setdefault(section, {})[key] = value
    return tension_from(table, "small")


@pytest.fixture
def quick(monkeypatch):
    """Tests that cost nothing: linear ones, softer along; which were made is kept."""
    made = []

    def test(self, pull, progress=None):
        made.append(pull.name)
        strain = np.linspace(0.0, self.file.pull.strain, self.file.pull.steps + 2)
        factor = 1.0 if pull.direction == "along" else 2.0
        return TensionTest(strain, factor * strain, strain, -0.3 * strain)

    monkeypatch.setattr(TensionStudy, "test", test)
    return made


def test_the_default_sheet_is_the_published_skin_laid_flat():
    made = study("[sheet]\n")
    assert made.sheets == {kind: Sheet(Cell(kind, 0.2)) for kind in ("re-entrant", "honeycomb")}
    assert made.material.mu == pytest.approx(1.85)
    assert made.size == pytest.approx(104.3 / 7 / 4)
    assert len(made.pulls) == 8


def test_a_sheet_and_its_cell_are_pulled_as_in_python():
    made = study(material__law="neo-hookean", material__mu="1.85 MPa")
    assert made.material == NeoHookean(1.85)
    found = {pull.model: made.test(pull) for pull in made.pulls if pull.direction == "along"}
    for model, test in found.items():
        assert test.strain[-1] == pytest.approx(0.1), model
        assert test.force[-1] > 0.0 > test.lateral[-1]  # honeycombs narrow
    # few cells are mostly edges: of one order with the endless sheet
    assert 0.5 < found["sheet"].stiffness / found["endless"].stiffness < 1.0


def test_a_curve_is_that_of_the_whole_sheet_and_is_read_back(quick, tmp_path):
    made = study()
    pull = Pull("honeycomb", "around", "sheet")
    test = made.test(pull)
    curve = made.curve(pull, test)
    sheet = made.sheets["honeycomb"]
    assert curve.values("displacement")[-1] == pytest.approx(0.1 * 2 * sheet.width)
    assert curve.values("force")[-1] == pytest.approx(0.2 * 2 * sheet.height)
    assert curve.values("stress")[-1] == pytest.approx(0.2 / sheet.depth)
    assert curve.values("lateral_displacement")[-1] == pytest.approx(-0.03 * 2 * sheet.height)
    curve.write_csv(tmp_path / "curve.csv")
    again = made.read_curve(pull, tmp_path / "curve.csv")
    for name in ("strain", "force", "gauge", "lateral"):
        assert getattr(again, name) == pytest.approx(getattr(test, name))
    (tmp_path / "curve.csv").write_text("strain,force\n0,0\n0.1,1\n")
    with pytest.raises(StorageError, match="is damaged: expected the columns strain, displacement"):
        made.read_curve(pull, tmp_path / "curve.csv")


def test_the_resolved_text_makes_an_equal_study():
    made = study("[sheet]\n")
    assert tension_from(tomllib.loads(made.resolved_text()), "other").resolved_text() == made.resolved_text()


def test_the_example_is_a_study_of_sheets():
    assert load_tension(EXAMPLE).title == "Lattice sheets in tension"
    assert is_tension_table(tomllib.loads(EXAMPLE.read_text()))
    assert not is_tension_table({"actuator": {}})


@pytest.mark.parametrize(
    ("changed", "error", "message"),
    [
        ({"sheet__kinds": ["honeycom"]}, NameNotFoundError, "sheet.kinds: unknown name 'honeycom': did you mean"),
        ({"sheet__kinds": []}, StudyError, r"sheet.kinds = \[\]: expected one or more of re-entrant"),
        ({"pull__directions": ["along", "along"]}, StudyError, "expected one or more of along, around, each once"),
        ({"pull__models": ["cell"]}, NameNotFoundError, "pull.models: unknown name 'cell'"),
        ({"pull__strain": 0.0}, StudyError, "pull.strain = 0.0: expected more than 0"),
        ({"pull__steps": 0}, StudyError, "pull.steps = 0: expected at least 1"),
        ({"mesh__detail": 0.5}, StudyError, "mesh: detail is given for flat sheets"),
        ({"sheet__beam": "9 mm"}, Exception, "beam = 9 mm: expected less than the width of the cell"),
        ({"sheet__columns": 3}, Exception, "columns = 3, allowed: an even number"),
        ({"sheet__cg": 0.6}, Exception, "the gap g = cg h"),
        ({"sheet__colums": 3}, StudyError, "unknown key 'colums': did you mean 'columns'"),
        ({"sheet__width": "9"}, Exception, "width = '9': expected length with its unit"),
    ],
)
def test_what_is_wrong_is_refused_with_its_key(changed, error, message):
    with pytest.raises(error, match=message):
        study(**changed)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(StudyError, match="cannot read the study file"):
        load_tension(tmp_path / "no.toml")
    (tmp_path / "bad.toml").write_text('[sheet]\nkinds = ["x"]\n')
    with pytest.raises(NameNotFoundError, match=r"bad\.toml: sheet\.kinds"):
        load_tension(tmp_path / "bad.toml")


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


@pytest.fixture
def pneumorph():
    from typer.testing import CliRunner

    from pneumorph.cli.app import app

    return lambda *words: CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)


def test_the_command_pulls_reports_and_is_resumed(pneumorph, quick, file, tmp_path):
    out = tmp_path / "out"
    result = pneumorph("run", file, "--out", out)
    assert result.exit_code == 0, result.output
    assert "4/4  honeycomb, around, a sheet between two grips: stiffness 2 N/mm, Poisson's ratio 0.3" in result.output
    rows = (out / "table.csv").read_text().splitlines()
    assert rows[0].startswith("kind,direction,model,stiffness,modulus [MPa],poisson_ratio")
    assert rows[1].startswith("honeycomb,along,endless,1")
    assert "Poisson" in (out / "report.html").read_text()
    (out / "curves" / "honeycomb-along-sheet.csv").unlink()
    (out / "report.html").unlink()
    assert pneumorph("run", file, "--out", out).exit_code == 2
    result = pneumorph("run", file, "--out", out, "--resume")
    assert "3/4  kept from before" in result.output
    assert quick[4:] == ["honeycomb-along-sheet"]
    (out / "report.html").unlink()
    assert pneumorph("report", out).exit_code == 0
    assert (out / "report.html").exists()


def test_a_folder_of_another_study_is_refused(pneumorph, quick, file, tmp_path):
    out = tmp_path / "out"
    assert pneumorph("run", file, "--out", out, "--no-report").exit_code == 0
    file.write_text(SMALL.replace("steps = 1", "steps = 2"))
    result = pneumorph("run", file, "--out", out, "--resume")
    assert result.exit_code == 2
    assert "holds another study" in result.output
    # further kinds are added to what is there
    file.write_text(SMALL.replace('["honeycomb"]', '["honeycomb", "brick"]'))
    assert "4/8  kept from before" in pneumorph("run", file, "--out", out, "--resume").output


def test_a_test_that_does_not_converge_does_not_stop_the_others(pneumorph, quick, file, tmp_path, monkeypatch):
    usual = TensionStudy.test

    def test(self, pull, progress=None):
        if pull.direction == "along":
            raise NotConvergedError("no further")
        return usual(self, pull, progress)

    monkeypatch.setattr(TensionStudy, "test", test)
    result = pneumorph("run", file, "--out", tmp_path / "out")
    assert result.exit_code == 3
    assert "stopped: honeycomb-along-sheet: no further" in result.output
    assert "2 of 4 tension tests" in (tmp_path / "out" / "report.html").read_text()


def test_ctrl_c_says_how_to_go_on(pneumorph, file, tmp_path, monkeypatch):
    def test(self, pull, progress=None):
        raise KeyboardInterrupt

    monkeypatch.setattr(TensionStudy, "test", test)
    result = pneumorph("run", file, "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert "go on with: pneumorph run" in result.output
    result = pneumorph("report", tmp_path / "out")
    assert result.exit_code == 2
    assert "holds no test that ended" in result.output
