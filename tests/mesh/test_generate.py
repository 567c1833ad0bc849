"""Actuator -> mesh: names, closed cavities, volumes, straight and curved cells, determinism."""

import numpy as np
import pytest

from pneumorph.errors import MeshError
from pneumorph.geometry import Finger, HexagonalPrism, PneuNet, ThickSphere, ThickTube, occ
from pneumorph.mesh import generate, inspect
from pneumorph.mesh.generate import from_raw
from pneumorph.mesh.reference import NODES, jacobians, quadrature, shape, shape_gradient, straightened
from pneumorph.mesh.structured import box
from pneumorph.mesh.topology import boundary, open_edges

PRISM = HexagonalPrism(chambers=2, length=22.0)
ACTUATORS = {
    "prism": PRISM,
    "finger": Finger(),
    "pneunet": PneuNet(chambers=3),
    "tube": ThickTube(),
    "quarter tube": ThickTube(quarter=True, cap=0.0),
    "sphere": ThickSphere(),
    "octant": ThickSphere(octant=True),
}


@pytest.fixture(scope="module")
def meshes():
    return {name: generate(actuator, coarse=True) for name, actuator in ACTUATORS.items()}


def enclosed_volume(mesh, name):
    """-1/3 of the integral of x . n over the faces: the volume of a cavity (its faces look into it)."""
    places, weights = quadrature("triangle6")
    values, gradients = shape("triangle6", places), shape_gradient("triangle6", places)
    total = 0.0
    for block in mesh.face_blocks(name):
        corner = mesh.points[block.nodes]
        x = np.einsum("qn,fni->fqi", values, corner)
        tangents = np.einsum("qnd,fni->fqdi", gradients, corner)
        normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
        total -= np.einsum("fqi,fqi,q->", x, normal, weights) / 3.0
    return total


@pytest.mark.parametrize("name", ACTUATORS)
def test_mesh_has_the_names_of_the_template_and_every_boundary_face_has_exactly_one(meshes, name):
    mesh, actuator = meshes[name], ACTUATORS[name]
    assert set(mesh.faces) == set(actuator.face_names)
    assert mesh.domains == actuator.domains
    assert mesh.bending_walls == actuator.bending_walls
    (skin,) = boundary(mesh.blocks)
    named = np.concatenate([block.nodes for blocks in mesh.faces.values() for block in blocks])
    assert len(named) == len(skin.nodes)
    assert len(np.unique(np.sort(named, axis=1), axis=0)) == len(skin.nodes)
    assert len(open_edges([skin])) == 0


@pytest.mark.parametrize("name", ["prism", "finger", "pneunet"])
def test_cavities_close_and_hold_their_analytic_volume(meshes, name):
    for cavity in ACTUATORS[name].cavities:
        assert len(open_edges(meshes[name].face_blocks(cavity))) == 0
        assert enclosed_volume(meshes[name], cavity) == pytest.approx(ACTUATORS[name].cavity_volume, rel=1e-9)


@pytest.mark.parametrize("name", ["tube", "sphere", "octant"])
def test_curved_cavities_hold_their_volume_as_well_as_quadratic_faces_can(meshes, name):
    # the cut faces of the octant go through the origin and add nothing
    assert enclosed_volume(meshes[name], "cavity") == pytest.approx(ACTUATORS[name].cavity_volume, rel=5e-3)


def test_cavity_of_a_tube_with_open_ends_shows_its_open_edges(meshes):
    assert len(open_edges(meshes["quarter tube"].face_blocks("cavity"))) > 0


@pytest.mark.parametrize("name", ACTUATORS)
def test_volume_of_the_mesh_is_that_of_the_solid_and_no_cell_is_inverted(meshes, name):
    quality = inspect(meshes[name])
    tolerance = 1e-9 if name in ("finger", "pneunet") else 2e-3
    assert quality.volume == pytest.approx(occ.volume(ACTUATORS[name].shape()), rel=tolerance)
    assert quality.smallest_jacobian > 0.0


def test_outer_surface_and_clamp_of_the_prism_lie_where_they_should(meshes):
    mesh = meshes["prism"]
    assert np.allclose(mesh.points[mesh.face_nodes("clamp"), 2], 0.0, atol=1e-9)
    assert np.allclose(mesh.points[mesh.face_nodes("tip"), 2], 22.0, atol=1e-9)
    first = mesh.points[mesh.face_nodes("cavity_1")].mean(axis=0)
    assert first[0] > 17.0
    assert abs(first[1]) < 1.0
    second = mesh.points[mesh.face_nodes("cavity_2")].mean(axis=0)
    assert np.degrees(np.arctan2(second[1], second[0])) == pytest.approx(60.0, abs=2.0)


def test_layer_shares_the_nodes_of_the_bond_with_the_body(meshes):
    mesh = meshes["pneunet"]
    body, base = (np.unique(block.nodes) for block in mesh.blocks)
    shared = np.intersect1d(body, base)
    assert len(shared) > 20
    assert np.allclose(mesh.points[shared, 2], 0.0, atol=1e-9)


def test_mid_nodes_of_curved_faces_lie_on_the_curve(meshes):
    mesh = meshes["sphere"]
    radius = np.linalg.norm(mesh.points[mesh.face_nodes("outer")], axis=1)
    assert np.allclose(radius, 15.0, atol=1e-6)


def test_equal_input_gives_an_equal_mesh(meshes):
    again = generate(ACTUATORS["octant"], coarse=True)
    assert np.array_equal(again.points, meshes["octant"].points)
    assert np.array_equal(again.blocks[0].nodes, meshes["octant"].blocks[0].nodes)


def test_smaller_sizes_make_more_cells():
    one = PneuNet(chambers=1, layer=0.0)
    coarse, fine, walls = generate(one, coarse=True), generate(one, 2.5), generate(one, 2.5, wall_size=1.5)
    assert coarse.cell_count < fine.cell_count < walls.cell_count


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"size": 0.0}, "size = 0.0: expected a finite number greater than 0"),
        ({"size": float("nan")}, "size = nan"),
        ({"size": "3"}, "size = '3'"),
        ({"grading": 1.5}, "grading = 1.5: expected a finite number greater than 0 and at most 1"),
        ({"detail": -1.0}, "detail = -1.0"),
        ({"wall_size": -2.0}, "wall_size = -2.0"),
    ],
)
def test_settings_out_of_range_are_refused_by_name(settings, message):
    with pytest.raises(MeshError, match=message):
        generate(Finger(), **settings)


def test_solid_that_netgen_cannot_mesh_is_refused_with_place_and_reason(monkeypatch):
    class Broken:
        def __init__(self, shape):
            pass

        def GenerateMesh(self, **settings):
            raise RuntimeError("surface meshing failed")

    monkeypatch.setattr(occ.occ, "OCCGeometry", Broken)
    with pytest.raises(MeshError, match=r"cannot mesh the solid in \(0.0, -8.0, 0.0\) to .*: surface meshing failed"):
        generate(Finger())


def _raw(**changes):
    cells = box(1, 1, 1)
    (skin,) = boundary(cells.blocks)
    data = {
        "points": cells.points,
        "cells": cells.blocks[0].nodes,
        "domain": np.zeros(6, dtype=int),
        "domains": ("body",),
        "triangles": skin.nodes,
        "face": np.zeros(len(skin.nodes), dtype=int),
        "face_names": ("outer",),
    }
    return occ.RawMesh(**(data | changes))


def test_surface_that_is_not_the_boundary_of_the_cells_is_refused():
    raw = _raw()
    with pytest.raises(MeshError, match="not the boundary of its tetrahedra"):
        from_raw(_raw(triangles=raw.triangles[1:], face=raw.face[1:]), Finger())


def test_mesh_without_a_face_of_the_template_is_refused():
    with pytest.raises(MeshError, match="the mesh has the faces outer, expected cavity, clamp, outer, tip"):
        from_raw(_raw(), Finger())


def test_negative_cells_are_turned_and_inverted_cells_straightened():
    mesh = box(1, 1, 1)
    flipped = mesh.blocks[0].nodes[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
    assert (jacobians(mesh.points, "tetra10", flipped) < 0.0).all()
    bent = mesh.points.copy()
    mid = mesh.blocks[0].nodes[0, 6]
    bent[mid] += 2.0
    assert jacobians(bent, "tetra10", mesh.blocks[0].nodes).min() < 0.0
    straight = straightened(bent, "tetra10", mesh.blocks[0].nodes)
    assert jacobians(straight, "tetra10", mesh.blocks[0].nodes).min() > 0.0
    assert 0.0 < np.abs(straight - mesh.points).max() < 0.5


@pytest.mark.parametrize("kind", NODES)
def test_shape_functions_are_one_at_their_node_and_have_exact_gradients(kind):
    assert np.allclose(shape(kind, NODES[kind]), np.eye(len(NODES[kind])), atol=1e-12)
    places = quadrature(kind)[0]
    step = 1e-6
    for axis in range(places.shape[1]):
        shift = step * np.eye(places.shape[1])[axis]
        numeric = (shape(kind, places + shift) - shape(kind, places - shift)) / (2 * step)
        assert np.allclose(shape_gradient(kind, places)[:, :, axis], numeric, atol=1e-8)
