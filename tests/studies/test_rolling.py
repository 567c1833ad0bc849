import json

import numpy as np
import pytest

from pneumorph.errors import EngineError, InputError, NameNotFoundError, StorageError
from pneumorph.studies import reproductions, rolling
from pneumorph.studies.reproductions.soft_wheel import RigidStudy, findings
from pneumorph.studies.rolling import (
    Cell,
    Ground,
    RollingRun,
    distances,
    ranking,
    read_sweep,
    read_trajectory,
    run_rolling,
    travel,
)
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.terrain import Drive, Rover, Wheel

SETTINGS = {"reproduction": "test"}
SHORT = Drive(duration=0.5)


class Here:
    """Workers that compute in this process, one call after the other."""

    text = "this process"

    def compute(self, function, calls):
        for number, call in enumerate(calls):
            try:
                yield number, function(*call)
            except Exception as error:
                yield number, error


def runs_of(*wheels):
    return [RollingRun(Rover(wheel), SHORT, Ground("flat")) for wheel in wheels]


def test_the_study_has_81_runs_of_which_each_wheel_meets_the_same_drops():
    runs = RigidStudy().runs
    assert len(runs) == len({run.name for run in runs}) == 81
    for terrain, drops in {"flat": 1, "steps": 1, "ramp": 1, "smooth": 3, "terraced": 3}.items():
        places = {run.rover.wheel.name: [] for run in runs}
        for run in runs:
            if run.ground.name == terrain:
                places[run.rover.wheel.name].append(run.place)
        assert len(places) == 9
        assert all(len(set(found)) == drops and found == places["plain"] for found in places.values())
    for run in runs:
        assert run.drive == Drive()
        run_far = run.place[0] + 140.0 * run.drive.wanted_turn
        assert abs(run.place[1]) < 25_000.0 - 9_000.0
        assert run_far < 25_000.0 - 1_000.0


def test_a_quick_study_takes_the_first_drop_of_the_whole_one():
    quick = RigidStudy(quick=True).runs
    assert len(quick) == 18
    whole = {run.name: run.place for run in RigidStudy().runs}
    assert all(whole[run.name] == run.place for run in quick)


def test_wheels_too_large_for_the_robot_are_refused():
    with pytest.raises(InputError, match="larger than the wheelbase: diameter 700 mm"):
        _ = RigidStudy(radius=350.0).runs


def test_systems_in_parts_are_known_beside_the_others():
    assert {"hexagonal-prism", "soft-wheel"} <= set(reproductions.names())
    assert {"rigid", "granular"} <= set(reproductions.reproduction("soft-wheel").parts)
    with pytest.raises(NameNotFoundError, match="did you mean 'soft-wheel'"):
        reproductions.reproduction("soft-whel")


@pytest.fixture
def swept(tmp_path):
    pytest.importorskip("mujoco")
    runs = runs_of(Wheel(0), Wheel(3))
    news = []
    rows = run_rolling(runs, tmp_path / "out", SETTINGS, workers=Here(), progress=news.append, command="again")
    return tmp_path / "out", runs, rows, news


def test_a_sweep_leaves_models_terrains_ways_and_a_table(swept):
    folder, runs, rows, news = swept
    assert {row["status"] for row in rows.values()} == {"done"}
    assert read_sweep(folder)["settings"] == SETTINGS
    assert read_sweep(folder)["command"] == "again"
    assert [item.finished for item in news] == [1, 2]
    assert news[-1].remaining == 0.0
    for run in runs:
        import mujoco

        mujoco.MjModel.from_xml_path(str(folder / "models" / f"{run.name}.xml"))
        way = read_trajectory(folder, run.name)
        forward = (way["centre"][-1, 0] - way["centre"][0, 0]) / 1000.0
        assert float(rows[run.name]["distance [m]"]) == pytest.approx(forward, rel=1e-5)
    assert (folder / "terrains" / "flat.png").exists()


def test_a_sweep_is_resumed_without_what_is_done_and_with_what_failed(swept, monkeypatch):
    folder, runs, rows, _ = swept
    tried = []

    def again(run):
        tried.append(run.name)
        return travel(run)

    monkeypatch.setattr(rolling, "travel", again)
    more = [*runs, *runs_of(Wheel(1))]
    lines = (folder / "runs.csv").read_text().splitlines()
    (folder / "runs.csv").write_text(
        "\n".join([lines[0], lines[1], "straight-3_flat,failed,no luck" + 14 * ","]) + "\n"
    )
    done = lines[1].split(",")[0]
    found = run_rolling(more, folder, SETTINGS, resume=True, workers=Here())
    assert sorted(tried) == sorted(
        {run.name for run in more} - {done, "straight-3_flat"} | {"straight-3_flat"} - {done}
    )
    assert {row["status"] for row in found.values()} == {"done"}


def test_a_folder_with_a_sweep_or_of_other_settings_is_refused(swept):
    folder, runs, _, _ = swept
    with pytest.raises(StorageError, match="already holds a run: resume it"):
        run_rolling(runs, folder, SETTINGS)
    with pytest.raises(StorageError, match="holds a sweep with other settings"):
        run_rolling(runs, folder, {"reproduction": "other"}, resume=True)
    (folder / "trajectories" / "plain_flat.npz").write_bytes(b"no")
    with pytest.raises(StorageError, match=r"plain_flat\.npz cannot be read"):
        read_trajectory(folder, "plain_flat")
    record = json.loads((folder / "sweep.json").read_text())
    (folder / "sweep.json").write_text(json.dumps({**record, "format": 99}))
    with pytest.raises(StorageError, match="has format 99, this version reads 1"):
        read_sweep(folder)
    (folder / "sweep.json").write_text("{}")
    with pytest.raises(StorageError, match=r"sweep\.json cannot be read"):
        read_sweep(folder)


def test_a_run_that_fails_is_a_row_with_its_reason_and_the_others_go_on(tmp_path, monkeypatch):
    pytest.importorskip("mujoco")

    def sometimes(run):
        if run.rover.wheel.paddles == 1:
            raise EngineError("unstable before 0.1 s")
        if run.rover.wheel.paddles == 2:
            raise ZeroDivisionError("a defect")
        return travel(run)

    monkeypatch.setattr(rolling, "travel", sometimes)
    rows = run_rolling(runs_of(Wheel(1), Wheel(0), Wheel(2)), tmp_path / "out", SETTINGS, workers=Here())
    assert rows["straight-1_flat"]["reason"] == "unstable before 0.1 s"
    assert rows["straight-2_flat"]["reason"] == "ZeroDivisionError: a defect"
    assert rows["plain_flat"]["status"] == "done"


def test_an_interruption_keeps_what_is_done(tmp_path, monkeypatch):
    pytest.importorskip("mujoco")

    def stop(run):
        if run.rover.wheel.paddles == 1:
            raise KeyboardInterrupt
        return travel(run)

    monkeypatch.setattr(rolling, "travel", stop)
    runs = runs_of(Wheel(0), Wheel(1))
    with pytest.raises(KeyboardInterrupt):
        run_rolling(runs, tmp_path / "out", SETTINGS, workers=Here())
    monkeypatch.undo()
    rows = run_rolling(runs, tmp_path / "out", SETTINGS, resume=True, workers=Here())
    assert {row["status"] for row in rows.values()} == {"done"}
    assert float(rows["plain_flat"]["wall [s]"]) > 0.0


def test_processes_of_this_machine_find_the_same_ways(tmp_path):
    pytest.importorskip("mujoco")
    runs = runs_of(Wheel(0), Wheel(3))
    rows = run_rolling(runs, tmp_path / "out", SETTINGS, workers=Workers(1))
    for run in runs:
        way, _ = travel(run)
        np.testing.assert_array_equal(read_trajectory(tmp_path / "out", run.name)["pose"], way.pose)
        assert rows[run.name]["status"] == "done"


def row(wheel, terrain, distance=None, upright=1.0):
    found = {"wheel": wheel, "terrain": terrain, "status": "done" if distance is not None else "failed"}
    return found | {"distance [m]": str(distance), "least upright [-]": str(upright)}


def test_distances_are_means_over_the_drops_that_were_computed():
    table = distances(
        [row("plain", "flat", 8.0), row("plain", "flat", 7.0, -0.5), row("plain", "flat"), row("x", "flat")]
    )
    cell = table["plain"]["flat"]
    assert (cell.mean, cell.spread, cell.failed, cell.overturned) == (7.5, 1.0, 1, 1)
    assert (table["x"]["flat"].mean, table["x"]["flat"].spread) == (None, 0.0)


def test_the_ranking_leaves_out_what_was_not_computed():
    table = {
        "a": {"flat": Cell((2.0,)), "ramp": Cell((4.0,))},
        "b": {"flat": Cell((5.0,)), "ramp": Cell((3.0,))},
        "c": {"flat": Cell((9.0,)), "ramp": Cell((), 1)},
    }
    assert ranking(table) == [("b", 4.0, 3.0), ("a", 3.0, 2.0)]


def test_findings_say_where_the_study_holds():
    flat = {
        f"{kind}-{n}": 2.2 * n + (0.1 if kind == "curved" else 0.0)
        for kind in ("straight", "curved")
        for n in (1, 2, 3, 4)
    }
    table = {wheel: {"flat": Cell((d,)), "steps": Cell((d, d + 0.2))} for wheel, d in flat.items()}
    table["straight-3"]["steps"] = Cell((1.0,), failed=1, overturned=1)
    found = {(item.row.quantity, item.row.condition): item for item in findings(table)}
    assert found["distance, straight-1", "flat"].holds is True
    assert found["distance, straight-3", "flat"].holds is False  # 6.6 m, not over 8 m
    assert found["distance, straight-4", "flat"].holds is True
    notes = found["distance, straight-3", "steps"].row.note
    assert "1 of 2 runs failed" in notes
    assert "overturned in 1 of 2 runs" in notes
    beats = "shortest distance of three and more paddles / longest of one"
    assert found[beats, "flat"].row.computed == pytest.approx(6.6 / 2.3)
    assert found[beats, "flat"].holds is True
    assert found[beats, "steps"].holds is False
    curved = "distance with curved / straight paddles, sums over one to four"
    assert found[curved, "flat"].holds is True
    assert found[curved, "steps"].holds is False  # curved ones are reported to lose there


def test_findings_without_numbers_hold_nowhere():
    wheels = [f"{kind}-{n}" for kind in ("straight", "curved") for n in (1, 2, 3, 4)]
    found = findings({wheel: {"flat": Cell((), 1)} for wheel in wheels})
    assert {item.holds for item in found} == {None}
    assert {item.row.computed for item in found} == {None}
