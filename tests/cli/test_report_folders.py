"""`pneumorph report` of folders that hold more than one run: sweeps, the reproduction by a sweep, inverse searches."""

import json

import numpy as np
import pytest

from pneumorph.cli import designing, skins
from pneumorph.errors import StorageError
from pneumorph.report.design import write_design_report
from pneumorph.studies.design import DesignTask, TableLaw, found_in, load_design, search
from pneumorph.studies.reproductions.auxetic_skin import SkinStudy
from pneumorph.studies.sweeps import Workers, run_sweep, stored_table

TARGET = """
[target]
file = "line.csv"
[search]
segments = 1
cg = [0.2, 0.5]
pressure = ["1 kPa", "20 kPa"]
trials = 12
starts = 2
"""
# an arc that turns by a third
POINTS = [(-300.0 * (1.0 - np.cos(a)), 300.0 * np.sin(a)) for a in np.linspace(0.0, 1.0 / 3.0, 9)]


def test_a_sweep_is_reported_anew_from_its_designs(pneumorph, study, tmp_path, monkeypatch):
    """Also one of a study without a title, which is called after its file."""
    monkeypatch.setattr(
        Workers, "compute", lambda self, function, calls: ((n, function(*call)) for n, call in enumerate(calls))
    )
    study.write_text(study.read_text().replace('title = "Octant of a sphere"\n', ""))
    sweep, out = tmp_path / "radii.toml", tmp_path / "out"
    sweep.write_text('study = "sphere.toml"\n[parameters]\nactuator.outer_radius = ["9 mm", "14 mm"]\n')
    assert pneumorph("sweep", sweep, "--out", out).exit_code == 0
    page, table = out / "report.html", (out / "table.csv").read_text()
    (out / "figures" / "x").touch()
    page.unlink()
    study.unlink()
    result = pneumorph("report", out)
    assert result.exit_code == 0, result.output
    assert f"report: {page}" in result.stdout
    assert "sphere" in page.read_text()
    assert "not computed" not in page.read_text()
    assert (out / "table.csv").read_text() == table
    with pytest.raises(StorageError, match="holds no sweep"):
        stored_table(SkinStudy(True).sweep, tmp_path / "no")


def test_the_skins_are_reported_anew_from_the_designs_that_ended(pneumorph, tmp_path, monkeypatch):
    monkeypatch.setattr(skins, "tension_findings", tuple)
    monkeypatch.setattr("pneumorph.report.skins.write_sweep_report", lambda sweep, table, folder, command: folder / "x")
    monkeypatch.setattr(Workers, "compute", lambda self, function, calls: iter(()))
    run_sweep(SkinStudy(True).sweep, tmp_path)
    (tmp_path / "skins.json").write_text(json.dumps({"quick": True, "command": "pneumorph reproduce it"}))
    assert pneumorph("report", tmp_path).exit_code == 0
    text = (tmp_path / "report.html").read_text()
    assert "14 of 14 designs did not reach their volume" in text
    assert "pneumorph reproduce it" in text
    (tmp_path / "skins.json").write_text('{"quick": 1}')
    result = pneumorph("report", tmp_path)
    assert result.exit_code == 2
    assert "skins.json is damaged: no 'quick'" in result.stderr


@pytest.fixture
def known(tmp_path, monkeypatch):
    """A search with a table that needs no solve: its task and its folder, which is kept as the command does."""
    (tmp_path / "line.csv").write_text("x [mm],z [mm]\n" + "".join(f"{x},{z}\n" for x, z in POINTS))
    (tmp_path / "bow.toml").write_text(TARGET)
    task, folder = load_design(tmp_path / "bow.toml"), tmp_path / "out"
    pressure = np.linspace(0.0, 0.02, 5)
    turn = {item: np.outer([1.0, 0.0], 0.3 * pressure) for item in task.lattices}
    law = TableLaw(np.array([0.2, 0.5]), pressure, turn, {item: np.ones((2, 5)) for item in task.lattices}, 0.0)
    monkeypatch.setattr(DesignTask, "runs", lambda self, place: {})
    monkeypatch.setattr(DesignTask, "law", lambda self, runs: law)
    designing._keep(task, folder, resume=False)
    record = {"command": "pneumorph design bow.toml", "table": None}
    (folder / "search.json").write_text(json.dumps(record))
    return task, folder, law


def test_a_search_is_reported_anew_from_its_journal_without_its_files(pneumorph, known, tmp_path):
    task, folder, law = known
    found = search(task, law, folder / "search.journal")
    write_design_report(task, law, found, None, folder, "pneumorph design bow.toml")
    names = ("report.html", "found.toml")
    before = {name: (folder / name).read_text() for name in names}
    for name in (*names, "../line.csv", "../bow.toml"):
        (folder / name).unlink()
    result = pneumorph("report", folder)
    assert result.exit_code == 0, result.output
    # the curve is named after the file that is kept beside the target
    assert (folder / "report.html").read_text().count("pneumorph design bow.toml") > 0
    assert (folder / "found.toml").read_text() == before["found.toml"]
    assert found_in(task, law, folder / "search.journal").deviation == found.deviation


def test_a_search_that_was_broken_off_or_damaged_is_not_reported(pneumorph, known, monkeypatch):
    task, folder, law = known
    missing = pneumorph("report", folder)
    assert missing.exit_code == 2
    assert "search.journal' is missing: the search was not started" in missing.stderr

    def broken(news):
        if news.ended == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        search(task, law, folder / "search.journal", broken)
    assert "holds 5 of 12 trials: go on with --resume" in pneumorph("report", folder).stderr
    (folder / "search.json").write_text("{}")
    assert "search.json is damaged: no 'command'" in pneumorph("report", folder).stderr


def test_points_that_changed_make_another_search(known, tmp_path):
    task, folder, _ = known
    designing._keep(task, folder, resume=True)
    with pytest.raises(StorageError, match="already holds a search"):
        designing._keep(task, folder, resume=False)
    (tmp_path / "line.csv").write_text("x [mm],z [mm]\n0,0\n-1,50\n-4,100\n")
    with pytest.raises(StorageError, match=r"holds another search, see its target\.csv"):
        designing._keep(load_design(tmp_path / "bow.toml"), folder, resume=True)
