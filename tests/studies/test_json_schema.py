"""The JSON schema that editors use: it takes what `load_study` takes, and refuses what it can see is wrong."""

import re
import tomllib
from pathlib import Path

import jsonschema
import pytest

from pneumorph.errors import InputError, StorageError
from pneumorph.materials import library
from pneumorph.studies import load_study, study_from
from pneumorph.studies.json_schema import DIALECT, SCHEMA_FILE, schema_text, study_schema, write_schema
from pneumorph.studies.measuring import names as measure_names
from pneumorph.studies.schema import LAWS, TEMPLATES
from pneumorph.units import KINDS, parse, show

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
FINGER = '[actuator]\ntemplate = "finger"\n'
PHASE = '\n[[phase]]\ntargets = { cavity = "10 kPa" }\n'
SCHEMA = study_schema()
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


def complaints(text):
    return [error.message for error in VALIDATOR.iter_errors(tomllib.loads(text))]


def tables():
    """Return (name, schema) of the whole and of every table in it."""
    return [("study", SCHEMA), *((k, v) for k, v in SCHEMA["$defs"].items() if v.get("type") == "object")]


def test_it_is_a_schema_of_its_dialect():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == DIALECT


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_is_valid_as_written_and_with_all_defaults(path):
    assert complaints(path.read_text(encoding="utf-8")) == []
    assert complaints(load_study(path).resolved_text()) == []


@pytest.mark.parametrize(
    "text",
    [
        FINGER + 'lenght = "9 mm"' + PHASE,
        FINGER + "[mehs]" + PHASE,
        FINGER + "length = 90" + PHASE,
        FINGER + 'length = "90"' + PHASE,
        FINGER + 'chambers = "7"' + PHASE,
        FINGER + '[mesh]\nsize = "3"' + PHASE,
        FINGER + '[mesh]\nsize = "fine"' + PHASE,
        FINGER + "[[phase]]\ntargets = { cavity = 3 }",
        FINGER + '[[phase]]\ntargets = { cavity = "3" }',
        FINGER + "[[phase]]\nname = 'x'",
        FINGER + PHASE + "[solver]\ntoleranse = 1e-6",
        FINGER + '[material]\nlaw = "yeo"' + PHASE,
        FINGER + '[material]\nlaw = "yeoh"\nc10 = "1 MPa"' + PHASE,
        FINGER + '[material]\nlaw = "yeoh"\nc10 = 1\nc20 = "1 MPa"' + PHASE,
        FINGER + '[[support]]\ntype = "clmp"\nface = "tip"' + PHASE,
        FINGER + '[[support]]\ntype = "roller"\nface = "tip"\naxis = "w"' + PHASE,
        FINGER + '[[load]]\ntype = "force"\nface = "tip"\ndirection = "down"\nname = "push"' + PHASE,
        FINGER + "[gravity]\ndirection = [0, 1]" + PHASE,
        'measures = ["tip_rotaton"]\n' + FINGER + PHASE,
        '[actuator]\ntemplate = "fingr"' + PHASE,
        PHASE,
    ],
)
def test_what_is_wrong_is_refused_by_the_schema_and_by_the_reader(text):
    assert complaints(text)
    with pytest.raises(InputError):
        study_from(tomllib.loads(text), "wrong")


def test_one_material_or_one_for_each_domain():
    one = '[material]\nlaw = "neo-hookean"\nmu = "1 MPa"'
    assert complaints(FINGER + one + PHASE) == []
    assert complaints(FINGER + one.replace("[material]", "[material.body]") + PHASE) == []


def test_every_key_has_a_meaning_and_no_table_takes_unknown_keys():
    for name, table in tables():
        assert table["additionalProperties"] is False, name
        assert table["description"], name
        for key, item in table["properties"].items():
            assert item.get("description"), f"{name}.{key}: describe it in the docstring of its class"


def test_defaults_stand_as_they_are_written_in_a_file():
    finger = SCHEMA["$defs"]["Finger"]["properties"]
    assert finger["length"]["default"] == "90 mm"
    assert finger["length"]["description"].startswith("whole length (L)")
    assert "null" not in schema_text().replace('"null"', "null")


def test_every_template_law_measure_and_library_material_is_offered():
    text = schema_text()
    for word in (*TEMPLATES, *LAWS, *measure_names(), *library.names()):
        assert f'"{word}"' in text, word


@pytest.mark.parametrize(
    "text", ["80 kPa", "-20 kPa", "1e-3 MPa", "0.1 N/mm^2", ".5 bar", " 3 psi", "2*MPa", "1.5e5 Pa"]
)
def test_the_pattern_takes_what_the_reader_of_units_takes(text):
    parse(text, "pressure")
    assert re.search(SCHEMA["$defs"]["PhaseSection"]["properties"]["targets"]["additionalProperties"]["pattern"], text)


@pytest.mark.parametrize("kind", KINDS)
def test_the_pattern_takes_every_printed_quantity(kind):
    pattern = SCHEMA["$defs"]["PhaseSection"]["properties"]["targets"]["additionalProperties"]["pattern"]
    for value in (0.0, 1.0, -2.5e-7, 3.25e12):
        assert re.search(pattern, show(value, kind)) or not KINDS[kind][1]


def test_it_is_written_into_a_file_or_refused(tmp_path):
    write_schema(tmp_path / SCHEMA_FILE)
    assert (tmp_path / SCHEMA_FILE).read_text(encoding="utf-8") == schema_text()
    with pytest.raises(StorageError, match="cannot write"):
        write_schema(tmp_path / "nowhere" / SCHEMA_FILE)
