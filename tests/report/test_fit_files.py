"""What a fit leaves behind."""

import csv
import json
import tomllib
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from pneumorph.errors import InputError, StorageError
from pneumorph.materials import MooneyRivlin, NeoHookean
from pneumorph.materials.fitting import SpecimenTest, model, rank
from pneumorph.materials.fitting.specimen import nominal_stress
from pneumorph.report.fit_figure import fit_figure
from pneumorph.report.fit_files import FILES, fragment, write_fit

LAW = MooneyRivlin(0.15, 0.02)


@pytest.fixture(scope="module")
def tests():
    stretch = np.linspace(1.1, 3.0, 12)
    return [SpecimenTest(mode, stretch, nominal_stress(LAW, mode, stretch), "made") for mode in ("uniaxial", "planar")]


@pytest.fixture(scope="module")
def ranking(tests):
    return rank(tests, [model(name) for name in ("neo-hookean", "mooney-rivlin", "yeoh", "ogden-1", "gent")])


def test_all_files_are_written_and_say_the_same(tmp_path, tests, ranking):
    write_fit(tmp_path / "new" / "fit", tests, ranking, {"options": {"weights": "equal"}})
    folder = tmp_path / "new" / "fit"
    assert {path.name for path in folder.iterdir()} == set(FILES)
    with (folder / "laws.csv").open() as file:
        laws = list(csv.reader(file))
    assert [row[0] for row in laws[1:]] == [item.model for item in ranking.fits]
    assert laws[1][1] == "c10 = 0.15 MPa; c01 = 0.02 MPa"
    with (folder / "curves.csv").open() as file:
        curves = list(csv.DictReader(file))
    assert len(curves) == 24
    assert all(float(row["nominal stress [MPa]"]) == pytest.approx(float(row["mooney-rivlin [MPa]"])) for row in curves)
    about = json.loads((folder / "fit.json").read_text())
    assert about["options"] == {"weights": "equal"}
    assert [test["points"] for test in about["tests"]] == [12, 12]
    assert (folder / "fit.png").read_bytes().startswith(b"\x89PNG")


def test_the_fragment_holds_the_recommended_law_and_the_others_as_comments(tests, ranking):
    text = fragment(tests, ranking)
    table = tomllib.loads(text)
    assert table["material"]["law"] == "mooney-rivlin"
    for item in ranking.fits[1:]:
        assert f"# {item.model}: R2 = " in text
    uncommented = text[text.index("# [material]") :].split("\n\n")[0].replace("# ", "")
    assert tomllib.loads(uncommented)["material"]["law"] in text


def test_an_unstable_law_says_so_in_the_fragment():
    stretch = np.linspace(1.1, 3.0, 12)
    test = SpecimenTest("uniaxial", stretch, nominal_stress(MooneyRivlin(0.25, -0.1), "uniaxial", stretch))
    text = fragment([test], rank([test], [model("mooney-rivlin")]))
    assert "mooney-rivlin: R2 = 1.00000, unstable: " in text
    assert "over stretch 1." in text


def test_the_figure_has_a_panel_for_each_test_and_comes_out_the_same_again(tests, ranking):
    first, second = (fit_figure(tests, ranking.fits) for _ in range(2))
    assert first == second
    panels = [item for item in ElementTree.fromstring(first).iter() if item.get("id", "").startswith("axes_")]
    assert len(panels) == 2


def test_a_figure_of_another_format_is_refused(tests, ranking):
    with pytest.raises(InputError, match="form = 'pdf', allowed: svg, png"):
        fit_figure(tests, ranking.fits, "pdf")


def test_a_folder_that_cannot_be_made_is_refused(tmp_path, tests, ranking):
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="file"):
        write_fit(tmp_path / "file" / "fit", tests, ranking, {})


def test_compression_is_drawn_too():
    stretch = np.linspace(0.6, 1.4, 20)
    tests = [SpecimenTest("uniaxial", stretch, NeoHookean(0.1).uniaxial_tension(stretch)) for _ in range(2)]
    assert fit_figure(tests, rank(tests, [model("neo-hookean")]).fits).startswith(b"<?xml")
