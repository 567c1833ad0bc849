"""The template of the bending skin: the study's dimensions, its mesh and names, and what is refused."""

import math

import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import BendingSkin
from pneumorph.geometry.bending_skin import SkinSegment
from pneumorph.mesh import generate

SHORT = {"cells_along": 2, "length": 29.8}


def test_default_is_the_study():
    skin = BendingSkin()
    assert skin.tube.lattice.columns == 12
    assert [cell.kind for cell in skin.tube.lattice.cells[0]] == ["re-entrant"] * 6 + ["honeycomb"] * 6
    assert skin.cavity_volume == pytest.approx(math.pi * 12.5**2 * 100.3)
    assert BendingSkin(half=True).cavity_volume == pytest.approx(skin.cavity_volume / 2.0)
    assert skin.axis == (0.0, 0.0, 1.0)


@pytest.mark.parametrize("share", [0.0, 0.25, 1.0])
def test_share_of_reentrant_columns(share):
    row = BendingSkin(reentrant=share, **SHORT).tube.lattice.cells[0]
    assert sum(cell.kind == "re-entrant" for cell in row) == 12 * share


@pytest.mark.parametrize("half", [False, True])
def test_mesh_has_the_names_of_the_template(half):
    skin = BendingSkin(half=half, **SHORT)
    mesh = generate(skin, coarse=True)
    assert set(mesh.faces) == set(skin.face_names)
    assert mesh.domains == skin.domains
    assert mesh.bending_walls == skin.bending_walls
    assert generate(skin).cell_count > mesh.cell_count
    assert generate(skin, 2.0).cell_count > generate(skin).cell_count
    if half:  # the middle of the re-entrant half, which grows longer when it swells, looks along x
        assert mesh.points[:, 1].min() == 0.0


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"half": "yes"}, "half = 'yes': expected True or False"),
        ({"cg": math.nan}, "cg = nan: expected a number above 0, at most 0.5"),
        ({"cg": 0.6}, r"cg = 0.6 of a re-entrant cell: the gap g = cg h = 8.94 mm, expected cg more than 0"),
        ({"reentrant": True}, "reentrant = True: expected a number from 0 to 1"),
        ({"reentrant": 0.3}, "reentrant = 0.3 of cells_around = 12 makes 3.6 columns: expected a whole number"),
        ({"reentrant": 1.5}, "makes 18 columns: expected a whole number of them, none to all"),
        ({"cells_along": 0}, "cells_along = 0: expected a whole number of at least 1"),
        ({"beam": 8.5}, "beam = 8.5 mm: expected less than the width of the cell, 8.11578 mm"),
        ({"wall": 20.0}, "wall = 20 mm: expected less than the radius, 14.5 mm"),
    ],
)
def test_dimensions_that_do_not_fit_are_refused(changed, message):
    with pytest.raises(GeometryError, match=message):
        BendingSkin(**changed)


def test_there_is_no_cad_solid_and_no_setting_of_tetrahedra():
    with pytest.raises(GeometryError, match="has no CAD solid: export its mesh instead"):
        BendingSkin().shape()
    for name in ("grading", "detail", "wall_size"):
        with pytest.raises(MeshError, match=rf"{name} = 0.5: a layered mesh has its size only"):
            generate(BendingSkin(), **{name: 0.5})
    with pytest.raises(MeshError, match=r"size = -1\.0: expected a finite number"):
        generate(BendingSkin(), -1.0)


def test_segments_make_the_map_from_the_clamp_on():
    skin = BendingSkin(
        cells_along=4,
        segment=(
            SkinSegment(2, ((6, "honeycomb"), (6, "re-entrant")), cg=0.3),
            SkinSegment(1, turn=3),
            SkinSegment(1, ((12, "brick"),), cg=0.5),
        ),
    )
    kinds = [[cell.kind for cell in row] for row in skin.cells]
    assert kinds[0] == kinds[1] == ["honeycomb"] * 6 + ["re-entrant"] * 6
    assert kinds[2] == ["honeycomb"] * 3 + ["re-entrant"] * 6 + ["honeycomb"] * 3
    assert kinds[3] == ["brick"] * 12
    assert [row[0].cg for row in skin.cells] == [0.3, 0.3, 0.2, 0.5]
    assert skin.tube.lattice.cells == skin.cells


def test_one_segment_is_the_skin_without_segments():
    assert BendingSkin(segment=(SkinSegment(7),)).cells == BendingSkin().cells


def test_turning_all_the_way_around_changes_nothing():
    """And turning by n columns, then by the rest, is that."""
    assert BendingSkin(segment=(SkinSegment(7, turn=12),)).cells == BendingSkin().cells
    assert BendingSkin(segment=(SkinSegment(7, turn=-5),)).cells == BendingSkin(segment=(SkinSegment(7, turn=7),)).cells


def test_a_blend_goes_through_bricks():
    """Between swapped halves of cg = 0.2, half-way lies cg = 0.5; two cells lie a quarter and three quarters of it."""
    skin = BendingSkin(cells_along=4, blend=2, segment=(SkinSegment(2), SkinSegment(2, turn=6)))
    assert [row[0].cg for row in skin.cells] == pytest.approx([0.2, 0.35, 0.35, 0.2])
    assert [row[0].kind for row in skin.cells] == ["re-entrant", "re-entrant", "honeycomb", "honeycomb"]


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"segment": (SkinSegment(3), SkinSegment(3))}, "the segments have 6 rows: expected cells_along = 7"),
        ({"segment": (SkinSegment(7, ((6, "brick"),)),)}, "segment 1 has 6 columns: expected cells_around = 12"),
        ({"blend": 2}, "blend = 2: expected segments to blend, or 0"),
        ({"segment": (SkinSegment(3), SkinSegment(4)), "blend": 3}, "blend = 3: expected an even number of cells"),
        ({"segment": (SkinSegment(7, cg=0.7),)}, "cg = 0.7 of a re-entrant cell: the gap g"),
        ({"segment": (SkinSegment(3), SkinSegment(4, turn=3)), "half": True}, "not its own mirror image"),
    ],
)
def test_segments_that_do_not_fit_are_refused(changed, message):
    with pytest.raises(GeometryError, match=message):
        BendingSkin(**changed)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"rows": 0}, "rows = 0: expected a whole number of at least 1"),
        ({"rows": 1, "turn": 0.5}, r"turn = 0\.5: expected a whole number of columns"),
        ({"rows": 1, "cg": True}, "cg = True: expected a number above 0"),
        ({"rows": 1, "columns": ((6, "honeycob"),)}, "unknown kind of cell 'honeycob': did you mean 'honeycomb'"),
        ({"rows": 1, "columns": ((0, "brick"),)}, "columns of a run = 0: expected a whole number of at least 1"),
        ({"rows": 1, "columns": ()}, "no runs of cells around, expected at least one"),
    ],
)
def test_a_segment_out_of_range_is_refused(given, message):
    with pytest.raises(GeometryError, match=message):
        SkinSegment(**given)
