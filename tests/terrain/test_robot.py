from dataclasses import replace
from itertools import pairwise
from math import cos, hypot, pi, sin

import pytest

from pneumorph.errors import InputError
from pneumorph.terrain import Drive, Rover, Wheel, all_wheels


def corners(box):
    """Return the corners of a box in the wheel's plane (x, z)."""
    along, across = (sin(box.angle), cos(box.angle)), (cos(box.angle), -sin(box.angle))
    return [
        (
            box.x + a * 0.5 * box.length * along[0] + b * 0.5 * box.thickness * across[0],
            box.z + a * 0.5 * box.length * along[1] + b * 0.5 * box.thickness * across[1],
        )
        for a in (-1, 1)
        for b in (-1, 1)
    ]


PADDLED = [wheel for wheel in all_wheels() if wheel.paddles]


def test_there_are_nine_wheels_of_equal_radius():
    names = [wheel.name for wheel in all_wheels()]
    assert names == [f"{kind}-{n}" for kind in ("straight", "curved") for n in (1, 2, 3, 4)] + ["plain"]
    assert {wheel.radius for wheel in all_wheels()} == {140.0}


@pytest.mark.parametrize("wheel", PADDLED, ids=lambda w: w.name)
def test_the_outermost_corner_of_the_paddles_lies_on_the_radius(wheel):
    assert max(hypot(*corner) for box in wheel.boxes for corner in corners(box)) == pytest.approx(wheel.radius)


@pytest.mark.parametrize("wheel", PADDLED, ids=lambda w: w.name)
def test_paddles_are_copies_turned_by_equal_angles(wheel):
    each = len(wheel.boxes) // wheel.paddles
    assert each == (4 if wheel.curved else 1)
    turn = 2.0 * pi / wheel.paddles
    for one, other in zip(wheel.boxes, wheel.boxes[each:], strict=False):
        x, z = one.x * cos(turn) + one.z * sin(turn), -one.x * sin(turn) + one.z * cos(turn)
        assert (other.x, other.z) == pytest.approx((x, z), abs=1e-9)


def test_the_first_paddle_points_down_and_a_curved_one_trails():
    (straight,) = Wheel(1).boxes
    assert (straight.x, straight.z) == pytest.approx((0.0, -0.5 * straight.length), abs=1e-9)
    curved = Wheel(1, curved=True).boxes
    # rolling forward the lower paddle moves towards -x: there bulges the convex side
    assert all(box.x < 0.0 for box in curved)
    assert curved[0].angle - curved[-1].angle == pytest.approx(pi / 2.0 * 3.0 / 4.0)


def test_the_pieces_of_a_curved_paddle_join():
    boxes = Wheel(1, curved=True).boxes
    for one, other in pairwise(boxes):
        end = (one.x + 0.5 * one.length * sin(one.angle), one.z + 0.5 * one.length * cos(one.angle))
        start = (other.x - 0.5 * other.length * sin(other.angle), other.z - 0.5 * other.length * cos(other.angle))
        assert end == pytest.approx(start, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"paddles": 5}, r"paddles = 5, expected 0 \(a plain disc\) to 4"),
        ({"paddles": 0, "curved": True}, "curved = True with paddles = 0"),
        ({"radius": 0.0}, "radius = 0 mm, expected more than 0"),
        ({"thickness": 150.0}, "thickness = 150 mm, expected less than the radius, 140 mm"),
        ({"hub_radius": 140.0}, "hub_radius = 140 mm, expected less than the radius"),
        ({"arc": 4.0}, "arc = 229.2 deg, expected more than 0 and at most 180 deg"),
    ],
)
def test_impossible_wheels_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(Wheel(2), **change)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": -1.0}, "rover: mass = -1e\\+09 mg, expected more than 0"),
        ({"wheel_mass": 125e-6}, "wheel_mass = 125000 mg, expected less than a quarter of the mass"),
        ({"track": 335.0}, "larger than the track: width 40 mm, expected less than 35 mm"),
        ({"wheelbase": 270.0}, "larger than the wheelbase: diameter 280 mm, expected less than 270 mm"),
        ({"height": 280.0}, "height = 280 mm, expected less than the wheels' diameter, 280 mm"),
    ],
)
def test_robots_that_do_not_fit_together_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        Rover(Wheel(3), **change)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"speed": 0.0}, "drive: speed = 0, expected more than 0"),
        ({"damping": -1.0}, "drive: damping = -1, expected at least 0"),
        ({"friction": (0.6, -1.0, 0.2)}, "expected three numbers of at least 0"),
        ({"contact_dimension": 2}, "contact_dimension = 2, expected 1, 3, 4 or 6"),
        ({"record": 0.003}, "record = 0.003 s, expected a whole number of times 0.002 s"),
        ({"duration": 10.52}, "duration = 10.52 s, expected a whole number of times 0.05 s"),
    ],
)
def test_impossible_drives_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        Drive(**change)


def test_the_wanted_turn_is_the_integral_of_the_wanted_speed():
    for drive in (Drive(), Drive(duration=0.5)):
        n = 10_000
        times = [drive.duration * (i + 0.5) / n for i in range(n)]
        integral = sum(drive.wanted_speed(t) for t in times) * drive.duration / n
        assert drive.wanted_turn == pytest.approx(integral, rel=1e-6)
