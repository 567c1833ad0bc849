"""The hexagonal prism in hexahedra: its drawing's volumes and areas, closed cavities, and what a half keeps."""

import math

import numpy as np
import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import Finger, HexagonalPrism, PneuNet
from pneumorph.mesh import generate, inspect
from pneumorph.mesh.topology import CORNERS, open_edges

SHORT = HexagonalPrism(chambers=3, length=32.0)


@pytest.fixture(scope="module")
def whole():
    return generate(SHORT, hexahedra=True)


@pytest.fixture(scope="module")
def half():
    return generate(HexagonalPrism(chambers=3, length=32.0, half=True), hexahedra=True)


@pytest.fixture(scope="module")
def solid():
    """The half in tetrahedra, from the CAD solid."""
    return generate(HexagonalPrism(chambers=3, length=32.0, half=True), coarse=True)


def silicone(prism):
    """Volume of the solid as drawn, mm3: the ring, and on each side blocks and bridges without their air."""
    ring = (1.5 * math.sqrt(3.0) * prism.side**2 - math.pi * prism.core_radius**2) * prism.length
    blocks = prism.chambers * prism.block_length * prism.block_width * prism.block_height
    bridge = (prism.airway_width + 2.0 * prism.airway_side) * (prism.airway_height + prism.airway_roof)
    bridges = (prism.chambers - 1) * prism.gap * bridge
    return ring + 6.0 * (blocks + bridges - prism.cavity_volume)


def enclosed(mesh, name):
    """Volume that plane faces around a cavity enclose, mm3; their normals point into it."""
    total = 0.0
    for block in mesh.face_blocks(name):
        a, b, c, d = (mesh.points[block.nodes[:, i]] for i in range(4))
        total -= float(np.einsum("fi,fi->", np.cross(c - a, d - b), a + b + c + d)) / 24.0
    return total


def test_the_body_has_the_volume_of_the_drawing(whole):
    # arcs of the core are parabolas over a seventh of 60 degrees: a few millionths of the whole
    assert inspect(whole).volume == pytest.approx(silicone(SHORT), rel=1e-5)


@pytest.mark.parametrize("name", SHORT.cavities)
def test_every_cavity_is_closed_and_holds_the_air_of_the_drawing(whole, name):
    assert len(open_edges(whole.face_blocks(name))) == 0
    assert enclosed(whole, name) == pytest.approx(SHORT.cavity_volume, rel=1e-9)


def test_faces_have_the_names_of_the_template_and_close(whole):
    assert set(whole.faces) == set(SHORT.face_names)
    assert len(open_edges([block for blocks in whole.faces.values() for block in blocks])) == 0


def test_walls_have_one_cell_through_them(whole):
    found = inspect(whole)
    assert not found.warnings
    assert dict(found.elements_across) == pytest.approx(dict.fromkeys(SHORT.bending_walls, 1.0), abs=0.02)


def test_a_size_puts_more_rings_on_the_end_walls(whole):
    fine = generate(SHORT, 5.0, hexahedra=True)
    assert fine.cell_count > whole.cell_count
    assert inspect(fine).volume == pytest.approx(inspect(whole).volume, rel=1e-5)


def test_a_half_is_half_and_cut_in_a_plane(whole, half):
    assert set(half.faces) == {"clamp", "tip", "outer", "core", "cavity_1", "cavity_2", "cavity_6", "symmetry_x"}
    assert inspect(half).volume == pytest.approx(0.5 * inspect(whole).volume, rel=1e-12)
    assert 2 * half.cell_count == whole.cell_count
    assert np.abs(half.points[half.face_nodes("symmetry_x"), 0]).max() < 1e-9
    assert half.points[:, 0].min() > -1e-9
    assert enclosed(half, "cavity_2") == pytest.approx(SHORT.cavity_volume, rel=1e-9)


def test_a_half_in_tetrahedra_is_the_same_body(half, solid):
    assert set(solid.faces) == set(half.faces)
    assert inspect(solid).volume == pytest.approx(inspect(half).volume, rel=1e-3)
    assert enclosed_by_triangles(solid, "cavity_2") == pytest.approx(SHORT.cavity_volume, rel=1e-9)
    for name in half.faces:
        ends = [mesh.points[mesh.face_nodes(name)] for mesh in (half, solid)]
        for limit in (np.min, np.max):
            assert limit(ends[0], axis=0) == pytest.approx(limit(ends[1], axis=0), abs=0.05), name


def enclosed_by_triangles(mesh, name):
    total = 0.0
    for block in mesh.face_blocks(name):
        a, b, c = (mesh.points[block.nodes[:, i]] for i in range(CORNERS[block.kind]))
        total -= float(np.einsum("fi,fi->", np.cross(b, c), a)) / 6.0
    return total


def test_one_chamber_has_no_airway():
    mesh = generate(HexagonalPrism(chambers=1, length=10.0), hexahedra=True)
    assert enclosed(mesh, "cavity_1") == pytest.approx(4.0 * 14.0 * 19.0)


def test_narrow_chambers_leave_part_of_the_flat_sides_free():
    prism = HexagonalPrism(chambers=2, length=20.0, side_wall=2.0)
    assert inspect(generate(prism, hexahedra=True)).volume == pytest.approx(silicone(prism), rel=1e-5)


def test_a_bridge_as_wide_as_a_chamber_is_refused():
    with pytest.raises(MeshError, match=r"15 x 4\.5 mm, is as wide or high as a chamber, 14 x 19 mm"):
        generate(HexagonalPrism(airway_side=6.0), hexahedra=True)


def test_templates_without_a_choice_of_cells_refuse_hexahedra():
    with pytest.raises(MeshError, match="PneuNet has no choice of cells, Finger, HexagonalPrism have"):
        generate(PneuNet(), hexahedra=True)


@pytest.mark.parametrize("name", ["grading", "detail", "wall_size"])
def test_a_block_grid_has_a_size_only(name):
    with pytest.raises(MeshError, match=f"{name} = 0.5: a layered mesh has its size only"):
        generate(Finger(), hexahedra=True, **{name: 0.5})


@pytest.mark.parametrize("hexahedra", [True, False])
def test_thick_end_walls_lengthen_the_rows_and_are_clamped_where_they_reach_the_end(hexahedra):
    thin = HexagonalPrism(chambers=2, length=22.0, gap=2.0, half=True)
    thick = HexagonalPrism(chambers=2, length=22.0, gap=2.0, half=True, end_wall=4.0)
    assert thin.blocks == ((2.0, 10.0), (12.0, 20.0))
    assert thick.blocks == ((0.0, 10.0), (12.0, 22.0))
    assert thick.chamber_starts == thin.chamber_starts
    one, other = (generate(p, 8.0, hexahedra=hexahedra) for p in (thin, thick))
    more = 3.0 * 2.0 * 2.0 * thick.block_width * thick.block_height  # three rows, two ends, 2 mm
    assert inspect(other).volume - inspect(one).volume == pytest.approx(more, rel=1e-4)
    low, high = (face_area(other, name) - face_area(one, name) for name in ("clamp", "tip"))
    assert low == pytest.approx(3.0 * thick.block_width * thick.block_height, rel=1e-3)
    assert high == pytest.approx(0.0, abs=1.0)  # the round core is meshed anew


def face_area(mesh, name):
    """Area of a plane face, mm2, from the corners of its pieces."""
    total = 0.0
    for block in mesh.face_blocks(name):
        corners = mesh.points[block.nodes[:, : CORNERS[block.kind]]]
        first = corners[:, :1]
        spans = corners[:, 1:] - first
        total += 0.5 * float(np.linalg.norm(np.cross(spans[:, :-1], spans[:, 1:]), axis=2).sum())
    return total


def test_end_walls_thinner_than_the_others_are_refused():
    with pytest.raises(GeometryError, match=r"end_wall = 1 mm: expected at least expansion_wall = 2 mm"):
        HexagonalPrism(end_wall=1.0)


@pytest.mark.parametrize("half", [False, True])
def test_an_end_plate_closes_the_free_end_but_for_its_hole(half):
    sizes = {"chambers": 2, "length": 24.0, "end_wall": 4.0, "half": half}
    prism = HexagonalPrism(**sizes, end_plate=4.0, end_plate_bore=2.0)
    open_end, mesh = (generate(p, hexahedra=True) for p in (HexagonalPrism(**sizes), prism))
    inserted = (0.5 if half else 1.0) * math.pi * (14.0**2 - 2.0**2) * 4.0
    assert inspect(mesh).volume - inspect(open_end).volume == pytest.approx(inserted, rel=1e-3)
    solid = generate(prism, coarse=True)
    assert inspect(solid).volume == pytest.approx(inspect(mesh).volume, rel=0.01)
    for found in (mesh, solid):
        assert set(found.faces) == set(prism.face_names)
        (plate,) = (block for block in found.blocks if block.domain == "plate")
        assert found.points[plate.nodes, 2].min() == pytest.approx(20.0)
        radius = np.hypot(*found.points[np.unique(plate.nodes), :2].T)
        assert radius.min() == pytest.approx(2.0, abs=0.3)  # coarse tetrahedra cut the corners
        assert radius.max() == pytest.approx(20.0, abs=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"end_plate": -1.0}, "end_plate = -1 mm: expected a length of at least 0"),
        ({"end_plate": 112.0}, "end_plate = 112 mm leaves no column: expected less than length = 112 mm"),
        ({"end_plate_bore": 14.0}, r"end_plate_bore = 14 mm leaves no plate in the core: .* core_radius = 14 mm"),
    ],
)
def test_an_end_plate_that_does_not_fit_is_refused(change, message):
    with pytest.raises(GeometryError, match=message):
        HexagonalPrism(**change)
