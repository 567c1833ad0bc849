"""Bodies that a line makes which is turned about an axis: volume, closure, and lines that make none."""

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.mechanics import Revolved
from pneumorph.mechanics.contact.free_body import moments

CUP = ((0.0, 0.0), (20.0, 0.0), (25.0, 60.0), (23.0, 60.0), (18.0, 2.0), (0.0, 2.0))


def disc(segments):
    """Return the area of the regular polygon with corners at distance 1 from its middle."""
    return 0.5 * segments * np.sin(2.0 * np.pi / segments)


def test_a_ball_has_the_volume_and_moments_of_one():
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 41)
    line = tuple((float(max(3.0 * np.cos(a), 0.0)), float(3.0 * np.sin(a))) for a in angle)
    volume, centre, spread = moments(*Revolved(line, (1.0, 2.0, 3.0), (1.0, 1.0, 0.0), 96).facets(3), "ball")
    assert volume == pytest.approx(4.0 / 3.0 * np.pi * 27.0, rel=3e-3)
    assert centre == pytest.approx([1.0, 2.0, 3.0])
    assert spread == pytest.approx(9.0 / 5.0 * np.eye(3), rel=3e-3, abs=1e-3)


def test_a_cup_holds_the_volume_of_its_frustums():
    def frustum(a, b, height):
        return disc(48) * height * (a * a + a * b + b * b) / 3.0

    points, facets = Revolved(CUP).facets(3)
    volume, centre, _ = moments(points, facets, "cup")
    assert volume == pytest.approx(frustum(20.0, 25.0, 60.0) - frustum(18.0, 23.0, 58.0), rel=1e-9)
    assert centre[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert points[:, 2].min() == 0.0
    assert points[:, 2].max() == 60.0


@pytest.mark.parametrize("line", [CUP, CUP[::-1], ((2.0, 0.0), (2.0, 5.0)), ((0.0, 5.0), (2.0, 0.0))])
def test_facets_look_outwards_whichever_way_the_line_runs(line):
    points, facets = Revolved(line, segments=12).facets(3)
    assert np.linalg.det(points[facets]).sum() / 6.0 > 0.0
    assert moments(points, facets, "body")[0] > 0.0  # closed


def test_ends_off_the_axis_are_closed_by_discs():
    volume, _, _ = moments(*Revolved(((2.0, 0.0), (2.0, 5.0)), segments=12).facets(3), "bar")
    assert volume == pytest.approx(5.0 * 4.0 * disc(12))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Revolved(((1.0, 0.0),)), "1 points of its profile, allowed: 2 or more"),
        (lambda: Revolved(((-1.0, 0.0), (1.0, 1.0))), "distance from the axis = -1 mm, allowed: 0 or more"),
        (lambda: Revolved(((1.0, np.inf), (1.0, 1.0))), "expected 2 finite numbers"),
        (lambda: Revolved(CUP, segments=7), "segments = 7, allowed: 8 or more"),
        (lambda: Revolved(CUP).facets(2), "a plane model meets blocks"),
        (lambda: Revolved(((1.0, 3.0), (2.0, 3.0))).facets(3), "encloses no volume"),
        (lambda: Revolved(CUP, axis=(0.0, 0.0, 0.0)).facets(3), "a vector that is not zero"),
    ],
)
def test_lines_that_make_no_body_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()
