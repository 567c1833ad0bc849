"""Flat lattices: closed-form areas and beams, maps with transitions, and what is refused."""

import math

import numpy as np
import pytest

from pneumorph.errors import GeometryError
from pneumorph.geometry.lattice import Cell, Lattice, Polygon, Segment, SkinnedTube, cell_map, halves, skinned_tube
from pneumorph.geometry.lattice.beams import distance

WIDTH, HEIGHT, BEAM = 8.12, 14.9, 1.57  # of a cell: Pu et al. 2024, table 1
NPR, PPR = Cell("re-entrant", 0.2), Cell("honeycomb", 0.2)
TALL = Polygon(((-0.45, -0.3), (0.45, -0.3), (0.45, 0.3), (-0.45, 0.3)))
DIAMOND = Polygon(((-0.4, 0.0), (0.0, -0.2), (0.4, 0.0), (0.0, 0.2)))


def sheet(cells, width=WIDTH, height=HEIGHT, beam=BEAM):
    return Lattice(width, height, beam, cells)


def uniform(cell, along=3, around=4):
    return sheet(cell_map([Segment(along, ((around, cell),))]))


@pytest.mark.parametrize("kind", ["re-entrant", "honeycomb", "brick"])
@pytest.mark.parametrize("cg", [0.1, 0.2, 0.4, 0.5])
def test_holes_have_the_area_of_the_study_and_the_sheet_what_is_left(kind, cg):
    lattice = uniform(Cell(kind, cg))
    g = cg * HEIGHT
    # trapezia on either side of the middle: heights h / 2 and g; a brick is g high all over
    hole = (WIDTH - BEAM) * (g if kind == "brick" else (HEIGHT / 2.0 + g) / 2.0)
    assert len(lattice.holes) == 2 * 3 * 4
    assert all(h.area == pytest.approx(hole, rel=1e-12) for h in lattice.holes)
    assert lattice.area == pytest.approx(4 * WIDTH * 3 * HEIGHT - 24 * hole, rel=1e-12)


@pytest.mark.parametrize("cg", [0.1, 0.2, 0.35])
def test_oblique_beams_have_their_closed_form_width(cg):
    rise = HEIGHT / 4.0 - cg * HEIGHT / 2.0  # of an oblique side over half the clear width
    cosine = 1.0 / math.hypot(1.0, rise / ((WIDTH - BEAM) / 2.0))
    reentrant = cosine * rise * (WIDTH - 2.0 * BEAM) / (WIDTH - BEAM)
    honeycomb = cosine * rise * WIDTH / (WIDTH - BEAM)
    assert uniform(Cell("re-entrant", cg)).narrowest_beam == pytest.approx(min(BEAM, reentrant), rel=1e-12)
    assert uniform(Cell("honeycomb", cg)).narrowest_beam == pytest.approx(min(BEAM, honeycomb), rel=1e-12)


@pytest.mark.parametrize("kind", ["re-entrant", "honeycomb", "brick"])
@pytest.mark.parametrize("cg", [0.2, 0.4, 0.45, 0.5])
def test_a_least_beam_is_kept_between_rows_and_changes_no_hole_that_leaves_more(kind, cg):
    plain, kept = uniform(Cell(kind, cg)), uniform(Cell(kind, cg, least_beam=1.2))
    if plain.narrowest_beam >= 1.2:
        assert all((a.corners == b.corners).all() for a, b in zip(plain.holes, kept.holes, strict=True))
    else:
        assert kept.narrowest_beam == pytest.approx(1.2, rel=1e-9)
        middle = [hole.corners.mean(axis=0) for hole in plain.holes]
        assert np.allclose([hole.corners.mean(axis=0) for hole in kept.holes], middle)


def test_with_a_least_beam_both_lattices_are_still_one_brick_at_cg_one_half():
    """Bricks in a wall: holes of h / 2 less the beam, w - b wide."""
    first, second = (uniform(Cell(kind, 0.5, least_beam=1.57)) for kind in ("re-entrant", "honeycomb"))
    assert all(np.allclose(a.corners, b.corners) for a, b in zip(first.holes, second.holes, strict=True))
    assert first.holes[0].area == pytest.approx((WIDTH - BEAM) * (HEIGHT / 2.0 - 1.57))


def test_a_blend_goes_from_one_least_beam_to_the_other():
    ends = Cell("re-entrant", 0.2, least_beam=1.0), Cell("honeycomb", 0.2, least_beam=2.0)
    rows = cell_map([Segment(2, ((4, ends[0]),)), Segment(2, ((4, ends[1]),))], blend=2)
    assert [row[0].least_beam for row in rows] == pytest.approx([1.0, 1.25, 1.75, 2.0])


def test_a_least_beam_that_is_none_or_leaves_no_hole_is_refused():
    for wrong in (-1.0, math.nan, True):
        with pytest.raises(GeometryError, match="least_beam = "):
            Cell("brick", 0.5, least_beam=wrong)
    with pytest.raises(GeometryError, match="least_beam = 8 mm leaves no hole in a brick cell"):
        uniform(Cell("brick", 0.5, least_beam=8.0))


def test_at_cg_one_half_both_lattices_are_the_same_bricks_that_touch():
    first, second = uniform(Cell("re-entrant", 0.5)), uniform(Cell("honeycomb", 0.5))
    x = np.linspace(0.0, first.around, 200)
    assert np.allclose(first.levels(x), second.levels(x))
    assert first.area == pytest.approx(BEAM / WIDTH * first.around * first.length)
    assert first.narrowest_beam == pytest.approx(0.0, abs=1e-12)


def test_rows_of_holes_are_half_a_cell_apart_and_shifted_by_half_a_column():
    lattice = uniform(NPR)
    centre = np.array([hole.corners.mean(axis=0) for hole in lattice.holes]).reshape(lattice.rows, 4, 2)
    assert np.allclose(np.diff(centre[..., 1], axis=0), HEIGHT / 2.0)
    assert np.allclose(centre[0, :, 0] - centre[1, :, 0], WIDTH / 2.0)


def test_a_hole_between_two_kinds_takes_a_half_from_each():
    lattice = sheet(halves(2, 4))
    between = lattice.in_row(1)[2]
    sides = between.upper[:, 1] - between.lower[:, 1]
    assert sides[[0, -1]] == pytest.approx([HEIGHT / 2.0, 0.2 * HEIGHT])
    assert sides[1] == pytest.approx((HEIGHT / 2.0 + 0.2 * HEIGHT) / 2.0)


def test_a_polygon_of_ones_own_keeps_its_area_in_either_sense():
    for points in (DIAMOND.points, DIAMOND.points[::-1]):
        lattice = uniform(Cell(Polygon(points)))
        assert lattice.holes[0].area == pytest.approx(0.5 * 0.8 * WIDTH * 0.4 * HEIGHT)
    slanted = Polygon(((-0.4, -0.1), (0.3, -0.2), (0.3, 0.2), (-0.4, 0.2)))
    assert uniform(Cell(slanted)).holes[5].area == pytest.approx(0.5 * (0.3 + 0.4) * 0.7 * WIDTH * HEIGHT)
    assert DIAMOND.symmetric
    assert not slanted.symmetric


def test_half_and_half_mirrors_about_the_middle_of_either_half():
    lattice = sheet(halves(2, 6))
    assert lattice.mirror == pytest.approx(1.5 * WIDTH)
    x = np.linspace(0.0, lattice.around / 2.0, 100)
    ahead, back = ((lattice.mirror + sign * x) % lattice.around for sign in (1.0, -1.0))
    assert np.allclose(lattice.levels(ahead), lattice.levels(back))
    runs = ((1, NPR), (2, PPR), (3, Cell("brick", 0.3)))
    assert sheet(cell_map([Segment(2, runs)])).mirror is None
    assert uniform(Cell(Polygon(((-0.4, -0.1), (0.3, -0.2), (0.3, 0.2))))).mirror is None


def test_a_transition_between_kinds_goes_through_the_brick():
    cells = cell_map([Segment(4, ((3, NPR),)), Segment(4, ((3, PPR),))], blend=4)
    column = [(row[0].kind, round(row[0].cg, 12)) for row in cells]
    assert column == [("re-entrant", 0.2)] * 2 + [("re-entrant", 0.275), ("re-entrant", 0.425)] + [
        ("honeycomb", 0.425), ("honeycomb", 0.275)] + [("honeycomb", 0.2)] * 2  # fmt: skip
    steps = cell_map([Segment(2, ((3, NPR),)), Segment(2, ((3, Cell("re-entrant", 0.4)),))], blend=2)
    assert [row[0].cg for row in steps] == pytest.approx([0.2, 0.25, 0.35, 0.4])
    sheet(cells)


def test_the_study_closes_around_its_tube_and_fills_its_length():
    tube = skinned_tube()
    assert tube.lattice.width == pytest.approx(8.12, abs=0.005)
    assert tube.lattice.height == pytest.approx(14.9)
    assert tube.cavity_volume == pytest.approx(math.pi * 12.5**2 * 100.3)
    assert tube.tube_volume == pytest.approx(math.pi * (14.5**2 - 12.5**2) * 104.3)


def test_distance_of_polygons_is_that_of_corner_and_side():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    diamond = np.array([[3.0, 0.5], [4.0, -0.5], [5.0, 0.5], [4.0, 1.5]])
    assert distance(square, diamond) == pytest.approx(2.0)
    assert distance(diamond, square) == pytest.approx(2.0)


MAP = halves(2, 4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: sheet(()), "the map of cells is empty, expected at least one row"),
        (lambda: sheet(((),)), "the map of cells is empty"),
        (lambda: skinned_tube(()), "the map of cells is empty"),
        (lambda: cell_map([]), "the map is empty, expected at least one segment"),
        (lambda: sheet(((NPR, NPR), (NPR,))), "row 1 of the map has 1 columns: expected 2 as in row 0"),
        (lambda: sheet((("brick", NPR),)), "row 0 of the map: expected objects of the class Cell"),
        (lambda: sheet(MAP, beam=9.0), "beam = 9 mm: expected less than the width of the cell, 8.12 mm"),
        (lambda: sheet(MAP, beam=0.0), "beam = 0.0: expected a finite length in mm greater than 0"),
        (lambda: sheet(MAP, width=math.nan), "width = nan: expected a finite length"),
        (lambda: sheet(MAP, height=True), "height = True: expected a finite length"),
        (lambda: skinned_tube(MAP, length=-1.0), "length = -1.0: expected a finite length"),
        (lambda: uniform(Cell(TALL)), "rows 0 and 1 of holes overlap by 1.49 mm at x = .*: expected holes that leave"),
        (lambda: uniform(Cell("re-entrant", 0.7)), r"cg = 0.7 of a re-entrant cell: the gap g = cg h = 10.43 mm"),
        (lambda: uniform(Cell("honeycomb", 0.0)), "cg = 0.0 of a honeycomb cell: .* expected cg more than 0"),
        (lambda: Cell("reentrant"), "unknown kind of cell 'reentrant': did you mean 're-entrant'"),
        (lambda: uniform(Cell(Polygon(((-0.6, 0.0), (0.6, 0.0), (0.0, 0.1))))), "0 and 1 of row 0 are -1.624 mm apart"),
        (lambda: uniform(Cell(Polygon(((-0.3, -0.1), (0.3, -0.1), (0.0, 0.3))))), "beyond the ends of the sheet"),
        (lambda: Polygon(((0.0, 0.0), (1.0, 0.0))), "polygon of 2 corners: expected at least 3"),
        (lambda: Polygon(((0.1, 0.0), (0.3, 0.0), (0.2, 0.1))), "expected corners on both sides of the middle"),
        (
            lambda: Polygon(((-0.3, 0.0), (0.3, 0.0), (0.1, 0.1), (0.2, 0.2), (-0.3, 0.2))),
            "crosses the outline more than twice",
        ),
        (lambda: Polygon(((-0.3, 0.0), (-0.1, 0.2), (0.1, 0.0), (0.3, 0.2), (0.1, 0.2), (-0.1, 0.0))), "polygon: "),
        (lambda: Segment(0, ((1, NPR),)), "cells = 0: expected a whole number of at least 1"),
        (lambda: Segment(1, ((-1, NPR),)), "columns of a run = -1"),
        (lambda: Segment(1, ()), "no runs of cells around"),
        (lambda: halves(2, 4, reentrant=5), "reentrant = 5: expected 0 to 4 columns"),
        (lambda: cell_map([Segment(2, ((1, NPR),))], blend=1), "blend = 1: expected an even number of cells"),
        (lambda: cell_map([Segment(2, ((1, NPR),))] * 2, blend=4), "blend = 4: expected at most 2"),
        (
            lambda: cell_map([Segment(2, ((1, NPR),)), Segment(2, ((2, NPR),))]),
            "segments of 1 and 2 columns: expected the same in all",
        ),
        (
            lambda: cell_map([Segment(2, ((1, NPR),)), Segment(2, ((1, Cell(DIAMOND)),))], blend=2),
            "nothing lies between re-entrant and polygon cells",
        ),
        (
            lambda: SkinnedTube(sheet(halves(7, 12), width=8.3)),
            r"do not close around the circumference: 12 of width = 8.3 mm make 99.6 mm, expected .* = 97.3894 mm",
        ),
        (lambda: skinned_tube(wall=15.0), "wall = 15 mm: expected less than the radius, 14.5 mm"),
        (lambda: skinned_tube(cap=60.0), "cap = 60 mm: expected less than half the length, 52.15 mm"),
        (lambda: SkinnedTube(skinned_tube().lattice, tip_radius=-1.0), "tip_radius = -1.0: expected a finite length"),
    ],
)
def test_bad_input_is_refused_by_name(make, message):
    with pytest.raises(GeometryError, match=message):
        make()
