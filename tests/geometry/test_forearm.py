"""The forearm: its solid, its sections, and its mesh of hexahedra."""

import math

import numpy as np
import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import Forearm, occ
from pneumorph.mesh import generate, inspect

ROUND = Forearm(100.0, 30.0, 30.0, 40.0, 40.0, 20.0)


@pytest.mark.parametrize("arm", [Forearm(), ROUND, Forearm(pressed=240.0)])
def test_solid_and_mesh_have_the_volume_of_a_tapered_elliptic_cylinder(arm):
    (a, b), (c, d) = arm.half_axes(0.0), arm.half_axes(arm.length)
    exact = math.pi * arm.length * (a * b / 3.0 + (a * d + b * c) / 6.0 + c * d / 3.0)
    assert arm.volume == pytest.approx(exact, rel=1e-12)
    assert occ.volume(arm.shape()) == pytest.approx(exact, rel=1e-6)
    assert inspect(generate(arm)).volume == pytest.approx(exact, rel=1e-3)


def test_the_girth_is_that_of_a_grown_man():
    for x, girth in ((0.0, 161.0), (250.0, 274.0)):
        a, b = Forearm().half_axes(x)
        angle = np.linspace(0.0, 2.0 * math.pi, 2001)
        found = np.hypot(np.diff(a * np.cos(angle)), np.diff(b * np.sin(angle))).sum()
        assert found == pytest.approx(girth, abs=0.6)


@pytest.mark.parametrize("settings", [{}, {"coarse": True}, {"size": 6.0}])
def test_the_mesh_ends_at_wrist_and_elbow_and_lies_on_the_skin(settings):
    arm = Forearm()
    mesh = generate(arm, **settings)
    assert set(mesh.faces) == set(arm.face_names)
    assert (mesh.points[mesh.face_nodes("wrist"), 0] == 0.0).all()
    np.testing.assert_allclose(mesh.points[mesh.face_nodes("elbow"), 0], arm.length, rtol=1e-12)
    x, y, z = mesh.points[mesh.face_nodes("skin")].T
    a, b = arm.half_axes(x)
    np.testing.assert_allclose((y / a) ** 2 + (z / b) ** 2, 1.0, rtol=1e-12)
    assert inspect(mesh).smallest_jacobian > 0.2


def test_the_mesh_is_finest_where_the_arm_is_pressed():
    mesh = generate(Forearm(pressed=120.0), 6.0)
    planes = np.unique(np.round(mesh.points[mesh.face_nodes("skin"), 0], 6))
    middles, steps = 0.5 * (planes[1:] + planes[:-1]), np.diff(planes)
    near = np.abs(middles - 120.0) < 12.0
    assert steps[near].max() < 3.5  # nodes lie at half a cell
    assert steps[~near].max() > 2.0 * steps[near].max()
    assert generate(Forearm(), 6.0).cell_count > 2 * generate(Forearm(), 12.0).cell_count


def test_what_makes_no_forearm_is_refused():
    with pytest.raises(GeometryError, match=r"wrist_thickness = 70 mm: expected at most wrist_width = 60 mm"):
        Forearm(wrist_thickness=70.0)
    with pytest.raises(GeometryError, match=r"pressed = 300 mm: expected at most length = 250 mm"):
        Forearm(pressed=300.0)
    with pytest.raises(MeshError, match=r"grading = 0\.5: a layered mesh has its size only"):
        generate(Forearm(), grading=0.5)
