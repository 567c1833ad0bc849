"""`pneumorph export`: what a suffix gives, which state is taken, and what is refused."""

import csv

import meshio
import numpy as np
import pytest
from netgen.occ import OCCGeometry

from pneumorph.cli.exporting import find_state
from pneumorph.errors import InputError
from pneumorph.solution import Solution
from pneumorph.studies import load_study, run_study

SPHERE = """
title = "Octant of a sphere"
[actuator]
template = "thick-sphere"
octant = true
[material]
law = "neo-hookean"
mu = "100 kPa"
[mesh]
size = "coarse"
[[phase]]
targets = { cavity = "20 kPa" }
first_increment = 0.5
largest_increment = 0.5
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of a run with states at 0, 10 and 20 kPa."""
    place = tmp_path_factory.mktemp("export")
    study = place / "sphere.toml"
    study.write_text(SPHERE)
    run_study(load_study(study), place / "run")
    return place / "run"


def refused(result, *words):
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    for word in words:
        assert word in result.stderr


def table(path):
    with path.open(newline="") as file:
        header, *lines = list(csv.reader(file))
    return dict(zip(header, zip(*lines, strict=True), strict=True))


def test_a_study_becomes_an_input_file_of_its_model(pneumorph, study, tmp_path):
    to = tmp_path / "sphere.inp"
    result = pneumorph("export", study, "--to", to, "--print", "outer")
    assert result.exit_code == 0, result.stderr
    assert result.stdout.startswith(f"{to}: ")
    assert " nodes, " in result.stdout
    assert " elements, 1 steps; " in result.stdout
    text = to.read_text()
    assert text.startswith("** Octant of a sphere\n")
    assert "\n*DSLOAD\nCAVITY, P, 0.02\n" in text
    assert "*NODE PRINT, NSET=OUTER" in text


def test_a_run_up_to_a_pressure_becomes_an_input_file_that_ends_there(pneumorph, run, tmp_path):
    to = tmp_path / "sphere.inp"
    assert pneumorph("export", run, "--to", to, "--state", "10 kPa", "--dialect", "abaqus").exit_code == 0
    text = to.read_text()
    assert "\n*DSLOAD\nCAVITY, P, 0.01\n" in text
    assert "C3D10H" in text
    assert pneumorph("export", run, "--to", to, "--force", "--pressures").exit_code == 0
    assert "*AMPLITUDE, NAME=P_CAVITY, TIME=TOTAL TIME\n0, 0, 0.5, 0.01, 1, 0.02\n" in to.read_text()


def test_bodies_are_written_in_the_state_that_is_asked_for(pneumorph, run, tmp_path):
    radii = {}
    for name, options in {
        "last": (),
        "first": ("--state", "0"),
        "mesh": ("--what", "mesh"),
        "half": ("--state", "0.01 MPa"),
    }.items():
        to = tmp_path / f"{name}.stl"
        result = pneumorph("export", run, "--to", to, *options)
        assert result.exit_code == 0, result.stderr
        data = np.frombuffer(to.read_bytes()[84:], dtype=[("v", "<f4", (4, 3)), ("a", "<u2")])["v"]
        radii[name] = np.linalg.norm(data[:, 1:], axis=-1).max()
    assert radii["first"] == radii["mesh"] == pytest.approx(15.0, abs=1e-3)
    assert radii["mesh"] < radii["half"] < radii["last"]


@pytest.mark.parametrize("kind", ["study", "run"])
def test_an_undeformed_template_keeps_its_exact_surfaces_in_step(pneumorph, study, run, tmp_path, kind):
    source, options = (study, ()) if kind == "study" else (run, ("--what", "mesh"))
    result = pneumorph("export", source, "--to", tmp_path / "ball.step", *options)
    assert result.exit_code == 0, result.stderr
    assert "exact surfaces" in result.stdout
    # an eighth of the shell between 10 and 15 mm
    exact = np.pi / 6.0 * (15.0**3 - 10.0**3)
    assert OCCGeometry(str(tmp_path / "ball.step")).shape.mass == pytest.approx(exact, rel=1e-6)


def test_step_vtu_and_tables_of_a_run(pneumorph, run, tmp_path):
    result = pneumorph("export", run, "--to", tmp_path / "ball.step")
    assert result.exit_code == 0, result.stderr
    assert "no CAD surfaces" in result.stdout
    assert OCCGeometry(str(tmp_path / "ball.step")).shape.mass > 0.0
    assert pneumorph("export", run, "--to", tmp_path / "ball.vtu", "--state", "1").exit_code == 0
    assert "Displacement" in meshio.read(tmp_path / "ball.vtu").point_data
    assert pneumorph("export", run, "--to", tmp_path / "nodes.csv").exit_code == 0
    assert "von_mises [MPa]" in table(tmp_path / "nodes.csv")
    assert pneumorph("export", run, "--to", tmp_path / "pv.csv", "--what", "pv", "--cavity", "cavity").exit_code == 0
    curve = table(tmp_path / "pv.csv")
    assert [float(value) for value in curve["pressure:cavity [Pa]"]] == pytest.approx([0.0, 1e4, 2e4])
    result = pneumorph("export", run, "--to", tmp_path / "history.csv", "--what", "history")
    assert result.stdout.startswith(f"{tmp_path / 'history.csv'}: 3 states")
    assert (tmp_path / "history.csv").read_text() == (run / "history.csv").read_text()


def test_a_file_that_is_there_is_kept_unless_forced(pneumorph, run, tmp_path):
    to = tmp_path / "ball.stl"
    to.write_text("mine")
    refused(pneumorph("export", run, "--to", to), "is there already", "--force")
    assert to.read_text() == "mine"
    assert pneumorph("export", run, "--to", to, "--force").exit_code == 0
    assert to.stat().st_size > 84


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--to", "x.obj"), ["unknown suffix '.obj'", ".csv, .inp, .step, .stl, .stp, .vtu"]),
        (("--to", "x"), ["unknown suffix ''"]),
        (("--to", "x.stl", "--what", "pv"), ["--what pv: allowed for .stl: state, mesh"]),
        (("--to", "x.stl", "--state", "7"), ["--state 7: the run has the states 0 to 2"]),
        (("--to", "x.stl", "--state", "15 kPa"), ["no state has that pressure; the nearest is 1, 10 kPa"]),
        (("--to", "x.stl", "--state", "3 mm"), ["--state 3 mm: expected 'last', a number, or a pressure"]),
        (("--to", "x.stl", "--part", "inner"), ["unknown part of a surface 'inner'"]),
        (("--to", "x.inp", "--state", "0"), ["state 0 is at rest"]),
        (("--to", "x.inp", "--dialect", "nastran"), ["unknown dialect 'nastran'"]),
        (("--to", "x.inp", "--print", "tip"), ["unknown face 'tip'"]),
        (("--to", "x.csv", "--what", "pv", "--cavity", "left"), ["unknown cavity 'left'"]),
        (("--to", "nowhere/x.vtu"), ["cannot write (there is no folder"]),
        (("--to", "nowhere/x.csv", "--what", "history"), ["x.csv cannot be written"]),
    ],
)
def test_bad_input_is_refused_with_one_message_and_nothing_written(pneumorph, run, tmp_path, options, words):
    _, name, *others = options
    refused(pneumorph("export", run, "--to", tmp_path / name, *others), *words)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "options", [("x.csv",), ("x.stl", "--state", "1"), ("x.stl", "--what", "state"), ("x.inp", "--pressures")]
)
def test_a_study_has_no_states_to_export(pneumorph, study, tmp_path, options):
    name, *others = options
    refused(pneumorph("export", study, "--to", tmp_path / name, *others), "is a study without states: run it")


def test_a_source_that_is_neither_study_nor_run_is_refused(pneumorph, tmp_path):
    refused(pneumorph("export", tmp_path / "none.toml", "--to", tmp_path / "x.stl"), "cannot read the study file")
    refused(pneumorph("export", tmp_path, "--to", tmp_path / "x.stl"), "is not the folder of a run")


def test_runs_without_states_or_cavities_have_no_state_by_pressure(run):
    class Empty:
        states = ()

    with pytest.raises(InputError, match="the run has no states yet"):
        find_state(Empty(), "last")
    solution = Solution.open(run)

    class Plain:
        states = solution.states

        class model:
            surfaces = ()

    with pytest.raises(InputError, match="the model has no cavity"):
        find_state(Plain(), "10 kPa")
