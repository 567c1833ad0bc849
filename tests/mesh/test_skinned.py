"""Tubes with lattice skins: exact areas and volumes, positive cells, closed cavities, named faces."""

import dataclasses
import math

import numpy as np
import pytest

from pneumorph.errors import LeakingCavityError, MeshError
from pneumorph.geometry.lattice import Cell, Polygon, Segment, cell_map, halves, skinned_tube
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Clamp, Model, Symmetry
from pneumorph.mesh.lattice_sheet import mesh_sheet
from pneumorph.mesh.reference import jacobians, quadrature
from pneumorph.mesh.skinned import mesh_skinned_tube
from pneumorph.mesh.topology import boundary

# no symmetry, and a pointed end
KITE = Polygon(((-0.4, 0.0), (-0.1, -0.2), (0.3, -0.1), (0.3, 0.15), (0.1, 0.2)))
MAPS = {
    "half and half": halves(2, 6),
    "one cell along": halves(1, 4, 0.3),
    "bricks that touch": halves(2, 4, 0.5),
    "odd": halves(2, 5, reentrant=2),
    "polygons": cell_map([Segment(1, ((4, Cell(KITE)),)), Segment(1, ((2, Cell("brick", 0.3)), (2, Cell(KITE))))]),
}
MATERIALS = {name: NeoHookean(0.037) for name in ("tube", "skin", "cap")}


def short(cells, **more):
    """The study's tube, cut to the length of the map."""
    return skinned_tube(cells, length=14.9 * len(cells), **more)


def volumes(mesh):
    result = {}
    for block in mesh.blocks:
        volume = float((jacobians(mesh.points, block.kind, block.nodes) @ quadrature(block.kind)[1]).sum())
        result[block.domain] = result.get(block.domain, 0.0) + volume
    return result


def flat_areas(sheet, around):
    """Areas of the planar cells in beams and in holes; all cells must be anticlockwise."""
    total = {True: 0.0, False: 0.0}
    for kind, nodes in sheet.cells.items():
        corners = sheet.points[nodes[:, : 3 if kind == "triangle6" else 4]]
        at_seam = np.ptp(corners[..., 0], axis=1) > around / 2.0  # their right end is at x = 0
        corners[..., 0] += np.where(at_seam[:, None] & (corners[..., 0] == 0.0), around, 0.0)
        x, y = corners[..., 0], corners[..., 1]
        area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
        assert (area > 0.0).all()
        for beam in total:
            total[beam] += float(area[sheet.beam[kind] == beam].sum())
    return total


@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize("size", [8.0, 2.0])
def test_flat_sheet_has_the_closed_form_area_of_beams_and_holes(name, size):
    lattice = short(MAPS[name]).lattice
    areas = flat_areas(mesh_sheet(lattice, size, 2.0), lattice.around)
    assert areas[True] == pytest.approx(lattice.area, rel=1e-9)
    assert areas[False] == pytest.approx(sum(hole.area for hole in lattice.holes), rel=1e-9)


@pytest.mark.parametrize("half", [False, True])
def test_tube_skin_and_caps_have_their_closed_form_volumes(half):
    """The skin closes at the middle of its depth, so rolling keeps the volume of the flat sheet."""
    tube = short(halves(2, 8), cap=3.0)
    found = volumes(mesh_skinned_tube(tube, 2.0, half=half))
    share = 0.5 if half else 1.0
    assert found["skin"] == pytest.approx(share * tube.lattice.area * tube.depth, rel=1e-6)
    assert found["tube"] == pytest.approx(share * tube.tube_volume, rel=1e-6)
    assert found["cap"] == pytest.approx(share * 2.0 * math.pi * 12.5**2 * 3.0, rel=1e-6)


def test_a_cone_has_its_closed_form_volume():
    tube = dataclasses.replace(short(halves(1, 16)), tip_radius=8.0)
    mesh = mesh_skinned_tube(tube)
    assert volumes(mesh)["tube"] == pytest.approx(tube.tube_volume, rel=1e-6)
    model = Model(mesh, MATERIALS, (Clamp("clamp"),), cavities=(Cavity("cavity", ("cavity",)),))
    assert model.surfaces["cavity"].reference_volume == pytest.approx(tube.cavity_volume, rel=1e-6)
    outside = mesh.points[mesh.face_nodes("outer")]
    assert np.allclose(np.hypot(outside[:, 0], outside[:, 1]), 14.5 - 6.5 * outside[:, 2] / 14.9)


@pytest.mark.parametrize("name", MAPS)
def test_cells_are_positive_all_faces_named_and_the_cavity_closed(name):
    tube = short(MAPS[name])
    mesh = mesh_skinned_tube(tube)
    assert mesh.domains == ("tube", "skin", "cap")
    for block in mesh.blocks:
        assert (jacobians(mesh.points, block.kind, block.nodes) > 0.0).all()
    assert set(mesh.faces) == {"clamp", "tip", "clamp_cap", "tip_cap", "cavity", "outer", "skin"}
    named = [tuple(sorted(row)) for blocks in mesh.faces.values() for b in blocks for row in b.nodes.tolist()]
    skin = [tuple(sorted(row)) for b in boundary(mesh.blocks) for row in b.nodes.tolist()]
    assert sorted(named) == sorted(skin)
    assert len(np.unique(np.round(mesh.points, 7), axis=0)) == len(mesh.points)
    model = Model(mesh, MATERIALS, (Clamp("clamp"),), cavities=(Cavity("cavity", ("cavity",)),))
    assert model.surfaces["cavity"].reference_volume == pytest.approx(tube.cavity_volume, rel=1e-4)


def test_names_lie_where_they_say():
    tube = short(halves(2, 6))
    mesh = mesh_skinned_tube(tube)
    radius, z = np.hypot(mesh.points[:, 0], mesh.points[:, 1]), mesh.points[:, 2]
    for name, height in (("clamp", 0.0), ("clamp_cap", 0.0), ("tip", 29.8), ("tip_cap", 29.8)):
        nodes = mesh.face_nodes(name)
        assert np.allclose(z[nodes], height)
        assert (radius[nodes].min() > 12.4) == (name in ("clamp", "tip"))
    assert np.allclose(radius[mesh.face_nodes("outer")], 14.5, atol=1e-6)
    assert radius[mesh.face_nodes("skin")].min() == pytest.approx(14.5)
    assert radius[mesh.face_nodes("skin")].max() == pytest.approx(16.5)
    assert radius[mesh.face_nodes("cavity")].max() == pytest.approx(12.5)
    inside = z[mesh.face_nodes("cavity")]
    assert (inside.min(), inside.max()) == pytest.approx((2.0, 27.8))


def test_half_a_tube_is_closed_by_its_plane_of_symmetry():
    tube = short(halves(2, 6))
    mesh = mesh_skinned_tube(tube, half=True)
    assert mesh.points[:, 1].min() == 0.0
    whole = mesh_skinned_tube(tube)
    assert 2 * mesh.cell_count == whole.cell_count
    supports = (Clamp("clamp"), Symmetry("symmetry_y"))
    model = Model(mesh, MATERIALS, supports, cavities=(Cavity("cavity", ("cavity",), mirrors=("symmetry_y",)),))
    assert model.surfaces["cavity"].reference_volume == pytest.approx(tube.cavity_volume / 2.0, rel=1e-4)
    with pytest.raises(LeakingCavityError):
        _ = Model(mesh, MATERIALS, supports, cavities=(Cavity("cavity", ("cavity",)),))


def test_layers_multiply_the_cells_of_wall_and_skin():
    tube = short(halves(1, 4))
    one, more = mesh_skinned_tube(tube), mesh_skinned_tube(tube, wall_layers=3, skin_layers=2)
    count = {
        number: {d: sum(len(b.nodes) for b in mesh.blocks if b.domain == d) for d in mesh.domains}
        for number, mesh in enumerate((one, more))
    }
    assert count[1]["tube"] == 3 * count[0]["tube"]
    assert count[1]["skin"] == 2 * count[0]["skin"]
    assert count[1]["cap"] == count[0]["cap"]


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"size": 0.0}, "size = 0.0: expected a finite number of mm greater than 0"),
        ({"size": math.inf}, "size = inf: expected a finite number"),
        ({"wall_layers": 0}, "wall_layers = 0: expected a whole number of at least 1"),
        ({"skin_layers": 1.5}, "skin_layers = 1.5: expected a whole number of at least 1"),
        ({"half": True}, "half = True: the map of cells is not its own mirror image"),
        ({"size": 1e-3}, "skinned tube at 0.001 mm"),
    ],
)
def test_bad_input_is_refused_by_name(more, message):
    with pytest.raises(MeshError, match=message):
        mesh_skinned_tube(short(MAPS["polygons"]), **more)
