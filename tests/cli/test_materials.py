import json
import tomllib

import pytest

from pneumorph.cli.materials import fragment
from pneumorph.materials import library
from pneumorph.studies.study import study_from

STUDY = """
[actuator]
template = "finger"
[[phase]]
targets = { cavity = "10 kPa" }
"""


def test_the_library_is_listed_with_its_numbers(pneumorph):
    result = pneumorph("materials")
    assert result.exit_code == 0, result.stderr
    lines = result.stdout.splitlines()
    assert {line.split()[0] for line in lines[3:]} == set(library.names())
    row = next(line for line in lines if line.startswith("dragon-skin-30 "))
    # 86 psi over 1.75; three times that, a little less as the bulk modulus is finite; 500 psi
    for text in ("neo-hookean", "Shore A 30", "0.3388", "1.016", "1080", "3.447", "364", "Smooth-On"):
        assert text in row


def test_one_material_is_shown_with_the_origin_of_each_number(pneumorph):
    result = pneumorph("materials", "Elastosil-M4601")
    assert result.exit_code == 0, result.stderr
    assert "initial shear modulus 0.22 MPa" in result.stdout
    for name, value, origin, place in (
        ("c10", "0.11 MPa", "given", "(1)"),
        ("bulk", "1000 × shear modulus", "assumed", ""),
        ("elongation at break", "700 %", "given", "(2)"),
    ):
        row = next(line for line in result.stdout.splitlines() if line.startswith(name))
        assert value in row
        assert origin in row
        assert place in row
    assert "(1) Polygerinos et al." in result.stdout
    assert "(2) Wacker" in result.stdout
    assert "as copied or cited by others" in result.stdout


def test_numbers_that_were_not_read_again_say_so(pneumorph):
    assert "check before you rely on it" in pneumorph("materials", "smooth-sil-950").stdout


@pytest.mark.parametrize("name", library.names())
def test_the_fragment_stands_for_the_material_in_a_study_file(pneumorph, name):
    output = pneumorph("materials", name).stdout
    by_name, by_law = output.split("In a study file:")[1].split("# the same with its constants:")
    text = "\n".join(line.removeprefix("# ") for line in by_law.splitlines() if line.startswith("# "))
    for shown in (by_name, text):
        material = study_from(tomllib.loads(shown + STUDY), "own").materials["body"]
        assert material == library.material(name)


def test_the_terms_of_a_series_stand_in_a_list_in_the_fragment():
    terms = 'given = { mus = ["100 kPa", "-10 kPa"], alphas = ["2", "-2"] }'
    book = '[source.book]\ncite = "A book."\nshort = "Book"\nread = "original"\n'
    own = library.read(f'{book}[material.own]\nlaw = "ogden"\nsource = "book"\n{terms}')["own"]
    text = fragment(own).split("constants:\n")[1].replace("# ", "")
    assert study_from(tomllib.loads(text + STUDY), "own").materials["body"] == own.material


def test_several_materials_are_compared_and_drawn(pneumorph, tmp_path):
    path = tmp_path / "curves.png"
    result = pneumorph("materials", "ecoflex-00-30", "dragon-skin-30", "ecoflex-00-30", "--plot", path)
    assert result.exit_code == 0, result.stderr
    assert f"curves: {path}" in result.stdout
    assert path.read_bytes().startswith(b"\x89PNG")
    assert result.stdout.count("\necoflex-00-30 ") == 1


def test_nothing_is_written_unless_asked_for(pneumorph, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert pneumorph("materials", "pla").exit_code == 0
    assert list(tmp_path.iterdir()) == []


def test_json_holds_values_units_and_sources(pneumorph):
    (pla,) = json.loads(pneumorph("materials", "pla", "--json").stdout)
    assert (pla["name"], pla["law"]) == ("pla", "linear-elastic")
    assert pla["numbers"]["young"]["value"] == 3600.0
    assert pla["numbers"]["young"]["unit"] == "MPa"
    assert pla["numbers"]["density"]["value"] == pytest.approx(1240.0)
    assert pla["numbers"]["poisson"] | {"how": ""} == {
        "value": 0.36,
        "unit": "",
        "origin": "assumed",
        "how": "",
        "source": None,
        "read": None,
    }
    assert len(json.loads(pneumorph("materials", "--json").stdout)) == len(library.names())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ecoflex-0030",), "unknown material 'ecoflex-0030': did you mean 'ecoflex-00-30'"),
        (("--plot", "curves.png"), "--plot needs the names of the materials to draw"),
        (("pla", "--plot", "curves.jpg"), "--plot = 'curves.jpg', allowed: a file that ends in .png, .svg, .pdf"),
        (("pla", "--plot", "no/such/folder/curves.png"), "cannot write 'no/such/folder/curves.png': No such file"),
    ],
)
def test_bad_input_ends_with_one_message_and_code_2(pneumorph, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    result = pneumorph("materials", *arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stdout == ""
