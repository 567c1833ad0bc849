"""A small gripper, half of one short finger, closes on a cup, and lifts it where friction holds."""

import pytest

from pneumorph.solution import solve
from pneumorph.studies import study_from

RISE, WEIGHT = 5.0, 6e-6 * 9810.0  # mm; N, of 6 g: half a finger of three bears a sixth


def lifted(friction, bottom, top):
    """Return the history of a cup of two radii, mm: settle, close with 60 kPa, raise the holder by 5 mm."""

    def phase(name, targets, first, largest):
        sizes = {"first_increment": first, "largest_increment": largest}
        return {"name": name, "targets": targets, "duration": "1 s", "inertia": "quasi-static", **sizes}

    table = {
        "actuator": {"template": "gripper", "half": True, "length": "38 mm", "chambers": 3, "palm_radius": "16 mm"},
        "mesh": {"size": "coarse"},
        "gravity": {},
        "support": [
            {"type": "roller", "face": "clamp", "axis": "x"},
            {"type": "roller", "face": "clamp", "axis": "y"},
            {"type": "prescribed", "face": "clamp", "axis": "z", "name": "holder"},
            {"type": "symmetry", "face": "symmetry_y"},
            {"type": "roller", "face": "cup", "axis": "x"},
            {"type": "roller", "face": "cup", "axis": "y"},
        ],
        "body": {
            "cup": {
                "shape": "revolved", "profile": [[f"{bottom} mm", "0 mm"], [f"{top} mm", "25 mm"]], "segments": 24,
                "point": ["0 mm", "0 mm", "-45 mm"], "mass": "1 g",
            },
            "table": {"shape": "half-space", "point": ["0 mm", "0 mm", "-45.1 mm"], "normal": "z"},
        },
        "contact": [
            {
                "name": "grip", "faces": ["outer_1", "tip_1"], "against": ["cup"], "friction": friction,
                "reach": "0.1 mm", "creep": "0.05 mm/s",
            },
            {"name": "stand", "faces": ["cup"], "body": "table", "friction": 0.5, "reach": "0.1 mm"},
        ],
        "phase": [
            phase("settle", {"gravity": "9.81 m/s²"}, 0.5, 0.5),
            phase("close", {"cavity_1": "60 kPa"}, 0.1, 0.25),
            phase("lift", {"holder": f"{RISE} mm"}, 0.2, 0.5),
        ],
    }  # fmt: skip
    problem = study_from(table, "lift").build()
    return solve(problem.model, problem.programme, settings=problem.settings).history


def at_the_end_of(history, phase, column):
    return float(history.values(column)[history.during(phase)][-1])


def test_a_cup_that_is_held_by_friction_rises_with_the_holder():
    history = lifted(0.5, 9.0, 10.0)
    assert 6.0 * at_the_end_of(history, "settle", "contact_force_z:stand") == pytest.approx(WEIGHT, rel=1e-3)
    # before the holder rises, table and fingers bear the cup together
    pressed = at_the_end_of(history, "close", "contact_force_z:grip")
    assert 6.0 * (at_the_end_of(history, "close", "contact_force_z:stand") - pressed) == pytest.approx(WEIGHT, rel=0.02)
    assert 6.0 * at_the_end_of(history, "lift", "contact_force_z:grip") == pytest.approx(-WEIGHT, rel=0.02)
    assert at_the_end_of(history, "lift", "contact_force_z:stand") == 0.0
    rise = at_the_end_of(history, "lift", "body_z:cup") - at_the_end_of(history, "close", "body_z:cup")
    assert 0.8 * RISE < rise < RISE
    assert history.smallest("contact_distance:") > 0.0


@pytest.mark.slow
def test_one_that_narrows_upwards_stays_on_the_table_without_friction():
    history = lifted(0.0, 10.0, 9.0)
    rise = at_the_end_of(history, "lift", "body_z:cup") - at_the_end_of(history, "close", "body_z:cup")
    assert abs(rise) < 0.1
    assert at_the_end_of(history, "lift", "contact_force_z:stand") > 0.0
