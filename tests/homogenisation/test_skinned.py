"""Homogenised skins: how well the law fits its cell, smooth meshes, and inflation."""

import math

import numpy as np
import pytest

from pneumorph.errors import InputError, MeshError
from pneumorph.geometry.lattice import Cell, Segment, cell_map, halves, skinned_tube
from pneumorph.homogenisation import blended, homogenised_model, inflate, inflated_line, skin_law
from pneumorph.homogenisation.law import SKIN
from pneumorph.materials import NeoHookean, OrthotropicLayer, Prony, Ridges
from pneumorph.measures import Curvature, Diameter
from pneumorph.measures.circle import fit_circle
from pneumorph.mesh.reference import jacobians, quadrature
from pneumorph.mesh.smooth_tube import mesh_smooth_tube, skin_domains

TUBE = skinned_tube(halves(2, 12), length=29.8)


def layer(stiffness):
    """A layer of constant curvature: W = stiffness / 2 sum of (l . e)^2 over three directions."""
    ridges = Ridges(np.eye(3), np.array([-1.0, 0.0, 1.0]), np.full((3, 3), stiffness))
    return OrthotropicLayer(surface=ridges, thickness=1.0, transverse=0.5, frame="cylinder")


def volumes(mesh):
    result = {}
    for block in mesh.blocks:
        volume = float((jacobians(mesh.points, block.kind, block.nodes) @ quadrature(block.kind)[1]).sum())
        result[block.domain] = result.get(block.domain, 0.0) + volume
    return result


def test_the_law_of_a_bare_skin_fits_its_cell_and_keeps_its_symmetry():
    law = skin_law(Cell("honeycomb", 0.4), TUBE, bonded=False)
    assert law.misfit < 0.05
    _, second = law.layer.surface.derivatives(np.zeros((1, 3)))
    assert abs(second[0, 2, :2]).max() < 1e-9
    assert np.linalg.eigvalsh(second[0]).min() > 0.0
    assert skin_law(Cell("honeycomb", 0.4), TUBE, bonded=False) is law


def test_a_viscous_skin_is_refused():
    viscous = NeoHookean(SKIN.shear_modulus, prony=Prony((0.2,), (1.0,)))
    with pytest.raises(InputError, match="viscous"):
        skin_law(Cell("honeycomb"), TUBE, skin_material=viscous)


@pytest.mark.parametrize("half", [False, True])
def test_each_kind_of_cell_has_a_domain_of_its_closed_form_volume(half):
    soft, stiff = Cell("re-entrant"), Cell("honeycomb")
    cells = cell_map([Segment(1, ((4, soft), (8, stiff))), Segment(2, ((12, soft),))])
    tube = skinned_tube(cells, length=44.7)
    mesh = mesh_smooth_tube(tube, half=half)
    assert list(skin_domains(tube.lattice).values()) == [soft, stiff]
    share = 0.5 if half else 1.0
    found, ring = volumes(mesh), math.pi * (16.5**2 - 14.5**2)
    assert found["skin 1"] == pytest.approx(share * ring * (14.9 * 4 / 12 + 29.8), rel=1e-3)
    assert found["skin 2"] == pytest.approx(share * ring * 14.9 * 8 / 12, rel=1e-3)
    assert found["tube"] == pytest.approx(share * tube.tube_volume, rel=1e-3)
    radius = np.hypot(*mesh.points[mesh.face_nodes("outer")][:, :2].T)
    assert radius == pytest.approx(np.full(len(radius), 14.5), rel=2e-3)


def test_a_tube_bends_away_from_its_softer_half_and_equal_halves_do_not_bend():
    """But for the triangles of the mesh at the caps, which are not the same all around."""
    tips = {}
    for ratio in (1.0, 4.0):
        model = homogenised_model(TUBE, {"skin 1": layer(0.5), "skin 2": layer(0.5 * ratio)})
        state = inflate(model, 1e3)
        assert state.volume["cavity"] - model.surfaces["cavity"].reference_volume == pytest.approx(500.0)
        tips[ratio] = state.displacement[model.mesh.face_nodes("tip"), 0].mean()
        assert Diameter()(state) > 29.0
    assert tips[4.0] < -0.01
    assert abs(tips[1.0]) < 0.1 * abs(tips[4.0])


def test_whole_and_half_tubes_have_the_same_centre_line():
    laws = {"skin 1": layer(0.5), "skin 2": layer(2.0)}
    line, state = inflated_line(TUBE, 0.002, supply="pressure", laws=laws)
    whole = inflate(homogenised_model(TUBE, laws, half=False, supply="pressure"), 0.002)
    assert state.pressure["cavity"] == pytest.approx(0.002)
    assert fit_circle(line).curvature == pytest.approx(Curvature(sections=24)(whole), rel=0.05)


def test_blended_layers_lie_between_their_parents():
    between = blended(layer(1.0), layer(3.0), 0.25)
    assert between.surface.curvature == pytest.approx(np.full((3, 3), 1.5))
    with pytest.raises(InputError, match=r"share = 1\.5, allowed: 0 to 1"):
        blended(layer(1.0), layer(2.0), 1.5)
    other = OrthotropicLayer(
        surface=Ridges(np.eye(3), np.array([0.0, 2.0]), np.ones((3, 2))), thickness=1.0, transverse=1.0
    )
    with pytest.raises(InputError, match="other directions or knots"):
        blended(layer(1.0), other, 0.5)


def test_what_a_smooth_tube_cannot_be_made_of_is_refused():
    with pytest.raises(InputError, match="supply = 'gas', allowed: volume, pressure"):
        homogenised_model(TUBE, {}, supply="gas")
    with pytest.raises(MeshError, match="size = 0"):
        mesh_smooth_tube(TUBE, 0)
    cells = cell_map([Segment(1, ((1, Cell("brick", 0.2)), (2, Cell("brick", 0.3)), (3, Cell("brick", 0.4))))])
    with pytest.raises(MeshError, match="not its own mirror image"):
        mesh_smooth_tube(skinned_tube(cells), half=True)
