import tomllib
from pathlib import Path

import numpy as np
import pytest

from pneumorph.errors import GeometryError, InputError, LeakingCavityError, NameNotFoundError, StudyError, UnitError
from pneumorph.geometry import Finger, ThickTube
from pneumorph.materials import NeoHookean, Yeoh, library
from pneumorph.mechanics import Clamp, Gravity, Prescribed, Roller, Symmetry, VolumeSupply
from pneumorph.studies import load_study, study_from

PHASE = '\n[[phase]]\ntargets = { cavity = "10 kPa" }\n'
FINGER = '[actuator]\ntemplate = "finger"\n'
SPHERE = '[actuator]\ntemplate = "thick-sphere"\noctant = true\n[material]\nlaw = "neo-hookean"\nmu = "100 kPa"\n'
EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


def study(text):
    return study_from(tomllib.loads(text), "test")


def test_quantities_are_read_into_inside_units():
    made = study(FINGER + 'length = "9 cm"\n[material]\nlaw = "yeoh"\nc10 = "110 kPa"\nc20 = "0.03 MPa"' + PHASE)
    assert made.actuator == Finger(length=90.0)
    assert made.materials == {"body": Yeoh(0.11, 0.03)}
    assert made.programme.phases[0].targets == {"cavity": 0.01}


def test_what_is_left_out_has_the_defaults_of_the_template():
    made = study(FINGER + PHASE)
    assert made.materials["body"] == library.material("lsr-finger")
    assert made.supports == (Clamp("clamp"),)
    assert [(c.name, c.faces, c.supply.kind) for c in made.cavities] == [("cavity", ("cavity",), "pressure")]
    assert [m.name for m in made.measures] == ["tip_rotation", "chord_angle"]
    assert made.programme.phases[0].name == "phase_1"
    assert made.title == "test"


def test_a_part_of_a_symmetric_body_is_held_and_closed_by_its_planes():
    made = study(SPHERE + PHASE)
    planes = ("symmetry_x", "symmetry_y", "symmetry_z")
    assert made.supports == tuple(Symmetry(name) for name in planes)
    assert made.cavities[0].mirrors == planes
    assert made.measures == ()


def test_every_domain_can_have_its_own_material():
    text = '[actuator]\ntemplate = "pneunet"\n'
    own = text + '[material.body]\nname = "ecoflex-00-30-tube"\n[material.base]\nlaw = "neo-hookean"\nmu = "2 MPa"'
    assert study(own + PHASE).materials == {"body": library.material("ecoflex-00-30-tube"), "base": NeoHookean(2.0)}
    one = study(text + '[material]\nname = "lsr-finger"' + PHASE).materials
    assert one == dict.fromkeys(["body", "base"], library.material("lsr-finger"))
    assert set(study(text + PHASE).materials) == {"body", "base"}


def test_bulk_modulus_and_density_of_a_library_material_can_be_replaced():
    text = '[material]\nname = "lsr-finger"\nbulk = "20 MPa"\ndensity = "1200 kg/m3"'
    material = study(FINGER + text + PHASE).materials["body"]
    assert material.bulk == 20.0
    assert material.density == pytest.approx(1.2e-9)
    assert material.c10 == library.material("lsr-finger").c10


def test_gravity_comes_first_unless_a_phase_names_it():
    made = study(FINGER + "[gravity]" + PHASE)
    assert [phase.name for phase in made.programme.phases] == ["gravity", "phase_1"]
    assert made.programme.phases[0].targets == {"gravity": 9810.0}
    assert made.loads == (Gravity((0.0, 0.0, -1.0)),)
    both = '[[phase]]\ntargets = { cavity = "10 kPa", gravity = "9.81 m/s2" }'
    assert len(study(FINGER + '[gravity]\ndirection = "-x"\n' + both).programme.phases) == 1


def test_supports_and_loads_of_every_kind():
    made = study(
        FINGER
        + """
[[support]]
type = "roller"
face = "clamp"
axis = "x"
[[support]]
type = "prescribed"
face = "tip"
axis = "z"
name = "lift"
[[load]]
type = "force"
face = "outer"
direction = [0, 1, 1]
name = "push"
[[load]]
type = "traction"
face = "outer"
direction = "y"
name = "drag"
[[phase]]
targets = { lift = "2 mm", push = "1 N", drag = "1 kPa" }
"""
    )
    assert made.supports == (Roller("clamp", "x"), Prescribed("tip", "z", "lift"))
    assert [load.direction for load in made.loads] == [(0.0, 1.0, 1.0), (0.0, 1.0, 0.0)]
    assert made.programme.phases[0].targets == {"lift": 2.0, "push": 1.0, "drag": 0.001}


def test_states_at_become_marks_and_are_hit_exactly():
    phases = """
[[phase]]
targets = { cavity = "20 kPa" }
[[phase]]
targets = { cavity = "100 kPa" }
states_at = { cavity = ["60 kPa", "40 kPa", "100 kPa"] }
"""
    programme = study(FINGER + phases).programme
    assert programme.phases[1].marks == pytest.approx((0.25, 0.5))
    values = [programme.values(1.0 + mark)["cavity"] for mark in programme.phases[1].marks]
    np.testing.assert_allclose(values, [0.04, 0.06], rtol=1e-15)


def test_volume_supply_takes_volumes():
    made = study(SPHERE + '[[cavity]]\nname = "cavity"\nsupply = "volume"\n[[phase]]\ntargets = { cavity = "4 mL" }')
    assert isinstance(made.cavities[0].supply, VolumeSupply)
    assert made.programme.phases[0].targets == {"cavity": 4000.0}


@pytest.mark.parametrize("size", ['"2 mm"', '"automatic"', '"coarse"'])
def test_mesh_sizes(size):
    made = study(SPHERE + f"[mesh]\nsize = {size}\ngrading = 0.7" + PHASE)
    assert made.mesh().cell_count > 100


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_resolved_study_makes_an_equal_study(path):
    first = load_study(path)
    again = study_from(tomllib.loads(first.resolved_text()), first.name)
    assert again.resolved() == first.resolved()
    for part in ("actuator", "materials", "supports", "loads", "cavities", "programme", "settings", "measures"):
        assert getattr(again, part) == getattr(first, part), part


def test_the_resolved_study_writes_every_default_with_its_unit():
    data = tomllib.loads(study(FINGER + PHASE).resolved_text())
    assert data["actuator"]["passage_roof"] == "2 mm"
    assert data["material"]["body"]["name"] == "lsr-finger"
    assert data["support"] == [{"type": "clamp", "face": "clamp"}]
    assert data["phase"][0]["largest_increment"] == 0.2
    assert "tolerance" in data["solver"]


def test_a_study_builds_model_and_programme():
    problem = study(SPHERE + '[mesh]\nsize = "coarse"' + PHASE).build()
    assert problem.model.kinds == {"cavity": "pressure"}
    problem.programme.check(problem.model)


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        (FINGER + 'length = "9 kPa"' + PHASE, UnitError, "actuator: length = '9 kPa': expected length.*'1 mm'"),
        (FINGER + "length = 90" + PHASE, UnitError, "actuator: length = 90: expected length with its unit"),
        (FINGER + '[mesh]\nsize = "3"' + PHASE, UnitError, "mesh: size = '3': .*; or 'automatic', 'coarse'"),
        (FINGER + "[mesh]\nsize = 3.0" + PHASE, UnitError, "mesh: size = 3.0"),
        (FINGER + '[[phase]]\ntargets = { cavity = "1 mm" }', UnitError, "targets.cavity = '1 mm'.*pressure"),
        (FINGER + "[[phase]]\ntargets = { cavity = 3 }", StudyError, r"phase\[1\].targets.cavity = 3"),
        (FINGER + 'lenght = "9 mm"' + PHASE, StudyError, "actuator: unknown key 'lenght': did you mean 'length'"),
        (FINGER + "[mehs]" + PHASE, StudyError, "unknown key 'mehs': did you mean 'mesh'"),
        (FINGER + PHASE + "[solver]\ntoleranse = 1e-6", StudyError, "solver: .*'toleranse': did you mean 'tolerance'"),
        ('[actuator]\ntemplate = "fingr"' + PHASE, StudyError, "actuator: unknown template 'fingr': did you mean 'fi"),
        ("[actuator]" + PHASE, StudyError, "actuator: missing 'template'"),
        (PHASE, StudyError, "actuator: missing"),
        (FINGER, StudyError, "phase: missing"),
        (FINGER + "[[phase]]\nname = 'x'", StudyError, r"phase\[1\].targets: missing"),
        (FINGER + "[[phase]]\ntargets = {}", InputError, "no targets"),
        (FINGER + 'chambers = "7"' + PHASE, StudyError, "actuator.chambers = '7'.*integer"),
        (FINGER + 'wall = "-2 mm"' + PHASE, GeometryError, "wall = -2 mm"),
        (FINGER + 'wall = "9 mm"' + PHASE, GeometryError, "overlap"),
        (FINGER + '[material]\nname = "lsr-fingr"' + PHASE, NameNotFoundError, "'lsr-fingr': did you mean 'lsr-fing"),
        (FINGER + '[material]\nlaw = "yeo"' + PHASE, StudyError, "material: unknown law 'yeo': did you mean 'yeoh'"),
        (
            FINGER + '[material.bdy]\nname = "lsr-finger"' + PHASE,
            NameNotFoundError,
            "domain 'bdy': did you mean",
        ),
        (FINGER + '[material]\nlaw = "yeoh"\nc10 = "1 MPa"' + PHASE, StudyError, "material.c20: missing"),
        (SPHERE.split("[material]")[0] + PHASE, StudyError, "material: missing for the domain 'body'"),
        (FINGER + '[[support]]\ntype = "clmp"\nface = "tip"' + PHASE, StudyError, "unknown type 'clmp': did you mean"),
        (
            FINGER + '[[support]]\ntype = "clamp"\nface = "tpi"' + PHASE,
            NameNotFoundError,
            "face 'tpi': did you mean",
        ),
        (FINGER + '[[cavity]]\nname = "cavty"' + PHASE, NameNotFoundError, "cavity 'cavty': unknown face"),
        (
            FINGER + '[[cavity]]\nname = "a"\nfaces = ["cavity", "cavity"]' + PHASE,
            InputError,
            "face 'cavity' is named in",
        ),
        (
            FINGER + '[[cavity]]\nname = "cavity"\n[[cavity]]\nname = "b"\nfaces = ["cavity"]' + PHASE,
            InputError,
            "face 'cavity' is named in cavity 'cavity' and in cavity 'b'",
        ),
        (
            FINGER
            + '[[support]]\ntype = "clamp"\nface = "tip"\n[[support]]\ntype = "roller"\nface = "tip"\naxis = "x"'
            + PHASE,
            InputError,
            r"face 'tip' is named in support\[1\] and in support\[2\]",
        ),
        (
            FINGER + '[[load]]\ntype = "force"\nface = "tip"\ndirection = "-z"\nname = "cavity"' + PHASE,
            InputError,
            "the name 'cavity' is given to more than one",
        ),
        (
            FINGER + '[[load]]\ntype = "force"\nface = "tip"\ndirection = "-z"\nname = "push"' + PHASE,
            StudyError,
            "'push' is in the study, but no phase drives it",
        ),
        (
            FINGER + '[[load]]\ntype = "force"\nface = "tip"\ndirection = "down"\nname = "push"' + PHASE,
            StudyError,
            r"load\[1\]: direction = 'down': expected an axis such as '-z'",
        ),
        (FINGER + "[gravity]\ndirection = [0, 1]" + PHASE, StudyError, "expected 3 numbers"),
        (
            FINGER + '[material]\nname = "auxetic-end-cap"\n[gravity]' + PHASE,
            InputError,
            "gravity: the material of 'body' has no density",
        ),
        (FINGER + '[[phase]]\ntargets = { cavty = "1 kPa" }', NameNotFoundError, "phase 'phase_1': .*'cavty': did you"),
        (
            FINGER + PHASE + 'states_at = { cavity = ["20 kPa"] }',
            StudyError,
            "states_at.cavity = '20 kPa': .*after 0 kPa, up to 10 kPa",
        ),
        (
            FINGER + "[gravity]" + PHASE + 'states_at = { gravity = ["1 m/s2"] }',
            StudyError,
            "states_at.gravity: expected one of its targets, cavity",
        ),
        (
            'measures = ["tip_rotaton"]\n' + FINGER + PHASE,
            NameNotFoundError,
            "'tip_rotaton': did you mean",
        ),
        ('measures = ["tip_rotation"]\n' + SPHERE + PHASE, StudyError, "'tip_rotation' needs the face 'clamp'"),
        ('measures = ["chord_angle", "chord_angle"]\n' + FINGER + PHASE, StudyError, "'chord_angle' is given 2 times"),
    ],
)
def test_bad_input_is_refused_with_a_message_that_names_it(text, error, message):
    with pytest.raises(error, match=message) as caught:
        study(text)
    assert "pydantic" not in str(caught.value)


def test_all_that_is_wrong_is_told_at_once():
    with pytest.raises(StudyError) as caught:
        study(FINGER + 'length = 3\nchambers = "x"\n[mesh]\nsize = 2' + PHASE)
    assert [line.split(" =")[0] for line in str(caught.value).splitlines()] == [
        "actuator: length",
        "actuator.chambers",
        "mesh: size",
    ]


def test_a_leaking_cavity_is_refused_when_the_model_is_built():
    tube = '[actuator]\ntemplate = "thick-tube"\ncap = "0 mm"\n[material]\nname = "lsr-finger"\n[mesh]\nsize = "coarse"'
    made = study(tube + PHASE)
    assert made.actuator == ThickTube(cap=0.0)
    with pytest.raises(LeakingCavityError, match="cavity 'cavity' leaks"):
        made.build()


def test_a_missing_or_broken_file_is_refused_with_its_path(tmp_path):
    with pytest.raises(StudyError, match=r"cannot read the study file .*nothing\.toml"):
        load_study(tmp_path / "nothing.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("[actuator\n")
    with pytest.raises(StudyError, match=r"broken\.toml' is not a TOML file"):
        load_study(broken)
    broken.write_bytes(b"title = '\xff'")
    with pytest.raises(StudyError, match="not a TOML file"):
        load_study(broken)
    broken.write_text(FINGER + 'length = "1 kPa"' + PHASE)
    with pytest.raises(UnitError, match=r"broken\.toml: actuator: length = '1 kPa'"):
        load_study(broken)


def test_warnings_of_the_mesh_go_to_the_log(caplog):
    study(SPHERE + '[mesh]\nsize = "5 mm"' + PHASE).mesh()
    assert "thick wall 'wall'" in caplog.text


def test_constants_that_soften_are_warned_of_with_the_stretch_at_which_they_do(caplog):
    soft = SPHERE.replace('law = "neo-hookean"\nmu = "100 kPa"', 'law = "yeoh"\nc10 = "100 kPa"\nc20 = "-10 kPa"')
    study(soft + '[mesh]\nsize = "coarse"' + PHASE).build()
    assert "material of 'body': unstable in equibiaxial tension from a stretch of 1.51 on" in caplog.text


def test_a_phase_takes_its_time_and_inertia_from_the_study():
    timed = PHASE + 'duration = "20 ms"\ninertia = "moderate"\n'
    (phase,) = study(SPHERE + 'density = "1100 kg/m3"' + timed).programme.phases
    assert (phase.duration, phase.inertia) == (0.02, "moderate")
    with pytest.raises(StudyError, match=r"phase\[1\].inertia"):
        study(SPHERE + timed.replace("moderate", "fast"))
