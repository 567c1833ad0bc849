"""The plane crawler: area, names, symmetry of its mesh, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import PlaneCrawler
from pneumorph.mechanics.surface import enclosed_volume
from pneumorph.mesh import generate, inspect

BLOCK = PlaneCrawler(segments=2, channels=2, rounding=0.0, layer=0.5)
TUBES = PlaneCrawler(segments=2, channels=2)


def soft_area(crawler):
    """Squares less the holes, less what the rounded corners lack: (4 - pi) rho^2 a channel, but for the two heels."""
    count = crawler.segments * crawler.channels
    whole = count * (4.0 * crawler.outer_radius**2 - math.pi * crawler.inner_radius**2)
    return whole - (count - 0.5) * (4.0 - math.pi) * crawler.rounding**2


@pytest.mark.parametrize("crawler", [BLOCK, TUBES], ids=["block", "tubes"])
def test_the_area_is_that_of_the_drawing(crawler):
    # straight outer edges cut the rounded corners a little
    area = inspect(generate(crawler, 0.6)).volume
    assert area == pytest.approx(
        soft_area(crawler) + crawler.length * crawler.layer, rel=1e-5 if crawler is BLOCK else 5e-3
    )


def test_every_face_has_its_place():
    mesh = generate(TUBES)
    assert set(mesh.faces) == set(TUBES.face_names)
    assert mesh.domains == TUBES.domains
    assert mesh.space == TUBES.space
    for number, name in enumerate(TUBES.cavities):
        x, y = mesh.points[mesh.face_nodes(name)].T
        assert number * 20.0 + 2.0 == pytest.approx(x.min())
        assert y.max() == pytest.approx(TUBES.layer + 8.0)
        volume = sum(
            enclosed_volume(b.kind, b.nodes, mesh.points, np.zeros(2), np.eye(2), False, 0)[0] for b in mesh.faces[name]
        )
        assert volume == pytest.approx(TUBES.cavity_volume, rel=1e-4)
    rear, front = (mesh.points[mesh.face_nodes(name)] for name in ("rear_foot", "front_foot"))
    assert rear[:, 0].min() == 0.0
    assert rear[:, 0].max() == pytest.approx(20.0)
    assert front[:, 0].max() == pytest.approx(40.0)
    assert rear[:, 1].max() == pytest.approx(TUBES.layer + 5.0)


@pytest.mark.parametrize("crawler", [BLOCK, TUBES], ids=["block", "tubes"])
def test_the_mesh_is_its_own_mirror_image(crawler):
    mesh = generate(crawler)

    def cells(points):
        places = np.round(np.concatenate([points[block.nodes].mean(axis=1) for block in mesh.blocks]), 8)
        return places[np.lexsort(places.T)]

    np.testing.assert_allclose(cells(mesh.points), cells(mesh.points * (-1, 1) + (crawler.length, 0)), atol=1e-7)


def test_the_feet_stand_on_square_corners_and_all_other_corners_are_round():
    mesh = generate(TUBES)
    distance = np.abs(mesh.points[:, None] - [(0.0, TUBES.layer), (0.0, TUBES.height)]).max(axis=2).min(axis=0)
    assert distance[0] < 1e-9
    assert distance[1] > 0.5


def test_dimensions_and_settings_that_do_not_fit_are_refused():
    with pytest.raises(GeometryError, match="rounding = 5 mm leaves no flat side"):
        replace(TUBES, rounding=5.0)
    with pytest.raises(GeometryError, match="inner_radius = 6 mm leaves no wall"):
        replace(TUBES, inner_radius=6.0)
    with pytest.raises(GeometryError, match="has no CAD solid"):
        TUBES.shape()
    with pytest.raises(MeshError, match="its size only"):
        generate(TUBES, wall_size=1.0)
    with pytest.raises(MeshError, match="cells"):
        generate(TUBES, 1e-3)
