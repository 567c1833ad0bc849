"""Studies with a homogenised skin."""

import numpy as np
import pytest

from pneumorph.errors import StudyError
from pneumorph.materials import OrthotropicLayer, Ridges
from pneumorph.solution import Solution
from pneumorph.studies import run_study, study_from

TUBE = {
    "template": "skinned-tube", "cells_along": 2, "cells_around": 12, "length": "29.8 mm", "cg": 0.4, "half": True
}  # fmt: skip
PHASE = {"name": "inflate", "targets": {"cavity": "2 kPa"}, "first_increment": 1.0, "largest_increment": 1.0}


def study(**mesh):
    return study_from({"title": "smooth", "actuator": TUBE, "mesh": mesh, "phase": [PHASE]}, "smooth")


@pytest.mark.slow
def test_a_homogenised_skin_bends_as_the_lattice_does():
    lattice, smooth = (
        run_study(study(**mesh)).history.values("tip_rotation")[-1]
        for mesh in ({"size": "coarse"}, {"homogenised": True})
    )
    assert smooth == pytest.approx(lattice, rel=0.25)


def test_a_homogenised_run_is_stored_and_read_back(tmp_path, monkeypatch):
    ridges = Ridges(np.eye(3), np.array([-1.0, 0.0, 1.0]), np.ones((3, 3)))
    made = OrthotropicLayer(surface=ridges, thickness=1.0, transverse=0.5, frame="cylinder")
    monkeypatch.setattr("pneumorph.studies.homogenised.skin_laws", lambda *_: {"skin 1": made, "skin 2": made})
    smooth = run_study(study(homogenised=True), tmp_path / "run")
    again = Solution.open(tmp_path / "run")
    first, second = (item.model.materials["skin 1"].surface for item in (smooth, again))
    assert np.array_equal(first.curvature, second.curvature)


@pytest.mark.parametrize(
    ("actuator", "mesh", "message"),
    [
        ({"template": "finger"}, {}, "only the template 'skinned-tube'"),
        (TUBE, {"detail": 0.5}, "detail is given with homogenised = true"),
    ],
)
def test_what_cannot_be_homogenised_is_refused(actuator, mesh, message):
    table = {"actuator": actuator, "mesh": mesh | {"homogenised": True}, "phase": [PHASE]}
    with pytest.raises(StudyError, match=message):
        study_from(table, "refused")
