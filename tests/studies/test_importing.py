"""Studies of bodies from files."""

from pathlib import Path

import pytest
from tests.mesh.decks import deck

from pneumorph.errors import InputError, StudyError, UnitError
from pneumorph.mesh import Imported, Selector
from pneumorph.solution import solve
from pneumorph.studies import load_study, study_from

BODY = """
[actuator]
file = "body.inp"
unit = "cm"
[actuator.faces]
clamp = { axis = "x", at = "0 mm" }
tip = { normal = "x", largest_planar = true }
"""
MATERIAL = '[material]\nlaw = "neo-hookean"\nmu = "100 kPa"\n'
PHASE = '[[phase]]\ntargets = { cavity = "5 kPa" }\n'


@pytest.fixture
def load(tmp_path):
    (tmp_path / "body.inp").write_text(deck((3, 3, 3), ((1, 1, 1),)))
    (tmp_path / "solid.inp").write_text(deck((3, 1, 1)))

    def read(text):
        (tmp_path / "study.toml").write_text(text)
        return load_study(tmp_path / "study.toml")

    return read


def test_an_imported_body_has_the_defaults_of_a_template(load):
    study = load(BODY + MATERIAL + PHASE)
    assert isinstance(study.actuator, Imported)
    assert study.actuator.faces["tip"] == Selector(normal=(1.0, 0.0, 0.0), largest_planar=True)
    (support,) = study.supports
    assert support.face == "clamp"
    assert [cavity.name for cavity in study.cavities] == ["cavity"]
    assert [measure.name for measure in study.measures] == ["tip_rotation", "chord_angle"]
    assert set(study.materials) == {"BODY"}


def test_the_file_is_sought_beside_the_study_and_the_resolved_study_finds_it_from_anywhere(load, tmp_path, monkeypatch):
    study = load(BODY + MATERIAL + PHASE)
    monkeypatch.chdir("/")
    again = study_from(study.resolved(), "again")
    assert again.actuator.paths == (tmp_path / "body.inp",)
    assert again.resolved() == study.resolved()
    (tmp_path / "elsewhere.toml").write_text(study.resolved_text())
    assert load_study(tmp_path / "elsewhere.toml").resolved() == study.resolved()


def test_a_solve_of_an_imported_body_starts_from_the_volume_of_the_file(load):
    problem = load(BODY + MATERIAL + PHASE + "first_increment = 1.0\nlargest_increment = 1.0").build()
    solution = solve(problem.model, problem.programme, measures=problem.measures)
    volume = solution.history.values("volume:cavity")
    assert volume[0] == pytest.approx(1000.0, rel=1e-9)
    assert volume[-1] > 1001.0


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        (BODY.replace('unit = "cm"\n', ""), InputError, "unit: missing; a .inp file does not say it"),
        (BODY.replace('"cm"', '"ell"'), StudyError, "actuator.unit = 'ell': input should be 'um', 'mm'"),
        (BODY.replace("0 mm", "0"), UnitError, "actuator.faces.clamp: at = '0': expected length"),
        (BODY.replace('at = "0 mm"', "a = 1"), StudyError, "actuator.faces.clamp: unknown key 'a'"),
        (BODY.replace('axis = "x", at = "0 mm"', 'axis = "x"'), StudyError, "actuator.faces.clamp: .*needs both"),
        (BODY.replace('axis = "x", at = "0 mm"', ""), StudyError, "actuator.faces.clamp: an empty selector"),
        (
            BODY.replace('"body.inp"', '["body.inp", 3]'),
            StudyError,
            "file = .*: expected the name of a file, or a list",
        ),
        (BODY.replace("body.inp", "gone.inp"), InputError, "gone.inp': there is no such file"),
        (BODY.replace("body.inp", "solid.inp"), InputError, "the solid has no closed cavity"),
        (
            BODY + '[[support]]\ntype = "clamp"\nface = "clmp"\n',
            InputError,
            "unknown face 'clmp': did you mean 'clamp'",
        ),
        (BODY + '[mesh]\nwall_size = "1 mm"\n', InputError, "wall_size: only templates know"),
        (BODY + '[mesh]\nsize = "1 mm"\n', InputError, "is a mesh already"),
        ('[actuator]\ntemplate = "finger"\nfile = "body.inp"\n', StudyError, "unknown key 'template'"),
        (BODY.replace("tip", "cap = 3\ntip"), StudyError, "actuator.faces.cap"),
    ],
)
def test_bad_imports_are_refused_with_the_key(load, text, error, message):
    with pytest.raises(error, match=message):
        load(text + MATERIAL + PHASE)


def test_a_body_without_a_material_is_refused(load):
    with pytest.raises(StudyError, match="missing for the domain 'BODY' of the file"):
        load(BODY + PHASE)


def test_a_solid_without_cavity_may_be_pulled(load):
    pulled = (
        '[[load]]\ntype = "force"\nface = "tip"\ndirection = "x"\nname = "pull"\n[[phase]]\ntargets = { pull = "1 N" }'
    )
    study = load(BODY.replace("body.inp", "solid.inp") + MATERIAL + pulled)
    assert study.cavities == ()


def test_a_finger_of_another_cad_kernel_with_an_open_inlet_bends(tmp_path):
    path = Path(__file__).parents[1] / "data" / "finger_inlet.step"
    text = BODY.replace("body.inp", str(path)).replace('unit = "cm"\n', 'caps = { inlet = ["0 mm", "0 mm", "6 mm"] }\n')
    phase = PHASE.replace("5 kPa", "10 kPa") + "first_increment = 0.5\nlargest_increment = 0.5\n"
    (tmp_path / "study.toml").write_text(text + MATERIAL + '[mesh]\nsize = "coarse"\n' + phase)
    problem = load_study(tmp_path / "study.toml").build()
    solution = solve(problem.model, problem.programme, measures=problem.measures)
    assert problem.model.surfaces["cavity"].reference_volume == pytest.approx(2094.137167, rel=1e-4)
    # the floor is the thicker side: the finger bends down, its tip turns about y
    tip = solution.states[-1].displacement[problem.model.mesh.face_nodes("tip")].mean(axis=0)
    assert tip[2] < -0.05
    assert len(solution.states) == 3
