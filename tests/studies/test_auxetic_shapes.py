"""The programmed shapes: those of the examples, what is measured on them, and the command that inflates them all."""

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from pneumorph.cli.app import app
from pneumorph.errors import EngineError, InputError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Clamp, Model
from pneumorph.mechanics.state import rest
from pneumorph.mesh import Mesh, box
from pneumorph.report import shapes as report
from pneumorph.solution import Column, History, Solution, Status
from pneumorph.studies import load_study, study_from
from pneumorph.studies.reproductions import auxetic_shapes as part
from pneumorph.studies.reproductions.auxetic_shapes import SHAPES, Shape, ShapeSegment, ShapesStudy

EXAMPLES = Path(__file__).parents[2] / "examples" / "shapes"
LENGTH = 40.0


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_is_the_one_of_the_examples(name):
    example, made = load_study(EXAMPLES / f"{name}.toml"), SHAPES[name].study
    assert made.actuator.cells == example.actuator.cells
    assert made.actuator.half is example.actuator.half
    assert made.title == example.title
    for same in ("materials", "programme", "measures"):
        assert getattr(made, same) == getattr(example, same), same
    assert made.file.mesh == example.file.mesh


@pytest.fixture(scope="module")
def beam():
    mesh = box(2, 2, 40, mapping=lambda p: p - [1.0, 1.0, 0.0], lengths=(2.0, 2.0, LENGTH))
    sides = tuple(block for name in ("x0", "x1", "y0", "y1") for block in mesh.faces[name])
    faces = {"clamp": mesh.faces["z0"], "tip": mesh.faces["z1"], "outer": sides}
    return Model(Mesh(mesh.points, mesh.blocks, faces), {"body": NeoHookean(0.1)}, (Clamp("clamp"),))


def test_segments_turn_by_their_shares_of_a_circle_and_keep_their_width(beam):
    angle = -0.8  # away from x
    x, y, z = beam.mesh.points.T
    radius = LENGTH / angle
    turn = z / radius
    place = np.column_stack([2 * radius * np.sin(turn / 2) ** 2 + x * np.cos(turn), y, (radius - x) * np.sin(turn)])
    state = replace(rest(beam), displacement=place - beam.mesh.points)
    shape = replace(SHAPES["finger"], segments=(ShapeSegment(2), ShapeSegment(4), ShapeSegment(2)))
    turns = part.turns(state, shape)
    assert np.degrees(-turns[:, 1]) == pytest.approx(np.degrees(0.8) * np.array([0.25, 0.5, 0.25]), rel=0.02)
    assert np.abs(turns[:, [0, 2]]).max() < 1e-3  # quadrature of slices is not the same on both sides
    assert part.widths(state, shape) == pytest.approx(2.0 * np.sqrt(2.0), rel=2e-3)
    assert "segments turn by 11.5, 22.9, 11.5 deg, are 2.8" in part.described(shape, turns, np.full(3, 2.83))


# degrees that segments turn away from x, widths: as the study shows each shape, and not so
SHOWN = {
    "finger": ([20, 10, 2], [1] * 3), "trunk": ([12, -12], [1, 1]), "s": ([12, -11], [1, 1]),
    "c": ([20, 15], [1, 1]), "u": ([2, 30, -2], [1] * 3), "tentacle": ([1, 8, 8, 8, 1], [35, 36, 35, 34, 32]),
    "trunk-out-of-plane": ([12, 0], [1, 1]),
}  # fmt: skip
OTHERWISE = {
    "finger": ([20, 10, 12], [1] * 3), "trunk": ([12, 12], [1, 1]), "s": ([-12, 11], [1, 1]),
    "c": ([20, 5], [1, 1]), "u": ([9, 30, -2], [1] * 3), "tentacle": ([1, 8, 8, 8, 1], [35, 36, 37, 34, 32]),
    "trunk-out-of-plane": ([12, 0], [1, 1]),
}  # fmt: skip


def vectors(name, angles, second):
    turns = np.zeros((len(angles), 3))
    turns[:, 1] = -np.radians(angles)
    if name == "trunk-out-of-plane":
        turns[1] = np.radians(second)
    return turns


def solution(stress=(0.5, 5.0), status=Status.DONE):
    columns = [Column(f"peak_principal_stress:{domain}", domain, "stress") for domain in part.STRESSES]
    row = dict(zip((column.key for column in columns), stress, strict=True))
    return SimpleNamespace(status=status, states=[None], history=History(columns, [row]))


@pytest.mark.parametrize(("cases", "second", "holds"), [(SHOWN, [12, 3, 0], True), (OTHERWISE, [0, 12, 0], False)])
def test_a_shape_counts_if_its_segments_turn_as_the_study_shows(monkeypatch, cases, second, holds):
    for name, (angles, width) in cases.items():
        monkeypatch.setattr(part, "turns", lambda state, shape, n=name, a=angles: vectors(n, a, second))
        monkeypatch.setattr(part, "widths", lambda state, shape, w=width: np.array(w, dtype=float))
        monkeypatch.setattr(ShapesStudy, "shapes", property(lambda self, n=name: (SHAPES[n],)))
        found = part.shape_findings(ShapesStudy(), {name: solution()})
        assert [f.holds for f in found] == [holds, True, True], name
        largest = np.degrees(np.linalg.norm(vectors(name, angles, second), axis=1).max())
        assert found[0].row.computed == pytest.approx(largest)


def test_stresses_out_of_the_reported_range_and_runs_that_stopped_do_not_count(monkeypatch):
    monkeypatch.setattr(part, "turns", lambda state, shape: vectors("c", [10, 10], 0))
    monkeypatch.setattr(part, "widths", lambda state, shape: np.ones(2))
    one = ShapesStudy()
    monkeypatch.setattr(ShapesStudy, "shapes", property(lambda self: (SHAPES["c"],)))
    holds = lambda given: [f.holds for f in part.shape_findings(one, given)]  # noqa: E731
    assert holds({"c": solution((0.39, 6.1))}) == [True, False, False]
    assert holds({"c": solution(status=Status.STOPPED)}) == [None, None, None]
    assert holds({}) == [None, None, None]


def test_trunk_and_s_are_computed_once():
    study = ShapesStudy()
    assert len(study.shapes) == 7
    assert "s" not in {run.name for run in study.runs}
    assert study.run_of(SHAPES["s"]) is SHAPES["trunk"]
    assert {run.name for run in ShapesStudy(quick=True).runs} == set(part.QUICK)


class Tiny(Shape):
    """Two rows, a little pressure, one increment."""

    @cached_property
    def study(self):
        table = Shape.study.func(self).resolved()
        table["actuator"]["length"] = "29.8 mm"
        table["phase"] = [{"targets": {"cavity": "0.5 kPa"}, "first_increment": 1.0, "largest_increment": 1.0}]
        return study_from(table, self.name)


@pytest.fixture
def tiny(monkeypatch):
    """One shape of two rows, and no pictures."""
    rows = tuple(ShapeSegment(1) for _ in range(2))
    shape = Tiny("c", "Tiny C", 0.028, rows, "two segments bend alike to one side")
    monkeypatch.setattr(ShapesStudy, "shapes", property(lambda self: (shape,)))

    def fail():
        raise EngineError("no OpenGL here")

    monkeypatch.setattr(report, "check", fail)


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)


def test_the_command_inflates_reports_resumes_and_reports_anew(tiny, tmp_path, monkeypatch):
    command = ("reproduce", "auxetic-skin", "--part", "shapes", "--quick", "--out", tmp_path / "out")
    result = run(*command)
    assert result.exit_code == 0, result.output
    assert "of 3 statements of the study hold" in result.output
    lines = (tmp_path / "out" / "comparison.csv").read_text().splitlines()
    assert len(lines) == 4
    assert "segments turn by" in lines[1]
    page = tmp_path / "out" / "report.html"
    assert "no OpenGL here" in page.read_text()
    again = run(*command)
    assert again.exit_code == 2
    assert "already holds a run: resume it (--resume)" in again.output
    other = run("reproduce", "auxetic-skin", "--part", "shapes", "--out", tmp_path / "out", "--resume")
    assert other.exit_code == 2
    assert "holds another run of this part, see its shapes.json" in other.output
    page.unlink()
    seen = []
    resumed = lambda study, folder, **given: seen.append(given["resume"]) or Solution.open(folder)  # noqa: E731
    monkeypatch.setattr("pneumorph.cli.shapes.run_study", resumed)
    assert run(*command, "--resume").exit_code == 0
    assert seen == [True]
    page.unlink()
    result = run("report", tmp_path / "out")
    assert result.exit_code == 0
    assert page.exists()
    assert (tmp_path / "out" / "comparison.csv").read_text().splitlines() == lines


def test_a_damaged_or_empty_folder_is_refused(tiny, tmp_path):
    (tmp_path / "shapes.json").write_text("{}")
    result = run("report", tmp_path)
    assert result.exit_code == 2
    assert "shapes.json is damaged: no 'quick'" in result.output
    (tmp_path / "shapes.json").write_text("{")
    assert "shapes.json cannot be read" in run("report", tmp_path).output
    with pytest.raises(InputError, match="holds no converged state"):
        report.write_shapes_report(tmp_path, ShapesStudy(True), {}, ())


def test_ctrl_c_says_how_to_go_on(tiny, tmp_path, monkeypatch):
    from pneumorph.cli import shapes

    def stop(*given, **settings):
        raise KeyboardInterrupt

    monkeypatch.setattr(shapes, "run_study", stop)
    result = run("reproduce", "auxetic-skin", "--part", "shapes", "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert "go on with: pneumorph reproduce auxetic-skin --part shapes" in result.output


@pytest.mark.parametrize("name", ["finger", "u"])
def test_the_assumed_beam_leaves_the_published_cells_as_they_are(name):
    """cg = 0.2 makes wider oblique beams by itself; its rows touch no row that the assumption changes."""
    kept = SHAPES[name].study.actuator.tube.lattice
    plain = replace(SHAPES[name], least_beam=0.0).study.actuator.tube.lattice
    for hole, published in zip(kept.holes, plain.holes, strict=True):
        same = np.array_equal(hole.corners, published.corners)
        assert same is (kept.cells[hole.row // 2][hole.place].cg == 0.2)
