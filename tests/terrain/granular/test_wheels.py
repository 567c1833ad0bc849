from math import pi

import numpy as np
import pytest

from pneumorph.errors import GeometryError, InputError, StorageError
from pneumorph.terrain import Drive
from pneumorph.terrain.granular import SANDS, Bed, Vehicle, WheelSurface, disc, from_stl, limbed, vehicle_mjcf
from pneumorph.terrain.granular.broad_phase import cell_lists
from pneumorph.terrain.granular.contact_kernels import MOST_CONTACTS, contact_places, nearest_on_triangle
from pneumorph.terrain.granular.model import WHEEL_FILE
from pneumorph.terrain.rigid import load


@pytest.mark.parametrize("height", [230.0, 255.0, 280.0])
def test_a_limbed_wheel_has_its_height_and_closed_shells_that_face_outwards(height):
    wheel = limbed("wheel", height)
    assert 2.0 * wheel.radius == pytest.approx(height, abs=1e-6)
    assert wheel.width == 44.0
    edges = np.concatenate([wheel.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    ahead = {tuple(edge) for edge in edges.tolist()}
    assert len(ahead) == len(edges)  # each edge once in each direction
    assert ahead == {(b, a) for a, b in ahead}


def test_the_wheel_is_the_same_after_a_quarter_turn():
    points = limbed("wheel", 250.0).points
    turned = points[:, [2, 1, 0]] * [1.0, 1.0, -1.0]
    gap = np.abs(points[:, None] - turned[None]).sum(axis=2).min(axis=0)
    hub = np.hypot(points[:, 0], points[:, 2]) < 26.0
    assert gap[~hub].max() < 1e-6


def test_higher_wheels_have_less_curved_limbs_of_the_same_length():
    def length(wheel):
        return wheel.volume / wheel.width

    assert length(limbed("a", 230.0)) == pytest.approx(length(limbed("b", 280.0)), rel=0.05)


def test_mass_properties_are_those_of_a_disc():
    wheel = disc("disc", 100.0, 40.0, sides=720)
    centre, inertia = wheel.mass_properties(2.0)
    assert wheel.volume == pytest.approx(pi * 100.0**2 * 40.0, rel=1e-4)
    np.testing.assert_allclose(centre, 0.0, atol=1e-9)
    about, across = 0.5 * 2.0 * 100.0**2, 2.0 * (3.0 * 100.0**2 + 40.0**2) / 12.0
    np.testing.assert_allclose(inertia, np.diag([across, about, across]), rtol=1e-4, atol=1e-6)


def test_mass_properties_follow_a_shift():
    still = disc("disc", 50.0, 20.0)
    moved = WheelSurface("moved", still.points + np.array([3.0, -4.0, 5.0]), still.triangles)
    centre, inertia = moved.mass_properties(1.0)
    np.testing.assert_allclose(centre, [3.0, -4.0, 5.0])
    np.testing.assert_allclose(inertia, still.mass_properties(1.0)[1], atol=1e-6)


def test_a_wheel_goes_through_an_stl_file(tmp_path):
    wheel = disc("disc", 100.0, 40.0)
    path = tmp_path / "disc.stl"
    path.write_bytes(wheel.stl())
    read = from_stl(path)
    assert read.name == "disc"
    assert read.volume == pytest.approx(wheel.volume, rel=1e-6)
    assert from_stl(path).stl() == read.stl()


def test_a_limbed_wheel_is_taken_from_its_own_file(tmp_path):
    wheel = limbed("full", 280.0)
    (tmp_path / "full.stl").write_bytes(wheel.stl())
    assert from_stl(tmp_path / "full.stl").volume == pytest.approx(wheel.volume, rel=1e-5)


def test_an_open_or_missing_stl_file_is_refused(tmp_path):
    wheel = disc("disc", 100.0, 40.0)
    (tmp_path / "open.stl").write_bytes(WheelSurface("open", wheel.points, wheel.triangles[1:]).stl())
    with pytest.raises(GeometryError, match=r"open.stl': the surface has a hole, .* expected closed surfaces"):
        from_stl(tmp_path / "open.stl")
    with pytest.raises(StorageError, match=r"none.stl' cannot be read"):
        from_stl(tmp_path / "none.stl")


def test_grains_over_a_third_of_the_wheel_are_refused():
    disc("small", 66.5, 40.0).check_grains(Bed(SANDS["dry"], radius=20.0))
    with pytest.raises(
        InputError, match=r"grains of up to 44 mm under wheel 'small' of height 130 mm: expected at most"
    ):
        disc("small", 65.0, 40.0).check_grains(Bed(SANDS["dry"], radius=20.0))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: limbed("w", 300.0), "height = 300 mm, expected 140 mm to 280 mm"),
        (lambda: limbed("w", 230.0, width=0.0), "width = 0 mm, expected more than 0"),
        (lambda: limbed("w", 230.0, pleats=0), "pleats = 0, expected at least 1"),
        (lambda: limbed("w", 230.0, hub_radius=60.0), "hub_radius = 60 mm, expected less than a quarter of the height"),
        (lambda: WheelSurface("w", np.zeros((3, 3)), np.array([[0, 1, 2]])), "enclose no volume"),
        (lambda: Vehicle(disc("w", 160.0, 60.0)), "wheels are larger than the wheelbase"),
        (lambda: Vehicle(disc("w", 100.0, 130.0)), "wheels are larger than the track"),
        (
            lambda: Vehicle(disc("w", 100.0, 60.0)).check_box(4000.0, 300.0, Drive()),
            "is larger than the bed of 4000 mm",
        ),
        (
            lambda: Vehicle(disc("w", 100.0, 60.0)).check_box(2000.0, 3000.0, Drive()),
            "expected a longer bed or a shorter",
        ),
    ],
)
def test_impossible_wheels_and_vehicles_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_the_nearest_place_is_found_in_every_region_of_a_triangle():
    corners = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
    place = np.empty(3)
    for p, expected in [
        ((1.0, 1.0, 2.0), (1.0, 1.0, 0.0)), ((-1.0, -1.0, 1.0), (0.0, 0.0, 0.0)), ((6.0, -1.0, 0.0), (4.0, 0.0, 0.0)),
        ((-1.0, 6.0, 0.0), (0.0, 4.0, 0.0)), ((2.0, -3.0, 1.0), (2.0, 0.0, 0.0)), ((-2.0, 1.0, 0.0), (0.0, 1.0, 0.0)),
        ((3.0, 3.0, 1.0), (2.0, 2.0, 0.0)),
    ]:  # fmt: skip
        squared = nearest_on_triangle(np.array(p), corners, place)
        np.testing.assert_allclose(place, expected, atol=1e-12)
        assert squared == pytest.approx(float(((np.array(p) - expected) ** 2).sum()))


def places_of(surface, p, radius):
    corners = surface.points[surface.triangles]
    middle = corners.mean(axis=1)
    around = np.linalg.norm(corners - middle[:, None], axis=2).max(axis=1)
    places, depths = np.empty((MOST_CONTACTS, 3)), np.empty(MOST_CONTACTS)
    spheres = np.column_stack([middle, around])
    n = contact_places(np.array(p), radius, corners, spheres, np.arange(len(corners)), places, depths)
    return places[:n], depths[:n]


def box(x, y, z):
    """A box between pairs of numbers."""
    points = np.array([[a, b, c] for a in x for b in y for c in z], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def test_a_sphere_on_many_triangles_of_one_face_has_one_contact():
    places, depths = places_of(disc("disc", 100.0, 40.0), (3.0, 29.0, 2.0), 10.0)
    np.testing.assert_allclose(places, [[3.0, 20.0, 2.0]])
    np.testing.assert_allclose(depths, [1.0])


def test_a_sphere_on_a_convex_edge_has_one_contact_and_in_a_corner_two():
    points, triangles = box((0, 10), (0, 10), (0, 10))
    cube = WheelSurface("cube", points, triangles)
    places, _ = places_of(cube, (10.6, 5.0, 10.6), 1.0)
    np.testing.assert_allclose(places, [[10.0, 5.0, 10.0]])
    other, more = box((10, 20), (0, 10), (0, 30))
    step = WheelSurface("step", np.concatenate([points, other]), np.concatenate([triangles, more + len(points)]))
    places, depths = places_of(step, (7.5, 5.0, 12.6), 3.0)  # on the cube's top and against the other's side
    np.testing.assert_allclose(sorted(map(tuple, places)), [(7.5, 5.0, 10.0), (10.0, 5.0, 12.6)])
    np.testing.assert_allclose(sorted(depths), [0.4, 0.5])


def test_the_cells_hold_every_triangle_that_a_sphere_touches():
    wheel = limbed("wheel", 250.0)
    corners, reach = wheel.points[wheel.triangles], 22.0
    cells = cell_lists(corners, reach)
    random, place = np.random.default_rng(3), np.empty(3)
    for p in random.uniform(-150.0, 150.0, (200, 3)) * [1.0, 0.35, 1.0]:
        touched = {t for t in range(len(corners)) if nearest_on_triangle(p, corners[t], place) < reach**2}
        cell = np.floor((p - cells.origin) / cells.size).astype(int)
        if (cell < 0).any() or (cell >= cells.counts).any():
            assert not touched
            continue
        number = (cell[0] * cells.counts[1] + cell[1]) * cells.counts[2] + cell[2]
        middle = cells.origin + (cell + 0.5) * cells.size
        if touched:  # what the kernel leaves out by this bound would not have touched
            assert cells.nearest[number] - np.linalg.norm(p - middle) < reach
        assert touched <= set(cells.triangles[cells.starts[number] : cells.starts[number + 1]].tolist())


@pytest.mark.parametrize("single", [False, True])
def test_the_model_has_the_wheels_and_their_mass(single):
    pytest.importorskip("mujoco")
    vehicle = Vehicle(limbed("wheel", 250.0), single=single)
    text = vehicle_mjcf(vehicle, Drive(step=2e-4), (100.0, 200.0, 300.0))
    model = load(text, {WHEEL_FILE: vehicle.surface.stl()})
    assert model.opt.timestep == 2e-4
    wheels = len(vehicle.wheels)
    assert model.nu == wheels == (1 if single else 4)
    assert model.body_subtreemass[0] == pytest.approx(0.125 if single else 0.5)
    assert model.body("rover").pos == pytest.approx([0.1, 0.2, 0.3])
    _, inertia = vehicle.surface.mass_properties(vehicle.wheel_mass)
    about_axle = inertia[1, 1] * 1e-3  # tonne mm2 -> kg m2
    assert sorted(model.body("front_left").inertia)[2] == pytest.approx(about_axle, rel=1e-3)
