"""Targets: named curves against their geometry, files with and without units, and where a curve is put."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from pneumorph.errors import InputError, NameNotFoundError, StudyError, UnitError
from pneumorph.studies.design import Target, named_curve, read_curve

EVEN = np.linspace(0.0, 1.0, 21)


@pytest.mark.parametrize("name", ["arc", "c", "s", "u", "helix", "line"])
def test_a_named_curve_has_its_length_and_starts_upright(name):
    curve = named_curve(name, 120.0, 0.0 if name == "line" else 1.0, 0.5 if name == "helix" else 0.0)
    assert curve.length == pytest.approx(120.0, rel=1e-5)
    np.testing.assert_allclose(curve.at([0.0, 0.001])[1], [0.0, 0.0, 0.12], atol=1e-3)
    assert curve.planar is (name != "helix")


def test_an_arc_bends_away_from_x():
    angle = math.pi / 2.0
    end = named_curve("arc", 100.0 * angle, angle).at([1.0])[0]
    np.testing.assert_allclose(end, [-100.0, 0.0, 100.0], atol=1e-3)


def test_an_s_ends_upright_and_is_its_own_image_turned_half_around():
    points = named_curve("s", 100.0, 1.0).at(EVEN)
    np.testing.assert_allclose(points + points[::-1], np.broadcast_to(points[-1], points.shape), atol=2e-3)
    assert points[-1, 0] < -10.0


def test_a_u_has_straight_thirds():
    points = named_curve("u", 90.0, math.pi).at([0.0, 1 / 3, 2 / 3, 1.0])
    np.testing.assert_allclose(points[1], [0.0, 0.0, 30.0], atol=0.02)
    np.testing.assert_allclose(points[3] - points[2], [0.0, 0.0, -30.0], atol=0.05)


def test_a_curve_may_lie_anywhere():
    arc = named_curve("s", 100.0, 1.2)
    moved = Rotation.from_euler("xyz", [0.3, 1.1, -2.0]).apply(arc.points) + np.array([5.0, -3.0, 40.0])
    np.testing.assert_allclose(Target("moved", moved).at(EVEN), arc.at(EVEN), atol=1e-3)


def test_points_of_a_file_in_any_unit(tmp_path):
    angle = np.linspace(0.0, 1.0, 15)
    lines = [f"{10.0 * math.sin(a)},{10.0 * (1.0 - math.cos(a))}" for a in angle]
    path = tmp_path / "hook.csv"
    path.write_text("z [cm],x [cm]\n" + "\n".join(lines) + "\n")
    np.testing.assert_allclose(read_curve(path).at(EVEN), named_curve("arc", 100.0, 1.0).at(EVEN), atol=0.05)


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("x,y\n0,0\n0,1\n0,2\n", UnitError, r"the column 'x' has no unit, expected 'x \[mm\]'"),
        ("x [kg],y [mm]\n0,0\n0,1\n0,2\n", UnitError, "'1 kg': expected length with its unit"),
        ("x [mm],a [mm]\n0,0\n", StudyError, r"column 'a \[mm\]': expected x, y, z with a unit"),
        ("x [mm]\n0\n", StudyError, "expected two or three of"),
        ("x [mm],z [mm]\n0,0\n1,b\n", StudyError, "point 2 has no number for z"),
        ("x [mm],z [mm]\n0,0\n1,2\n", InputError, "expected at least 3 finite points"),
        ("x [mm],z [mm]\n0,0\n0,0\n1,2\n", InputError, "neighbouring points coincide"),
    ],
)
def test_a_file_that_is_no_curve_is_refused(tmp_path, text, error, message):
    path = tmp_path / "curve.csv"
    path.write_text(text)
    with pytest.raises(error, match=message):
        read_curve(path)


def test_what_makes_no_curve_is_refused(tmp_path):
    with pytest.raises(NameNotFoundError, match="unknown curve 'helx': did you mean 'helix'"):
        named_curve("helx", 100.0, 1.0)
    with pytest.raises(InputError, match="length = 0 mm: expected more than 0"):
        named_curve("arc", 0.0, 1.0)
    with pytest.raises(InputError, match="only a helix has one"):
        named_curve("arc", 100.0, 1.0, 0.1)
    with pytest.raises(StudyError, match="cannot read"):
        read_curve(tmp_path / "none.csv")
