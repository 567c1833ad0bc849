"""`pneumorph fit`: the table, the files, the warnings; and every bad input with one message and exit code 2."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from pneumorph.materials import MooneyRivlin, Yeoh
from pneumorph.materials.fitting import MODELS
from pneumorph.studies import load_study

TRELOAR = Path(__file__).parents[2] / "examples" / "data" / "treloar.csv"
GOOD = "stretch [-],stress [MPa]\n" + "".join(
    f"{x:.3f},{Yeoh(0.11, 0.02).uniaxial_tension(x):.6f}\n" for x in np.linspace(1.0, 2.0, 21)
)


@pytest.fixture
def data(tmp_path):
    path = tmp_path / "rubber.csv"
    path.write_text(GOOD)
    return path


def test_treloars_data_give_a_table_of_all_laws_best_first(pneumorph, tmp_path):
    result = pneumorph("fit", TRELOAR, "--model", "all", "--out", tmp_path / "fit")
    assert result.exit_code == 0
    rows = [line.split() for line in result.stdout.splitlines() if line.split()[:1] and line.split()[0] in _NAMES]
    assert {row[0] for row in rows} == _NAMES
    # in a pipe of 80 columns no constant is cut off
    assert "…" not in result.stdout
    assert "mus = " in result.stdout
    differences = [float(re.findall(r"(\d+\.\d) +(?:yes|no|in the fit)", " ".join(row))[0]) for row in rows]
    assert differences[0] == 0.0
    assert differences == sorted(differences)
    r2 = {row[0]: float(re.search(r" (0\.\d{5}) ", " ".join(row))[1]) for row in rows}
    assert r2["extended-tube"] > 0.998 > r2["yeoh"] > 0.98 > r2["neo-hookean"]
    assert "warning: mooney-rivlin-5 is unstable inside its fit: uniaxial over stretch 5." in result.stderr
    assert "recommended: " in result.stderr


_NAMES = {item.name for item in MODELS}


def test_one_law_goes_from_data_to_a_study(pneumorph, data, tmp_path):
    out = tmp_path / "fit"
    result = pneumorph("fit", data, "--model", "yeoh-2", "--test", "uniaxial", "--out", out)
    assert result.exit_code == 0
    assert "c10 = 0.11 MPa" in result.stdout
    assert "only uniaxial data" in result.stderr
    study = tmp_path / "study.toml"
    rest = '\n[actuator]\ntemplate = "thick-sphere"\n[[phase]]\ntargets = { cavity = "1 kPa" }\n'
    study.write_text((out / "fit.toml").read_text() + rest)
    (material,) = load_study(study).materials.values()
    assert (material.c10, material.c20) == pytest.approx((0.11, 0.02), rel=1e-4)
    about = json.loads((out / "fit.json").read_text())
    assert about["options"]["test"] == "uniaxial"
    assert about["versions"]["pneumorph"]


def test_several_files_are_fitted_together_and_earlier_results_replaced(pneumorph, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    law = MooneyRivlin(0.15, 0.02)
    for mode, curve in (("uniaxial", law.uniaxial_tension), ("planar", law.planar_tension)):
        rows = "".join(f"{100 * (x - 1):.4f};{1000 * curve(x):.5f}\n".replace(".", ",") for x in np.linspace(1, 2.5, 9))
        (tmp_path / f"{mode}.csv").write_text(f"# test: {mode}\nstrain;stress\n{rows}")
    units = ("--strain-unit", "%", "--stress-unit", "kPa")
    for _ in range(2):
        result = pneumorph("fit", "uniaxial.csv", "planar.csv", "--model", "mooney-rivlin", *units)
        assert result.exit_code == 0
    table = tomllib.loads((tmp_path / "runs" / "fit-uniaxial" / "fit.toml").read_text())["material"]
    assert float(table["c01"].split()[0]) == pytest.approx(0.02, rel=1e-3)


def test_force_and_displacement_are_read_with_the_size_of_the_specimen(pneumorph, tmp_path):
    path = tmp_path / "machine.csv"
    law = Yeoh(0.11, 0.02)
    path.write_text(
        "Displacement [mm],Force [N]\n"
        + "".join(f"{25 * (x - 1):.5f},{12 * law.uniaxial_tension(x):.6f}\n" for x in np.linspace(1.0, 2.0, 21))
    )
    options = ("--test", "uniaxial", "--area", "12 mm2", "--length", "2.5 cm", "--model", "yeoh-2")
    result = pneumorph("fit", path, *options, "--out", tmp_path / "fit")
    assert result.exit_code == 0
    assert "c10 = 0.11 MPa" in result.stdout


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (GOOD, [], ["which test is it? Give --test"]),
        (GOOD, ["--test", "bending"], ["unknown test 'bending'", "Allowed: equibiaxial, planar, uniaxial"]),
        (GOOD, ["--test", "uniaxial", "--model", "yeo"], ["unknown model 'yeo': did you mean 'yeoh'?"]),
        (GOOD, ["--test", "uniaxial", "--stress", "cauchy"], ["stress = 'cauchy'", "engineering or true"]),
        (GOOD, ["--test", "uniaxial", "--branch", "mean"], ["needs an unloading"]),
        (GOOD, ["--test", "uniaxial", "--weights", "none"], ["unknown weighting 'none'"]),
        (GOOD, ["--test", "uniaxial", "--area", "12"], ["--area = '12'", "area with its unit"]),
        (GOOD.replace(" [MPa]", ""), ["--test", "uniaxial"], ["column 'stress' has no unit", "--stress-unit"]),
        (GOOD + "1.5,0.1\n1.9,0.2\n", ["--test", "uniaxial"], ["line 22 to", "and turns around"]),
        (GOOD.replace("1.200", "nan"), ["--test", "uniaxial"], ["line 6, column 'stretch [-]': 'nan'"]),
        (GOOD[:55], ["--test", "uniaxial", "--model", "yeoh"], ["yeoh has 3 constants, the tests 2 points"]),
    ],
)  # fmt: skip
def test_bad_data_and_options_are_refused(pneumorph, tmp_path, text, options, words):
    path = tmp_path / "rubber.csv"
    path.write_text(text)
    result = pneumorph("fit", path, *options, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    for word in words:
        assert word in result.stderr
    assert not (tmp_path / "out").exists()


def test_compression_alone_is_fitted_with_a_warning(pneumorph, tmp_path):
    path = tmp_path / "rubber.csv"
    law = Yeoh(0.11, 0.02)
    rows = "".join(f"{x:.3f},{law.uniaxial_tension(x):.6f}\n" for x in np.linspace(1.0, 0.5, 21))
    path.write_text(f"# test: uniaxial compression\nstretch,stress [MPa]\n{rows}")
    result = pneumorph("fit", path, "--model", "yeoh-2", "--out", tmp_path / "fit")
    assert result.exit_code == 0
    assert "warning: only compression" in result.stderr


def test_laws_with_too_many_constants_are_skipped_and_named(pneumorph, tmp_path):
    path = tmp_path / "rubber.csv"
    path.write_text("# test: uniaxial\nstretch,stress [MPa]\n1.2,0.1\n1.4,0.17\n1.7,0.25\n2,0.31\n")
    result = pneumorph("fit", path, "--out", tmp_path / "fit")
    assert result.exit_code == 0
    assert "skipped: ogden-4 has 8 constants, the tests 4 points" in result.stderr
