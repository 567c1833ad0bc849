"""The soft limb: dimensions that fit, a solid that is what they say, and a cavity that closes."""

from dataclasses import replace
from math import atan2, cos, hypot, pi, sin

import numpy as np
import pytest

from pneumorph.errors import GeometryError
from pneumorph.geometry import SoftLimb, occ
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Clamp, Model, Symmetry
from pneumorph.mesh import generate

SMALL = SoftLimb(chambers=2, length=55.0, half=True)
RUBBER = NeoHookean(0.2)


def test_a_sector_of_a_ring_has_its_volume():
    ring = occ.side_sector((0.0, -54.5), (40.0, 54.5), (0.0, 2.2), -3.0, 3.0)
    assert occ.volume(ring) == pytest.approx(0.5 * 2.2 * (54.5**2 - 40.0**2) * 6.0)


def test_the_defaults_are_described_and_none_but_the_form_is_given_by_the_study():
    rows = SoftLimb().dimensions()
    assert len({row.symbol for row in rows}) == len(rows)
    assert not any(row.given for row in rows)
    assert np.linalg.norm(SoftLimb().axis) == pytest.approx(1.0)


def test_half_a_limb_has_half_the_volume_and_half_the_air():
    whole = replace(SMALL, half=False)
    assert occ.volume(SMALL.shape()) == pytest.approx(0.5 * occ.volume(whole.shape()), rel=1e-6)
    assert SMALL.cavity_volume == pytest.approx(0.5 * whole.cavity_volume, rel=1e-6)


def test_the_air_is_that_of_the_trapezoids_above_a_round_base_and_of_the_airway():
    """With an airway that is as wide as a chamber and hardly high, the air is nearly that of the trapezoids alone."""
    limb = replace(SMALL, chambers=1, length=36.0, half=False)
    trapezoid = 0.5 * (limb.chamber_foot + limb.chamber_top) * limb.chamber_height
    # between the flat foot of the trapezoid and the round base: a segment of the circle inside the base
    radius, half = limb.radius - limb.base, 0.5 * limb.chamber_foot
    segment = 2.0 / 3.0 * half**3 / radius
    expected = (trapezoid - segment) * limb.chamber_depth
    # the foot is x1 wide at the level of the base, a little less where the walls meet the lower ends of the arc
    assert limb.cavity_volume == pytest.approx(expected, rel=0.03)


def test_every_face_has_one_of_the_names_that_the_template_lists():
    for limb in (SMALL, replace(SMALL, half=False)):
        assert {face.name or "outer" for face in limb.shape().faces} == set(limb.face_names)


def test_the_mesh_closes_its_cavity_and_foot_and_tip_lie_where_the_template_says():
    mesh = generate(SMALL, 7.0, detail=0.2)
    model = Model(
        mesh, {"body": RUBBER, "base": RUBBER}, (Clamp("clamp"), Symmetry("symmetry_y")), (),
        (Cavity("cavity", ("cavity",), mirrors=("symmetry_y",)),),
    )  # fmt: skip
    assert model.surfaces["cavity"].reference_volume == pytest.approx(SMALL.cavity_volume, rel=0.01)
    sole = mesh.points[mesh.face_nodes("foot")]
    assert np.hypot(sole[:, 0], sole[:, 2] + SMALL.radius) == pytest.approx(SMALL.radius + SMALL.foot_height, abs=0.05)
    # middle of the sole, from the middle of the arc
    x, _, z = SMALL.foot_point
    assert hypot(x, z + SMALL.radius) == pytest.approx(SMALL.radius + SMALL.foot_height)
    assert atan2(x, z + SMALL.radius) == pytest.approx(SMALL.turn - 0.5 * SMALL.foot_length / SMALL.radius)
    tip = mesh.points[mesh.face_nodes("tip")]
    normal = np.array([cos(SMALL.turn), 0.0, -sin(SMALL.turn)])
    place = np.array([SMALL.radius * sin(SMALL.turn), 0.0, SMALL.radius * (cos(SMALL.turn) - 1.0)])
    assert np.abs((tip - place) @ normal).max() < 1e-6
    assert mesh.points[mesh.face_nodes("clamp")][:, 0] == pytest.approx(0.0, abs=1e-9)


def test_the_pleats_all_but_touch_at_rest_where_the_limb_is_most_curved():
    limb = SoftLimb()
    top = limb._pleat_top
    room = 2.0 * (limb.radius - limb.height) * np.tan(0.5 * limb.pitch)
    assert 0.1 < room - top < 1.0
    assert limb.cuts[0] - limb.root / limb.radius == pytest.approx(limb.pitch)
    assert pi / 2 < limb.turn < pi


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"half": 1}, r"half = 1: expected True or False"),
        ({"length": 400.0}, r"length = 400 mm: expected less than a full turn"),
        ({"root": 130.0}, r"root \+ end = 142 mm: expected less than length = 125 mm"),
        ({"chamber_height": 50.0}, r"= 58 mm: expected less than radius = 54.5 mm"),
        ({"chamber_top": 9.0}, r"chamber_top = 9 mm: expected at most chamber_foot = 8 mm"),
        ({"depth": 6.0}, r"the side walls overlap: depth = 6 mm, expected more than 2 \* side_wall = 6 mm"),
        ({"airway_width": 40.0}, r"airway_width = 40 mm: expected at most depth - 2 \* side_wall = 36 mm"),
        ({"airway_roof": 14.0}, r"airway_height \+ airway_roof = 17 mm: expected less than"),
        ({"foot_length": 13.0}, r"foot_length = 13 mm: expected at most end = 12 mm"),
        ({"chamber_top": 6.0}, r"the pleats overlap: .* wide 22 mm inside the outer arc"),
        ({"chambers": 8}, r"the pleats overlap: .* that 8 pleats leave there"),
    ],
)
def test_dimensions_that_do_not_fit_are_refused(change, message):
    with pytest.raises(GeometryError, match=message):
        SoftLimb(**change)
