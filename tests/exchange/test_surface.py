"""STL and STEP of deformed bodies: they close, and hold the volume of the body."""

import re
from dataclasses import replace

import meshio
import numpy as np
import pytest
from netgen.occ import OCCGeometry

from pneumorph.errors import InputError, MeshError, StorageError
from pneumorph.exchange import surface as surfaces
from pneumorph.exchange import surface_of, write_bodies, write_step, write_stl
from pneumorph.exchange.step import step_text
from pneumorph.exchange.surface import Surface
from pneumorph.geometry import ThickSphere
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Block, Cavity, Clamp, Contact, FreeBody, HalfSpace, Model, Motion, Symmetry
from pneumorph.mechanics.body import cell_volumes
from pneumorph.mechanics.fields import deformation_gradient
from pneumorph.mechanics.state import rest
from pneumorph.mechanics.tables import cell_table
from pneumorph.mesh import CellBlock, FaceBlock, Mesh, box, generate, rectangle

SHEAR = np.array([[1.2, 0.1, 0.0], [0.0, 0.9, 0.2], [0.0, 0.0, 1.0]])
RUBBER = {"body": NeoHookean(0.1)}


def block(kind="tetra10"):
    return Model(box(2, 2, 2, kind=kind, lengths=(4.0, 1.0, 1.0)), RUBBER, (Clamp("x0"),))


@pytest.fixture(scope="module")
def ball():
    """A whole sphere with its cavity."""
    mesh = generate(ThickSphere(), coarse=True)
    return Model(mesh, RUBBER, (Clamp("outer"),), cavities=(Cavity("cavity", ("cavity",)),))


def moved(model, positions):
    """Return the state at rest with other positions."""
    state = rest(model)
    object.__setattr__(state, "displacement", positions - model.mesh.points)
    return state


def bulged(points):
    """Blow a sphere up unevenly: every node moves, nothing stays straight."""
    radius = np.linalg.norm(points, axis=1, keepdims=True)
    return points * (1.0 + 4.0 / radius) + 0.02 * points[:, [1, 2, 0]] ** 2


def body_volume(model, positions):
    """Return the deformed volume of the cells: the integral of det F."""
    total = 0.0
    for block in model.mesh.blocks:
        table = cell_table(block.kind)
        gradient = deformation_gradient(model.mesh, block, positions, table.shape, table.gradient)
        total += float((np.linalg.det(gradient) * cell_volumes(model.mesh, block)).sum())
    return total


def edges_are_shared_twice(corners):
    """Whether every edge of triangles (k, 3, 3), found by its coordinates alone, is passed once in each direction."""
    _, nodes = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    nodes = nodes.reshape(-1, 3)
    ways = [tuple(pair) for pair in np.concatenate([nodes[:, [0, 1]], nodes[:, [1, 2]], nodes[:, [2, 0]]]).tolist()]
    return len(set(ways)) == len(ways) and set(ways) == {(b, a) for a, b in ways}


def read_stl(path):
    table = np.frombuffer(path.read_bytes()[84:], dtype=[("v", "<f4", (4, 3)), ("a", "<u2")])["v"]
    return table[:, 1:].astype(float)


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_surface_of_a_sheared_block_holds_its_volume_exactly(kind):
    model = block(kind)
    surface = surface_of(model, model.mesh.points @ SHEAR.T)
    assert surface.volume == pytest.approx(4.0 * np.linalg.det(SHEAR), rel=1e-12)
    assert edges_are_shared_twice(surface.points[surface.triangles])


@pytest.mark.parametrize("part", ["whole", "outer"])
def test_stl_of_a_deformed_ball_is_watertight_and_holds_its_volume(ball, tmp_path, part):
    positions = bulged(ball.mesh.points)
    written = write_stl(tmp_path / "ball.stl", ball, moved(ball, positions), part=part)
    corners = read_stl(written.path)
    assert edges_are_shared_twice(corners)
    assert written.counts == {"triangles": len(corners)}
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    exact = body_volume(ball, positions)
    if part == "outer":
        exact += ball.surfaces["cavity"].volume(positions)
    # flat triangles cut off a little of each curved face
    assert volume == pytest.approx(exact, rel=0.01)


def test_undeformed_ball_is_that_of_the_mesh(ball, tmp_path):
    corners = read_stl(write_stl(tmp_path / "ball.stl", ball).path)
    assert np.linalg.norm(corners, axis=-1).max() == pytest.approx(15.0, abs=1e-4)


def hollow():
    """A cube of 3 mm without the cube of 1 mm in its middle."""
    full = box(3, 3, 3, lengths=(3.0, 3.0, 3.0))
    cells = full.blocks[0].nodes
    inside = (np.abs(full.points[cells[:, :4]].mean(axis=1) - 1.5) < 0.5).all(axis=1)
    used, numbers = np.unique(cells[~inside], return_inverse=True)
    block = CellBlock("tetra10", "body", numbers.reshape(-1, 10))
    faces = {"x0": (FaceBlock("triangle6", np.searchsorted(used, full.faces["x0"][0].nodes)),)}
    return Model(Mesh(full.points[used], (block,), faces), RUBBER, (Clamp("x0"),))


def test_step_of_a_deformed_hollow_body_is_one_solid_with_its_void(tmp_path):
    model = hollow()
    state = moved(model, model.mesh.points @ SHEAR.T)
    written = write_step(tmp_path / "hollow.step", model, state, title="Body's 'cavity' \\ ü")
    shape = OCCGeometry(str(written.path)).shape
    assert len(shape.solids) == 1
    assert shape.mass == pytest.approx(26.0 * np.linalg.det(SHEAR), rel=1e-9)
    text = written.path.read_text(encoding="ascii")
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    assert len(re.findall("=ADVANCED_FACE", text)) == written.counts["plane faces"] == 4 * 2 * (6 * 9 + 6)
    assert "no CAD surfaces" in written.notes[0]


def test_a_surface_that_a_cavity_reaches_has_no_outer_part():
    sphere = ThickSphere(octant=True)
    planes = tuple(name for name in sphere.face_names if name.startswith("symmetry"))
    supports = tuple(Symmetry(name) for name in planes)
    model = Model(generate(sphere, coarse=True), RUBBER, supports, (), (Cavity("c", ("cavity",), mirrors=planes),))
    assert surface_of(model).volume > 0.0
    with pytest.raises(InputError, match=r"outer surface is open: \d+ free edges, one at .*; take 'whole'"):
        surface_of(model, part="outer")


def test_unknown_part_plane_model_and_unknown_faces_are_refused(monkeypatch):
    with pytest.raises(InputError, match=r"unknown part of a surface 'hole'.*Allowed: outer, whole"):
        surface_of(block(), part="hole")
    flat = Model(rectangle(1, 1), RUBBER, (Clamp("left"),))
    with pytest.raises(InputError, match="a plane_strain model has no surface in space"):
        surface_of(flat)
    monkeypatch.delitem(surfaces._CUTS, "quad9")
    with pytest.raises(MeshError, match="quad9 faces cannot be cut into triangles: known are triangle6"):
        surface_of(block("wedge18"))


def test_step_files_of_too_many_faces_two_bodies_or_flat_triangles_are_refused(monkeypatch):
    surface = surface_of(block())
    two = Surface(
        np.vstack([surface.points, surface.points + 9.0]),
        np.vstack([surface.triangles, surface.triangles + len(surface.points)]),
    )
    with pytest.raises(InputError, match="2 separate bodies: expected one"):
        step_text(two, "two", "0")
    flat = surface.points.copy()
    flat[surface.triangles[0]] = flat[surface.triangles[0, 0]]
    with pytest.raises(InputError, match=r"triangles of the surface have no area"):
        step_text(Surface(flat, surface.triangles), "flat", "0")
    monkeypatch.setattr("pneumorph.exchange.step.MOST_FACES", 10)
    with pytest.raises(InputError, match="plane faces: allowed are 10; write an STL file"):
        step_text(surface, "many", "0")


def test_a_place_that_cannot_be_written_is_refused(tmp_path):
    with pytest.raises(StorageError, match=r"cannot write \(there is no folder"):
        write_stl(tmp_path / "nowhere" / "block.stl", block())
    with pytest.raises(StorageError, match=r"cannot write \(is a folder\)"):
        write_stl(tmp_path, block())


def test_rigid_bodies_are_written_where_a_state_has_them(tmp_path):
    stamp = Block((0.0, 0.0, 1.1), (1.0, 1.0, 2.0), motion=Motion("stamp", (0.0, 0.0, -1.0)))
    floor = HalfSpace((0.0, 0.0, -0.5), (0.0, 0.0, 1.0))
    contacts = Contact("top", ("z1",), stamp, body="stamp"), Contact("foot", ("z0",), floor, reach=0.01)
    model = Model(box(1, 1, 1), {"body": NeoHookean(0.1)}, (Clamp("z0"),), contacts=contacts)
    written = write_bodies(tmp_path / "bodies.stl", model, replace(rest(model), values={"stamp": 0.5}))
    assert written.counts == {"bodies": 2, "triangles": 14}
    points = meshio.read(tmp_path / "bodies.stl").points
    assert np.unique(points[:, 2].round(6)) == pytest.approx([-0.5, 0.6, 1.5])
    free = FreeBody("brick", Block((3.0, 0.0, 0.0), (4.0, 1.0, 1.0)), mass=1e-6)
    model = replace(model, free_bodies=(free,), contacts=(Contact("side", ("x1",), ("brick",)),))
    moved = np.zeros_like(model.mesh.points)
    moved[model.mesh.frames["brick"]] = (0.0, 0.0, 5.0)
    written = write_bodies(tmp_path / "free.stl", model, replace(rest(model), displacement=moved))
    assert written.counts == {"bodies": 1, "triangles": 12}
    assert np.unique(meshio.read(tmp_path / "free.stl").points[:, 2]) == pytest.approx([5.0, 6.0])
    with pytest.raises(InputError, match="no rigid bodies: the model is 3d, with 0 of them"):
        write_bodies(tmp_path / "none.stl", replace(model, free_bodies=(), contacts=()))
