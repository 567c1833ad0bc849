"""Solving, keeping, resuming: the run folder gives back what was put in, and a break changes nothing."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError, NotConvergedError, StorageError, UnitError
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.measures import ReactionForce
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Model,
    Phase,
    Prescribed,
    Programme,
    Roller,
    Settings,
    State,
    Traction,
    VolumeSupply,
)
from pneumorph.mesh import box, rectangle
from pneumorph.solution import Solution, Status, read_csv, solve

MEASURES = (ReactionForce("x0"),)


def block():
    """A block of two domains' worth of features: a moved face, a dead load, a density."""
    return Model(
        box(2, 1, 1, lengths=(2.0, 1.0, 1.0), bending_walls={"wall": 1.0}),
        {"body": Yeoh(0.11, 0.03, density=1.1e-9)},
        (Clamp("x0"), Prescribed("x1", "x", "pull")),
        (Traction("y1", (0.0, 1.0, 0.0), "lift"),),
    )


def ring():
    """A ring in axial symmetry, inflated by volume."""
    mesh = rectangle(2, 1, lambda p: np.add(p, [3.0, 0.0]), space="axisymmetric")
    cavity = Cavity("cavity", ("left",), VolumeSupply(), mirrors=("bottom", "top"))
    return Model(mesh, {"body": NeoHookean(0.1)}, (Roller("bottom", "y"), Roller("top", "y")), (), (cavity,))


PROGRAMME = Programme((Phase("pull", {"pull": 0.4}, marks=(0.5,), first=0.2), Phase("lift, then hold", {"lift": 5e-3})))
INFLATE = Programme((Phase("inflate", {"cavity": 10.0}, first=0.2),))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs") / "whole"
    return solve(block(), PROGRAMME, measures=MEASURES, folder=folder, about={"title": "a block"})


def assert_same(first: State, second: State):
    for item in fields(State):
        a, b = getattr(first, item.name), getattr(second, item.name)
        if item.name == "model":
            continue
        if isinstance(a, np.ndarray):
            np.testing.assert_array_equal(a, b)
        elif isinstance(a, list):
            for x, y in zip(a, b, strict=True):
                np.testing.assert_array_equal(x, y)
        elif item.name == "energies":
            assert vars(a) == vars(b)
        else:
            assert a == b, item.name


def test_an_opened_folder_gives_the_same_objects_bit_for_bit(whole):
    opened = Solution.open(whole.folder)
    assert opened.status is Status.DONE
    assert opened.about == {"title": "a block"}
    assert len(opened.states) == len(whole.states) == len(opened.history) > 8
    for first, second in zip(whole.states, opened.states, strict=True):
        assert_same(first, second)
    assert opened.states[-1].time == 2.0
    assert [state.index for state in opened.states[2:4]] == [2, 3]
    model, mesh = opened.model, opened.model.mesh
    given = block()
    np.testing.assert_array_equal(mesh.points, given.mesh.points)
    np.testing.assert_array_equal(mesh.blocks[0].nodes, given.mesh.blocks[0].nodes)
    assert list(mesh.faces) == list(given.mesh.faces)
    for name, faces in given.mesh.faces.items():
        for a, b in zip(faces, mesh.faces[name], strict=True):
            assert a.kind == b.kind
            np.testing.assert_array_equal(a.nodes, b.nodes)
    assert (mesh.space, dict(mesh.bending_walls)) == ("3d", {"wall": 1.0})
    assert (model.materials, model.supports, model.loads) == (given.materials, given.supports, given.loads)
    assert opened.programme == PROGRAMME
    for column in whole.history.columns:
        np.testing.assert_array_equal(opened.history.values(column.key), whole.history.values(column.key))
    assert opened.meta["mesh"]["cells"] == 12
    assert opened.meta["versions"]["numpy"] == np.__version__
    assert opened.meta["iterations"] == whole.history.values("iterations").sum()
    assert opened.meta["wall_time"] > 0.0


def test_a_model_with_a_cavity_in_axial_symmetry_comes_back(tmp_path):
    solution = solve(ring(), INFLATE, folder=tmp_path / "ring")
    opened = Solution.open(tmp_path / "ring")
    assert opened.model.cavities == ring().cavities
    assert_same(opened.states[-1], solution.states[-1])
    assert opened.history.values("added_volume:cavity")[-1] == pytest.approx(10.0, rel=1e-7)
    assert opened.history.column("pressure:cavity").header == "pressure:cavity [kPa]"
    in_memory = solve(ring(), INFLATE)
    assert in_memory.folder is None
    assert_same(in_memory.states[-1], solution.states[-1])


def test_the_csv_holds_all_digits_in_printed_units(whole):
    table = read_csv(whole.folder / "history.csv")
    assert table["phase"][-1] == "lift, then hold"
    np.testing.assert_array_equal(table["reaction_force [N]"], whole.history.values("reaction_force"))
    np.testing.assert_array_equal(table["value:pull [mm]"], whole.history.values("value:pull"))
    assert table["value:pull [mm]"][-1] == 0.4
    assert list(whole.history.values("phase")[:2]) == ["rest", "pull"]
    with pytest.raises(NameNotFoundError, match="reaction_force"):
        whole.history.values("reaction_forc")


def test_pyvista_reads_a_state_with_its_linked_geometry(whole):
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.read(whole.folder / "states" / "state_00003.vtkhdf")
    mesh = whole.model.mesh
    np.testing.assert_array_equal(grid.points, mesh.points)
    np.testing.assert_array_equal(grid.cell_connectivity.reshape(-1, 10), mesh.blocks[0].nodes)
    np.testing.assert_array_equal(grid.point_data["Displacement"], whole.states[3].displacement)
    assert {"VonMises", "LargestPrincipalStress", "LargestStretch"} <= set(grid.point_data.keys())
    assert "Domain" in grid.cell_data
    assert pyvista.read(whole.folder / "mesh.vtkhdf").n_cells == 12


class Stop(Exception):
    pass


def stop_after(count):
    def progress(now):
        if now.state.index == count:
            raise Stop

    return progress


@pytest.mark.parametrize("count", [0, 1, 4, 7])
def test_a_resumed_run_equals_the_uninterrupted_one(whole, tmp_path, count):
    folder = tmp_path / "run"
    with pytest.raises(Stop):
        solve(block(), PROGRAMME, measures=MEASURES, folder=folder, progress=stop_after(count))
    assert Solution.open(folder).status is Status.RUNNING
    (folder / "states" / "state_00099.vtkhdf.part").write_bytes(b"half")
    (folder / "history.csv").write_text("half a li")
    seen = []
    again = solve(block(), PROGRAMME, measures=MEASURES, folder=folder, resume=True, progress=seen.append)
    assert seen[0].state.index == count
    assert seen[-1].fraction == 1.0
    assert seen[-1].total_iterations == whole.meta["iterations"]
    assert not list(folder.glob("**/*.part"))
    assert (folder / "history.csv").read_bytes() == (whole.folder / "history.csv").read_bytes()
    for first, second in zip(whole.states, again.states, strict=True):
        assert_same(first, second)


SCRIPT = """
import sys
sys.path.insert(0, {tests!r})
from test_solve import MEASURES, PROGRAMME, block
from pneumorph.solution import solve
solve(block(), PROGRAMME, measures=MEASURES, folder={folder!r})
"""


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL is of POSIX systems")
def test_a_run_killed_at_any_moment_is_resumed(whole, tmp_path):
    folder = tmp_path / "killed"
    script = SCRIPT.format(tests=str(Path(__file__).parent), folder=str(folder))
    process = subprocess.Popen([sys.executable, "-c", script])
    try:
        end = time.monotonic() + 60.0
        while process.poll() is None and time.monotonic() < end and not list(folder.glob("states/*2.vtkhdf")):
            time.sleep(0.001)
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert list(folder.glob("states/*2.vtkhdf"))
    solution = solve(block(), PROGRAMME, measures=MEASURES, folder=folder, resume=True)
    assert solution.status is Status.DONE
    for key in solution.history.keys:
        if key != "phase":
            np.testing.assert_allclose(
                solution.history.values(key), whole.history.values(key), rtol=1e-8, atol=1e-12, err_msg=key
            )


def test_a_finished_run_is_returned_at_once(whole):
    def never(now):
        raise AssertionError("nothing to solve")

    again = solve(block(), PROGRAMME, measures=MEASURES, folder=whole.folder, resume=True, progress=never)
    assert again.status is Status.DONE
    assert len(again.states) == len(whole.states)


def test_a_run_is_not_written_over(whole):
    with pytest.raises(StorageError, match="already holds a run: resume it"):
        solve(block(), PROGRAMME, folder=whole.folder)


def test_a_run_of_something_else_is_not_resumed(whole):
    def resume(model=None, programme=PROGRAMME, measures=MEASURES, settings=None):
        arguments = {"measures": measures, "folder": whole.folder, "resume": True, "settings": settings}
        return solve(model or block(), programme, **arguments)

    with pytest.raises(StorageError, match=r"model\.materials\.body\.c20 = 0\.02, the folder holds 0\.03"):
        resume(replace(block(), materials={"body": Yeoh(0.11, 0.02, density=1.1e-9)}))
    with pytest.raises(StorageError, match=r"programme\.phases\[0\]\.targets\.pull = 0\.5, the folder holds 0\.4"):
        resume(programme=Programme((replace(PROGRAMME.phases[0], targets={"pull": 0.5}), PROGRAMME.phases[1])))
    with pytest.raises(StorageError, match="the mesh differs"):
        resume(replace(block(), mesh=box(3, 1, 1, lengths=(2.0, 1.0, 1.0), bending_walls={"wall": 1.0})))
    with pytest.raises(StorageError, match=r"settings\.tolerance"):
        resume(settings=Settings(tolerance=1e-9))
    with pytest.raises(StorageError, match=r"measures\.reaction_force is gone"):
        resume(measures=())
    with pytest.raises(StorageError, match=r"model\.supports = .*Roller"):
        resume(replace(block(), supports=(*block().supports, Roller("x0", "x"))))


def test_a_solve_that_stops_keeps_its_states(tmp_path):
    steep = Programme(
        (Phase("pull", {"pull": 0.4, "lift": 0.0}, smallest=0.05), Phase("lift", {"lift": 50.0}, smallest=0.05))
    )
    with pytest.raises(NotConvergedError, match="stopped in phase 'lift'") as caught:
        solve(block(), steep, folder=tmp_path / "run", settings=Settings(relaxations=1))
    assert caught.value.solution.status is Status.STOPPED
    opened = Solution.open(tmp_path / "run")
    assert opened.status is Status.STOPPED
    assert "stopped in phase 'lift'" in opened.message
    assert opened.states[-1].time >= 1.0
    quiet = solve(block(), steep, settings=Settings(relaxations=1), raise_on_stop=False)
    assert quiet.status is Status.STOPPED


@dataclass(frozen=True)
class Odd:
    name: str = "odd"
    kind: str = "number"

    def __call__(self, state):
        return 1.0


def test_wrong_arguments_are_refused_before_anything_is_written(tmp_path):
    folder = tmp_path / "run"
    with pytest.raises(InputError, match="needs the folder"):
        solve(block(), PROGRAMME, resume=True)
    with pytest.raises(InputError, match="measure 'iterations': the name is taken"):
        solve(block(), PROGRAMME, measures=(Odd("iterations"),), folder=folder)
    with pytest.raises(UnitError, match="'nmber'"):
        solve(block(), PROGRAMME, measures=(Odd(kind="nmber"),), folder=folder)
    with pytest.raises(NameNotFoundError, match="face 'x9'"):
        solve(block(), PROGRAMME, measures=(ReactionForce("x9"),), folder=folder)
    with pytest.raises(InputError, match="about"):
        solve(block(), PROGRAMME, about={"title": object()}, folder=folder)
    with pytest.raises(NameNotFoundError, match="target 'cavity'"):
        solve(block(), INFLATE, folder=folder)
    assert not folder.exists()


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match=r"file/run.*cannot be made"):
        solve(block(), PROGRAMME, folder=tmp_path / "file" / "run")


def test_resume_starts_where_a_kill_came_before_the_first_record(whole, tmp_path):
    (tmp_path / "run" / "states").mkdir(parents=True)
    (tmp_path / "run" / "mesh.vtkhdf").write_bytes((whole.folder / "mesh.vtkhdf").read_bytes())
    assert solve(ring(), INFLATE, folder=tmp_path / "run", resume=True).status is Status.DONE


def damaged(whole, tmp_path):
    """A copy of the run, to be damaged."""
    import shutil

    return Path(shutil.copytree(whole.folder, tmp_path / "copy"))


def test_missing_and_damaged_files_are_named(whole, tmp_path):
    with pytest.raises(StorageError, match=r"run\.json is missing"):
        Solution.open(tmp_path / "nothing")
    folder = damaged(whole, tmp_path)
    (folder / "states" / "state_00002.vtkhdf").write_bytes(b"no")
    with pytest.raises(StorageError, match=r"state_00002\.vtkhdf is damaged"):
        Solution.open(folder)
    (folder / "states" / "state_00002.vtkhdf").unlink()
    with pytest.raises(StorageError, match=r"state_00002\.vtkhdf is missing"):
        Solution.open(folder)
    (folder / "mesh.vtkhdf").unlink()
    with pytest.raises(StorageError, match=r"mesh\.vtkhdf is missing"):
        Solution.open(folder)
    with pytest.raises(StorageError, match=r"history\.csv cannot be read"):
        read_csv(folder / "none" / "history.csv")
    (folder / "history.csv").write_text("a,b\n1\n")
    with pytest.raises(StorageError, match="expected 2 values"):
        read_csv(folder / "history.csv")


def test_a_state_of_another_mesh_and_another_mesh_are_refused(whole, tmp_path):
    solve(ring(), INFLATE, folder=tmp_path / "ring")
    folder = damaged(whole, tmp_path)
    state = Path("states") / "state_00001.vtkhdf"
    (folder / state).write_bytes((tmp_path / "ring" / state).read_bytes())
    opened = Solution.open(folder)
    with pytest.raises(StorageError, match=r"state_00001\.vtkhdf is damaged or not the state.*nodes"):
        opened.states[1]
    (folder / "mesh.vtkhdf").write_bytes((tmp_path / "ring" / "mesh.vtkhdf").read_bytes())
    with pytest.raises(StorageError, match=r"mesh\.vtkhdf is not the mesh"):
        Solution.open(folder)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("format", 99, "has format 99"),
        ("status", "fine", "is damaged: 'fine'"),
        ("model", {"pressure": "constant"}, "model cannot be restored"),
        ("model", {"materials": {"body": {"$class": "Popen"}}}, "unknown class in a run folder 'Popen'"),
        ("model", {"materials": {"body": {"$class": "Yeoh", "c10": -1.0}}}, "Yeoh cannot be restored"),
        ("programme", {"$class": "Popen"}, "programme cannot be restored"),
        ("programme", {"$class": "Clamp", "face": "x0"}, "holds no programme"),
        ("columns", [{"key": 1}], "columns cannot be restored"),
    ],
)
def test_a_damaged_record_is_refused(whole, tmp_path, key, value, message):
    folder = damaged(whole, tmp_path)
    record = json.loads((folder / "run.json").read_text())
    (folder / "run.json").write_text(json.dumps(record | {key: value}))
    with pytest.raises(StorageError, match=message):
        Solution.open(folder)
    (folder / "run.json").write_text("{")
    with pytest.raises(StorageError, match=r"run\.json is damaged"):
        Solution.open(folder)
