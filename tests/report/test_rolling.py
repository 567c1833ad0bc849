import imageio_ffmpeg
import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError, StorageError
from pneumorph.report import rolling as report
from pneumorph.report.rolling_figures import distance_figure
from pneumorph.studies.reproductions.soft_wheel import RigidStudy
from pneumorph.studies.rolling import Cell, _write_trajectory
from pneumorph.terrain import Travel


@pytest.fixture
def folder(tmp_path):
    """A folder with the way of one run: 3 s, recorded every 0.05 s."""
    (tmp_path / "trajectories").mkdir()
    count = 61
    line, pose = np.linspace(0.0, 3.0, count), np.zeros((count, 11))
    way = Travel(line, pose[:, :3], line, pose[:, :4], pose[:, :4], pose, 0.0)
    _write_trajectory(tmp_path, "plain_flat", way)
    return tmp_path


def test_a_film_lasts_as_long_as_the_run(folder, monkeypatch):
    drawn = []

    def grey(model_file, poses, width, height):
        drawn.append((model_file.name, len(poses)))
        return (np.full((height, width, 3), 4 * i, np.uint8) for i in range(len(poses)))

    monkeypatch.setattr(report, "pictures", grey)
    last = report.write_film(folder, "plain_flat", folder / "film.mp4")
    assert drawn == [("plain_flat.xml", 31)]
    assert last[0, 0, 0] == 120
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(folder / "film.mp4"))
    assert frames == 31
    assert seconds == pytest.approx(3.0, abs=0.15)


def test_half_a_film_is_removed(folder, monkeypatch):
    def broken(model_file, poses, width, height):
        yield np.zeros((height, width, 3), np.uint8)
        raise EngineError("no OpenGL")

    monkeypatch.setattr(report, "pictures", broken)
    with pytest.raises(EngineError, match="no OpenGL"):
        report.write_film(folder, "plain_flat", folder / "film.mp4")
    assert not (folder / "film.mp4").exists()


def test_a_film_of_a_run_that_is_not_there_is_refused(folder):
    with pytest.raises(StorageError, match=r"plain_ramp\.npz cannot be read"):
        report.write_film(folder, "plain_ramp", folder / "film.mp4")


def test_a_report_needs_a_run_that_is_done(folder):
    rows = {"plain_flat": {"status": "failed", "wheel": "plain", "terrain": "flat"}}
    with pytest.raises(InputError, match="holds no run that is done"):
        report.write_rolling_report(folder, RigidStudy(quick=True).runs, rows)


def test_the_head_names_single_runs_that_one_paddle_beats():
    runs = [run for run in RigidStudy(quick=True).runs if run.ground.name == "smooth"]
    rows = {run.name: {"distance [m]": f"{2 * run.rover.wheel.paddles}", "least upright [-]": "1"} for run in runs}
    assert report._beaten(rows, runs) == []
    rows["curved-3_smooth-1"] = {"distance [m]": "1.5", "least upright [-]": "-0.9"}
    assert report._beaten(rows, runs) == ["curved-3_smooth-1 (1.50 m against 2.00 m, overturned)"]


def test_tables_have_means_spreads_and_gaps():
    table = {
        "plain": {"flat": Cell((8.0,)), "smooth": Cell((7.0, 8.0, 9.0))},
        "curved-1": {"flat": Cell((2.0,)), "smooth": Cell((), 3)},
    }
    lines = report.distances_csv(table, ("flat", "smooth")).splitlines()
    assert lines == [
        "wheel,flat [m],smooth [m],smooth spread [m]",
        "plain,8.0000,8.0000,2.0000",
        "curved-1,2.0000,,",
    ]
    assert report.ranking_csv(table).splitlines()[1:] == ["1,plain,8.0000,8.0000"]
    assert distance_figure(table, ("flat", "smooth")).startswith(b"<?xml")
