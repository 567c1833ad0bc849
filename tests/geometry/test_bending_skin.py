"""The template of the bending skin: the study's dimensions, its mesh and names, and what is refused."""

import math

import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import BendingSkin
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
