"""Running a sweep: what is kept, what is computed again, and that one design never stops the rest."""

import csv
import json
from math import pi

import numpy as np
import pyarrow.parquet
import pytest
from tests.studies.sweeps.pretend import SPHERE, TWELVE, Pretend, history

from pneumorph.closed_form.thick_wall import sphere_inner_radius
from pneumorph.errors import NotConvergedError, StorageError
from pneumorph.materials import NeoHookean
from pneumorph.solution import Solution
from pneumorph.studies import load_study
from pneumorph.studies.sweeps import SweepFolder, Workers, run_sweep
from pneumorph.studies.sweeps.compute import Record, compute

TWO = '[parameters]\nactuator.outer_radius = ["13 mm", "15 mm"]\n'


class Here(Workers):
    """Compute in this process."""

    def compute(self, function, calls):
        for number, call in enumerate(calls):
            yield number, function(*call)


def test_the_table_holds_what_the_closed_form_says_of_each_design(sweep, tmp_path):
    made = sweep(TWO + '[results]\ninside = "volume:cavity"\n', SPHERE.replace('"2 kPa"', '"10 kPa"'))
    table = run_sweep(made, tmp_path / "out", workers=Here())
    radii = [sphere_inner_radius(NeoHookean(0.1), 10.0, outer, 0.01) for outer in (13.0, 15.0)]
    np.testing.assert_allclose(table.values("inside"), pi / 6.0 * np.array(radii) ** 3, rtol=0.01)
    assert table.statuses == ["done", "done"]
    notes = SweepFolder(tmp_path / "out").record(made.designs[0]).notes
    assert any("quadratic elements across" in note for note in notes)


def test_both_files_hold_the_same_numbers_with_their_units(sweep, tmp_path):
    made = sweep('[parameters]\nactuator.outer_radius = ["9 mm", "13 mm"]\nmesh.size = ["coarse"]\n')
    run_sweep(made, tmp_path / "out", workers=Pretend())
    with (tmp_path / "out" / "table.csv").open(newline="") as file:
        refused, done = list(csv.DictReader(file))
    parquet = pyarrow.parquet.read_table(tmp_path / "out" / "table.parquet").to_pylist()
    assert list(parquet[0]) == list(refused)
    assert done["pressure:cavity [kPa]"] == "2.0"
    assert done["actuator.outer_radius [mm]"] == "13.0"
    assert done["mesh.size"] == "coarse"
    np.testing.assert_allclose(parquet[1]["added_volume:cavity [mL]"], 0.007)
    assert refused["status"] == "refused"
    assert "leaves no wall" in refused["message"]
    assert refused["pressure:cavity [kPa]"] == ""
    assert parquet[0]["pressure:cavity [kPa]"] is None


def test_a_design_that_fails_is_a_row_with_its_reason_and_the_rest_goes_on(sweep, tmp_path):
    failed = Record("failed", "no mesh").plain()
    stopped = Record("stopped", "at 0.5", history(("inflate", 0.5, 0.001, 3.0))).plain()
    workers = Pretend(outcomes={0: failed, 1: stopped, 2: RuntimeError("out of memory")})
    table = run_sweep(sweep(TWELVE), tmp_path / "out", workers=workers)
    assert table.statuses == ["failed", "stopped", "failed", *["done"] * 9]
    messages = [row["message"] for row in table.rows.rows[:3]]
    assert messages == ["no mesh", "at 0.5", "its worker ended: RuntimeError: out of memory"]
    assert np.isnan(table.values("added_volume:cavity")[:3]).all()
    again = Pretend()
    table = run_sweep(sweep(TWELVE), tmp_path / "out", workers=again, resume=True)
    assert (again.asked, table.count("done")) == ([], 9)
    table = run_sweep(sweep(TWELVE), tmp_path / "out", workers=again, resume=True, retry=True)
    assert (len(again.asked), table.count("done")) == (3, 12)


def test_an_interrupted_sweep_keeps_its_table_and_computes_only_what_is_missing(sweep, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        run_sweep(sweep(TWELVE), tmp_path / "out", workers=Pretend(outcomes={5: KeyboardInterrupt}))
    with (tmp_path / "out" / "table.csv").open(newline="") as file:
        assert [row["status"] for row in csv.DictReader(file)] == ["done"] * 5 + ["not computed"] * 7
    again, news = Pretend(), []
    run_sweep(sweep(TWELVE), tmp_path / "out", workers=again, resume=True, progress=news.append)
    assert [call[0]["actuator"]["outer_radius"] for call in again.asked] == ["14 mm", *["15 mm"] * 3, *["16 mm"] * 3]
    assert [item.ended for item in news] == [5, 6, 7, 8, 9, 10, 11, 12]
    assert news[0].remaining is None
    assert news[-1].remaining == 0.0


def test_a_resumed_sweep_may_have_other_designs_and_other_results(sweep, tmp_path):
    run_sweep(sweep(TWO), tmp_path / "out", workers=Pretend())
    text = (
        '[parameters]\nactuator.outer_radius = ["15 mm", "14 mm"]\n[results]\npeak = { column = "added_volume:cavity", '
    )
    workers = Pretend()
    table = run_sweep(sweep(text + 'at = "maximum" }'), tmp_path / "out", workers=workers, resume=True)
    assert len(workers.asked) == 1
    assert table.values("peak").tolist() == [7.0, 7.0]


def test_equal_designs_are_computed_once_and_every_one_has_a_row(sweep, tmp_path):
    workers = Pretend()
    table = run_sweep(sweep('[parameters]\nmaterial.mu = ["100 kPa", "0.1 MPa"]'), tmp_path / "out", workers=workers)
    assert (len(workers.asked), table.statuses) == (1, ["done", "done"])


def test_a_result_may_be_called_like_a_parameter(sweep, tmp_path):
    made = sweep('[parameters]\nmaterial.mu = ["80 kPa", "0.1 MPa"]\n[results]\n"material.mu" = "pressure:cavity"')
    table = run_sweep(made, tmp_path / "out", workers=Pretend())
    np.testing.assert_allclose(table.values("material.mu"), [0.08, 0.1])
    assert table.values("result:material.mu").tolist() == [0.002, 0.002]


def test_a_folder_that_holds_a_sweep_is_refused_unless_it_is_resumed(sweep, tmp_path):
    run_sweep(sweep(TWO), tmp_path / "out", workers=Pretend())
    with pytest.raises(StorageError, match="already holds a sweep: resume it"):
        run_sweep(sweep(TWO), tmp_path / "out", workers=Pretend())


def test_a_folder_with_a_sweep_file_of_another_hand_is_left_alone(sweep, tmp_path):
    made = sweep(TWO)  # its own file lies there
    text = (tmp_path / "sweep.toml").read_text()
    with pytest.raises(StorageError, match=r"has a sweep\.toml but no designs: choose a folder of its own"):
        run_sweep(made, tmp_path, workers=Pretend(), resume=True)
    assert (tmp_path / "sweep.toml").read_text() == text


def test_half_written_files_are_removed_and_damaged_ones_named(sweep, tmp_path):
    made, place = sweep(TWO), SweepFolder(tmp_path / "out")
    run_sweep(made, place.path, workers=Pretend())
    part = place.of(made.designs[0]) / "design.json.part"
    part.write_text("{")
    run_sweep(made, place.path, workers=Pretend(), resume=True)
    assert not part.exists()
    file = part.with_name("design.json")
    file.write_text(json.dumps(json.loads(file.read_text()) | {"format": 99}))
    with pytest.raises(StorageError, match="format 99, this version reads 1"):
        place.record(made.designs[0])
    file.write_text("{")
    with pytest.raises(StorageError, match=r"is damaged.*remove it to compute the design again"):
        place.record(made.designs[0])


def test_every_design_keeps_its_study_and_history_and_the_whole_run_if_asked(sweep, tmp_path):
    made, place = sweep('keep_runs = true\n[parameters]\nmaterial.mu = ["80 kPa"]'), SweepFolder(tmp_path / "out")
    run_sweep(made, place.path, workers=Here())
    folder = place.of(made.designs[0])
    assert load_study(folder / "study.toml").materials["body"] == NeoHookean(0.08)
    assert (folder / "history.csv").read_text().startswith("index,phase,time,pressure:cavity [kPa]")
    assert len(Solution.open(folder / "run").states) == 2
    assert json.loads((folder / "design.json").read_text())["about"]["unknowns"] > 1000


@pytest.mark.parametrize(
    ("error", "message", "traced"),
    [
        (NotConvergedError("no equilibrium"), "no equilibrium", False),
        (ZeroDivisionError("oh"), "ZeroDivisionError: oh", True),
    ],
)
def test_whatever_a_design_raises_becomes_its_record(monkeypatch, sweep, error, message, traced):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("pneumorph.studies.sweeps.compute.run_study", fail)
    study = sweep(TWO).designs[0].study
    record = Record.of_plain(compute(study.resolved(), study.name, None))
    assert (record.status, record.message, "Traceback" in record.details) == ("failed", message, traced)
    assert record.about["versions"]["python"]
