"""Cavities closed by caps: virtual membranes on the rim of an opening."""

import numpy as np
import pytest
from tests.mesh.decks import deck

from pneumorph.materials import NeoHookean
from pneumorph.mechanics.body import Body
from pneumorph.mechanics.cavity import Cavity, CavitySurface
from pneumorph.mesh import Imported
from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.mesh.rims import cap, cap_corners
from pneumorph.mesh.skin import integrals
from pneumorph.solution.vtkhdf import read_mesh, write_mesh


@pytest.fixture(scope="module")
def surface(tmp_path_factory):
    """A block with a blind hole, closed by a cap, and the pattern in which it couples nodes."""
    path = tmp_path_factory.mktemp("caps") / "body.inp"
    path.write_text(deck((3, 3, 2), ((1, 1, 1),)))
    body = Imported(str(path), "mm", caps={"inlet": (1.5, 1.5, 2.0)})
    pattern = Body(body.mesh, {"BODY": NeoHookean(0.1)}).pattern
    return CavitySurface(Cavity("cavity", body.cavity_faces("cavity")), body.mesh, pattern)


def moved(surface, size=0.1):
    points = surface._mesh.points
    return points + size * np.random.default_rng(5).standard_normal(points.shape)


def test_a_cap_on_curved_edges_closes_the_surface_in_every_position(surface):
    """Then the volume does not depend on the origin: a shift does not change it, and no net force acts."""
    assert surface.reference_volume == pytest.approx(1.0, rel=1e-12)
    position = moved(surface)
    volume = surface.volume(position)
    assert abs(volume - 1.0) > 1e-3
    assert surface.volume(position + np.array([7.0, -3.0, 11.0])) == pytest.approx(volume, rel=1e-10)
    gradient = surface.gradient(position).reshape(-1, 3)
    assert np.abs(gradient).max() > 0.05
    assert gradient.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.cross(position, gradient).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-11)


def test_derivatives_of_the_volume_match_differences(surface):
    position, pattern, step = moved(surface), surface._pattern, 1e-6
    gradient = surface.gradient(position)
    values = np.zeros(pattern.indptr[-1])
    surface.add_hessian(position, 1.0, values)
    n = position.size
    upper = np.zeros((n, n))
    upper[np.repeat(np.arange(n), np.diff(pattern.indptr)), pattern.indices] = values
    hessian = upper + np.triu(upper, 1).T
    for direction in np.random.default_rng(1).standard_normal((3, *position.shape)):
        ends = [position + sign * step * direction for sign in (1, -1)]
        slope = (surface.volume(ends[0]) - surface.volume(ends[1])) / (2 * step)
        assert slope == pytest.approx(gradient @ direction.ravel(), rel=1e-7)
        second = (surface.gradient(ends[0]) - surface.gradient(ends[1])) / (2 * step)
        assert second == pytest.approx(hessian @ direction.ravel(), abs=1e-7)


def test_a_cap_over_a_circle_of_quadratic_edges_has_the_area_within_the_arcs():
    """The area between a parabola and its chord is 2/3 of chord times sagitta."""
    angle = 2.0 * np.pi * np.arange(8) / 8
    points = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    edges = np.array([[i, (i + 2) % 8, i + 1] for i in range(0, 8, 2)])
    vector, _ = integrals(cap_corners(points, cap(edges)), "triangle6")
    square, chord, sagitta = 2.0, np.sqrt(2.0), 1.0 - np.sqrt(0.5)
    assert vector.sum(axis=0) == pytest.approx([0, 0, -(square + 4 * 2 / 3 * chord * sagitta)])


def test_a_mesh_with_caps_is_stored_and_read_back(surface, tmp_path):
    write_mesh(tmp_path / "mesh.vtkhdf", surface._mesh)
    mesh = read_mesh(tmp_path / "mesh.vtkhdf")
    assert [block.kind for block in mesh.caps["inlet"]] == ["triangle3", "lens3"]
    for block, other in zip(mesh.caps["inlet"], surface._mesh.caps["inlet"], strict=True):
        assert np.array_equal(block.nodes, other.nodes)


def test_faces_of_a_cap_are_checked(surface):
    mesh = surface._mesh
    with pytest.raises(ValueError, match="unknown kind of cell or face 'triangle6'"):
        Mesh(mesh.points, mesh.blocks, mesh.faces, caps={"inlet": (FaceBlock("triangle6", np.zeros((1, 6), int)),)})
