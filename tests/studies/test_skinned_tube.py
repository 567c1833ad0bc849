"""Studies of the tube with a lattice skin: which way it bends, and when it does not."""

import pytest

from pneumorph.studies import run_study, study_from


def rotation(pressure="2 kPa", **changed):
    """Tip rotation (rad) of a short tube, positive away from the re-entrant half."""
    actuator = {"template": "skinned-tube", "cells_along": 1, "cells_around": 6, "length": "14.9 mm", "half": True}
    table = {
        "title": "short tube",
        "actuator": actuator | changed,
        "mesh": {"size": "coarse"},
        "phase": [
            {"name": "inflate", "targets": {"cavity": pressure}, "first_increment": 1.0, "largest_increment": 1.0}
        ],
    }
    return run_study(study_from(table, "short tube")).history.values("tip_rotation")[-1]


@pytest.fixture(scope="module")
def bent():
    return rotation()


def test_it_bends_away_from_its_reentrant_half(bent):
    """Pu et al. 2024: the re-entrant half is the softer one lengthwise."""
    assert bent > 1e-3


@pytest.mark.parametrize(
    "changed", [{"cg": 0.5}, {"cg": 0.5, "least_beam": "1.1 mm"}, {"reentrant": 0.0}, {"reentrant": 1.0}]
)
def test_a_skin_that_is_the_same_all_around_does_not_bend(bent, changed):
    """But for the triangles of the mesh at the caps, which are not the same all around."""
    assert abs(rotation(**changed)) < 0.1 * bent
