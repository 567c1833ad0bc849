"""`pneumorph reproduce soft-wheel --part reduced` on a synthetic limb: files, report, and what it refuses."""

import csv
import sys

import pytest
from tests.terrain.limbs import data_of

from pneumorph.cli import reduced as command
from pneumorph.errors import NotConvergedError
from pneumorph.studies import limb_reduction, reduced_wheel
from pneumorph.terrain.limb_data import read_limb_data

REDUCED = ("reproduce", "soft-wheel", "--part", "reduced")


@pytest.fixture
def synthetic(monkeypatch):
    """Limb data of a known chain in place of finite elements, and a roll of a second."""
    pytest.importorskip("mujoco")
    pytest.importorskip("gymnasium")
    data = data_of(held_out=((0.02, (-1.0, 1.0)),))
    monkeypatch.setattr(command, "read_limb_data", lambda path=None: data if path is None else read_limb_data(path))
    whole = reduced_wheel.reduce_wheel
    monkeypatch.setattr(reduced_wheel, "reduce_wheel", lambda data: whole(data, duration=1.0))
    return data


def test_the_quick_part_writes_data_tables_comparison_and_report(pneumorph, synthetic, tmp_path):
    out = tmp_path / "out"
    result = pneumorph(*REDUCED, "--quick", "--out", out)
    assert result.exit_code == 0, result.stderr
    assert len(read_limb_data(out / "limb_data.json").pressures) == len(synthetic.pressures)
    static = list(csv.DictReader((out / "static.csv").open()))
    assert [row["held out"] for row in static].count("yes") == 1
    # the data are those of a chain: MuJoCo must give the same
    assert max(abs(float(row["difference of sizes [-]"])) for row in static) < 0.01
    assert (out / "comparison.csv").read_text().startswith("quantity,condition,reported,computed,unit")
    assert "height of the wheel" in (out / "comparison.csv").read_text()
    roll = list(csv.DictReader((out / "roll.csv").open()))
    assert float(roll[-1]["time [s]"]) == pytest.approx(1.0)
    assert len(next(csv.reader((out / "hinges.csv").open()))) == 1 + 2 * 5
    page = (out / "report.html").read_text()
    assert "under held-out forces differ by at most 0.0% (within 15%; 20 kPa, 1.41 N)" in page
    assert {path.stem for path in (out / "figures").iterdir()} == {"laws", "shapes", "static", "heights", "roll"}
    again = pneumorph(*REDUCED, "--quick", "--out", out)
    assert again.exit_code == 2
    assert "already holds a run" in again.stderr
    (out / "report.html").unlink()
    assert pneumorph("report", out).exit_code == 0
    assert (out / "report.html").exists()


def test_an_interrupted_solve_says_how_to_go_on(pneumorph, synthetic, tmp_path, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(limb_reduction, "run_limb", interrupted)
    out = tmp_path / "out"
    result = pneumorph(*REDUCED, "--out", out)
    assert result.exit_code == 130
    assert f"--out {out} --resume" in result.stderr


def test_a_solve_that_stops_keeps_its_states_and_one_that_is_done_is_reported(
    pneumorph, synthetic, tmp_path, monkeypatch
):
    def stopped(*_, **__):
        raise NotConvergedError("the smallest increment fails")

    out = tmp_path / "out"
    monkeypatch.setattr(limb_reduction, "run_limb", stopped)
    result = pneumorph(*REDUCED, "--out", out)
    assert result.exit_code == 3
    assert f"the smallest increment fails\nthe states so far are kept in {out / 'finite-elements'}" in result.stderr
    monkeypatch.setattr(limb_reduction, "run_limb", lambda *_, command, **__: synthetic)
    assert pneumorph(*REDUCED, "--out", out, "--resume").exit_code == 0
    assert (out / "report.html").exists()


def test_options_of_other_parts_are_refused(pneumorph, tmp_path):
    result = pneumorph(*REDUCED, "--radius", "100 mm", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "--radius: the part 'reduced' does not take this option" in result.stderr


def test_a_missing_extra_shows_before_anything_is_written(pneumorph, tmp_path, monkeypatch):
    monkeypatch.delitem(sys.modules, "pneumorph.terrain.environment", raising=False)
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    result = pneumorph(*REDUCED, "--quick", "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert "pip install 'pneumorph[gym]'" in result.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_with_another_file_of_that_name_is_refused(pneumorph, tmp_path):
    pytest.importorskip("gymnasium")
    (tmp_path / "limb_data.json").write_text("{}")
    result = pneumorph("report", tmp_path)
    assert result.exit_code == 2
    assert "is no limb data" in result.stderr
