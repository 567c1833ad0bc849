"""The quality report: counts, shapes, elements across walls, and its warnings."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.geometry import Finger
from pneumorph.mesh import box, generate, inspect, rectangle


def test_counts_and_edges_of_a_known_mesh():
    quality = inspect(box(2, 2, 2))
    assert (quality.cells, quality.nodes, quality.unknowns) == (48, 125, 375)
    assert quality.volume == pytest.approx(1.0)
    assert quality.smallest_edge == pytest.approx(0.5)
    assert quality.smallest_jacobian == pytest.approx(1.0)
    assert quality.warnings == ()


def test_aspect_is_one_for_regular_triangles_and_three_for_halves_of_a_rhombus_along_its_long_diagonal():
    regular = rectangle(1, 1, lambda p: np.column_stack([p[:, 0] - 0.5 * p[:, 1], p[:, 1] * np.sqrt(0.75)]))
    assert inspect(regular).worst_aspect == pytest.approx(1.0)
    long = rectangle(1, 1, lambda p: np.column_stack([p[:, 0] + 0.5 * p[:, 1], p[:, 1] * np.sqrt(0.75)]))
    assert inspect(long).worst_aspect == pytest.approx(3.0)


@pytest.mark.parametrize("layers", [1, 2, 3])
@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_elements_across_a_plate_are_counted(kind, layers):
    plate = box(6, 6, layers, kind, lengths=(10.0, 10.0, 1.0), bending_walls={"plate": 1.0})
    assert inspect(plate).elements_across["plate"] == pytest.approx(layers, rel=1e-6)


def test_elements_across_a_strip_in_two_dimensions_are_counted():
    strip = rectangle(8, 2, width=10.0, bending_walls={"strip": 1.0})
    assert inspect(strip).elements_across["strip"] == pytest.approx(2.0)


def test_one_element_across_a_thick_wall_is_warned_of_and_two_are_enough():
    one = box(4, 4, 1, lengths=(4.0, 4.0, 2.0), bending_walls={"slab": 2.0})
    (warning,) = inspect(one).warnings
    assert warning.startswith("thick wall 'slab' of 2 mm has 1 quadratic elements across it, expected at least 2")
    two = box(4, 4, 2, lengths=(4.0, 4.0, 2.0), bending_walls={"slab": 2.0})
    assert inspect(two).warnings == ()


def test_elements_across_a_plate_do_not_depend_on_its_direction():
    leaning = box(2, 2, 1, mapping=lambda p: p + 0.5 * p[:, [2, 2, 0]] * [0, 0, 1], lengths=(20.0, 20.0, 1.0))
    leaning = replace(leaning, bending_walls={"plate": 1.0 / np.sqrt(1.25)})
    assert inspect(leaning).elements_across["plate"] == pytest.approx(1.0, abs=0.05)


def test_wall_that_is_not_there_is_warned_of():
    quality = inspect(box(2, 2, 2, bending_walls={"fin": 0.3}))
    assert np.isnan(quality.elements_across["fin"])
    assert "wall 'fin' of 0.3 mm was not found" in quality.warnings[0]


def test_inverted_cells_are_warned_of():
    mesh = box(1, 1, 1)
    points = mesh.points.copy()
    points[mesh.blocks[0].nodes[0, 6]] += 2.0
    quality = inspect(replace(mesh, points=points))
    assert quality.smallest_jacobian < 0.0
    assert "inverted cells" in quality.warnings[0]


def test_finger_at_its_default_size_has_an_element_across_every_wall():
    quality = inspect(generate(Finger()))
    assert quality.warnings == ()
    assert all(number >= 0.95 for number in quality.elements_across.values())
