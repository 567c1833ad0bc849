import numpy as np
import pytest

from pneumorph.geometry import BendingSkin
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Clamp, Model, Symmetry
from pneumorph.mechanics.state import rest
from pneumorph.mesh import CellBlock, Mesh, box, generate
from pneumorph.report.cut import Plane, cap, cut_lines, cut_surface, rim
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import FIELDS
from pneumorph.report.surface import UNNAMED, edges, normals, outline, surface
from pneumorph.report.view import View, cut_plane, face_on


def area(part, points):
    a, b, c = ((part.weights @ points)[part.triangles[:, i]] for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_the_surface_of_a_box_has_its_area_and_every_face_its_name(kind):
    mesh = box(2, 2, 2, kind, lengths=(2.0, 3.0, 4.0))
    drawn = surface(mesh)
    assert area(drawn, mesh.points) == pytest.approx(52.0)
    assert area(drawn.part(["x1"]), mesh.points) == pytest.approx(12.0)


def test_subdivided_faces_follow_a_curved_surface_better_than_flat_ones(octant):
    flat, fine = (surface(octant, most).part(["outer"]) for most in (1, 10**6))
    far = [abs(np.linalg.norm(s.weights @ octant.points, axis=1) - 15.0).max() for s in (flat, fine)]
    assert len(fine.triangles) == 16 * len(flat.triangles)
    assert far[1] < 0.05
    exact = 0.5 * np.pi * 15.0**2
    errors = [abs(area(s, octant.points) - exact) for s in (flat, fine)]
    assert errors[1] < 0.2 * errors[0]


def test_faces_without_a_name_are_drawn_as_unnamed():
    whole = box(1, 1, 1)
    mesh = Mesh(whole.points, whole.blocks, {k: v for k, v in whole.faces.items() if k != "z1"})
    drawn = surface(mesh)
    assert area(drawn.part([UNNAMED]), mesh.points) == pytest.approx(1.0)
    assert area(drawn, mesh.points) == pytest.approx(6.0)


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_the_outline_of_a_box_is_its_twelve_edges_and_all_edges_are_more(kind):
    mesh = box(2, 2, 2, kind, lengths=(2.0, 3.0, 4.0))

    def length(lines):
        ends = (lines.weights @ mesh.points)[lines.segments]
        return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()

    assert length(outline(mesh)) == pytest.approx(36.0)
    assert length(outline(mesh, {"z1"})) == pytest.approx(36.0 - 10.0)
    assert length(edges(mesh)) > 72.0


def test_sharp_edges_are_outlined_inside_one_name_and_smooth_ones_are_not(octant):
    mesh = box(2, 2, 2, lengths=(2.0, 3.0, 4.0))
    together = Mesh(mesh.points, mesh.blocks, {"skin": tuple(b for blocks in mesh.faces.values() for b in blocks)})
    assert len(outline(together).segments) == len(outline(mesh).segments) > 0
    radius = np.linalg.norm((outline(octant).weights @ octant.points), axis=1)
    inner = np.abs(outline(octant).weights @ octant.points).min(axis=1) > 0.1
    assert not inner.any()  # nothing crosses the sphere's faces
    assert radius.max() < 15.1


def test_normals_of_a_sphere_point_outward(octant):
    outer = surface(octant).part(["outer"])
    points = outer.weights @ octant.points
    assert np.einsum("ij,ij->i", normals(points, outer.triangles), points / 15.0).min() > 0.98


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
@pytest.mark.parametrize("at", [0.5, 0.7])  # through nodes, and between them
def test_a_cut_box_keeps_half_its_surface_and_is_closed_by_its_section(kind, at):
    mesh = box(2, 2, 2, kind, lengths=(2.0, 3.0, 4.0))
    plane = Plane((2.0 * at, 0.0, 0.0), (1.0, 0.0, 0.0))
    half, section = cut_surface(surface(mesh), mesh, plane), cap(mesh, plane)
    assert area(half, mesh.points) == pytest.approx(12.0 + 14.0 * 2.0 * at, rel=1e-5)
    assert area(section, mesh.points) == pytest.approx(12.0, rel=1e-5)
    border = rim(surface(mesh), mesh, plane)
    ends = (border.weights @ mesh.points)[border.segments]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(14.0, rel=1e-5)
    kept = cut_lines(outline(mesh), mesh, plane)
    assert (kept.weights @ mesh.points)[kept.segments, 0].max() <= 2.0 * at + 1e-6


def test_a_cut_moves_with_the_material():
    mesh = box(2, 2, 2)
    section = cap(mesh, Plane((0.4, 0.0, 0.0), (1.0, 0.0, 0.0)))
    moved = mesh.points * [2.0, 1.0, 1.0] + [5.0, 0.0, 0.0]
    assert (section.weights @ moved)[:, 0] == pytest.approx(5.8, abs=1e-6)


def test_the_camera_faces_the_bending_plane_and_sees_every_state(beam):
    states = list(beam.states)
    view = face_on(states)
    assert np.abs(view.direction) == pytest.approx([0.0, 1.0, 0.0])
    assert view.up == pytest.approx((0.0, 0.0, 1.0))
    assert view.right == pytest.approx([1.0, 0.0, 0.0])
    for state in states:
        away = np.abs((state.positions - np.array(view.centre)) @ np.column_stack([view.right, view.up]))
        assert (away <= [0.5 * view.width, 0.5 * view.height]).all()


def test_a_turned_view_keeps_right_angles_and_length():
    view = View((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)).turned(30.0, 20.0)
    frame = np.array([view.direction, view.up, view.right])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)


def test_an_axisymmetric_body_is_drawn_on_both_sides_of_its_axis(balloon):
    drawing = Drawing(list(balloon.states))
    left, right = drawing.body(balloon.states[-1].positions, np.zeros(len(drawing.mesh.points)), (0, 1), FIELDS[0])[2:4]
    assert left.points[:, 0] == pytest.approx(-right.points[:, 0])
    assert abs(drawing.view.centre[0]) < 1e-9


def test_fields_at_rest_have_their_start_value_and_grow_afterwards(beam):
    for field in FIELDS:
        assert field.values(beam.states[0]) == pytest.approx(field.start, abs=1e-9)
        low, high, largest = field.limits([field.values(beam.states[-1])])
        assert low == field.start < high <= largest


def test_a_mesh_of_two_domains_labels_its_section_by_domain():
    mesh = box(2, 1, 1)
    (block,) = mesh.blocks
    left = mesh.points[block.nodes].mean(axis=1)[:, 0] < 0.5
    blocks = tuple(CellBlock(block.kind, name, block.nodes[which]) for name, which in (("a", left), ("b", ~left)))
    section = cap(Mesh(mesh.points, blocks, mesh.faces), Plane((0.0, 0.0, 0.3), (0.0, 0.0, 1.0)))
    x = (section.weights @ mesh.points)[section.triangles].mean(axis=1)[:, 0]
    assert section.names == ("a", "b")
    assert ((x < 0.5) == (section.label == 0)).all()


def test_a_half_tube_that_is_wider_than_long_is_cut_and_seen_from_above():
    mesh = generate(BendingSkin(cells_along=1, length=14.9, half=True), coarse=True)
    materials = dict.fromkeys(("tube", "skin", "cap"), NeoHookean(0.037))
    cavity = Cavity("cavity", ("cavity",), mirrors=("symmetry_y",))
    model = Model(mesh, materials, (Clamp("clamp"), Symmetry("symmetry_y")), cavities=(cavity,))
    plane, view = cut_plane([rest(model)], View((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)))
    assert np.abs(plane.normal) == pytest.approx([0.0, 0.0, 1.0])
    assert np.linalg.norm(view.up) == pytest.approx(1.0)
    assert np.dot(view.up, view.direction) == pytest.approx(0.0)
