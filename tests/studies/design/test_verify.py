"""The full model of a design bends to the side that the surrogate says: signs and frames of map, mesh and rod."""

import numpy as np
import pytest

from pneumorph.studies.design.law import Bend
from pneumorph.studies.design.skin import Part, SkinDesign, seam_angle
from pneumorph.studies.design.task import design_from
from pneumorph.studies.design.verify import fractions_of, verify

HELIX = {"curve": "helix", "length": "30 mm", "angle": "2 deg", "twist": "30 deg"}


class Law:
    """Every segment turns a little."""

    end = 0.0

    def bend(self, lattice, cg, pressure):
        return Bend(3e-4, 1.0)


@pytest.fixture(scope="module")
def task():
    search = {"segments": 2, "cells_along": [2], "cells_around": [6], "cg": [0.2, 0.5], "pressure": ["1 kPa", "2 kPa"]}
    steps = {"first_increment": 1.0, "largest_increment": 1.0}
    return design_from({"target": HELIX, "actuator": {"length": "29.8 mm"}, "search": search, "steps": steps}, "x")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("middles", "half"),
    [((3, 3), True), ((9, 9), True), ((1, 5), False)],
    ids=["right", "left", "two ways"],
)
def test_the_tip_goes_where_the_rod_says(task, middles, half):
    """A half is turned into the frame of the map; a whole tube has no mirror plane and stays."""
    design = SkinDesign(tuple(Part(1, 0.2, 3, middle) for middle in middles), 6, 0.002)
    actuator = task.verification(design).actuator
    assert actuator.half is half
    assert seam_angle(actuator) == pytest.approx(np.pi / 2 if half else 0.0)
    predicted = design.line(Law(), 29.8, [1.0])[0, :2]
    found = verify(task, design).line[-1, :2]
    cosine = predicted @ found / np.linalg.norm(predicted) / np.linalg.norm(found)
    assert np.degrees(np.arccos(min(1.0, cosine))) < 20.0


def test_fractions_follow_the_line():
    line = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [3.0, 0.0, 1.0]])
    np.testing.assert_allclose(fractions_of(line), [0.0, 0.25, 1.0])


def test_a_part_puts_its_reentrant_columns_about_its_middle():
    """Twice the border: 3 columns about 5/2 are those from 1 to 3; about border 0 of 12, 6 lie from 9 to 2."""
    kinds = [cell.kind == "re-entrant" for cell in Part(1, 0.2, 3, 5).segment(6).cells((), 0.2).row]
    assert kinds == [False, True, True, True, False, False]
    kinds = [cell.kind == "re-entrant" for cell in Part(1, 0.2, 6, 0).segment(12).cells((), 0.2).row]
    assert [i for i, one in enumerate(kinds) if one] == [0, 1, 2, 9, 10, 11]
