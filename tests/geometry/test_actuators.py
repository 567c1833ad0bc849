"""Templates: checked dimensions, and a solid that is what its dimensions say."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from pneumorph.errors import GeometryError
from pneumorph.geometry import Finger, HexagonalPrism, PneuNet, ThickSphere, ThickTube, occ

TEMPLATES = [HexagonalPrism, Finger, PneuNet, ThickTube, ThickSphere]
SMALL_PRISM = HexagonalPrism(chambers=2, length=22.0)


@pytest.mark.parametrize("template", TEMPLATES)
def test_default_dimensions_are_described_and_say_whether_the_study_gives_them(template):
    rows = template().dimensions()
    assert all(row.symbol and row.help and row.kind in ("length", "count") for row in rows)
    assert len({row.symbol for row in rows}) == len(rows)
    assert np.linalg.norm(template().axis) == pytest.approx(1.0)
    assert template().default_size > 0.0


def test_hexagonal_prism_marks_what_table_1_gives():
    given = {row.symbol: row.value for row in HexagonalPrism().dimensions() if row.given}
    assert given == {"a": 20.0, "l": 112.0, "r": 14.0, "N": 11, "h2": 19.0, "w2": 14.0, "l2": 4.0, "l1": 2.0}


@pytest.mark.parametrize("template", TEMPLATES)
@pytest.mark.parametrize("value", [-1.0, 0.0, float("nan"), float("inf"), "3 mm", True, None])
def test_length_that_is_not_a_positive_number_is_refused_by_name(template, value):
    name = next(row.name for row in template().dimensions() if row.kind == "length")
    with pytest.raises(GeometryError, match=f"{name} = .*expected a"):
        template(**{name: value})


@pytest.mark.parametrize("value", [0, -2, 2.0, True, "3"])
@pytest.mark.parametrize("template", [HexagonalPrism, Finger, PneuNet])
def test_count_of_chambers_that_is_not_a_whole_number_from_one_is_refused(template, value):
    with pytest.raises(GeometryError, match=r"chambers = .*expected a whole number of at least 1"):
        template(chambers=value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"core_radius": 17.4}, r"core_radius = 17.4 mm leaves no wall: expected less than 17.32 mm"),
        ({"chambers": 12}, r"the chambers overlap or do not fit: .* = 118 mm, expected at most length = 112 mm"),
        ({"side_wall": 4.0}, r"neighbouring cavities overlap: .* = 22 mm, expected at most side = 20 mm"),
        ({"airway_width": 15.0}, r"airway_width = 15 mm: expected at most chamber_width = 14 mm"),
        ({"airway_height": 20.0}, r"airway_height = 20 mm: expected at most chamber_height = 19 mm"),
        ({"airway_side": 9.0}, r"wider than a chamber's block: expected at most 20 mm"),
        ({"airway_roof": 20.0}, r"higher than a chamber's block: expected at most 22 mm"),
        ({"airway_roof": 0.0}, r"airway_roof = 0 mm: expected a length greater than 0"),
        ({"gap": 0.0}, r"gap = 0 mm: expected a length greater than 0"),
        ({"half": 1}, r"half = 1: expected True or False"),
    ],
)
def test_hexagonal_prism_refuses_dimensions_that_do_not_fit(change, message):
    with pytest.raises(GeometryError, match=message):
        HexagonalPrism(**change)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gap": 12.0}, r"the chambers overlap: length = 90 mm leaves 2.571 mm for each of 7 chambers"),
        ({"width": 4.0}, r"the side walls overlap: width = 4 mm, expected more than 2 \* wall = 4 mm"),
        ({"base": 16.0}, r"base and top wall overlap: height = 18 mm, expected more than base \+ wall = 18 mm"),
        ({"passage_width": 13.0}, r"passage_width = 13 mm: expected at most width - 2 \* wall = 12 mm"),
        ({"passage_height": 14.0}, r"passage_height = 14 mm: expected at most height - base - wall = 13 mm"),
        ({"passage_roof": 13.0}, r"is higher than a chamber: expected at most height = 18 mm"),
        ({"passage_roof": 0.0}, r"passage_roof = 0 mm: expected a length greater than 0"),
    ],
)
def test_finger_refuses_dimensions_that_do_not_fit(change, message):
    with pytest.raises(GeometryError, match=message):
        Finger(**change)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"airway_width": 13.0}, r"airway_width = 13 mm: expected at most chamber_width = 12 mm"),
        ({"airway_height": 11.0}, r"airway_height = 11 mm: expected at most chamber_height = 10 mm"),
        ({"airway_roof": 11.0}, r"is higher than a chamber: expected at most chamber_height \+ top_wall = 12 mm"),
        ({"layer": -0.1}, r"layer = -0.1 mm: expected a length of at least 0"),
    ],
)
def test_pneunet_refuses_dimensions_that_do_not_fit(change, message):
    with pytest.raises(GeometryError, match=message):
        PneuNet(**change)


@pytest.mark.parametrize(
    ("template", "change", "message"),
    [
        (ThickTube, {"inner_radius": 15.0}, r"inner_radius = 15 mm leaves no wall"),
        (ThickTube, {"cap": 20.0}, r"the caps overlap: cap = 20 mm, expected less than length / 2 = 20 mm"),
        (ThickTube, {"quarter": 1}, r"quarter = 1: expected True or False"),
        (ThickSphere, {"inner_radius": 16.0}, r"inner_radius = 16 mm leaves no wall"),
        (ThickSphere, {"octant": "yes"}, r"octant = 'yes': expected True or False"),
    ],
)
def test_tube_and_sphere_refuse_dimensions_that_do_not_fit(template, change, message):
    with pytest.raises(GeometryError, match=message):
        template(**change)


def test_prism_solid_has_the_volume_of_column_blocks_and_bridges_less_the_air():
    one = SMALL_PRISM
    column = (3.0 * sqrt(3.0) / 2.0 * 20.0**2 - pi * 14.0**2) * 22.0
    silicone = 2 * 8.0 * 20.0 * 22.0 + 2.0 * 6.0 * 4.5
    assert occ.volume(one.shape()) == pytest.approx(column + 6 * (silicone - one.cavity_volume), rel=1e-9)


def test_blocks_narrower_than_the_side_make_one_solid_too():
    assert len(list(replace(SMALL_PRISM, side_wall=2.0).shape().solids)) == 1


def test_finger_solid_has_the_volume_of_its_profile_less_the_air():
    profile = 90.0 * 18.0 - 6 * 3.0 * (18.0 - 3.0 - 3.0 - 2.0)
    assert occ.volume(Finger().shape()) == pytest.approx(profile * 16.0 - Finger().cavity_volume, rel=1e-9)


def test_pneunet_with_a_layer_is_two_bonded_solids_and_without_it_one():
    beam = PneuNet(chambers=2)
    assert beam.domains == ("body", "base")
    assert len(list(beam.shape().solids)) == 2
    bare = replace(beam, layer=0.0)
    assert bare.domains == ("body",)
    assert len(list(bare.shape().solids)) == 1
    layer = beam.length * beam.width * beam.layer
    assert occ.volume(beam.shape()) == pytest.approx(occ.volume(bare.shape()) + layer, rel=1e-9)
    assert beam.height == bare.height + beam.layer


@pytest.mark.parametrize("chambers", [1, 2, 9])
def test_pneunet_takes_any_number_of_chambers(chambers):
    beam = PneuNet(chambers=chambers)
    assert len(list(beam.shape().solids)) == 2
    assert ("airway_roof" in beam.bending_walls) == (chambers > 1)


def test_pneunet_without_gaps_is_a_solid_block():
    beam = PneuNet(gap=0.0)
    block = beam.length * beam.width * beam.height
    assert occ.volume(beam.shape()) == pytest.approx(block - beam.cavity_volume, rel=1e-9)


def test_every_face_of_a_solid_has_one_of_the_names_that_the_template_lists():
    for one in (SMALL_PRISM, Finger(), PneuNet(), ThickTube(quarter=True), ThickSphere(octant=True)):
        names = {face.name or "outer" for face in one.shape().faces}
        assert names == set(one.face_names)


def test_separate_solids_where_one_is_expected_are_refused():
    two = occ.fused([occ.box((0, 0, 0), (1, 1, 1)), occ.box((2, 0, 0), (3, 1, 1))])
    with pytest.raises(GeometryError, match="make 2 separate solids, expected 1"):
        occ.check_solid(two, 1, "pair")
