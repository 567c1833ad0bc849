"""`pneumorph mesh`."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tests.mesh.decks import deck

from pneumorph.mesh import Imported
from pneumorph.solution.vtkhdf import read_mesh
from pneumorph.studies import load_study

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests" / "data"


@pytest.fixture(scope="module")
def script():
    """The script that drew the files of a finger with another CAD kernel."""
    spec = importlib.util.spec_from_file_location("finger_build123d", ROOT / "examples" / "cad" / "finger_build123d.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", ["finger_closed.step", "finger_closed.iges", "finger_closed.stl"])
def test_the_cavity_of_a_finger_from_another_cad_kernel_has_its_closed_form_volume(script, name):
    body = Imported(str(DATA / name), "mm" if name.endswith("stl") else None)
    assert body.cavities == ("cavity",)
    assert body.cavity_volume == pytest.approx(script.cavity_volume(inlet=False), rel=1e-9)


@pytest.mark.skipif(importlib.util.find_spec("build123d") is None, reason="needs the extra 'cad'")
def test_the_files_are_those_that_the_script_writes(script, tmp_path):
    # in a process of its own: two copies of Open CASCADE in one process crash
    subprocess.run([sys.executable, script.__file__, str(tmp_path)], check=True, capture_output=True)
    fresh, kept = (Imported(str(folder / "finger_inlet.step")) for folder in (tmp_path, DATA))
    assert fresh.mesh.cell_count == kept.mesh.cell_count
    assert np.ptp(fresh.body.points, axis=0) == pytest.approx(np.ptp(kept.body.points, axis=0), abs=1e-6)


def test_tables_picture_mesh_and_study_of_a_step_file(pneumorph, tmp_path):
    study = tmp_path / "mine.toml"
    result = pneumorph(
        "mesh", DATA / "finger_closed.step", "--out", tmp_path / "out", "--study", study, "--size", "4 mm"
    )
    assert result.exit_code == 0, result.stderr
    rows = {line.split()[0]: line for line in result.stdout.splitlines() if line.strip()}
    assert "2.08 mL" in rows["cavity"]
    assert "1416 mm²" in next(line for line in result.stdout.splitlines() if "1416" in line)
    assert "4.256 mL" in rows["body"]
    assert read_mesh(tmp_path / "out" / "mesh.vtkhdf").faces.keys() == {"cavity", "outer"}
    with Image.open(tmp_path / "out" / "faces.png") as picture:
        assert min(picture.size) > 500
    loaded = load_study(study)
    assert loaded.actuator.cavities == ("cavity",)
    assert {"clamp", "tip"} <= set(loaded.actuator.face_names)
    assert loaded.actuator.mesh.cell_count == read_mesh(tmp_path / "out" / "mesh.vtkhdf").cell_count
    again = pneumorph("mesh", DATA / "finger_closed.step", "--out", tmp_path / "out", "--study", study, "--no-picture")
    assert again.exit_code == 2
    assert "exists already" in again.stderr


def test_an_opening_is_pointed_out_and_a_study_that_caps_it_is_shown(pneumorph, tmp_path):
    result = pneumorph("mesh", DATA / "finger_inlet.step", "--out", tmp_path, "--no-picture")
    assert "Cavities: none" in result.stdout
    assert "a cap could close: (0, 0, 6) mm, rim 9.4 mm, 2.09 mL behind it" in result.stdout
    (tmp_path / "study.toml").write_text(
        f'[actuator]\nfile = "{DATA / "finger_inlet.step"}"\ncaps = {{ inlet = ["0 mm", "0 mm", "6 mm"] }}\n'
        '[material]\nname = "shore-a45-platinum"\n[[phase]]\ntargets = { cavity = "1 kPa" }\n'
    )
    result = pneumorph("mesh", tmp_path / "study.toml", "--out", tmp_path, "--no-picture")
    assert "by inlet" in result.stdout
    assert "2.0941" in result.stdout


def test_a_template_and_a_mesh_file_are_shown_too(pneumorph, tmp_path):
    result = pneumorph("mesh", "thick-tube", "--size", "coarse", "--out", tmp_path, "--no-picture")
    assert result.exit_code == 0
    assert "clamp" in result.stdout
    path = tmp_path / "body.inp"
    path.write_text(deck((3, 3, 3), ((1, 1, 1),)))
    result = pneumorph("mesh", path, "--unit", "cm", "--out", tmp_path, "--no-picture")
    assert "hexahedron27" in result.stdout
    assert "note: hexahedron: mid-edge nodes were added, since linear cells lock" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("body.inp",), "unit: missing"),
        (("body.inp", "--unit", "mile"), "unknown unit 'mile'"),
        (("body.inp", "--unit", "mm", "--size", "3"), "--size = '3': expected length with its unit"),
        (("body.inp", "--unit", "mm", "--size", "3 mm"), "is a mesh already"),
        (("body.obj",), "suffix of a geometry or mesh file '.obj'"),
        (("gone.step",), "there is no such file"),
        (("fingr",), "unknown template 'fingr': did you mean 'finger'"),
        (("finger", "--unit", "mm"), "--unit and more files go with CAD and mesh files only"),
        (("study.toml", "--size", "1 mm"), "leave --size out"),
        (("finger", "--size", "coarse", "--no-picture", "--study", "new.toml"), "--study goes with CAD and mesh files"),
        (("body.inp", "--unit", "mm", "--no-picture", "--study", "no/where.toml"), "cannot write"),
    ],
)
def test_bad_input_ends_with_one_message_and_code_2(pneumorph, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "body.inp").write_text(deck((1, 1, 1)))
    (tmp_path / "body.obj").write_text("v 0 0 0\n")
    result = pneumorph("mesh", *arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.count("error:") == 1
