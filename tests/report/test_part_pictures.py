"""Maps on one part of several: where it is pressed, how far it moves, and what is left out."""

import numpy as np
import pytest

from pneumorph.measures import contact_pressure
from pneumorph.report.fields import CONTACT_PRESSURE
from pneumorph.report.part_pictures import PartMap, part_names, part_pictures, touched_most
from pneumorph.studies import run_study, study_from

BAR = {
    "template": "forearm", "length": "30 mm", "pressed": "15 mm", "wrist_width": "10 mm", "wrist_thickness": "10 mm",
    "elbow_width": "10 mm", "elbow_thickness": "10 mm",
}  # fmt: skip


@pytest.fixture(scope="module")
def pressed():
    """Return the run of a bar that is lowered across another one, both round."""
    bar = {"actuator": BAR, "mesh": {"size": "5 mm"}}
    table = bar | {
        "part": {
            "upper": bar | {"turn": [{"axis": "z", "angle": "90 deg"}], "shift": ["15 mm", "-15 mm", "10.4 mm"]},
        },
        "support": [
            *({"type": "clamp", "face": face} for face in ("wrist", "elbow")),
            *({"type": "roller", "face": f"upper.{e}", "axis": a} for e in ("wrist", "elbow") for a in "xy"),
            *({"type": "prescribed", "face": f"upper.{e}", "axis": "z", "name": e} for e in ("wrist", "elbow")),
        ],
        "contact": [{"name": "cross", "faces": ["upper.skin"], "against": ["skin"], "reach": "0.3 mm"}],
        "gravity": {"direction": "-z"},
        "phase": [
            {"name": "gravity", "targets": {"gravity": "9.81 m/s^2"}},
            {"name": "lower", "targets": dict.fromkeys(("wrist", "elbow"), "-0.6 mm")},
        ],
    }
    return run_study(study_from(table, "crossed"))


def test_the_parts_are_those_of_the_study(pressed):
    assert part_names(pressed) == ("upper",)


def test_the_map_of_a_part_holds_its_own_faces_and_where_it_is_pressed(pressed):
    drawn, state = PartMap(pressed, "upper"), touched_most(pressed)
    assert state is not None
    assert set(drawn.faces) == {"upper.wrist", "upper.elbow", "upper.skin"}
    pressure = contact_pressure(state)
    strongest = pressed.model.mesh.points[drawn.nodes[np.argmax(pressure[drawn.nodes])]]
    # the crossing, on the lower side of the upper bar
    np.testing.assert_allclose(strongest, [15.0, 0.0, 5.4], atol=2.6)
    far, near = drawn._views(state)
    assert far.direction[2] < 0.0
    assert near is not None
    assert near.width < far.width


def test_both_sides_bear_the_same_force(pressed):
    state = pressed.states[-1]
    pressure = contact_pressure(state, "cross")
    mesh = pressed.model.mesh
    peaks = [pressure[mesh.face_nodes(name)].max() for name in ("skin", "upper.skin")]
    assert min(peaks) > 0.3 * max(peaks) > 0.0
    assert pressed.history.values("contact_pressure:cross")[-1] == pytest.approx(peaks[1], rel=1e-9)


def test_the_scale_of_contact_pressure_is_that_of_what_touches_without_its_edges():
    pressure = np.zeros(1000)
    pressure[:99], pressure[99] = np.linspace(0.01, 0.02, 99), 5.0
    low, high, largest = CONTACT_PRESSURE.limits([np.zeros(1000), pressure])
    assert (low, largest) == (0.0, 5.0)
    assert 0.019 < high <= 0.02
    assert CONTACT_PRESSURE.limits([np.zeros(1000)])[1] > 0.0


def test_displacement_counts_from_the_end_of_gravity(pressed):
    drawn = PartMap(pressed, "upper")
    assert drawn.before.phase == "gravity"
    assert drawn.displacement(drawn.before).max() == 0.0
    moved = drawn.displacement(pressed.states[-1])[drawn.nodes]
    assert moved.max() == pytest.approx(0.6, rel=0.1)


def test_the_pictures_are_a_map_of_displacement_and_one_of_pressure(pressed):
    pytest.importorskip("pyvista")
    names, captions, pictures = zip(*part_pictures(pressed), strict=True)
    assert names == ("upper-displacement", "upper-contact-pressure")
    assert "since the phase 'gravity'" in captions[0]
    assert all(picture.ndim == 3 and picture.std() > 5.0 for picture in pictures)
