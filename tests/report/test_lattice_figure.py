"""The planar map of a lattice as a picture."""

import re

import pytest

from pneumorph.errors import InputError
from pneumorph.geometry.lattice import Cell, Polygon, Segment, cell_map, halves, skinned_tube
from pneumorph.report.lattice_figure import lattice_figure


def test_picture_draws_every_hole_and_those_on_the_seam_twice():
    lattice = skinned_tube(halves(2, 6)).lattice
    text = lattice_figure(lattice).decode()
    white = len(re.findall(r"<path[^>]*(?:stroke-width: 0.5|fill: #ffffff[^>]*stroke-width: 0.5)", text))
    # a row of every two lies on the borders between columns, and so on the seam
    assert white == len(lattice.holes) + lattice.rows // 2


def test_picture_tells_kinds_and_gaps_apart():
    polygon = Cell(Polygon(((-0.3, -0.2), (0.3, -0.2), (0.0, 0.2))))
    cells = cell_map([Segment(1, ((2, Cell("re-entrant", 0.2)), (2, polygon))), Segment(1, ((4, Cell("brick", 0.4)),))])
    lattice = skinned_tube(cells, length=30.0).lattice
    fills = set(re.findall(r"fill: (#[0-9a-f]{6})", lattice_figure(lattice).decode()))
    assert len(fills - {"#ffffff"}) >= 3
    assert lattice_figure(lattice, "png").startswith(b"\x89PNG")


def test_unknown_form_is_refused():
    with pytest.raises(InputError, match="form = 'pdf', allowed: svg, png"):
        lattice_figure(skinned_tube(halves(1, 4)).lattice, "pdf")
