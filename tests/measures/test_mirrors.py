"""Measures of a body that is cut in a plane of symmetry: those of the whole."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.geometry.lattice import halves, skinned_tube
from pneumorph.materials import NeoHookean
from pneumorph.measures import Curvature, Diameter, TipRotation
from pneumorph.measures.mirrors import completed
from pneumorph.mechanics import Clamp, Model, Symmetry
from pneumorph.mechanics.state import rest
from pneumorph.mesh.skinned import mesh_skinned_tube

MATERIALS = {name: NeoHookean(0.1) for name in ("tube", "skin", "cap")}
LENGTH = 29.8


@pytest.fixture(scope="module", params=[False, True], ids=["whole", "half"])
def tube(request):
    mesh = mesh_skinned_tube(skinned_tube(halves(2, 8), length=LENGTH), half=request.param)
    supports = (Clamp("clamp"), Symmetry("symmetry_y")) if request.param else (Clamp("clamp"),)
    return Model(mesh, MATERIALS, supports)


def swollen(model, swell, radius):
    """All sections swell towards the middle of the length, the axis is bent to a circle about y."""
    x, y, z = model.mesh.points.T
    x, y = (c * (1.0 + swell * np.sin(np.pi * z / LENGTH)) for c in (x, y))
    place = np.column_stack([radius - (radius - x) * np.cos(z / radius), y, (radius - x) * np.sin(z / radius)])
    return replace(rest(model), displacement=place - model.mesh.points)


def test_a_tube_that_bends_has_its_curvature_however_it_swells(tube):
    state = swollen(tube, 0.3, 50.0)
    assert Curvature()(state) == pytest.approx(1.0 / 50.0, rel=0.1)
    assert TipRotation()(state) == pytest.approx(LENGTH / 50.0, rel=1e-6)


def test_a_tube_that_only_swells_has_none(tube):
    state = swollen(tube, 0.3, 1e6)
    assert Curvature()(state) < 2e-3  # not 0, because cells differ around the tube
    assert Diameter()(state) == pytest.approx(2.0 * 14.5 * 1.3, rel=2e-3)


def test_a_section_wider_across_the_plane_of_symmetry_than_along_it_has_its_larger_diameter(tube):
    points = tube.mesh.points
    state = replace(rest(tube), displacement=points * [0.0, 0.5, 0.0])
    assert Diameter()(state) == pytest.approx(3.0 * 14.5, rel=2e-3)


def test_points_are_completed_by_their_images():
    found = completed(np.array([[1.0, 2.0, 3.0]]), [(0, 0.0), (1, 5.0)])
    assert found == pytest.approx(np.array([[1, 2, 3], [-1, 2, 3], [1, 8, 3], [-1, 8, 3]]))
