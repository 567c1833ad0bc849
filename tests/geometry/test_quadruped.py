"""The quadruped's dimensions: what the study gives, what follows, and what is refused."""

import math

import pytest

from pneumorph.errors import GeometryError
from pneumorph.geometry import Quadruped


def test_the_study_gives_the_outer_size_the_layers_and_the_channels():
    given = {row.symbol: row.value for row in Quadruped().dimensions() if row.given}
    assert given == {"L": 135.7, "B": 58.5, "h": 5.3, "s": 1.0, "d": 4.0, "t": 1.5, "g": 2.0}
    assert Quadruped().height == pytest.approx(6.3)


def test_legs_centre_and_their_turns_fill_the_length_and_the_width():
    robot = Quadruped(body_width=24.0, leg_width=16.0, junction=3.0)
    assert math.cos(robot.leg_angle) == pytest.approx(0.75)
    reach = robot.junction + robot.leg_width * math.sin(robot.leg_angle) + robot.leg_length * math.cos(robot.leg_angle)
    assert robot.centre_length + 2.0 * reach == pytest.approx(robot.length)
    assert robot.body_width + 2.0 * robot.leg_length * math.sin(robot.leg_angle) == pytest.approx(robot.width)


def test_by_default_the_legs_lie_along_the_diagonals_of_the_plan():
    robot = Quadruped()
    assert math.tan(robot.leg_angle) == pytest.approx(robot.width / robot.length, rel=0.02)


def test_as_many_channels_as_fit_between_gaps():
    robot = Quadruped()
    for length, count in ((robot.leg_length, robot.leg_channels), (robot.centre_length, robot.centre_channels)):
        assert count * (robot.channel + robot.gap) + robot.gap <= length
        assert (count + 1) * (robot.channel + robot.gap) + robot.gap > length


def test_a_half_has_the_legs_on_the_left():
    robot = Quadruped(half=True)
    assert robot.cavities == ("PN1", "PN3", "PN5")
    assert "symmetry_y" in robot.face_names
    assert "foot_PN2" not in robot.face_names
    assert robot.centre_volume == pytest.approx(Quadruped().centre_volume / 2.0)
    assert robot.plan_area == pytest.approx(Quadruped().plan_area / 2.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"half": 1}, r"half = 1: expected True or False"),
        ({"channel_depth": 5.3}, r"no roof: channel_depth = 5.3 mm, expected less than soft = 5.3 mm"),
        ({"body_width": 30.0}, r"body_width = 30 mm: expected less than 2 \* leg_width = 30 mm"),
        ({"body_width": 58.5, "leg_width": 40.0}, r"body_width = 58.5 mm: expected less than width = 58.5 mm"),
        ({"side_wall": 7.5}, r"leg_width = 15 mm leaves no channels: expected more than 2 \* side_wall = 15 mm"),
        ({"gap": 20.0}, r"the legs of 38.78 mm hold no channel: expected at least .* 41.5 mm"),
        ({"length": 90.0}, r"length = 90 mm leaves 2.907 mm for the centre: expected at least .* 5.5 mm"),
        ({"leg_width": "15 mm"}, r"leg_width = '15 mm': expected a finite number in mm"),
    ],
)
def test_dimensions_that_do_not_fit_are_refused(change, message):
    with pytest.raises(GeometryError, match=message):
        Quadruped(**change)


def test_there_is_no_cad_solid():
    with pytest.raises(GeometryError, match="no CAD solid: export its mesh"):
        Quadruped().shape()
