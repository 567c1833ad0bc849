"""Terms of contact and friction: derivatives by finite differences, resultants, step limits, pattern; no solving."""

import numpy as np
import pytest
import scipy.sparse as sparse

from pneumorph.mechanics.contact import Block, Contact, Contacts, Cylinder, HalfSpace, Motion, Pipe
from pneumorph.mechanics.contact.barrier import barrier, friction
from pneumorph.mechanics.contact.facets import force_points, nodal_areas, split
from pneumorph.mechanics.contact.widened import WidenedPattern
from pneumorph.mechanics.pattern import Pattern
from pneumorph.mesh import Mesh, box, rectangle
from pneumorph.mesh.topology import boundary

DRIVE = Motion("drive", (0.3, 0.2, -1.0))
PLANE_DRIVE = Motion("drive", (0.3, -1.0))


def two(first, second, shift):
    """Return one mesh of two bodies; faces of the second get a prime."""
    offset = len(first.points)
    blocks = [*first.blocks, *(type(b)(b.kind, b.domain, b.nodes + offset) for b in second.blocks)]
    faces = dict(first.faces)
    for name, items in second.faces.items():
        faces[name + "'"] = tuple(type(b)(b.kind, b.nodes + offset) for b in items)
    return Mesh(np.concatenate([first.points, second.points + shift]), tuple(blocks), faces, first.space)


SOLID = box(2, 2, 1, distortion=0.2)
BRICK = box(2, 1, 1, kind="hexahedron27")
PLANE = rectangle(3, 2)
RING = rectangle(3, 2, space="axisymmetric")
# mesh, contact, a place where it acts: all bodies are 1 mm wide
CASES = {
    "half-space": (SOLID, Contact("c", ("z0",), HalfSpace((0, 0, -0.03), (0.1, 0, 1), motion=DRIVE), 0.7, reach=0.1)),
    "half-space, bricks": (BRICK, Contact("c", ("z0",), HalfSpace((0, 0, -0.05), (0, 0, 1)), 0.7, reach=0.1)),
    "half-plane": (PLANE, Contact("c", ("bottom",), HalfSpace((0, -0.04), (0, 1), motion=PLANE_DRIVE), 0.7, reach=0.1)),
    "half-plane about an axis": (RING, Contact("c", ("bottom",), HalfSpace((0, -0.04), (0, 1)), 0.7, reach=0.1)),
    "pipe": (SOLID, Contact("c", ("x0", "x1"), Pipe((0.5, 0.5, 0), 0.73, (0, 0, 1)), 0.7, reach=0.1)),
    "hole": (PLANE, Contact("c", ("left", "right"), Pipe((0.5, 0.5), 0.74), 0.7, reach=0.1)),
    "block": (SOLID, Contact("c", ("z0",), Block((-3, -4, -2), (3.3, 4, -0.04), motion=DRIVE), 0.7, reach=0.1)),
    "bar": (SOLID, Contact("c", ("z0",), Cylinder((-1, 0.5, -0.34), (2, 0.6, -0.34), 0.3, 24), 0.7, reach=0.1)),
    "rectangle": (PLANE, Contact("c", ("bottom",), Block((-3, -4), (3.3, -0.04), motion=PLANE_DRIVE), 0.7, reach=0.1)),
    "disc": (PLANE, Contact("c", ("bottom",), Cylinder((0.4, -0.35), (), 0.3, 32), 0.7, reach=0.1)),
    "bodies": (two(SOLID, BRICK, (0.2, 0.1, -1.04)), Contact("c", ("z0",), ("z1'",), 0.7, reach=0.1)),
    "plane bodies": (two(PLANE, PLANE, (0.2, -1.04)), Contact("c", ("bottom",), ("top'",), 0.7, reach=0.1)),
}
ALL = pytest.mark.parametrize("case", CASES, ids=list(CASES))


def made(case):
    mesh, contact = CASES[case]
    return mesh, Contacts(mesh, (contact,), 0.3)


def moved(mesh, size=0.01):
    rng = np.random.default_rng(3)
    return mesh.points + size * rng.uniform(-1, 1, mesh.points.shape)


def terms(contacts, mesh, position, way, rubbing):
    return contacts.evaluate(position, np.array([way]), rubbing, hessian=True)


def push(contacts, position, way, rubbing):
    """Return the force along its direction that moves the obstacle."""
    along = contacts.pairs[0].along
    return sum(part.push @ along for part in contacts._parts(0, position, np.array([way]), rubbing, False, True))


def rubbed(contacts, mesh):
    """Return friction that began a little elsewhere: partly sticking, partly slipping."""
    start = mesh.points + 2e-4 * np.random.default_rng(5).uniform(-1, 1, mesh.points.shape)
    return contacts.rubbing(start, np.array([-1e-5]), 0.3, (moved(mesh), np.zeros(1)))


@ALL
@pytest.mark.parametrize("with_friction", [False, True], ids=["normal", "friction"])
def test_forces_are_the_derivative_of_the_energy_and_the_tangent_theirs(case, with_friction):
    mesh, contacts = made(case)
    position = moved(mesh)
    rubbing = rubbed(contacts, mesh) if with_friction else None
    if with_friction:  # a short way from the start, so that some points stick
        position = position * 0.0 + rubbing.start + 2e-4 * np.random.default_rng(7).uniform(-1, 1, position.shape)
    here = terms(contacts, mesh, position, 0.001, rubbing)
    without = terms(contacts, mesh, position, 0.001, None)
    if with_friction:
        gradient = here.gradient - without.gradient
        assert np.abs(gradient).max() > 1e-6
    assert np.abs(here.gradient).max() > 1e-4
    n = position.size
    matrix = sparse.coo_matrix((here.entries[2], here.entries[:2]), shape=(n, n)).toarray()
    matrix = matrix + np.triu(matrix, 1).T
    step = 1e-8
    rng = np.random.default_rng(1)
    for _ in range(6):
        way = rng.uniform(-1, 1, position.shape)
        ahead = terms(contacts, mesh, position + step * way, 0.001, rubbing)
        back = terms(contacts, mesh, position - step * way, 0.001, rubbing)
        slope = (ahead.energy - back.energy) / (2 * step)
        assert slope == pytest.approx(here.gradient @ way.ravel(), rel=1e-4, abs=1e-6 * np.abs(here.gradient).max())
        change = (ahead.gradient - back.gradient) / (2 * step)
        assert change == pytest.approx(matrix @ way.ravel(), rel=1e-3, abs=1e-4 * np.abs(change).max())
    if CASES[case][1].motion:
        ahead = terms(contacts, mesh, position, 0.001 + step, rubbing)
        back = terms(contacts, mesh, position, 0.001 - step, rubbing)
        slope = (ahead.energy - back.energy) / (2 * step)
        assert slope == pytest.approx(push(contacts, position, 0.001, rubbing), rel=1e-4)
        change = (ahead.gradient - back.gradient) / (2 * step)
        assert change == pytest.approx(here.coupling[:, 0], rel=1e-3, abs=1e-4 * np.abs(change).max())


@ALL
def test_a_step_is_cut_before_anything_collides_and_keeps_a_part_of_the_distance(case):
    mesh, contacts = made(case)
    position, ways = mesh.points, np.zeros(1)
    before = contacts.distance(position, ways)
    assert 0.0 < before < 0.1
    towards = np.zeros_like(position)
    first = np.unique(np.concatenate([b.nodes.ravel() for f in CASES[case][1].faces for b in mesh.face_blocks(f)]))
    body = np.arange(len(position)) < len(position) if "bodies" not in case else np.arange(len(position)) <= first.max()
    if case in ("pipe", "hole"):
        towards[:, :2] = position[:, :2] - 0.5
    else:
        towards[body, -1] = -1.0
    share = contacts.limit((position, ways), (position + towards, ways))
    assert 0.0 < share < 1.0
    after = contacts.distance(position + share * towards, ways)
    assert 0.25 * before < after < before
    assert contacts.limit((position, ways), (position - 0.01 * towards, ways)) == 1.0


def test_the_barrier_is_that_of_ipctk():
    import ipctk

    gap = np.array([0.011, 0.05, 0.09])
    potential = ipctk.BarrierPotential(0.1, 0.3, True)
    value, first, _ = barrier(gap, 0.1, 0.3)
    # ipctk's force is that by the distance
    assert -first == pytest.approx([potential.force_magnitude(d * d, 0.0) for d in gap], rel=1e-12)
    assert barrier(np.array([0.1, 0.2]), 0.1, 0.3) == (pytest.approx(0.0), pytest.approx(0.0), pytest.approx(0.0))
    assert -barrier(np.array([0.78, 0.522, 0.24]), 1.0, 1.0)[1] == pytest.approx([1.0, 4.0, 10.0], rel=0.005)


def test_friction_rises_to_its_limit_and_is_the_derivative_of_its_integral():
    slip = np.array([1e-6, 0.3, 0.9, 1.1, 5.0])
    step = 1e-7
    integral, over, slope = friction(slip, 1.0)
    force = (friction(slip + step, 1.0)[0] - friction(slip - step, 1.0)[0]) / (2 * step)
    assert force == pytest.approx(over * slip, rel=1e-6, abs=1e-8)
    change = [(f * s) for f, s in ((friction(slip + e, 1.0)[1], slip + e) for e in (step, -step))]
    assert (change[0] - change[1]) / (2 * step) == pytest.approx(slope, rel=1e-5, abs=1e-6)
    assert (over * slip)[3:] == pytest.approx(1.0)


@pytest.mark.parametrize(
    "mesh", [SOLID, BRICK, box(1, 1, 1, kind="wedge18"), PLANE], ids=["t6", "quad9", "both", "line3"]
)
def test_a_uniform_pressure_on_the_force_points_gives_the_forces_of_the_finite_elements(mesh):
    from pneumorph.mechanics.loads import Traction

    name = "z1" if mesh.dimension == 3 else "top"
    normal = (0, 0, 1) if mesh.dimension == 3 else (0, 1)
    expected = Traction(name, normal, "t").pattern(mesh, {}).reshape(-1, mesh.dimension)[:, -1]
    forces = np.zeros(len(mesh.points))
    for group in force_points(mesh, mesh.face_blocks(name)):
        np.add.at(forces, group.nodes, group.weight[:, None] * group.share)
    assert forces == pytest.approx(expected, abs=1e-14)
    areas = nodal_areas(mesh, mesh.face_blocks(name))
    assert areas.sum() == pytest.approx(1.0)
    assert (areas[mesh.face_nodes(name)] > 0.0).all()


@pytest.mark.parametrize("mesh", [box(2, 1, 1), BRICK, box(1, 1, 1, kind="wedge18")], ids=["tets", "bricks", "wedges"])
def test_split_faces_cover_the_surface_and_keep_their_side(mesh):
    corners = mesh.points[split(boundary(mesh.blocks))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    assert np.linalg.norm(normals, axis=1).sum() == pytest.approx(6.0)
    assert np.einsum("mi,mi->", normals, corners.mean(axis=1)) / 3.0 == pytest.approx(1.0)  # the volume, by Gauss


@pytest.mark.parametrize("case", ["half-space", "block", "bodies", "plane bodies", "rectangle"])
def test_action_equals_reaction(case):
    mesh, contacts = made(case)
    rubbing = rubbed(contacts, mesh)
    parts = contacts._parts(0, moved(mesh), np.zeros(1), rubbing, False, True)
    for part in parts:
        total = part.gradient.reshape(-1, mesh.dimension).sum(axis=0) + part.push
        assert total == pytest.approx(np.zeros(mesh.dimension), abs=1e-12)
    touches = contacts.touches(moved(mesh), np.zeros(1), rubbing)
    touch = touches["c"]
    assert contacts.drives(touches)[0] == pytest.approx(push(contacts, moved(mesh), 0.0, rubbing))
    assert touch.force[-1] > 0.0
    assert 0.0 < touch.area <= 1.01
    assert touch.distance == contacts.distance(moved(mesh), np.zeros(1))


def test_a_slot_touches_itself_but_neighbours_on_its_surface_do_not():
    def bent(points):  # a strip bent to an open ring, its ends 0.05 rad apart
        angle = (2 * np.pi - 0.05) * points[:, 0] / 20.0
        radius = 3.0 - points[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    mesh = rectangle(60, 2, bent, width=20.0, height=0.4)
    contacts = Contacts(mesh, (Contact("c", ("left", "right", "top", "bottom"), reach=0.1),), 0.3)
    total = contacts.evaluate(mesh.points, np.zeros(1), None, hessian=False)
    assert total.energy == 0.0  # nothing touches at rest, although facets are 0.17 long
    turned = mesh.points.copy()
    turn = np.array([[np.cos(0.035), -np.sin(0.035)], [np.sin(0.035), np.cos(0.035)]])
    end = mesh.face_nodes("left")
    assert contacts.limit((turned, np.zeros(1)), (_turn(turned, end, turn.T @ turn.T), np.zeros(1))) < 1.0
    closer = _turn(turned, end, turn.T)
    total = contacts.evaluate(closer, np.zeros(1), None, hessian=False)
    assert total.energy > 0.0
    assert total.gradient.reshape(-1, 2).sum(axis=0) == pytest.approx(np.zeros(2), abs=1e-12)


def _turn(points, nodes, matrix):
    result = points.copy()
    result[nodes] = points[nodes] @ matrix.T
    return result


def test_a_widened_pattern_keeps_the_old_values_and_finds_new_pairs():
    base = Pattern.of_cells(6, 2, [np.array([[0, 1, 2], [2, 4, 5]]), np.array([[3]])])
    wide = WidenedPattern(base)
    values = np.arange(1.0, base.indptr[-1] + 1)
    rows, columns = np.array([0, 1, 3, 6, 3]), np.array([7, 2, 10, 7, 3])
    entries = rows, columns, np.array([5.0, 7.0, 11.0, 13.0, 17.0])
    missing = wide.missing(entries)
    assert missing.tolist() == [[0, 3], [1, 5]]
    assert wide.include(missing)
    assert not wide.include(missing)
    assert len(wide.missing(entries)) == 0
    result = wide.widen(values)
    wide.add(entries, result)
    matrix = sparse.csr_matrix((result, wide.pattern.indices, wide.pattern.indptr), shape=(12, 12)).toarray()
    expected = sparse.csr_matrix((values, base.indices, base.indptr), shape=(12, 12)).toarray()
    np.add.at(expected, (rows, columns), entries[2])
    assert (matrix == expected).all()
