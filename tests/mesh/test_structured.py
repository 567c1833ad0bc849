"""Structured and layered meshes: orientation, names, mapping."""

import numpy as np
import pytest

from pneumorph.errors import MeshError
from pneumorph.mesh import box, extrude, inspect, rectangle, rolled
from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.mesh.reference import jacobians, quadrature, shape_gradient
from pneumorph.mesh.topology import boundary, open_edges

LAYERS = [(0.5, "soft"), (0.25, "stiff"), (0.5, "soft")]


def annulus(points):
    """Section of a quarter tube, radius 1 to 2, from the unit square (radius, angle)."""
    radius, angle = 1.0 + points[:, 0], 0.5 * np.pi * points[:, 1]
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def cooks_membrane(points):
    x, y = points.T
    return np.column_stack([48.0 * x, 44.0 * x + y * (44.0 + (16.0 - 44.0) * x)])


def mean_normal(mesh, name):
    """Area vector of a face set: outward if the cells and faces are oriented as they should."""
    total = np.zeros(mesh.dimension)
    for block in mesh.face_blocks(name):
        corner = mesh.points[block.nodes]
        if block.kind == "line3":
            along = (corner[:, 1] - corner[:, 0]).sum(axis=0)
            total += np.array([along[1], -along[0]])
        else:
            a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
            total += np.cross(a, b).sum(axis=0) * (1.0 if block.kind == "quad9" else 0.5)
    return total


ALL = {
    "rectangle": lambda: rectangle(3, 4, distortion=0.3),
    "annulus": lambda: rectangle(3, 4, annulus),
    "tetrahedra": lambda: box(3, 2, 2, distortion=0.3),
    "wedges": lambda: box(3, 3, 2, "wedge18", distortion=0.3),
    "layers": lambda: extrude(_sheet(), LAYERS),
    "rolled layers": lambda: extrude(_sheet(), LAYERS, rolled(4.0)),
}


def _sheet():
    flat = rectangle(4, 2, width=3.0)
    names = {"left": "left", "right": "right", "bottom": "front", "top": "back"}
    return Mesh(flat.points, flat.blocks, {names[name]: faces for name, faces in flat.faces.items()}, flat.space)


@pytest.mark.parametrize("name", ALL)
def test_cells_are_positive_and_the_named_faces_are_the_whole_boundary(name):
    mesh = ALL[name]()
    for block in mesh.blocks:
        assert (jacobians(mesh.points, block.kind, block.nodes) > 0.0).all()
    named = [block for blocks in mesh.faces.values() for block in blocks]
    assert sum(len(b.nodes) for b in named) == sum(len(b.nodes) for b in boundary(mesh.blocks))
    assert len(open_edges(named)) == 0
    assert len(np.unique(np.concatenate([b.nodes.ravel() for b in mesh.blocks]))) == len(mesh.points)


@pytest.mark.parametrize("name", ALL)
def test_every_mid_node_of_a_face_belongs_to_a_face_of_a_cell(name):
    mesh = ALL[name]()
    skin = {tuple(sorted(row)) for block in boundary(mesh.blocks) for row in block.nodes.tolist()}
    named = {tuple(sorted(r)) for blocks in mesh.faces.values() for b in blocks for r in b.nodes.tolist()}
    assert named == skin


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_faces_of_a_box_look_outward_along_their_axis(kind):
    mesh = box(2, 3, 2, kind, lengths=(1.0, 2.0, 4.0))
    areas = {"x": 8.0, "y": 4.0, "z": 2.0}
    for axis, letter in enumerate("xyz"):
        for end in (0, 1):
            expected = np.zeros(3)
            expected[axis] = areas[letter] * (1 if end else -1)
            assert np.allclose(mean_normal(mesh, f"{letter}{end}"), expected)
    assert inspect(mesh).volume == pytest.approx(8.0)


def test_edges_of_a_rectangle_look_outward():
    mesh = rectangle(2, 3, width=2.0, height=5.0)
    assert np.allclose(mean_normal(mesh, "left"), [-5.0, 0.0])
    assert np.allclose(mean_normal(mesh, "right"), [5.0, 0.0])
    assert np.allclose(mean_normal(mesh, "bottom"), [0.0, -2.0])
    assert np.allclose(mean_normal(mesh, "top"), [0.0, 2.0])


def test_mapping_puts_mid_nodes_on_the_curve():
    mesh = rectangle(2, 4, annulus)
    radius = np.linalg.norm(mesh.points[mesh.face_nodes("left")], axis=1)
    assert np.allclose(radius, 1.0)
    assert inspect(mesh).volume == pytest.approx(0.75 * np.pi, rel=1e-4)


def test_axisymmetric_rectangle_has_the_volume_of_the_tube():
    mesh = rectangle(2, 2, lambda p: p + np.array([1.0, 0.0]), space="axisymmetric")
    assert inspect(mesh).volume == pytest.approx(3.0 * np.pi)


def test_cooks_membrane_is_one_mapping():
    assert inspect(rectangle(4, 4, cooks_membrane)).volume == pytest.approx(48.0 * 30.0)


def test_distortion_moves_inner_nodes_only_and_repeats():
    plain, bent = box(3, 3, 3), box(3, 3, 3, distortion=0.3)
    moved = np.abs(plain.points - bent.points).max(axis=1) > 1e-12
    assert moved.any()
    for name in plain.faces:
        assert not moved[plain.face_nodes(name)].any()
    assert np.array_equal(bent.points, box(3, 3, 3, distortion=0.3).points)


def test_layers_carry_their_domains_heights_and_side_names():
    mesh = extrude(_sheet(), LAYERS)
    assert mesh.domains == ("soft", "stiff")
    assert set(mesh.faces) == {"bottom", "top", "left", "right", "front", "back"}
    assert np.allclose(mean_normal(mesh, "top"), [0.0, 0.0, 3.0])
    assert np.allclose(mean_normal(mesh, "bottom"), [0.0, 0.0, -3.0])
    assert np.allclose(mean_normal(mesh, "front"), [0.0, -3.0 * 1.25, 0.0])
    assert np.allclose(mean_normal(mesh, "right"), [1.25, 0.0, 0.0])
    volume = {
        b.domain: float((jacobians(mesh.points, b.kind, b.nodes) @ quadrature(b.kind)[1]).sum()) for b in mesh.blocks
    }
    assert volume == pytest.approx({"soft": 3.0, "stiff": 0.75})


def test_rolled_sheet_lies_between_its_radii():
    mesh = extrude(_sheet(), LAYERS, rolled(4.0))
    distance = np.hypot(mesh.points[:, 0], mesh.points[:, 2])
    assert distance.min() == pytest.approx(4.0)
    assert distance.max() == pytest.approx(5.25)
    angle = 3.0 / 4.0
    assert inspect(mesh).volume == pytest.approx(0.5 * angle * (5.25**2 - 4.0**2), rel=1e-5)


def test_quadrilateral_faces_of_wedges_have_their_nodes_in_order():
    mesh = box(1, 1, 1, "wedge18")
    (face,) = mesh.face_blocks("x1")
    corner = mesh.points[face.nodes[0]]
    assert np.allclose(corner[4:8], (corner[:4] + np.roll(corner[:4], -1, axis=0)) / 2.0)
    assert np.allclose(corner[8], corner[:4].mean(axis=0))
    assert shape_gradient("wedge18", np.zeros((1, 3))).shape == (1, 18, 3)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: rectangle(0, 1), "nx = 0: expected a whole number of at least 1"),
        (lambda: box(1, 1, 1.5), "nz = 1.5: expected a whole number"),
        (lambda: rectangle(1, 1, width=-1.0), "width = -1.0: expected a finite length"),
        (lambda: rectangle(1, 1, space="3d"), "unknown space of a rectangle '3d'"),
        (lambda: box(1, 1, 1, "hexahedron"), "unknown kind of cell of a box 'hexahedron'"),
        (lambda: box(1, 1, 1, distortion=0.5), "distortion = 0.5: expected at least 0 and less than 0.5"),
        (lambda: rectangle(1, 1, lambda p: p[:, ::-1]), "turns cells over"),
        (lambda: extrude(box(1, 1, 1), LAYERS), r"expected a flat mesh with points \(n, 2\)"),
        (lambda: extrude(rectangle(1, 1), LAYERS), "already has a face named bottom, top"),
        (lambda: extrude(_sheet(), []), "expected at least one layer"),
        (lambda: extrude(_sheet(), [(0.0, "soft")]), "layer 'soft' of thickness 0.0: expected a length"),
        (lambda: extrude(_sheet(), LAYERS, lambda p: p * [1.0, 1.0, -1.0]), "turns cells over"),
        (lambda: rolled(0.0), "radius = 0.0: expected a finite length"),
    ],
)
def test_bad_input_is_refused_by_name(make, message):
    with pytest.raises(MeshError, match=message):
        make()


def test_open_edges_finds_holes_turned_faces_and_faces_met_twice():
    (skin,) = boundary(box(1, 1, 1).blocks)
    assert len(open_edges([FaceBlock("triangle6", skin.nodes[1:])])) == 3
    turned = skin.nodes.copy()
    turned[0] = turned[0][[0, 2, 1, 5, 4, 3]]
    assert len(open_edges([FaceBlock("triangle6", turned)])) == 3
    assert len(open_edges([skin, FaceBlock("triangle6", skin.nodes[:1])])) == 3
    (line,) = boundary(rectangle(2, 2).blocks)
    assert len(open_edges([line])) == 0
    assert open_edges([FaceBlock("line3", line.nodes[1:])]).shape == (2, 1)
    assert len(open_edges([])) == 0
