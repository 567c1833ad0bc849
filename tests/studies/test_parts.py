"""Studies of several bodies: names, places, defaults, and solutions that do not depend on who else is there."""

import copy
import tomllib
from functools import cache

import numpy as np
import pytest

from pneumorph.cli.exporting import Wanted, export_file
from pneumorph.errors import GeometryError, InputError, NameNotFoundError, StudyError
from pneumorph.geometry import Finger, Forearm, export
from pneumorph.measures import CentreOfMass, LargestStress, MeanStress, TipRotation, contact_pressure
from pneumorph.mechanics.contact.facets import nodal_areas
from pneumorph.mesh.findings import cavities_found
from pneumorph.report.asked import asked_tables
from pneumorph.solution import Status
from pneumorph.studies import load_study, run_study, study_from
from pneumorph.studies.sweeps.paths import replaced

SMALL = {"template": "finger", "length": "20 mm", "chambers": 1}
BLOCKS = {"hexahedra": True}
MEASURES = ["tip_rotation", "mean_von_mises", "centre_of_mass_x", "peak_von_mises:two.body"]


def pair(**changes):
    """Return the data of a study of two small fingers side by side, the second at half the pressure."""
    table = {
        "actuator": SMALL,
        "mesh": BLOCKS,
        "part": {"two": {"actuator": SMALL, "mesh": BLOCKS, "shift": ["0 mm", "30 mm", "0 mm"]}},
        "phase": [{"name": "inflate", "targets": {"cavity": "20 kPa", "two.cavity": "10 kPa"}}],
    }
    return table | changes


@cache
def alone(pressure):
    """Return the last state of one such finger."""
    phase = [{"name": "inflate", "targets": {"cavity": pressure}}]
    return run_study(study_from({"actuator": SMALL, "mesh": BLOCKS, "phase": phase}, "alone")).states[-1]


@pytest.fixture(scope="module")
def solved_pair():
    return run_study(study_from(pair(measures=MEASURES), "pair"))


def test_the_names_of_a_part_are_led_by_its_own():
    study = study_from(pair(), "pair")
    assert study.actuator == Finger(length=20.0, chambers=1)
    assert study.assembly.face_names == (
        "clamp", "tip", "outer", "cavity", "two.clamp", "two.tip", "two.outer", "two.cavity",
    )  # fmt: skip
    assert [cavity.name for cavity in study.cavities] == ["cavity", "two.cavity"]
    assert set(study.materials) == {"body", "two.body"}
    assert [support.face for support in study.supports] == ["clamp", "two.clamp"]


def test_a_study_with_parts_written_out_is_the_same_study():
    study = study_from(pair(), "pair")
    again = study_from(tomllib.loads(study.resolved_text()), "pair")
    assert again.resolved() == study.resolved()
    assert again.placements == study.placements


def test_a_target_of_a_part_may_be_written_with_a_dot():
    text = 'targets = { cavity = "20 kPa", two.cavity = "10 kPa" }\nstates_at = { two.cavity = ["5 kPa"] }'
    phase = tomllib.loads(text)
    study = study_from(pair(phase=[phase]), "pair")
    assert study.programme.phases[0].targets == {"cavity": 0.02, "two.cavity": 0.01}
    assert study.programme.phases[0].marks == (0.5,)


def test_two_bodies_apart_do_what_each_does_alone(solved_pair):
    assert solved_pair.status is Status.DONE
    for name, pressure in (("cavity", "20 kPa"), ("two.cavity", "10 kPa")):
        together, single = solved_pair.states[-1], alone(pressure)
        assert together.volume[name] == pytest.approx(single.volume["cavity"], rel=1e-9)
        count = len(single.model.mesh.points)
        first = 0 if name == "cavity" else count
        scale = np.abs(single.displacement).max()
        np.testing.assert_allclose(together.displacement[first : first + count], single.displacement, atol=1e-6 * scale)


def test_measures_without_a_domain_are_of_the_actuator_alone(solved_pair):
    one, other, history = alone("20 kPa"), alone("10 kPa"), solved_pair.history
    assert history.values("tip_rotation")[-1] == pytest.approx(TipRotation(axis=(0, 1, 0))(one), rel=1e-6)
    assert history.values("mean_von_mises")[-1] == pytest.approx(MeanStress("von_mises")(one), rel=1e-6)
    assert history.values("centre_of_mass_x")[-1] == pytest.approx(CentreOfMass("x")(one), rel=1e-6)
    assert history.values("peak_von_mises:two.body")[-1] == pytest.approx(LargestStress()(other), rel=1e-6)


def test_a_part_that_is_turned_and_shifted_moves_as_it_would_unturned():
    """The same body, pressure and support in another pose: the displacement turns with it."""
    turn = [{"axis": "x", "angle": "90 deg"}, {"axis": [1.0, 1.0, 0.5], "angle": "40 deg", "about": ["1 mm"] * 3}]
    part = {"actuator": SMALL, "mesh": BLOCKS, "turn": turn, "shift": ["5 mm", "60 mm", "-4 mm"]}
    study = study_from(pair(part={"two": part}, phase=[{"targets": {"cavity": "20 kPa", "two.cavity": "20 kPa"}}]), "p")
    last = run_study(study).states[-1]
    half = len(last.displacement) // 2
    mesh, (first, second) = last.model.mesh, (last.displacement[:half], last.displacement[half:])
    # the rotation from the edges of the bodies at rest
    centred = [part - part.mean(axis=0) for part in (mesh.points[:half], mesh.points[half:])]
    rotation = np.linalg.lstsq(centred[0], centred[1], rcond=None)[0]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
    assert np.abs(rotation - np.eye(3)).max() > 0.5
    np.testing.assert_allclose(second, first @ rotation, atol=1e-6 * np.abs(first).max())


def test_a_slender_arm_sags_as_a_clamped_beam_does():
    """Both ends clamped, an even load q along it: w = q L^4 / (384 EI) + q L^2 / (8 k G A), Timoshenko's beam.

    Round section, so I = pi d^4 / 64 and k = 6 (1 + nu) / (7 + 6 nu) (Cowper, J. Appl. Mech. 33 (1966) 335). Without
    Poisson's ratio, as a clamp that hinders the section's change of size is no part of the theory.
    """
    arm = {"template": "forearm", "length": "250 mm", "pressed": "125 mm"}
    arm |= {f"{end}_{side}": "20 mm" for end in ("wrist", "elbow") for side in ("width", "thickness")}
    pressure, d, length, young, nu = 1e-4, 20.0, 250.0, 270.0, 0.0
    table = {
        "actuator": arm,
        "material": {"law": "linear-elastic", "young": f"{young} MPa", "poisson": nu},
        "mesh": {"size": "7 mm"},
        "measures": ["largest_displacement"],
        "support": [{"type": "clamp", "face": face} for face in ("wrist", "elbow")],
        "load": [{"type": "traction", "face": "skin", "direction": "-z", "name": "press"}],
        "phase": [{"targets": {"press": f"{pressure} MPa"}}],
    }
    found = run_study(study_from(table, "arm")).history.values("largest_displacement")[-1]
    load, area, second = pressure * np.pi * d, np.pi * d**2 / 4, np.pi * d**4 / 64
    shear = 6 * (1 + nu) / (7 + 6 * nu) * young / (2 * (1 + nu))
    exact = load * length**4 / (384 * young * second) + load * length**2 / (8 * shear * area)
    assert found == pytest.approx(exact, rel=0.01)


def massage(arm, **changes):
    """Return a short finger above a small arm that lies across it, both ends of the arm fixed."""
    table = {
        "actuator": SMALL,
        "mesh": BLOCKS,
        "part": {
            "arm": {"turn": [{"axis": "z", "angle": "90 deg"}], "shift": ["14 mm", "-20 mm", "-10.3 mm"]} | arm,
        },
        "support": [{"type": "clamp", "face": face} for face in ("clamp", "arm.wrist", "arm.elbow")],
        "contact": [{"name": "massage", "faces": ["outer", "tip"], "against": ["arm.skin"]}],
        "measures": ["largest_displacement:arm.body", "mean_contact_pressure:massage"],
        "phase": [{"name": "inflate", "targets": {"cavity": "40 kPa"}}],
    }
    return table | changes


ARM = {
    "template": "forearm", "length": "40 mm", "pressed": "20 mm", "wrist_width": "24 mm", "wrist_thickness": "20 mm",
    "elbow_width": "26 mm", "elbow_thickness": "20 mm",
}  # fmt: skip


@pytest.fixture(scope="module")
def massaged():
    return run_study(study_from(massage({"actuator": ARM, "mesh": {"size": "5 mm"}}), "massage"))


def test_finger_and_arm_press_each_other_equally(massaged):
    assert massaged.status is Status.DONE
    state = massaged.states[-1]
    mesh, force = state.model.mesh, np.array(state.touches["massage"].force)
    reactions = state.reactions.reshape(-1, 3)
    held = {name: reactions[mesh.face_nodes(name)].sum(axis=0) for name in ("arm.wrist", "arm.elbow")}
    assert force[2] > 0.05  # the arm bears the finger
    # what the finger gives goes through the arm to its ends
    np.testing.assert_allclose(sum(held.values()), force, atol=1e-6 * np.linalg.norm(force))
    assert 0.0 < massaged.history.values("largest_displacement:arm.body")[-1] < 0.01


def test_the_pressure_on_the_arm_adds_up_to_the_force(massaged):
    state = massaged.states[-1]
    mesh = state.model.mesh
    pressure = contact_pressure(state, "massage")
    sides = {
        side: float(
            nodal_areas(mesh, [b for name in names for b in mesh.face_blocks(name)], state.positions) @ pressure
        )
        for side, names in (("finger", ("outer", "tip")), ("arm", ("arm.skin",)))
    }
    size = np.linalg.norm(state.touches["massage"].force)
    # sizes of forces add up to more than their sum, as the arm is round
    assert all(size < value < 1.5 * size for value in sides.values())
    peak = massaged.history.values("contact_pressure:massage")[-1]
    mean = massaged.history.values("mean_contact_pressure:massage")[-1]
    outside = np.unique(np.concatenate([mesh.face_nodes(name) for name in ("outer", "tip")]))
    assert pressure[outside].max() == pytest.approx(peak, rel=1e-9)
    assert mean == pytest.approx(sides["finger"] / state.touches["massage"].area, rel=1e-9)
    assert 0.0 < mean < peak


@pytest.mark.parametrize("suffix", ["stl", pytest.param("step", marks=pytest.mark.slow)])
def test_an_arm_from_a_file_does_what_the_template_does(massaged, tmp_path, suffix):
    export(Forearm(40.0, 24.0, 20.0, 26.0, 20.0, 20.0), tmp_path / f"arm.{suffix}", size=3.0)
    arm = {
        "actuator": {
            "file": f"arm.{suffix}",
            **({"unit": "mm"} if suffix == "stl" else {}),
            "faces": {
                "wrist": {"axis": "x", "at": "0 mm"}, "elbow": {"axis": "x", "at": "40 mm"},
                "skin": {"nearest": ["20 mm", "0 mm", "10 mm"]},
            },
        },
        "material": {"name": "finger-arm"},
        "mesh": {"size": "6 mm"},
    }  # fmt: skip
    study = study_from(massage(arm), "massage", tmp_path)
    state, other = run_study(study).states[-1], massaged.states[-1]
    assert state.touches["massage"].force[2] == pytest.approx(other.touches["massage"].force[2], rel=0.1)


def test_parts_that_intersect_are_refused_with_the_shift_that_helps():
    study = study_from(pair(part={"two": pair()["part"]["two"] | {"shift": ["1 mm", "12 mm", "2 mm"]}}), "pair")
    with pytest.raises(InputError, match=r"main body and part 'two' intersect at .*takes part 'two' free is 4\.\d* mm"):
        study.mesh()


def test_a_part_inside_another_is_refused():
    arm = {"actuator": {**ARM, "wrist_thickness": "3 mm", "elbow_thickness": "3 mm", "wrist_width": "3 mm"}}
    arm["actuator"] |= {"elbow_width": "3 mm", "length": "6 mm", "pressed": "3 mm"}
    whole = {
        "actuator": ARM,
        "part": {"bone": arm | {"shift": ["15 mm", "0 mm", "0 mm"]}},
        "support": [{"type": "clamp", "face": face} for face in ("wrist", "bone.wrist")],
        "load": [{"type": "traction", "face": "skin", "direction": "-z", "name": "press"}],
        "phase": [{"targets": {"press": "1 kPa"}}],
    }
    with pytest.raises(InputError, match="part 'bone' lies inside the main body, at"):
        study_from(whole, "bone").mesh()


def without(table, *path):
    table = copy.deepcopy(table)
    place = table
    for key in path[:-1]:
        place = place[key]
    del place[path[-1]]
    return table


def changed(table, value, *path):
    table = copy.deepcopy(table)
    place = table
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return table


@pytest.mark.parametrize(
    ("table", "error", "message"),
    [
        (changed(pair(), 1, "part", "two", "shft"), StudyError, r"part\.two: unknown key 'shft': did you mean 'shift'"),
        (without(pair(), "part", "two", "actuator"), StudyError, r"part\.two\.actuator: missing"),
        (changed(pair(), "90", "part", "two", "actuator", "length"), InputError, r"part\.two\.actuator.*length"),
        (changed(pair(), "1 mm", "part", "two", "actuator", "length"), GeometryError, r"part\.two: Finger: the chamb"),
        (changed(pair(), "fingr", "part", "two", "actuator", "template"), StudyError, "did you mean 'finger'"),
        (
            changed(pair(), {"skin": {"name": "pla"}}, "part", "two", "material"),
            NameNotFoundError,
            r"part\.two\.material: unknown domain 'skin'",
        ),
        (
            changed(pair(), [{"axis": [0, 0, 0], "angle": "3 deg"}], "part", "two", "turn"),
            InputError,
            r"part\.two: turn: axis .*not all zero",
        ),
        (
            changed(pair(), [{"axis": "z", "angle": "3 mm"}], "part", "two", "turn"),
            InputError,
            r"part\.two\.turn\[1\]: angle = '3 mm'",
        ),
        (
            changed(pair(), [{"type": "clamp", "face": "clamp"}], "support"),
            StudyError,
            r"part\.two: nothing holds or touches it; name one of its faces, two\.clamp",
        ),
        (
            changed(pair(), [{"type": "clamp", "face": "two.clmp"}], "support"),
            NameNotFoundError,
            r"support\[1\]: unknown face 'two\.clmp': did you mean 'two\.clamp'",
        ),
        (changed(pair(), {"two.cavty": "1 kPa"}, "phase", 0, "targets"), NameNotFoundError, "mean 'two.cavity'"),
        (changed(pair(), pair()["part"]["two"], "part", "a.b"), StudyError, r"part 'a\.b': expected a name of letters"),
        (
            changed(pair(), {"actuator": {"template": "thick-sphere"}}, "part", "ball"),
            StudyError,
            r"part\.ball\.material: missing for the domain 'body'.*give \[part\.ball\.material\]",
        ),
        (
            changed(pair(), {"actuator": {"template": "crawler-2d"}}, "part", "worm"),
            StudyError,
            r"part\.worm is plane_strain, the main body 3d",
        ),
        (
            changed(pair(), ["mean_von_mises", "peak_von_mises:arm.body"], "measures"),
            NameNotFoundError,
            r"unknown domain 'arm\.body'.*two\.body",
        ),
        (
            changed(pair(), ["mean_contact_pressure:walls"], "measures"),
            NameNotFoundError,
            "unknown contact 'walls': Allowed: none",
        ),
    ],
)
def test_what_is_wrong_with_a_part_is_said_with_its_name(table, error, message):
    with pytest.raises(error, match=message):
        study_from(table, "pair")


def test_a_part_that_is_not_held_enough_is_refused_when_it_is_built():
    supports = [{"type": "clamp", "face": "clamp"}, {"type": "roller", "face": "two.clamp", "axis": "x"}]
    with pytest.raises(InputError, match=r"do not hold the body of 'two\.body': it is free in translation [yz]"):
        study_from(pair(support=supports), "pair").build()


def test_two_parts_of_one_name_are_refused(tmp_path):
    part = '[part.two]\n[part.two.actuator]\ntemplate = "finger"\n'
    path = tmp_path / "twice.toml"
    path.write_text('[actuator]\ntemplate = "finger"\n' + part + part, encoding="utf-8")
    with pytest.raises(StudyError, match=r"twice\.toml.*two"):
        load_study(path)


def test_a_step_file_holds_one_body_and_says_so(tmp_path):
    """The exact solid of one of several bodies would not be the study."""
    single, double = tmp_path / "one.toml", tmp_path / "two.toml"
    table = without(pair(phase=[{"targets": {"cavity": "1 kPa"}}]), "part")
    single.write_text(study_from(table, "one").resolved_text(), encoding="utf-8")
    double.write_text(study_from(pair(), "two").resolved_text(), encoding="utf-8")
    export_file(single, Wanted(tmp_path / "one.step"))
    with pytest.raises(InputError, match="2 separate bodies: expected one for a STEP file"):
        export_file(double, Wanted(tmp_path / "two.step"))
    export_file(double, Wanted(tmp_path / "two.vtu"))


def test_cavities_of_all_bodies_are_found_in_the_mesh():
    study = study_from(pair(), "pair")
    main, part = cavities_found(study.mesh(), study.assembly)
    assert (main.name, part.name) == ("cavity", "two.cavity")
    assert main.volume == pytest.approx(part.volume) == pytest.approx(study.actuator.cavity_volume)
    np.testing.assert_allclose(part.middle - main.middle, [0.0, 30.0, 0.0], atol=1e-9)


def test_the_report_has_the_dimensions_of_every_body(solved_pair):
    titles = [table.title for table in asked_tables(solved_pair)]
    assert titles[:2] == ["Dimensions: finger", "Dimensions of 'two': finger"]


def test_a_sweep_may_change_a_part():
    table = replaced(pair(), "part.two.actuator.wall", "2.5 mm")
    assert study_from(table, "swept").assembly.parts["two"].wall == 2.5
