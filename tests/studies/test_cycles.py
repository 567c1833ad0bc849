"""The [cycle] section, plane templates and their directions in study files, and the measures of the centre of mass."""

import math
import tomllib

import pytest

from pneumorph.errors import InputError, NameNotFoundError, StudyError
from pneumorph.studies import study_from

TABLE = {
    "actuator": {"template": "crawler-2d", "channels": 2},
    "gravity": {"direction": "-y"},
    "support": [{"type": "clamp", "face": "rear_foot"}],
    "measures": ["centre_of_mass_x", "centre_of_mass_y"],
    "phase": [
        {"name": "settle", "targets": {"gravity": "9.81 m/s2"}},
        {"name": "up", "targets": {"PN3": "4 kPa"}, "states_at": {"PN3": ["2 kPa"]}},
        {"name": "down", "targets": {"PN3": "0 kPa"}},
    ],
    "cycle": {"phases": ["up", "down"], "repeat": 3},
}


def study(**changes):
    return study_from(TABLE | changes, "walk")


def test_a_cycle_repeats_the_last_phases_of_the_file():
    names = [phase.name for phase in study().programme.phases]
    assert names == ["settle", "up", "down", "up, cycle 2", "down, cycle 2", "up, cycle 3", "down, cycle 3"]
    assert study().cycle_ends == (1, 3, 5, 7)
    assert study().programme.phases[5].marks == pytest.approx((0.5,))
    assert study(cycle={"phases": ["up", "down"]}).cycle_ends == (1, 3)


def test_without_a_cycle_each_phase_is_run_once():
    table = {key: value for key, value in TABLE.items() if key != "cycle"}
    assert len(study_from(table, "walk").programme.phases) == 3
    assert study_from(table, "walk").cycle_ends == ()


def test_the_resolved_study_makes_the_same_study():
    again = study_from(tomllib.loads(study().resolved_text()), "walk")
    assert again.resolved() == study().resolved()
    assert again.programme == study().programme


@pytest.mark.parametrize("repeat", [0, -2])
def test_a_cycle_without_end_is_refused(repeat):
    with pytest.raises(InputError, match=f"cycle: repeat = {repeat}, allowed: a whole number of at least 1"):
        study(cycle={"phases": ["up", "down"], "repeat": repeat})


@pytest.mark.parametrize("repeat", [math.inf, 1.5, "always"])
def test_a_number_of_cycles_that_is_not_whole_is_refused(repeat):
    with pytest.raises(StudyError, match=r"cycle\.repeat"):
        study(cycle={"phases": ["up", "down"], "repeat": repeat})


def test_cycles_of_other_phases_are_refused():
    with pytest.raises(NameNotFoundError, match="cycle: unknown phase 'hop'"):
        study(cycle={"phases": ["up", "hop"]})
    for phases in (["settle", "up"], ["down", "up"], []):
        with pytest.raises(StudyError, match="expected the last phases of the file in their order"):
            study(cycle={"phases": phases})


def test_directions_stay_in_the_plane_of_a_plane_template():
    assert study().loads[0].direction == (0.0, -1.0)
    with pytest.raises(StudyError, match=r"load 'gravity': direction = .* leaves the plane of the model"):
        study(gravity={"direction": "-z"})


def test_it_builds_a_model_that_is_measured():
    problem = study(mesh={"size": "2.5 mm"}).build()
    assert problem.model.mesh.space == "plane_strain"
    assert [measure.name for measure in problem.measures] == ["centre_of_mass_x", "centre_of_mass_y"]
    assert set(problem.model.surfaces) == {"PN1", "PN2", "PN3"}
