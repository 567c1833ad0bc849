"""Contact in a solve: patches, Hertz, weight, the sliding block, self-contact, moved obstacles, resuming, bad input."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError, NotConvergedError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Block,
    Cavity,
    Clamp,
    Contact,
    Cylinder,
    Gravity,
    HalfSpace,
    Model,
    Motion,
    Phase,
    Pipe,
    Prescribed,
    Programme,
    Roller,
    Settings,
    SurfaceFile,
    Symmetry,
    march,
)  # fmt: skip
from pneumorph.mechanics.fields import fields
from pneumorph.mesh import Mesh, box, rectangle
from pneumorph.solution import solve

RUBBER = NeoHookean(0.3, bulk=30.0, density=1.1e-9)
G = 9810.0
DOWN = Motion("press", (0, 0, -1))
PLANE_DOWN = Motion("press", (0, -1))


def two(first, second, shift):
    """Return one mesh of two bodies; faces of the second get a prime."""
    offset = len(first.points)
    blocks = [*first.blocks, *(replace(b, nodes=b.nodes + offset) for b in second.blocks)]
    faces = {name + "'": tuple(replace(b, nodes=b.nodes + offset) for b in f) for name, f in second.faces.items()}
    return Mesh(
        np.concatenate([first.points, second.points + shift]), tuple(blocks), {**first.faces, **faces}, first.space
    )


def axial_stress(state):
    """Return the Cauchy stress along the last axis at all integration points, MPa."""
    axis = state.model.mesh.dimension - 1
    return np.concatenate([part.stress.reshape(-1, 3, 3)[:, axis, axis] for part in fields(state)])


def pressed(mesh, bottom, obstacle, *, reach=0.01, supports=()):
    contact = Contact("plate", ("z1",) if mesh.dimension == 3 else ("top",), obstacle, reach=reach)
    model = Model(
        mesh, {"body": RUBBER}, (Roller(bottom, "z" if mesh.dimension == 3 else "y"), *supports), contacts=(contact,)
    )
    return list(march(model, Programme((Phase("press", {"press": 0.1}, first=0.2, largest=0.25),))))


SIDES = (Symmetry("x0"), Symmetry("y0"))


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron27", "wedge18"])
def test_a_block_under_a_smooth_plate_has_one_uniform_stress(kind):
    plate = HalfSpace((0, 0, 1.01), (0, 0, -1), motion=DOWN)
    *_, last = pressed(box(2, 2, 2, kind=kind, distortion=0.2), "z0", plate, supports=SIDES)
    stress = axial_stress(last)
    assert stress == pytest.approx(np.full_like(stress, stress[0]), rel=1e-6)
    touch = last.touches["plate"]
    # incompressible: the area grows as the height shrinks; the material is nearly so
    assert touch.force[2] == pytest.approx(stress[0] / (1 - last.displacement[:, 2].min() * -1), rel=0.01)
    assert touch.area == pytest.approx(1.0 / (1.0 + last.displacement[:, 2].min()), rel=1e-3)
    assert touch.pressure == pytest.approx(-touch.force[2] / touch.area, rel=1e-6)
    assert touch.pressure == pytest.approx(-stress[0], rel=1e-3)
    assert last.reactions.reshape(-1, 3).sum(axis=0) == pytest.approx(-np.array(touch.force), abs=1e-8)


@pytest.mark.parametrize(
    ("mesh", "bottom", "obstacle", "supports"),
    [
        (box(2, 2, 1), "z0", Block((-5, -4, 1.009), (6, 4.3, 3), motion=DOWN), SIDES),
        (rectangle(3, 2), "bottom", Block((-5, 1.009), (6, 3), motion=PLANE_DOWN), (Symmetry("left"),)),
    ],
    ids=["solid", "plane"],
)
def test_a_rigid_block_presses_like_a_smooth_plate(mesh, bottom, obstacle, supports):
    normal = (0, 0, -1) if mesh.dimension == 3 else (0, -1)
    plate = HalfSpace(obstacle.lower, normal, motion=obstacle.motion)
    *_, smooth = pressed(mesh, bottom, plate, reach=0.001, supports=supports)
    *_, faceted = pressed(mesh, bottom, obstacle, reach=0.001, supports=supports)
    assert faceted.touches["plate"].force[-1] == pytest.approx(smooth.touches["plate"].force[-1], rel=0.01)


@pytest.mark.parametrize(
    ("first", "second", "spread"),
    [
        (rectangle(3, 2), rectangle(3, 2), 0.02),
        (rectangle(3, 2), rectangle(4, 3), 0.05),
        (box(2, 2, 1, kind="hexahedron27"), box(2, 2, 1, kind="hexahedron27"), 0.01),
    ],
    ids=["plane, same mesh", "plane, other mesh", "bricks, same mesh"],
)
def test_two_blocks_pressed_together_pass_the_patch_test(first, second, spread):
    plane = first.dimension == 2
    shift = (0, -1.0009) if plane else (0, 0, -1.0009)
    names = (("left",), "bottom", "top", "y") if plane else (("x0", "y0"), "z0", "z1", "z")
    sides, bottom, top, axis = names
    held = [Symmetry(name + prime) for name in sides for prime in ("", "'")]
    joint = Contact("joint", (bottom,), (top + "'",), reach=0.001)
    mesh = two(first, second, shift)
    supports = (*held, Roller(bottom + "'", axis), Prescribed(top, axis, "press"))
    model = Model(mesh, {"body": RUBBER}, supports, contacts=(joint,))
    *_, last = march(model, Programme((Phase("press", {"press": -0.1}, first=0.2, largest=0.5),)))
    stress = axial_stress(last)
    assert stress.mean() < -0.03
    assert stress.std() < spread * abs(stress.mean())
    assert 0.0 < last.touches["joint"].distance < 0.001


def test_a_round_body_on_a_plane_follows_hertz():
    """A paraboloid of radius R = 10 mm, pressed 0.012 mm; 24 x 24 x 2 cells, reach 0.001 mm = 7 % of a2 / R.

    Radius and pressure from the force (Johnson, Contact Mechanics, eqs. 4.22-4.24), with E* = 4 mu: incompressible.
    """
    radius, size, reach, mu = 10.0, 4.0, 1e-3, 1.0

    def graded(points):
        r = size * points[:, 0] ** 2
        low = r**2 / (2 * radius)
        return np.column_stack([r, low + (size - low) * points[:, 1] ** 2])

    mesh = rectangle(24, 24, graded, space="axisymmetric")
    floor = HalfSpace((0, -2 * reach), (0, 1), motion=Motion("up", (0, 1)))
    contact = Contact("floor", ("bottom",), floor, reach=reach, stiffness=0.1)
    model = Model(mesh, {"body": NeoHookean(mu, bulk=1000 * mu)}, (Clamp("top"), Symmetry("left")), contacts=(contact,))
    *_, last = march(model, Programme((Phase("up", {"up": 0.012 + 2 * reach}, first=0.2, largest=0.25),)))
    force = last.touches["floor"].force[1]
    a = (3 * force * radius / (4 * 4 * mu)) ** (1 / 3)
    total = model.contact.evaluate(last.positions, np.array([last.values["up"]]), None, hessian=False)
    nodal = -total.gradient.reshape(-1, 2)[:, 1]
    assert nodal.sum() == pytest.approx(force)
    r = last.positions[:, 0]
    assert nodal @ r / force == pytest.approx(3 * np.pi / 16 * a, rel=0.03)  # mean radius of Hertz's pressure
    assert np.sqrt(nodal @ r**2 / force) == pytest.approx(np.sqrt(0.4) * a, rel=0.03)


PLANE = rectangle(4, 2, width=20.0, height=8.0)
SOLID = box(2, 1, 1, mapping=lambda p: p * np.array([20.0, 10.0, 8.0]))
FLOORS = {
    "half-plane": (PLANE, "bottom", HalfSpace((0, -0.01), (0, 1))),
    "rectangle": (PLANE, "bottom", Block((-50, -5), (100, -0.01))),
    "half-space": (SOLID, "z0", HalfSpace((0, 0, -0.01), (0, 0, 1))),
    "block": (SOLID, "z0", Block((-50, -40, -5), (100, 50, -0.01))),
}


def on_a_slope(floor, slope, friction=0.5):
    """Return the states of a block that settles, is tilted to a slope, and is left there for 0.2 s; its weight, N."""
    mesh, face, obstacle = FLOORS[floor]
    d = mesh.dimension
    loads = Gravity((0,) * (d - 1) + (-1,), "weight"), Gravity((1,) + (0,) * (d - 1), "side")
    contact = Contact("floor", (face,), obstacle, friction, reach=0.02, stiffness=1e-3)
    model = Model(mesh, {"body": RUBBER}, (), loads, contacts=(contact,))
    step = {"inertia": "quasi-static", "first": 0.05, "largest": 0.1}
    programme = Programme((
        Phase("settle", {"weight": G}, duration=0.2, **step),
        Phase("tilt", {"side": slope * G}, duration=0.3, **step),
        Phase("stay", {"side": slope * G}, duration=0.2, **step | {"inertia": "moderate"}),
    ))  # fmt: skip
    return list(march(model, programme)), 1.1e-9 * G * float(np.prod(np.ptp(mesh.points, axis=0)))


@pytest.mark.parametrize("floor", FLOORS)
def test_a_block_below_the_angle_of_friction_sticks_and_above_it_slides_as_coulomb_says(floor):
    states, weight = on_a_slope(floor, 0.48)
    settled = next(state for state in reversed(states) if state.phase == "settle")
    assert settled.touches["floor"].force[-1] == pytest.approx(weight, rel=1e-4)
    tilted, last = next(state for state in reversed(states) if state.phase == "tilt"), states[-1]
    moved = (last.displacement - tilted.displacement)[:, 0].mean()
    assert abs(moved) <= 0.2 * 1e-3 * last.model.mesh.size  # no faster than the creep, for 0.2 s
    assert last.touches["floor"].friction[0] == pytest.approx(-0.48 * weight, rel=1e-3)

    states, weight = on_a_slope(floor, 0.55)
    tilted, last = next(state for state in reversed(states) if state.phase == "tilt"), states[-1]
    speed = [state.velocity[:, 0].mean() for state in (tilted, last)]
    assert (speed[1] - speed[0]) / 0.2 == pytest.approx((0.55 - 0.5) * G, rel=0.01)
    touch = last.touches["floor"]
    assert np.linalg.norm(touch.friction) == pytest.approx(0.5 * weight, rel=0.01)
    energies = last.energies
    slid = (last.displacement - tilted.displacement)[:, 0].mean()
    lost = energies.friction - tilted.energies.friction
    assert lost == pytest.approx(0.5 * weight * slid, rel=0.01)  # friction takes mu N times the way
    assert abs(energies.difference) < 0.01 * energies.friction
    frictions = [state.energies.friction for state in states]
    assert (np.diff(frictions) >= 0.0).all()
    assert min(state.touches["floor"].distance for state in states[1:] if state.touches["floor"].area) > 0.0


def half_ring(stored=None):
    """Return the flattening of a ring between two plates, by its right half, until its inside touches itself."""

    def bent(points):
        angle, radius = np.pi * (points[:, 0] - 0.5), 1 - 0.25 * points[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    contacts = (
        Contact("plate", ("bottom",), HalfSpace((0, 1.004), (0, -1), motion=PLANE_DOWN), 0.3, reach=0.01),
        Contact("floor", ("bottom",), HalfSpace((0, -1.004), (0, 1)), 0.3, reach=0.01),
        Contact("inside", ("top",), friction=0.3, reach=0.01),
    )
    mesh = rectangle(24, 2, bent)
    return Model(mesh, {"body": RUBBER}, (Symmetry("left"), Symmetry("right")), contacts=contacts)


def test_a_flattened_ring_touches_itself_and_never_crosses():
    model = half_ring()
    states = list(march(model, Programme((Phase("flatten", {"press": 1.49}, first=0.02, largest=0.05),))))
    last = states[-1]
    assert last.touches["inside"].area > 0.5
    assert 0.0 < last.touches["inside"].distance < 0.01
    for state in states:
        ways = model.contact.ways(state.values)
        assert model.contact.distance(state.positions, ways) > 0.0
        if state.index:
            force = [state.touches[name].force[1] for name in ("plate", "floor")]
            assert force[0] == pytest.approx(-force[1], rel=1e-6)
            assert state.touches["inside"].force == pytest.approx((0.0, 0.0), abs=1e-12)
    upper = last.positions[model.mesh.face_nodes("right")][:, 1]
    assert upper.max() < 1.004 - 1.49


def test_the_work_of_a_moved_obstacle_is_found_as_energy():
    model = half_ring()
    *_, last = march(model, Programme((Phase("flatten", {"press": 0.6}, first=0.02, largest=0.02),)))
    energies = last.energies
    assert energies.load > 0.0
    assert abs(energies.difference) < 0.02 * energies.load


def test_pressure_in_a_ring_that_fills_a_bore_goes_on_to_the_bore():
    """Incompressible rubber in a rigid bore cannot deform: more pressure inside is as much more outside."""

    def bent(points):
        angle, radius = np.pi / 2 * points[:, 0], 1 - 0.2 * points[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    mesh = rectangle(12, 2, bent)
    bore = Contact("bore", ("bottom",), Pipe((0, 0), 1.01), reach=0.002)
    supports = Symmetry("left"), Symmetry("right")
    cavity = Cavity("gas", ("top",), mirrors=("left", "right"))
    model = Model(mesh, {"body": NeoHookean(0.3, bulk=3000.0)}, supports, (), (cavity,), contacts=(bore,))
    programme = Programme(
        (Phase("fill", {"gas": 0.2}, first=0.1, largest=0.5), Phase("more", {"gas": 0.5}, first=0.5, largest=0.5))
    )
    states = list(march(model, programme))
    filled = next(state for state in reversed(states) if state.phase == "fill")
    outer = 1.01
    assert filled.touches["bore"].area == pytest.approx(np.pi / 2 * outer, rel=2e-3)
    # on a quarter, the pressure times the radius is the force in x and in y
    more = np.array(states[-1].touches["bore"].force) - np.array(filled.touches["bore"].force)
    assert states[-1].touches["bore"].pressure - filled.touches["bore"].pressure == pytest.approx(0.3, rel=0.02)
    assert more == pytest.approx([-0.3 * outer, -0.3 * outer], rel=0.02)


def test_a_bar_pressed_into_a_block_is_met_by_equal_and_opposite_forces():
    bar = Cylinder((0.5, 1.35), (), 0.34, 48, motion=PLANE_DOWN)
    mesh = rectangle(8, 6)
    model = Model(
        mesh, {"body": RUBBER}, (Clamp("bottom"),), contacts=(Contact("bar", ("top",), bar, 0.4, reach=0.01),)
    )
    *_, last = march(model, Programme((Phase("press", {"press": 0.2}, first=0.1, largest=0.25),)))
    touch = last.touches["bar"]
    assert touch.force[1] < -0.01
    assert last.reactions.reshape(-1, 2).sum(axis=0) == pytest.approx(-np.array(touch.force), abs=1e-8)
    assert 0.2 < touch.area < 0.9
    depth = last.displacement[mesh.face_nodes("top"), 1].min()
    assert -0.2 < depth < -0.15  # the bar starts 0.01 mm above and stays off by less than the reach


def test_friction_goes_by_the_normal_forces_of_the_same_increment():
    plate = HalfSpace((0, 1.01), (0, -1), motion=Motion("press", (1, -1)))
    contact = Contact("plate", ("top",), plate, 0.1, reach=0.01)
    model = Model(rectangle(4, 4), {"body": RUBBER}, (Clamp("bottom"),), contacts=(contact,))
    *_, last = march(model, Programme((Phase("press", {"press": 0.15}, first=1.0, largest=1.0),)))
    touch = last.touches["plate"]
    assert last.index == 1  # at its start nothing touched
    assert 0.05 < touch.friction[0] / -touch.force[1] <= 0.1  # the sides bulge, so a part slips the other way


def test_a_run_with_contact_that_is_resumed_ends_bit_for_bit_alike(tmp_path):
    """Two blocks, one slides over the other, so that pairs of nodes come and go."""
    mesh = two(rectangle(3, 2), rectangle(4, 3), (0.1, -1.009))
    joint = Contact("joint", ("bottom",), ("top'",), 0.3, reach=0.01)
    supports = Clamp("bottom'"), Prescribed("top", "y", "press"), Prescribed("top", "x", "slide")
    model = Model(mesh, {"body": RUBBER}, supports, contacts=(joint,))
    programme = Programme((
        Phase("press", {"press": -0.1}, first=0.5, largest=0.5),
        Phase("slide", {"slide": 0.4}, first=0.1, largest=0.1),
    ))  # fmt: skip
    whole = solve(model, programme, folder=tmp_path / "whole")

    class StopError(Exception):
        pass

    def stop(progress):
        if progress.state.index == 7:
            raise StopError

    with pytest.raises(StopError):
        solve(model, programme, folder=tmp_path / "broken", progress=stop)
    resumed = solve(model, programme, folder=tmp_path / "broken", resume=True)
    assert len(resumed.states) == len(whole.states) > 10
    last, other = resumed.states[-1], whole.states[-1]
    assert (last.displacement == other.displacement).all()
    assert last.touches == other.touches
    assert vars(last.energies) == vars(other.energies)
    assert _alike(resumed.history.rows, whole.history.rows)
    assert "contact_force_y:joint" in whole.history.keys
    assert last.touches["joint"].force[1] > 0.01


def _alike(one, other):
    return all(
        a == b or (a != a and b != b)
        for x, y in zip(one, other, strict=True)
        for a, b in zip(x.values(), y.values(), strict=True)
    )


@pytest.mark.parametrize("friction", [-0.1, 5.1, float("nan")])
def test_a_friction_out_of_range_is_refused(friction):
    with pytest.raises(InputError, match=r"contact 'c': friction = .*, allowed: 0 to 5"):
        Contact("c", ("top",), None, friction)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: Contact("c", "top"), "contact 'c': faces = 'top', expected a tuple"),
        (lambda: Contact("c", ("top",), ()), r"contact 'c': against = \(\), expected a tuple"),
        (lambda: Contact("c", ("top",), ("top", "left")), "top is on both sides"),
        (lambda: Contact("c", ("top",), reach=0.0), "reach = 0.0 mm, allowed: more than 0"),
        (lambda: Contact("c", ("top",), stiffness=-1.0), "stiffness = -1.0 MPa, allowed"),
        (lambda: Contact("c", ("top",), creep=float("inf")), "creep = inf mm/s, allowed"),
        (lambda: Block((0, 0), (1, 0)), "block: lower = .*, allowed: lower < upper"),
        (lambda: Cylinder((0, 0), (), 0.0), "cylinder: radius = 0.0 mm, allowed: more than 0"),
        (lambda: Cylinder((0, 0), (), 1.0, 4), "segments = 4, allowed: 8 or more"),
        (lambda: Pipe((0, 0), -1.0), "pipe: radius = -1.0 mm"),
    ],
)
def test_wrong_contacts_are_refused(wrong, message):
    with pytest.raises(InputError, match=message):
        wrong()


def resting(contact, mesh=None):
    return Model(mesh or rectangle(3, 2), {"body": RUBBER}, (Clamp("left"),), contacts=(contact,))


@pytest.mark.parametrize(
    ("obstacle", "message"),
    [
        (
            HalfSpace((0, 0.3), (0, 1)),
            r"bottom and HalfSpace intersect at .* mm; move them apart by 0.301\d* mm along \(0, 1\)",
        ),
        (HalfSpace((0, 0), (0, 1)), r"bottom and HalfSpace intersect at \(.*, 0\) mm"),
        (Pipe((0.5, 0), 0.3), "bottom and Pipe intersect at .*; no shift takes them apart"),
        (Pipe((0.9, 0), 0.6), r"bottom and Pipe intersect at .*; move them apart by 0.301\d* mm along \(1, 0\)"),
        (Block((0.5, -1), (2.0, 0.2)), r"bottom and Block intersect at \(0.5, 0\) mm; .* is 0.2\d* mm along \(0, 1\)"),
        (Cylinder((0.5, 0), (), 0.2), r"bottom and Cylinder intersect at .*; the smallest shift .* is 0.2\d* mm along"),
        (Block((-1, -1), (3, 3)), r"the body with bottom lies inside the Block, at \(0, 0\) mm"),
        (HalfSpace((0, 0, 0), (0, 1)), r"half-space: point = \(0, 0, 0\), expected 2 finite numbers"),
        (HalfSpace((0, -1), (0, 0)), "half-space: normal = .*, expected a vector that is not zero"),
        (SurfaceFile("part.stl"), "a plane model meets blocks, cylinders and half-spaces only"),
        (HalfSpace((0, -1), (0, 1), motion=Motion("m", (0, 0))), "motion 'm': direction = "),
    ],
)
def test_obstacles_in_the_way_are_refused_with_the_place_and_the_shift(obstacle, message):
    with pytest.raises(InputError, match=message):
        resting(Contact("c", ("bottom",), obstacle))


def test_a_body_inside_a_closed_surface_is_noticed_in_space():
    around = Contact("c", ("z1",), Cylinder((0.5, 0.5, -3), (0.5, 0.5, 3), 2.0))
    with pytest.raises(InputError, match="lies inside the Cylinder"):
        Model(box(1, 1, 1), {"body": RUBBER}, (Clamp("z0"),), contacts=(around,))


def test_bodies_that_intersect_or_hang_together_are_refused():
    mesh = two(rectangle(2, 2), rectangle(2, 2), (0.2, -0.9))
    supports = Clamp("left"), Clamp("left'")
    with pytest.raises(InputError, match=r"bottom and top' intersect at \(.*\) mm; .* is 0.1\d* mm along \(0, 1\)"):
        Model(mesh, {"body": RUBBER}, supports, contacts=(Contact("c", ("bottom",), ("top'",)),))
    with pytest.raises(InputError, match="bottom and left share nodes"):
        resting(Contact("c", ("bottom",), ("left",)))


def test_a_surface_that_crosses_itself_and_a_reach_beyond_its_gap_are_refused():
    def folded(points, overlap):
        angle, radius = (2 * np.pi + overlap) * points[:, 0], 3.0 - points[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    outside = ("left", "right", "top", "bottom")
    crossing = rectangle(60, 2, lambda p: folded(p, 0.05), width=1.0, height=0.4)
    with pytest.raises(InputError, match=r"intersect at .* must not cross itself"):
        resting(Contact("c", outside), crossing)
    slit = rectangle(60, 2, lambda p: folded(p, -0.05), width=1.0, height=0.4)
    with pytest.raises(InputError, match=r"reach = 0.2 mm, allowed: less than the smallest gap at rest, 0.13\d* mm"):
        resting(Contact("c", outside, reach=0.2), slit)


def test_unknown_faces_names_given_twice_and_obstacles_off_the_axis_are_refused():
    with pytest.raises(NameNotFoundError, match="unknown face 'botom': did you mean 'bottom'"):
        resting(Contact("c", ("botom",), HalfSpace((0, -1), (0, 1))))
    floor = Contact("c", ("bottom",), HalfSpace((0, -1), (0, 1)))
    with pytest.raises(InputError, match="the name 'c' is given to 2 loads, cavities, displacements or contacts"):
        Model(rectangle(2, 2), {"body": RUBBER}, (Clamp("left"),), contacts=(floor, floor))
    aside = Contact("c", ("bottom",), HalfSpace((0, -1), (0, 1), motion=Motion("m", (1, 0))))
    with pytest.raises(InputError, match="with axial symmetry an obstacle moves along the axis"):
        resting(aside, rectangle(2, 2, space="axisymmetric"))


def test_surface_files_are_read_and_wrong_ones_refused(tmp_path):
    import meshio

    points, facets = Block((-3, -4, -2), (3.3, 4, -0.02)).facets(3)
    meshio.write_points_cells(tmp_path / "block.stl", points, [("triangle", facets)])
    got, triangles = SurfaceFile(str(tmp_path / "block.stl")).facets(3)
    assert (len(got), len(triangles)) == (8, 12)
    corners = got[triangles]
    volume = np.einsum("mi,mi->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume == pytest.approx(6.3 * 8 * 1.98, rel=1e-5)  # closed, normals outwards
    (tmp_path / "wrong.stl").write_text("no surface")
    for name, message in (("wrong.stl", "wrong.stl' cannot be read"), ("none.stl", "none.stl' cannot be read")):
        with pytest.raises(InputError, match=message):
            SurfaceFile(str(tmp_path / name)).facets(3)
    meshio.write_points_cells(tmp_path / "line.vtk", points, [("line", facets[:, :2])])
    with pytest.raises(InputError, match="no triangles in it"):
        SurfaceFile(str(tmp_path / "line.vtk")).facets(3)


def test_a_solve_that_cannot_go_on_says_which_contact_holds_it():
    mesh = rectangle(2, 2)
    press = HalfSpace((0, 1.005), (0, -1), motion=PLANE_DOWN)
    contact = Contact("lid", ("top",), press, reach=0.01)
    model = Model(mesh, {"body": RUBBER}, (Clamp("bottom"), Clamp("top")), contacts=(contact,))
    programme = Programme((Phase("press", {"press": 0.5}, first=0.5, largest=0.5, smallest=0.1),))
    with pytest.raises(NotConvergedError, match="'lid'"):
        list(march(model, programme, Settings(viscosity=0.0)))
