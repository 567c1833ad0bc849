"""Maps of skins by segments in study files, and the programmed shapes among the examples."""

import json
import tomllib
from pathlib import Path

import pytest

from pneumorph.errors import GeometryError, NameNotFoundError, StudyError
from pneumorph.geometry.bending_skin import SkinSegment
from pneumorph.studies import load_study, study_from
from pneumorph.studies.json_schema import study_schema

SHAPES = Path(__file__).parents[2] / "examples" / "shapes"
# Pu et al. 2024: shape -> pressure, kPa; whether it has a mirror plane
REPORTED = {
    "finger": (28, True), "trunk": (28, True), "trunk-out-of-plane": (28, False), "s": (28, True), "c": (28, True),
    "u": (30, True), "tentacle": (25, True),
}  # fmt: skip
TEXT = """
[actuator]
template = "skinned-tube"
cells_along = 3
blend = {blend}
[[actuator.segment]]
rows = 1
[[actuator.segment]]
rows = 2
cg = 0.4
turn = 3
columns = {columns}
[[phase]]
targets = {{ cavity = "1 kPa" }}
"""


def study(columns='[[6, "re-entrant"], [6, "honeycomb"]]', blend=0):
    return study_from(tomllib.loads(TEXT.format(columns=columns, blend=blend)), "x")


def test_a_study_file_gives_the_map_by_segments():
    assert study().actuator.segment == (
        SkinSegment(1),
        SkinSegment(2, ((6, "re-entrant"), (6, "honeycomb")), cg=0.4, turn=3),
    )


def test_the_resolved_study_makes_the_same_map():
    first = study()
    again = study_from(tomllib.loads(first.resolved_text()), "x")
    assert again.actuator == first.actuator
    assert again.resolved() == first.resolved()


@pytest.mark.parametrize(
    ("columns", "error", "message"),
    [
        ('"all"', StudyError, r"actuator.segment\[2\].columns: 'all': expected pairs of a whole number and a name"),
        ('[["six", "brick"]]', StudyError, "expected pairs of a whole number and a name, as"),
        ('[[6, "re-entrent"]]', StudyError, "unknown kind 're-entrent': did you mean 're-entrant'"),
        ("[]", GeometryError, "no runs of cells around"),
        ('[[5, "brick"]]', GeometryError, "segment 2 has 5 columns: expected cells_around = 12"),
    ],
)
def test_a_wrong_run_is_refused_with_its_place(columns, error, message):
    with pytest.raises(error, match=message):
        study(columns)


def test_an_unknown_key_of_a_segment_is_refused():
    table = tomllib.loads(TEXT.format(columns='[[12, "brick"]]', blend=0).replace("turn", "trun"))
    with pytest.raises(StudyError, match="'trun': did you mean 'turn'"):
        study_from(table, "x")


def test_the_schema_knows_segments_and_their_kinds():
    schema = study_schema()
    segment = schema["$defs"]["SkinSegment"]["properties"]
    assert set(segment) == {"rows", "columns", "cg", "turn"}
    assert '"enum": ["re-entrant", "honeycomb", "brick"]' in json.dumps(segment["columns"])


def test_stress_can_be_asked_of_one_domain():
    table = tomllib.loads(TEXT.format(columns='[[12, "brick"]]', blend=0))
    made = study_from(table | {"measures": ["peak_principal_stress:skin"]}, "x").measures
    assert [(m.name, m.domain) for m in made] == [("peak_principal_stress:skin", "skin")]
    with pytest.raises(NameNotFoundError, match="unknown domain 'skn': did you mean 'skin'"):
        study_from(table | {"measures": ["peak_principal_stress:skn"]}, "x")
    with pytest.raises(NameNotFoundError, match="unknown measure 'tip_rotation:skin'"):
        study_from(table | {"measures": ["tip_rotation:skin"]}, "x")


def test_the_reported_shapes_are_among_the_examples():
    assert {path.stem for path in SHAPES.glob("*.toml")} == set(REPORTED)


@pytest.mark.parametrize("name", REPORTED)
def test_a_shape_is_inflated_to_its_reported_pressure(name):
    made = load_study(SHAPES / f"{name}.toml")
    pressure, mirror = REPORTED[name]
    assert made.programme.phases[-1].targets == {"cavity": pytest.approx(pressure / 1000.0)}
    assert made.actuator.half is mirror
