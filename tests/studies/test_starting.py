"""Studies to start from: complete, commented, and the same study with the comments as without."""

import dataclasses
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from pneumorph.closed_form.thick_wall import sphere_inner_radius
from pneumorph.errors import InputError, NameNotFoundError, StorageError
from pneumorph.solution import Status
from pneumorph.studies import load_study, run_study, study_from
from pneumorph.studies.json_schema import SCHEMA_FILE, study_schema
from pneumorph.studies.schema import TEMPLATES
from pneumorph.studies.starting import import_text, starter, starter_text, starters, write_starter

NAMES = tuple(sorted(TEMPLATES))


def uncommented(text):
    """Return the keys that stand in comments as `# key = value`, with their values."""
    lines = re.findall(r"^# ([a-z_0-9]+ = .*)$", text, re.MULTILINE)
    return [next(iter(tomllib.loads(line).items())) for line in lines]


def test_there_is_one_for_every_template():
    assert set(starters()) == {*TEMPLATES, "import"}
    assert all(starters().values())


@pytest.mark.parametrize("name", NAMES)
def test_the_text_makes_the_study_with_every_dimension_in_it(name):
    text = starter_text(name)
    study = study_from(tomllib.loads(text), name)
    assert study.resolved() == starter(name).resolved()
    # a map by segments is a choice, and stands there as a comment
    dimensions = {item.name for item in dataclasses.fields(TEMPLATES[name]) if item.init} - {"segment"}
    assert dimensions <= tomllib.loads(text)["actuator"].keys()
    for item in study.actuator.dimensions():
        assert item.help in text
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("name", [*NAMES, "import"])
def test_every_key_of_the_schema_stands_in_the_text(name):
    text = import_text("part.step") if name == "import" else starter_text(name)
    schema = study_schema()
    # what the file does not choose: other templates, or other ways to say what the body is
    others = {"SelectorSection", "ImportedSection", "SkinSegment"}
    others -= {"import": {"ImportedSection"}, "skinned-tube": {"SkinSegment"}}.get(name, set())
    for owner, table in schema["$defs"].items():
        if "properties" not in table or "template" in table["properties"] or owner in others:
            continue
        for key in table["properties"]:
            array = rf"\[\[part\.name\.{key}\]\]"  # of tables in a part
            assert re.search(rf"^(# )?((\w+ = {{.*)?\b{key} = |{array})", text, re.MULTILINE), f"{owner}.{key}"
    for key in schema["properties"]:
        assert re.search(rf"^(# )?(\[+{key}[.\]]|{key} = )", text, re.MULTILINE), key


@pytest.mark.parametrize("name", NAMES)
def test_comments_are_toml_that_can_be_taken_in(name):
    text = starter_text(name)
    keys = uncommented(text)
    assert len(keys) > 30
    for line in re.findall(r"^# (?:mesh|wall_size|states_at|largest_increment|supply|viscosity|grading) = .*$", text):
        study_from(tomllib.loads(text.replace(line, line[2:])), name)
    whole = text.replace("# [gravity]", "[gravity]").replace("# states_at", "states_at")
    whole = whole.replace('["80 kPa"]', '["1 kPa"]')
    if name == "skinned-tube":  # its source gives no densities
        with pytest.raises(InputError, match="the material of 'tube' has no density; give density"):
            study_from(tomllib.loads(whole), name)
        return
    assert "gravity" in study_from(tomllib.loads(whole), name).resolved()


def test_the_sphere_runs_and_keeps_to_its_closed_form():
    study = study_from(tomllib.loads(starter_text("thick-sphere")), "sphere")
    solution = run_study(study)
    assert solution.status is Status.DONE
    exact = sphere_inner_radius(study.materials["body"], 10.0, 15.0, 0.04)
    volume = solution.history.values("volume:cavity")[-1]
    assert np.cbrt(6.0 / np.pi * volume) == pytest.approx(exact, rel=0.005)


def test_the_tube_runs():
    solution = run_study(study_from(tomllib.loads(starter_text("thick-tube")), "tube"))
    assert solution.status is Status.DONE
    assert solution.history.values("volume:cavity")[-1] > solution.history.values("volume:cavity")[0]


def test_a_study_of_a_cad_file_comes_with_one_and_is_read(tmp_path):
    path = write_starter("import", tmp_path / "part.toml")
    assert (tmp_path / "part.step").is_file()
    study = load_study(path)
    assert study.actuator.cavities == ("cavity",)
    assert {"clamp", "tip", "outer"} <= set(study.actuator.face_names)
    assert study.programme.phases[0].targets == {"cavity": 0.02}
    path.unlink()
    with pytest.raises(StorageError, match=r"part\.step' exists already"):
        write_starter("import", path)


def test_an_unknown_template_is_refused_with_the_nearest():
    with pytest.raises(NameNotFoundError, match="unknown template 'fingr': did you mean 'finger'"):
        starter("fingr")
    with pytest.raises(NameNotFoundError, match="unknown template 'imprt': did you mean 'import'"):
        write_starter("imprt", Path("study.toml"))


def test_a_file_is_never_overwritten(tmp_path):
    path = write_starter("finger", tmp_path / "mine.toml")
    before = path.read_text(encoding="utf-8")
    with pytest.raises(StorageError, match=r"mine\.toml' exists already"):
        write_starter("pneunet", path)
    assert path.read_text(encoding="utf-8") == before
    with pytest.raises(StorageError, match="cannot write"):
        write_starter("finger", tmp_path / "nowhere" / "mine.toml")


def test_with_the_schema_beside_it_the_first_line_points_there(tmp_path):
    path = write_starter("finger", tmp_path / "mine.toml", schema=True)
    first = path.read_text(encoding="utf-8").splitlines()[0]
    assert first == f"#:schema ./{SCHEMA_FILE}"
    assert (tmp_path / SCHEMA_FILE).is_file()
