"""Free rigid bodies: moments, mass, rigidity and contact terms by closed forms and finite differences; bad input."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.spatial.transform import Rotation

from pneumorph.errors import InputError, MeshError, NameNotFoundError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Block,
    Clamp,
    Contact,
    Cylinder,
    Force,
    FreeBody,
    Gravity,
    HalfSpace,
    Model,
    Motion,
    Phase,
    Pipe,
    Prescribed,
    Programme,
    Roller,
    SurfaceFile,
)
from pneumorph.mechanics.contact import Contacts
from pneumorph.mechanics.contact.free_body import moments, with_frames
from pneumorph.mechanics.contact.part import Place
from pneumorph.mechanics.contact.rigidity import Rigidity
from pneumorph.mechanics.contact.widened import WidenedPattern
from pneumorph.mechanics.mass import Mass
from pneumorph.mesh import box, rectangle

RUBBER = NeoHookean(0.3, bulk=30.0, density=1.1e-9)
DRIVE = Motion("drive", (0.3, 0.2, -1.0))
SOLID = box(2, 2, 1, distortion=0.2)
BRICK = box(2, 1, 1, kind="hexahedron27")
PLANE = rectangle(3, 2)


def cube(name="cup", lower=(0.2, 0.1, -1.04), size=1.0, **mass):
    upper = tuple(x + size for x in lower)
    return FreeBody(name, Block(lower, upper), **(mass or {"mass": 2e-9}))


BAR = FreeBody("bar", Cylinder((-1, 0.5, -0.34), (2, 0.6, -0.34), 0.3, 24), density=1e-9)
FLAT = FreeBody("flat", Block((0.2, -1.04), (1.1, -0.04)), density=1e-9)
# mesh, free bodies, a contact, and where it acts: all bodies are about 1 mm wide
CASES = {
    "soft on a block": (SOLID, (cube(),), Contact("c", ("z0",), ("cup",), 0.7, reach=0.1)),
    "block on soft bricks": (BRICK, (cube(lower=(0.2, 0.1, 1.04)),), Contact("c", ("cup",), ("z1",), 0.7, reach=0.1)),
    "soft on a bar": (SOLID, (BAR,), Contact("c", ("z0",), ("bar",), 0.7, reach=0.1)),
    "soft on a rectangle": (PLANE, (FLAT,), Contact("c", ("bottom",), ("flat",), 0.7, reach=0.1)),
    "block on a half-space": (
        SOLID, (cube(),), Contact("c", ("cup",), HalfSpace((0, 0, -1.07), (0.02, 0, 1), motion=DRIVE), 0.7, reach=0.1),
    ),
    "block in a pipe": (SOLID, (cube(),), Contact("c", ("cup",), Pipe((0.7, 0.6, 0), 0.73, (0, 0, 1)), 0.7, reach=0.1)),
    "block on an obstacle": (
        SOLID, (cube(),), Contact("c", ("cup",), Block((-3, -4, -2), (3.3, 4, -1.08), motion=DRIVE), 0.7, reach=0.1),
    ),
    "block on another": (
        SOLID, (cube(), cube("other", (0.4, 0.3, -2.08))), Contact("c", ("cup",), ("other",), 0.7, reach=0.1),
    ),
    "block and soft on a plane": (
        SOLID, (cube(lower=(2.0, 0.1, 0.0)),), Contact("c", ("z0", "cup"), HalfSpace((0, 0, -0.03), (0, 0, 1)), 0.7,
                                                       reach=0.1),
    ),
}  # fmt: skip
ALL = pytest.mark.parametrize("case", CASES, ids=list(CASES))


def made(case):
    mesh, bodies, contact = CASES[case]
    mesh, frames = with_frames(mesh, bodies)
    return mesh, Contacts(mesh, (replace(contact, stiffness=0.3),), 0.3, frames)


def moved(mesh, size=0.01):
    return mesh.points + size * np.random.default_rng(3).uniform(-1, 1, mesh.points.shape)


def dense(entries, n):
    upper = sparse.coo_matrix((entries[2], entries[:2]), shape=(n, n)).toarray()
    return upper + np.triu(upper, 1).T


@ALL
@pytest.mark.parametrize("with_friction", [False, True], ids=["normal", "friction"])
def test_contact_forces_are_the_derivative_of_the_energy_and_the_tangent_theirs(case, with_friction):
    mesh, contacts = made(case)
    position, rubbing, ways = moved(mesh), None, np.array([0.001])
    if with_friction:  # on a short way from the start, so that some points stick
        start = mesh.points + 2e-4 * np.random.default_rng(5).uniform(-1, 1, mesh.points.shape)
        rubbing = contacts.rubbing(start, np.array([-1e-5]), 0.3, (position, np.zeros(1)))
        position = start + 2e-4 * np.random.default_rng(7).uniform(-1, 1, start.shape)

    def total(place, way=ways):
        return contacts.evaluate(place, way, rubbing, hessian=True)

    here = total(position)
    own = np.concatenate(list(mesh.frames.values()))
    bare = contacts.evaluate(position, ways, None, hessian=False).gradient if with_friction else 0.0
    assert np.abs((here.gradient - bare).reshape(mesh.points.shape)[own]).max() > 1e-6
    matrix, step = dense(here.entries, position.size), 1e-8
    rng = np.random.default_rng(1)
    for _ in range(4):
        way = rng.uniform(-1, 1, position.shape)
        ahead, back = total(position + step * way), total(position - step * way)
        slope = (ahead.energy - back.energy) / (2 * step)
        assert slope == pytest.approx(here.gradient @ way.ravel(), rel=1e-4, abs=1e-6 * np.abs(here.gradient).max())
        change = (ahead.gradient - back.gradient) / (2 * step)
        assert change == pytest.approx(matrix @ way.ravel(), rel=1e-3, abs=1e-4 * np.abs(change).max())
    if contacts.contacts[0].motion:
        ahead, back = total(position, ways + step), total(position, ways - step)
        change = (ahead.gradient - back.gradient) / (2 * step)
        assert np.abs(change).max() > 1e-3
        assert change == pytest.approx(here.coupling[:, 0], rel=1e-3, abs=1e-4 * np.abs(change).max())


@ALL
def test_pairs_that_couple_have_a_place_in_the_pattern_beforehand(case):
    mesh, contacts = made(case)
    clamp = (Clamp("top" if mesh.dimension == 2 else "x0"),)
    model = Model(mesh, {"body": RUBBER}, clamp, free_bodies=CASES[case][1], contacts=(CASES[case][2],))
    wide = WidenedPattern(model.body.pattern)
    entries = contacts.evaluate(moved(mesh), np.zeros(1), None, hessian=True).entries
    assert len(entries[0])
    wide.include(contacts.near(mesh.points, np.zeros(1)))
    assert len(wide.missing(entries)) == 0


@ALL
def test_forces_between_bodies_balance_and_steps_are_cut_before_they_collide(case):
    mesh, contacts = made(case)
    contact = contacts.contacts[0]
    position, way = moved(mesh), np.zeros(1)
    touch = contacts.touches(position, way, None)["c"]
    assert np.linalg.norm(touch.force) > 1e-3
    assert touch.force == pytest.approx(np.sum([touch.by_face[name] for name in contact.faces], axis=0))
    if contact.other_faces in (("cup",), ("bar",), ("flat",), ("other",)):
        assert touch.by_face[contact.other_faces[0]] == pytest.approx([-x for x in touch.force], abs=1e-12)
    assert touch.pressure > 0.0
    before = contacts.distance(mesh.points, way)
    towards = np.zeros_like(position)
    towards[contacts.vertices.nodes(contact.faces)] = 2.0 * np.array(touch.force) / -np.linalg.norm(touch.force)
    share = contacts.limit((mesh.points, way), (mesh.points + towards, way))
    assert 0.0 < share < 1.0
    assert 0.0 < contacts.distance(mesh.points + share * towards, way) < before


@pytest.mark.parametrize(
    ("surface", "volume", "centre", "spread"),
    [
        (Block((1, 2, 3), (3, 5, 9)), 36.0, (2, 3.5, 6), (4 / 12, 9 / 12, 36 / 12)),
        (Block((1, 2), (3, 5)), 6.0, (2, 3.5), (4 / 12, 9 / 12)),
        # a round bar of 512 flats: r2 / 4 across, l2 / 12 along
        (Cylinder((0, 0, 1), (0, 0, 7), 2.0, 512), 24 * np.pi, (0, 0, 4), (1, 1, 3)),
        (Cylinder((1, 1), (), 2.0, 512), 4 * np.pi, (1, 1), (1, 1)),
    ],
)
def test_volume_centre_and_second_moments_are_those_of_the_shape(surface, volume, centre, spread):
    got = moments(*surface.facets(len(centre)), "body")
    assert got[0] == pytest.approx(volume, rel=1e-4)
    assert got[1] == pytest.approx(np.array(centre), abs=1e-9)
    assert got[2] == pytest.approx(np.diag(spread), rel=1e-4, abs=1e-9)
    points, facets = surface.facets(len(centre))
    assert moments(points, facets[:, ::-1], "body")[0] == pytest.approx(got[0])  # wound the other way


@pytest.mark.parametrize("case", ["soft on a bar", "soft on a rectangle"])
def test_the_mass_matrix_is_exact_for_every_affine_motion(case):
    mesh, bodies, contact = CASES[case]
    model = Model(mesh, {"body": RUBBER}, (), free_bodies=bodies, contacts=(contact,))
    (frame,), d = model.frames, mesh.dimension
    volume, centre, spread = moments(*bodies[0].surface.facets(d), "body")
    assert frame.mass == pytest.approx(1e-9 * volume)
    assert frame.rest.mean(axis=0) == pytest.approx(centre)
    rng = np.random.default_rng(2)
    drift, turn = rng.normal(size=d), rng.normal(size=(d, d))  # v = drift + turn (x - c)
    velocity = np.zeros_like(model.mesh.points)
    velocity[frame.nodes] = drift + (frame.rest - centre) @ turn.T
    energy = 0.5 * frame.mass * (drift @ drift + np.trace(turn @ spread @ turn.T))
    mass = Mass(model)
    assert 0.5 * np.sum(velocity * mass.times(velocity)) == pytest.approx(energy, rel=1e-10)
    values = np.zeros(model.body.pattern.indptr[-1])  # and so is what goes into the tangent
    mass.add(2.0, values)
    pattern, n = model.body.pattern, model.body.unknowns
    upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(n, n))
    full = upper + sparse.triu(upper, 1).T
    assert velocity.ravel() @ full @ velocity.ravel() == pytest.approx(4.0 * energy, rel=1e-10)


@pytest.mark.parametrize("case", ["soft on a bar", "soft on a rectangle"])
def test_rigidity_resists_all_but_rigid_motion_with_forces_and_tangents_that_fit(case):
    mesh, bodies, _ = CASES[case]
    mesh, frames = with_frames(mesh, bodies)
    rigidity, d = Rigidity(frames, 7.0), mesh.dimension
    angles = (0.4, -0.3, 0.8) if d == 3 else (0, 0, 0.7)
    turned = mesh.points @ Rotation.from_rotvec(angles).as_matrix()[:d, :d].T + 3.0
    force = np.zeros(mesh.points.size)
    rigidity.add_force(turned, force)
    assert rigidity.energy(turned) < 1e-28
    assert np.abs(force).max() < 1e-13
    rng, step = np.random.default_rng(4), 1e-6
    place = turned + 0.1 * rng.uniform(-1, 1, turned.shape)

    def forces(at):
        result = np.zeros(at.size)
        rigidity.add_force(at, result)
        return result

    here = forces(place)
    assert np.abs(here).max() > 0.01
    assert here.reshape(-1, d).sum(axis=0) == pytest.approx(np.zeros(d), abs=1e-13)
    matrix = dense(rigidity.tangent(place, rigidity.stresses(place)), place.size)
    for _ in range(4):
        way = rng.uniform(-1, 1, place.shape)
        slope = (rigidity.energy(place + step * way) - rigidity.energy(place - step * way)) / (2 * step)
        assert slope == pytest.approx(here @ way.ravel(), rel=1e-6)
        change = (forces(place + step * way) - forces(place - step * way)) / (2 * step)
        assert change == pytest.approx(matrix @ way.ravel(), rel=1e-5, abs=1e-7)
        carried = rigidity.carried(place, step * way) - rigidity.stresses(place)
        true = rigidity.stresses(place + step * way) - rigidity.stresses(place)
        assert carried == pytest.approx(true, rel=1e-3, abs=1e-4 * np.abs(true).max())


def test_what_touches_nothing_soft_is_as_stiff_as_its_weight_asks_for():
    mesh, bodies, _ = CASES["block on another"]
    mesh, frames = with_frames(mesh, (*bodies, cube("light", (0.4, 0.3, -3.2), mass=1e-9)))
    plane = HalfSpace((0, 0, -9), (0, 0, 1))

    def stiffness(faces, against, **more):
        return Contacts(mesh, (Contact("c", faces, against, **more),), 0.3, frames).pairs[0].stiffness

    weight = 1e-9 * 9810.0  # on a side of 1 mm2, a sixth of all
    assert stiffness(("light",), plane) == pytest.approx(20 / 6 * weight)
    assert stiffness(("cup",), plane) == pytest.approx(40 / 6 * weight)
    assert stiffness(("cup",), ("light",)) == pytest.approx(20 / 6 * weight)
    assert stiffness(("z0",), ("light",)) == stiffness(("z0", "cup"), plane) == 0.3
    assert stiffness(("light",), plane, stiffness=0.1) == 0.1


def test_a_model_with_free_bodies_has_their_nodes_once_however_often_it_is_made():
    mesh, bodies, contact = CASES["block on another"]
    model = Model(mesh, {"body": RUBBER}, (Clamp("z1"),), free_bodies=bodies, contacts=(contact,))
    again = replace(model, loads=(Gravity((0, 0, -1)),))
    assert (again.mesh.points == model.mesh.points).all()
    assert len(model.mesh.points) == len(mesh.points) + 8
    assert model.mesh.size == mesh.size
    assert model.mesh.face_nodes("other").tolist() == list(range(len(mesh.points) + 4, len(mesh.points) + 8))


def test_weight_and_forces_act_at_the_centre_of_mass():
    mesh, bodies, contact = CASES["soft on a bar"]
    loads = Gravity((0, 0, -2)), Force("bar", (1, 0, 0), "pull")
    model = Model(mesh, {"body": RUBBER}, (Clamp("z1"),), loads, free_bodies=bodies, contacts=(contact,))
    frame = model.frames[0]
    arms = frame.rest - frame.rest.mean(axis=0)
    for name, wanted in (("gravity", (0, 0, -frame.mass)), ("pull", (1, 0, 0))):
        forces = model.load_patterns[name].reshape(-1, 3)[frame.nodes]
        assert forces.sum(axis=0) == pytest.approx(np.array(wanted))
        assert np.cross(arms, forces).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    soft = model.load_patterns["gravity"].reshape(-1, 3)[: len(mesh.points)]
    assert soft.sum(axis=0)[2] == pytest.approx(-1.1e-9, rel=1e-9)


def test_the_area_a_block_stands_on_is_that_of_its_base():
    mesh, frames = with_frames(SOLID, (cube(),))
    floor = Contact("c", ("cup",), HalfSpace((0, 0, -1.05), (0, 0, 1)), reach=0.1)
    touch = Contacts(mesh, (floor,), 0.3, frames).touches(mesh.points, np.zeros(1), None)["c"]
    assert touch.area == pytest.approx(1.0)
    assert touch.pressure == pytest.approx(touch.force[2], rel=0.35)  # corners bear thirds of one or two triangles
    leaning = HalfSpace((0.2, 0, -1.05), (0.3, 0, 1))  # meets it along one edge
    touch = Contacts(mesh, (Contact("c", ("cup",), leaning, reach=0.1),), 0.3, frames).touches(
        mesh.points, np.zeros(1), None
    )["c"]
    assert touch.force[2] > 0.0
    assert touch.area == 0.0
    assert 0.0 < touch.pressure < np.inf


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (
            lambda: FreeBody("cup", Block((0, 0, 0), (1, 1, 1))),
            "free body 'cup': mass = None, density = None: expected one",
        ),
        (lambda: cube(mass=1e-9, density=1e-9), "mass = 1e-09, density = 1e-09: expected one of the two"),
        (lambda: cube(mass=0.0), "mass = 0.0 tonne, allowed: more than 0"),
        (lambda: cube(density=-1.0), "density = -1.0 tonne/mm3, allowed: more than 0"),
        (
            lambda: FreeBody("cup", HalfSpace((0, 0, 0), (0, 0, 1)), mass=1.0),
            "surface of kind HalfSpace, allowed: Block, ",
        ),
        (
            lambda: FreeBody("cup", Block((0, 0, 0), (1, 1, 1), motion=DRIVE), mass=1.0),
            "leave the motion of its surface out",
        ),
    ],
)
def test_wrong_free_bodies_are_refused(wrong, says):
    with pytest.raises(InputError, match=says):
        wrong()


def held(*bodies, contacts=None, mesh=SOLID, supports=None, **more):
    contacts = contacts or tuple(Contact(f"c {b.name}", ("z0",), (b.name,), reach=0.01) for b in bodies)
    supports = (Clamp("z1"),) if supports is None else supports
    return Model(mesh, {"body": RUBBER}, supports, free_bodies=bodies, contacts=contacts, **more)


@pytest.mark.parametrize(
    ("make", "error", "says"),
    [
        (
            lambda: held(cube(lower=(0.2, 0.1, -0.9))),
            InputError,
            r"contact 'c cup': z0 and cup intersect at \(.*\) mm; the smallest shift .* is 0.1 mm along \(0, 0, 1\)",
        ),
        (lambda: held(cube(lower=(0.3, 0.3, 0.3), size=0.2)), InputError, "cup lies inside the body with z0, at"),
        (lambda: held(cube(lower=(-1, -1, -1), size=4)), InputError, "the body with z0 lies inside cup, at"),
        (
            lambda: held(cube(), contacts=(Contact("c", ("cup",), HalfSpace((0, 0, -0.5), (0, 0, 1))),)),
            InputError,
            r"cup and HalfSpace intersect at \(.*\) mm; move them apart by 0.54\d* mm along \(0, 0, 1\)",
        ),
        (
            lambda: held(cube(), contacts=(Contact("c", ("cup",), Block((0, 0, -2), (1, 1, -0.9))),)),
            InputError,
            "contact 'c': cup and Block intersect at",
        ),
        (
            lambda: held(cube(), cube("other", (0.3, 0.2, -1.5)), contacts=(Contact("c", ("cup",), ("other",)),)),
            InputError,
            "contact 'c': cup and other intersect",
        ),
        (
            lambda: held(cube(), contacts=(Contact("c", ("z0",), HalfSpace((0, 0, -1), (0, 0, 1))),)),
            InputError,
            "free body 'cup': no contact has it among its faces",
        ),
        (
            lambda: held(cube(), contacts=(Contact("c", ("z0", "cup")),)),
            InputError,
            "a free body does not touch itself",
        ),
        (
            lambda: held(cube("z0"), contacts=(Contact("c", ("z0",), ("x1",)),)),
            InputError,
            "free body 'z0': the name is that of a face, or of another body",
        ),
        (lambda: held(cube(), cube()), InputError, "free body 'cup': the name is that of a face, or of another body"),
        (
            lambda: held(cube(), contacts=(Contact("c", ("z0",), ("cap",)),)),
            NameNotFoundError,
            "'cap': did you mean 'cup'",
        ),
        (
            lambda: held(
                cube(),
                contacts=(
                    Contact("c", ("z0",), ("cup",)),
                    Contact("d", ("z0",), HalfSpace((0, 0, -2), (0, 0, 1)), body="cup"),
                ),
            ),
            InputError,
            "contact 'd': 'cup' is a free body; name it among faces",
        ),
        (
            lambda: held(FLAT, mesh=rectangle(2, 2, space="axisymmetric"), supports=()),
            InputError,
            "free body 'flat': a model with axial symmetry takes none",
        ),
        (
            lambda: replace(SOLID, frames={"cup": np.array([0, 1, 2, 3])}),
            MeshError,
            "expected their nodes to be the last ones",
        ),
    ],
)
def test_models_that_do_not_fit_their_free_bodies_are_refused(make, error, says):
    with pytest.raises(error, match=says):
        make()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda points, facets: (points, facets[1:]), r"its surface is not closed.*open edges, one at \(.*\) mm"),
        (lambda points, facets: (points, np.vstack([facets[:1, ::-1], facets[1:]])), "wound the same way"),
        (lambda points, facets: (points * (1, 1, 0), facets), "its surface encloses no volume"),
        (lambda points, facets: (points * (1, 1, 1e-7), facets), "encloses a body without thickness"),
    ],
    ids=["open", "one triangle turned", "flat", "thin"],
)
def test_surfaces_that_bound_no_body_are_refused(tmp_path, change, says):
    import meshio

    points, facets = change(*Block((0, 0, -2), (1, 1, -1)).facets(3))
    meshio.write_points_cells(tmp_path / "cup.vtk", points, [("triangle", facets)])
    with pytest.raises(InputError, match=f"free body 'cup': .*{says}"):
        held(FreeBody("cup", SurfaceFile(str(tmp_path / "cup.vtk")), mass=1e-9))


def test_an_open_outline_is_refused():
    points, edges = Block((0, 0), (1, 1)).facets(2)
    with pytest.raises(InputError, match=r"body: its surface is not closed"):
        moments(points, edges[1:], "body")


def test_a_phase_in_which_nothing_holds_a_free_body_is_refused():
    model = held(cube(), loads=(Gravity((0, 0, -1)),))
    still = Programme((Phase("weigh", {"gravity": 9810.0}, duration=1.0),))
    with pytest.raises(InputError, match="phase 'weigh': nothing holds the free body 'cup' without inertia"):
        still.check(model)
    Programme((Phase("weigh", {"gravity": 9810.0}, duration=1.0, inertia="moderate"),)).check(model)
    carried = Clamp("z1"), Roller("cup", "x"), Roller("cup", "y"), Prescribed("cup", "z", "lift")
    model = held(cube(), supports=carried)
    Programme((Phase("lift", {"lift": 1.0}),)).check(model)


def test_only_the_motion_of_bodies_of_the_model_can_be_asked_for():
    from pneumorph.mechanics.state import rest

    state = rest(held(cube()))
    assert state.body_motion("cup").centre == pytest.approx([0.7, 0.6, -0.54])
    with pytest.raises(NameNotFoundError, match="'cap': did you mean 'cup'"):
        state.body_motion("cap")
    turned, d = state.model.mesh.points.copy(), Rotation.from_rotvec((0.1, -0.5, 0.3))
    own = state.model.mesh.frames["cup"]
    centre = turned[own].mean(axis=0)
    way, drift = np.array((1.0, 2.0, 3.0)), np.array((7.0, 8.0, 9.0))
    turned[own] = centre + d.apply(turned[own] - centre) + way
    velocity = np.zeros_like(turned)
    velocity[own] = np.cross((4, 5, 6), turned[own] - centre - way) + drift
    motion = replace(state, displacement=turned - state.model.mesh.points, velocity=velocity).body_motion("cup")
    assert motion.rotation == pytest.approx([0.1, -0.5, 0.3])
    assert motion.centre == pytest.approx(centre + way)
    assert motion.velocity == pytest.approx(drift)
    assert motion.spin == pytest.approx([4, 5, 6])
    assert motion.strain < 1e-12


def test_distances_to_a_body_follow_its_frame():
    mesh, contacts = made("soft on a block")
    place = mesh.points.copy()
    place[mesh.frames["cup"]] += (0, 0, 0.01)
    pair = contacts.pairs[0]
    assert pair.distance(Place(mesh.points)) == pytest.approx(0.04)
    assert pair.distance(Place(place)) == pytest.approx(0.03)
