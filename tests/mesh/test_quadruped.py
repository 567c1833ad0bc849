"""The quadruped's mesh: volumes, closed cavities, names, mirror images and weight."""

import numpy as np
import pytest

from pneumorph.errors import MeshError
from pneumorph.geometry import Quadruped
from pneumorph.materials import library
from pneumorph.measures.centre_of_mass import nodal_mass
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, Symmetry
from pneumorph.mechanics.surface import enclosed_volume
from pneumorph.mesh import generate, inspect
from pneumorph.mesh.topology import open_edges
from pneumorph.solution import solve

ROBOT = Quadruped()
# one channel in a leg and two in the centre: the least that has all there is
SMALL = Quadruped(length=54.0, width=38.0, body_width=24.0, leg_width=15.0)
MATERIALS = {"body": library.material("ecoflex-pneunet"), "base": library.material("pdms-pneunet")}


def solid(robot):
    air = len(robot.legs) * robot.cavity_volume + robot.centre_volume
    return robot.plan_area * robot.height - air


def held(mesh, name):
    return sum(
        enclosed_volume(block.kind, block.nodes, mesh.points, np.zeros(3), np.eye(3), False, 0)[0]
        for block in mesh.faces[name]
    )


@pytest.mark.parametrize("robot", [ROBOT, SMALL, Quadruped(half=True)], ids=["published", "small", "half"])
def test_volumes_are_those_of_the_drawing(robot):
    mesh = generate(robot)
    assert inspect(mesh).volume == pytest.approx(solid(robot), rel=1e-9)
    assert np.ptp(mesh.points, axis=0) == pytest.approx(
        [robot.length, robot.width / (2.0 if robot.half else 1.0), robot.height]
    )
    assert set(mesh.faces) == set(robot.face_names)
    assert set(mesh.domains) == set(robot.domains)


@pytest.mark.parametrize("robot", [ROBOT, SMALL], ids=["published", "small"])
def test_every_cavity_is_closed_and_in_its_place(robot):
    mesh = generate(robot)
    for name in robot.cavities:
        assert len(open_edges(mesh.faces[name])) == 0
        volume = robot.centre_volume if name == "PN5" else robot.cavity_volume
        assert held(mesh, name) == pytest.approx(volume, rel=1e-9)
        low, high = mesh.points[mesh.face_nodes(name), 2].min(), mesh.points[mesh.face_nodes(name), 2].max()
        assert (low, high) == pytest.approx((robot.layer, robot.layer + robot.channel_depth))
    for leg, (rear, left) in {"PN1": (1, 1), "PN2": (1, 0), "PN3": (0, 1), "PN4": (0, 0)}.items():
        for name in (leg, f"foot_{leg}"):
            x, y, _ = mesh.points[mesh.face_nodes(name)].T
            assert (x.max() < 0.0) == rear
            assert (x.min() > 0.0) != rear
            assert (y.min() >= 0.0) == left


def test_undersides_and_tips_are_the_feet():
    mesh = generate(ROBOT)
    names = [name for name in mesh.faces if name.startswith(("foot", "belly"))]
    area = {}
    for name in names:
        corner = mesh.points[mesh.face_blocks(name)[0].nodes[:, :4]]
        half = 0.5 * np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
        area[name] = half.sum(axis=0)
    assert sum(area.values())[2] == pytest.approx(-ROBOT.plan_area)
    tip = ROBOT.leg_width * ROBOT.height * np.array([np.cos(ROBOT.leg_angle), np.sin(ROBOT.leg_angle)])
    assert area["foot_PN3"] == pytest.approx([*tip, -ROBOT.leg_width * ROBOT.leg_length])
    assert area["belly_rear"] == pytest.approx(area["belly_front"])


@pytest.mark.parametrize("axis", [0, 1])
def test_the_mesh_is_its_own_mirror_image(axis):
    mesh = generate(ROBOT)
    image = mesh.points * np.where(np.arange(3) == axis, -1.0, 1.0)

    def in_order(points):
        places = np.round(points, 7) + 0.0
        return places[np.lexsort(places.T)]

    assert in_order(image) == pytest.approx(in_order(mesh.points))
    for block in mesh.blocks:
        assert in_order(image[block.nodes].mean(axis=1)) == pytest.approx(
            in_order(mesh.points[block.nodes].mean(axis=1))
        )


def test_a_smaller_size_refines_along_first():
    default, finer = generate(SMALL), generate(SMALL, 1.2)
    assert inspect(finer).volume == pytest.approx(solid(SMALL), rel=1e-9)
    for mesh, size in ((default, SMALL.default_size), (finer, 1.2)):
        top = mesh.points[mesh.face_blocks("outer")[0].nodes[:, :4]]
        edges = np.linalg.norm(top - np.roll(top, 1, axis=1), axis=2)
        assert edges.max() < 3.0 * size * 1.3  # the turns between centre and legs are not square
    assert finer.cell_count > 2 * default.cell_count
    assert generate(SMALL, coarse=True).cell_count <= default.cell_count


def test_its_weight_is_near_the_reported_one():
    model = Model(generate(ROBOT), MATERIALS, (Clamp("belly_rear"),))
    # reported: 0.12 N under the rear and the front pair of legs
    assert 9810.0 * nodal_mass(model).sum() == pytest.approx(0.24, rel=0.15)


def test_settings_of_other_meshers_and_meshes_without_end_are_refused():
    with pytest.raises(MeshError, match=r"grading = 0.5: a layered mesh has its size only"):
        generate(ROBOT, grading=0.5)
    with pytest.raises(MeshError, match=r"the quadruped at 0.001 mm: about .* choose a larger size"):
        generate(ROBOT, 1e-3)


def test_an_inflated_leg_arches_and_only_it():
    robot = Quadruped(length=54.0, width=38.0, body_width=24.0, leg_width=15.0, half=True)
    mesh = generate(robot)
    model = Model(
        mesh, MATERIALS, (Clamp("belly_front"), Clamp("belly_rear"), Symmetry("symmetry_y")),
        cavities=tuple(Cavity(name, (name,), mirrors=("symmetry_y",)) for name in robot.cavities),
    )  # fmt: skip
    last = solve(model, Programme((Phase("inflate", {"PN1": 0.004}, first=1.0, largest=1.0),))).states[-1]
    tips = {}
    for leg in ("PN1", "PN3"):
        nodes = mesh.face_nodes(f"foot_{leg}")
        tips[leg] = last.displacement[nodes[np.argmax(np.abs(mesh.points[nodes, 0]))]]
    assert tips["PN1"][2] < -0.02  # the tip goes down
    assert abs(tips["PN3"][2]) < 0.01 * abs(tips["PN1"][2])
    assert last.volume["PN1"] > 1.02 * robot.cavity_volume
