"""Block grids: volumes, areas, closed cavities, and joined parts against the same body in one piece."""

import math

import numpy as np
import pytest

from pneumorph.errors import MeshError
from pneumorph.mesh import BlockGrid, FaceBlock, Mesh, Quads, inspect, join, lines, nested, placed, rectangle, tensor
from pneumorph.mesh.reference import quadrature, shape_gradient
from pneumorph.mesh.topology import open_edges


def area(mesh, name):
    """Area of a set of faces of quad9, mm2, and its vector."""
    total, vector = 0.0, np.zeros(3)
    gradient, weight = shape_gradient("quad9", quadrature("quad9")[0]), quadrature("quad9")[1]
    for block in mesh.face_blocks(name):
        tangent = np.einsum("qnj,fni->fqij", gradient, mesh.points[block.nodes])
        normal = np.cross(tangent[..., 0], tangent[..., 1])
        total += float((np.linalg.norm(normal, axis=-1) @ weight).sum())
        vector += np.einsum("fqi,q->i", normal, weight)
    return total, vector


def box_with_cavity(width=10.0, airway=None):
    """A box 10 x 6 x 8 with a cavity 6 x 3 x 4 inside."""
    u = [0.0, 2.0, 8.0, width]
    grid = BlockGrid(tensor(u, [0.0, 1.0, 4.0, 6.0]), [0.0, 2.0, 6.0, 8.0])
    return grid.fill("body").hollow("cavity", u=(2.0, 8.0), v=(1.0, 4.0), w=(2.0, 6.0))


def ring(angle, inner=2.0, outer=3.0):
    """Sector of a tube along z: u is the angle, v the radius."""
    grid = BlockGrid(tensor([0.0, 0.5 * angle, angle], [inner, outer]), [0.0, 1.0, 2.5]).fill("body")

    def bent(points):
        turn = -points[:, 0]  # against u, so that u, v, w stay right-handed
        return np.column_stack([points[:, 1] * np.cos(turn), points[:, 1] * np.sin(turn), points[:, 2]])

    return grid.mesh(bent, patches=[("bottom", {"w": (0.0, 0.0)})])


def test_a_box_with_a_cavity_has_the_volume_and_the_areas_of_its_drawing():
    mesh = box_with_cavity().mesh(patches=[("clamp", {"w": (0.0, 0.0)})])
    assert inspect(mesh).volume == pytest.approx(10 * 6 * 8 - 6 * 3 * 4, rel=1e-12)
    assert area(mesh, "cavity")[0] == pytest.approx(2 * (6 * 3 + 6 * 4 + 3 * 4), rel=1e-12)
    assert area(mesh, "clamp")[1] == pytest.approx([0.0, 0.0, -60.0])
    assert area(mesh, "outer")[0] == pytest.approx(60 + 2 * (10 + 6) * 8, rel=1e-12)
    assert len(open_edges(mesh.face_blocks("cavity"))) == 0
    assert len(open_edges([*mesh.face_blocks("outer"), *mesh.face_blocks("clamp")])) == 0
    assert not inspect(mesh).warnings


def test_a_curved_mapping_puts_mid_nodes_on_the_curve():
    mesh = ring(0.25 * math.pi)
    radius = np.linalg.norm(mesh.points[:, :2], axis=1)
    assert np.unique(np.round(radius, 9)) == pytest.approx([2.0, 2.5, 3.0])
    assert inspect(mesh).volume == pytest.approx(0.125 * math.pi * (9.0 - 4.0) * 2.5, rel=1e-4)


def test_sectors_joined_to_a_tube_are_closed_and_have_its_volume():
    part = ring(0.25 * math.pi)
    turns = [2.0 * math.pi * i / 8 for i in range(8)]

    def turned(angle):
        c, s = math.cos(angle), math.sin(angle)
        return lambda p: p @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    mesh = join([placed(part, turned(angle), rename={"outer": "wall"}) for angle in turns])
    assert set(mesh.faces) == {"wall", "bottom"}
    assert inspect(mesh).volume == pytest.approx(math.pi * 5.0 * 2.5, rel=1e-4)
    assert area(mesh, "wall")[0] == pytest.approx(2.0 * math.pi * (2.0 + 3.0) * 2.5 + 5.0 * math.pi, rel=1e-4)
    assert len(open_edges([*mesh.face_blocks("wall"), *mesh.face_blocks("bottom")])) == 0
    assert len(mesh.points) == 8 * len(part.points) - 8 * 3 * 5  # the nodes of a radial cut, each twice


def test_two_joined_halves_equal_one_grid():
    whole = box_with_cavity().mesh()
    grid = box_with_cavity()
    left = BlockGrid(tensor([0.0, 2.0], [0.0, 1.0, 4.0, 6.0]), grid.heights).fill("body").mesh()
    right = BlockGrid(tensor([2.0, 8.0, 10.0], [0.0, 1.0, 4.0, 6.0]), grid.heights).fill("body")
    right = right.hollow("cavity", u=(2.0, 8.0), v=(1.0, 4.0), w=(2.0, 6.0)).mesh()
    # the side of the left part that the hollow of the right one lays bare stays an outer face of it
    halves = join([left, right])
    assert halves.cell_count == whole.cell_count
    assert len(halves.points) == len(whole.points)
    assert inspect(halves).volume == pytest.approx(inspect(whole).volume, rel=1e-12)
    order = [np.lexsort(np.round(mesh.points, 9).T) for mesh in (halves, whole)]
    assert np.allclose(halves.points[order[0]], whole.points[order[1]])
    assert area(halves, "cavity")[0] + area(halves, "outer")[0] == pytest.approx(
        area(whole, "cavity")[0] + area(whole, "outer")[0], rel=1e-12
    )


def test_nested_rectangles_fill_the_largest_one_with_few_quadrilaterals():
    sheet = nested([(3.0, 3.0), (6.0, 4.5), (14.0, 19.0), (20.0, 22.0)], rings=(1, 2, 1))
    assert len(sheet.corners) == 1 + 3 * 4
    grid = BlockGrid(sheet, [0.0, 2.0, 6.0]).fill("body").hollow("air", u=(-7.0, 7.0), v=(0.0, 19.0), w=(2.0, 6.0))
    mesh = grid.mesh(patches=[("floor", {"v": (0.0, 0.0)})])
    assert inspect(mesh).volume == pytest.approx(20 * 22 * 6 - 14 * 19 * 4, rel=1e-12)
    assert area(mesh, "floor")[0] == pytest.approx(20 * 2 + 6 * 4, rel=1e-12)
    assert area(mesh, "air")[0] == pytest.approx(14 * 19 + (14 + 2 * 19) * 4, rel=1e-12)


def test_a_split_sheet_covers_the_same_plane_with_more_cells():
    sheet = nested([(2.0, 2.0), (4.0, 5.0)])
    fine = sheet.split(3)
    assert len(fine.corners) == 9 * len(sheet.corners)
    volumes = [inspect(BlockGrid(each, [0.0, 1.0]).fill("body").mesh()).volume for each in (sheet, fine)]
    assert volumes == pytest.approx([20.0, 20.0], rel=1e-12)


def test_two_sheets_are_one_where_their_corners_meet():
    both = tensor([0.0, 1.0, 2.0], [0.0, 1.0]) + tensor([0.0, 1.0, 2.0], [-2.0, 0.0])
    assert len(both.points) == 9
    mesh = BlockGrid(both, [0.0, 1.0]).fill("body").mesh()
    assert area(mesh, "outer")[0] == pytest.approx(2 * 6 + (2 * 2 + 2 * 3) * 1)


def test_several_materials_share_nodes_and_keep_their_own_cells():
    grid = BlockGrid(tensor([0.0, 1.0], [0.0, 1.0, 3.0]), [0.0, 2.0]).fill("soft").fill("stiff", v=(0.0, 1.0))
    mesh = grid.mesh()
    assert mesh.domains == ("soft", "stiff")
    assert len(mesh.points) == 3 * 5 * 3


def test_lines_are_spread_evenly_between_the_stops():
    assert lines([0.0, 2.0, 2.0, 3.0], 0.8) == pytest.approx([0.0, 2 / 3, 4 / 3, 2.0, 2.5, 3.0])
    assert lines([0.0, 1.0]) == pytest.approx([0.0, 1.0])


def test_a_box_beside_a_slanting_cell_does_not_cut_it():
    diamond = Quads(np.array([[0.5, 1.5], [1.5, 0.5], [2.5, 1.5], [1.5, 2.5]]), np.array([[0, 1, 2, 3]]))
    grid = BlockGrid(tensor([0.0, 1.0], [0.0, 1.0]) + diamond, [0.0, 1.0])
    assert (grid.fill("body", u=(0.0, 1.0), v=(0.0, 1.0)).domain != "").sum() == 1


def test_of_two_patches_the_first_has_the_faces_of_both():
    mesh = BLOCK.mesh(patches=[("corner", {"u": (0.0, 1.0), "w": (0.0, 0.0)}), ("floor", {"w": (0.0, 0.0)})])
    assert area(mesh, "corner")[0] == pytest.approx(1.0)
    assert area(mesh, "floor")[0] == pytest.approx(1.0)


SHEET = tensor([0.0, 1.0, 2.0], [0.0, 1.0])
BLOCK = BlockGrid(SHEET, [0.0, 1.0]).fill("body")


def shifted(x, y=0.0):
    return placed(BLOCK.mesh(), lambda p: p + np.array([x, y, 0.0]))


BAD = {
    "lines that do not grow": (lambda: tensor([0.0, 0.0], [0.0, 1.0]), "lines u"),
    "one height": (lambda: BlockGrid(SHEET, [0.0]), "lines w"),
    "a box through cells": (lambda: BLOCK.fill("body", u=(0.0, 1.5)), "cuts through cells"),
    "a box through layers": (lambda: BLOCK.fill("body", w=(0.0, 0.5)), "cuts through cells"),
    "a box beside the grid": (lambda: BLOCK.fill("body", u=(5.0, 6.0)), "no cell lies"),
    "limits the wrong way": (lambda: BLOCK.hollow("air", u=(1.0, 0.0)), "the smaller first"),
    "no material": (lambda: BlockGrid(SHEET, [0.0, 1.0]).mesh(), "no cell has a material"),
    "an empty patch": (lambda: BLOCK.mesh(patches=[("a", {"u": (0.5, 0.5)})]), "patch 'a': no face"),
    "a patch along an unknown axis": (lambda: BLOCK.mesh(patches=[("a", {"x": (0.0, 0.0)})]), "expected limits of u"),
    "a mapping that mirrors": (lambda: BLOCK.mesh(lambda p: p * [-1.0, 1.0, 1.0]), "turns cells over"),
    "a mapping to a plane": (lambda: BLOCK.mesh(lambda p: p[:, :2]), "made points of shape"),
    "rectangles that cross": (lambda: nested([(2.0, 3.0), (4.0, 3.0)]), "wider and higher"),
    "rectangles of one number": (lambda: nested([2.0]), "pairs"),  # type: ignore[list-item]
    "a count of rings too many": (lambda: nested([(2.0, 3.0)], rings=(1,)), "expected 0 whole numbers"),
    "a sheet split by nothing": (lambda: SHEET.split(0), "whole number"),
    "stops that fall": (lambda: lines([1.0, 0.0]), "do not fall"),
    "steps of no length": (lambda: lines([0.0, 1.0], 0.0), "size"),
    "points in space": (lambda: Quads(np.zeros((4, 3)), np.array([[0, 1, 2, 3]])), "points of shape"),
    "corners of triangles": (lambda: Quads(np.eye(3, 2), np.array([[0, 1, 2]])), "corners of shape"),
    "corners out of range": (lambda: Quads(np.eye(4, 2), np.array([[0, 1, 2, 9]])), "must lie in 0..3"),
    "a clockwise quadrilateral": (
        lambda: Quads(np.array([[0, 0], [0, 1], [1, 1], [1, 0]], float), np.array([[0, 1, 2, 3]])),
        "anticlockwise",
    ),
    "sheets on each other": (lambda: SHEET + SHEET, "same side"),
    "nothing to join": (lambda: join([]), "at least one"),
    "parts that overlap": (lambda: join([BLOCK.mesh(), BLOCK.mesh()]), "overlap"),
    "parts that are apart": (lambda: join([BLOCK.mesh(), shifted(5.0)]), "part 2 of 2 shares no face"),
    "parts that meet in an edge": (lambda: join([BLOCK.mesh(), shifted(2.0, 1.0)]), "shares no face"),
    "parts with other mid nodes": (
        lambda: join([BLOCK.mesh(), BLOCK.mesh(lambda p: p + np.array([2.0, 0.0, 0.0]) - _bulge(p))]),
        "mid nodes elsewhere",
    ),
    "a plane part": (lambda: join([BLOCK.mesh(), rectangle(1, 1)]), "one space"),
    "an unknown face": (lambda: placed(BLOCK.mesh(), rename={"top": "tip"}), "no face top"),
    "a part turned over": (lambda: placed(BLOCK.mesh(), lambda p: p * [-1.0, 1.0, 1.0]), "turns cells over"),
}


def _bulge(points):
    """Move the middle of the side u = 0, but not its corners."""
    return 0.1 * np.column_stack([(1 - points[:, 0] / 2) * np.sin(np.pi * points[:, 1]), *np.zeros((2, len(points)))])


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_refused(name):
    make, message = BAD[name]
    with pytest.raises(MeshError, match=message):
        make()


def test_meshes_with_caps_are_not_joined():
    mesh = BLOCK.mesh()
    lid = (FaceBlock("triangle3", np.array([[0, 1, 2]])),)
    with pytest.raises(MeshError, match="without caps"):
        join([Mesh(mesh.points, mesh.blocks, mesh.faces, caps={"lid": lid})])
