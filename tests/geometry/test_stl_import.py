import numpy as np
import pytest

from pneumorph.errors import GeometryError
from pneumorph.geometry.stl import stl_bytes
from pneumorph.geometry.stl_import import read_stl
from pneumorph.mesh import Imported, MeshSize

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]]
)  # fmt: skip


def cube(low, size, inward=False):
    return CORNERS * size + np.array(low, dtype=float), FACES[:, ::-1] if inward else FACES


def write(path, *parts, keep=slice(None)):
    points = np.concatenate([p for p, _ in parts])
    start = np.cumsum([0, *[len(p) for p, _ in parts]])
    triangles = np.concatenate([t + s for (_, t), s in zip(parts, start, strict=False)])[keep]
    path.write_bytes(stl_bytes(points, triangles, "test"))
    return path


def volume(points, triangles):
    return np.linalg.det(points[triangles]).sum() / 6.0


@pytest.mark.parametrize("inward", [False, True])
@pytest.mark.parametrize("turned", [False, True])
def test_shells_are_turned_by_which_lies_in_which(tmp_path, inward, turned):
    path = write(tmp_path / "a.stl", cube((0, 0, 0), 10, turned), cube((3, 3, 3), 4, inward))
    points, triangles = read_stl([path])
    assert len(points) == 16
    assert volume(points, triangles) == pytest.approx(1000.0 - 64.0)


def test_outer_surface_and_cavities_may_lie_in_several_files(tmp_path):
    files = [write(tmp_path / "outer.stl", cube((0, 0, 0), 10))]
    files += [write(tmp_path / f"{i}.stl", cube((2, 2, 2 + 4 * i), 2)) for i in range(2)]
    body = Imported(tuple(map(str, files)), "mm", meshing=MeshSize(4.0))
    assert body.cavities == ("cavity_1", "cavity_2")
    assert list(body.volumes.values()) == pytest.approx([8.0, 8.0])


def test_a_text_file_reads_as_a_binary_one(tmp_path):
    points, triangles = cube((0, 0, 0), 2)
    rows = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x:.6e} {y:.6e} {z:.6e}\n" for x, y, z in points[triangle])
        + "endloop\nendfacet\n"
        for triangle in triangles
    )
    path = tmp_path / "text.stl"
    path.write_text(f"solid facets of a cube\n{rows}endsolid\n")
    assert volume(*read_stl([path])) == pytest.approx(8.0)
    path.write_text(f"solid cube\n{rows.replace('0.000000e+00', 'nil', 1)}endsolid\n")
    with pytest.raises(GeometryError, match="damaged vertex"):
        read_stl([path])


def test_holes_are_counted_and_said_where(tmp_path):
    keep = [i for i in range(12) if i not in (2, 3)]
    with pytest.raises(GeometryError, match=r"has a hole, about \(10, 5, 5\) \(4 open edges\)"):
        read_stl([write(tmp_path / "a.stl", cube((0, 0, 0), 10), keep=keep)])
    with pytest.raises(GeometryError, match=r"2 holes, about \(0, 3.333, 6.667\) \(3.*, \(10, 6.667, 3.333\) \(3 open"):
        read_stl([write(tmp_path / "b.stl", cube((0, 0, 0), 10), keep=[1, *range(3, 12)])])


def test_triangles_that_face_different_ways_are_refused(tmp_path):
    points, triangles = cube((0, 0, 0), 10)
    triangles = triangles.copy()
    triangles[4] = triangles[4][::-1]
    with pytest.raises(GeometryError, match=r"face different ways.*at 3 edges"):
        read_stl([write(tmp_path / "a.stl", (points, triangles))])


def test_surfaces_that_overlap_are_refused(tmp_path):
    with pytest.raises(GeometryError, match="two closed surfaces overlap, about"):
        read_stl([write(tmp_path / "a.stl", cube((0, 0, 0), 10), cube((5, 5, 5), 10))])


def test_a_file_without_triangles_is_refused(tmp_path):
    path = tmp_path / "a.stl"
    path.write_bytes(bytes(84))
    with pytest.raises(GeometryError, match="at least one triangle"):
        read_stl([path])
    path.write_bytes(stl_bytes(np.zeros((3, 3)), np.array([[0, 1, 2]]), "flat"))
    with pytest.raises(GeometryError, match="no triangle with an area"):
        read_stl([path])
