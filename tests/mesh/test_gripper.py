"""Grids of hexahedra of a finger and of a gripper: volumes, names, symmetry and places."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import Finger, Gripper
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Clamp, Model, Symmetry
from pneumorph.mechanics.body import cell_volumes
from pneumorph.mesh import generate
from pneumorph.mesh.finger import mesh_finger


def solid_volume(finger):
    """Return the volume of the silicone, mm3, from the dimensions: the beam without its gaps and its air."""
    low = finger.base + finger.passage_height + finger.passage_roof
    gaps = (finger.chambers - 1) * finger.gap * finger.width * (finger.height - low)
    return finger.length * finger.width * finger.height - gaps - finger.cavity_volume


def cell_volume(mesh):
    return sum(float(np.abs(cell_volumes(mesh, block)).sum()) for block in mesh.blocks)


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize(
    "finger",
    [Finger(), Finger(chambers=1), Finger(passage_width=12.0), Finger(passage_height=13.0), Finger(passage_roof=12.0)],
    ids=["default", "one chamber", "wide passage", "high passage", "no gaps"],
)
def test_the_grid_of_a_finger_has_the_volume_of_its_dimensions(finger, half):
    mesh = mesh_finger(finger, half=half)
    part = 0.5 if half else 1.0
    assert cell_volume(mesh) == pytest.approx(part * solid_volume(finger), rel=1e-9)
    assert set(mesh.faces) == {*finger.face_names, *(("symmetry_y",) if half else ())}
    assert np.ptp(mesh.points, axis=0) == pytest.approx([finger.length, part * finger.width, finger.height])
    for name, place in (("clamp", 0.0), ("tip", finger.length)):
        assert mesh.points[mesh.face_nodes(name), 0] == pytest.approx(place)


def test_no_edge_is_longer_than_asked():
    mesh = mesh_finger(Finger(), 2.5)
    corners = mesh.points[mesh.blocks[0].nodes[:, :8]]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    assert max(np.linalg.norm(corners[:, a] - corners[:, b], axis=1).max() for a, b in edges) <= 2.5 + 1e-9


@pytest.mark.parametrize("gripper", [Gripper(), Gripper(fingers=4, tilt=0.3), Gripper(half=True)])
def test_every_finger_of_a_gripper_has_a_closed_cavity_of_its_own(gripper):
    mesh = generate(gripper, coarse=True)
    assert set(mesh.faces) == set(gripper.face_names)
    assert cell_volume(mesh) == pytest.approx(solid_volume(gripper.finger) * (0.5 if gripper.half else gripper.fingers))
    mirrors = ("symmetry_y",) if gripper.half else ()
    supports = (Clamp("clamp"), *(Symmetry(name) for name in mirrors))
    cavities = tuple(Cavity(name, (name,), mirrors=mirrors) for name in gripper.cavities)
    model = Model(mesh, {"body": NeoHookean(0.1)}, supports, cavities=cavities)
    for name in gripper.cavities:
        assert model.surfaces[name].reference_volume == pytest.approx(gripper.cavity_volume, rel=1e-9)


def test_fingers_hang_down_with_their_bases_to_the_axis():
    gripper = Gripper()
    mesh = generate(gripper, coarse=True)
    for number, turn in enumerate(gripper.angles, 1):
        out = np.array([math.cos(turn), math.sin(turn), 0.0])
        outer, tip = (mesh.points[mesh.face_nodes(f"{name}_{number}")] for name in ("outer", "tip"))
        assert (outer @ out).min() == pytest.approx(gripper.palm_radius)
        assert (outer @ out).max() == pytest.approx(gripper.palm_radius + gripper.height)
        assert tip[:, 2] == pytest.approx(-gripper.length)
    assert mesh.points[mesh.face_nodes("clamp"), 2] == pytest.approx(0.0)


def test_turned_by_a_third_the_gripper_is_itself():
    mesh = generate(Gripper(tilt=0.2), coarse=True)
    third = 2.0 * math.pi / 3.0
    turn = np.array([[math.cos(third), -math.sin(third), 0.0], [math.sin(third), math.cos(third), 0.0], [0, 0, 1.0]])
    count = len(mesh.points) // 3
    assert mesh.points[:count] @ turn.T == pytest.approx(mesh.points[count : 2 * count], abs=1e-9)


def test_tilt_spreads_the_tips():
    tips = {tilt: generate(Gripper(tilt=tilt, half=True)) for tilt in (0.0, 0.3)}
    out = {tilt: mesh.points[mesh.face_nodes("tip_1"), 0].min() for tilt, mesh in tips.items()}
    assert out[0.3] - out[0.0] == pytest.approx(Gripper().length * math.sin(0.3))


def test_a_finger_of_a_gripper_has_its_dimensions():
    assert Gripper(width=14.0, chambers=5).finger == Finger(width=14.0, chambers=5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"fingers": 1}, "fingers = 1: expected 2 or more"),
        ({"palm_radius": 4.0}, "leaves 13.86 mm for each of 3, expected more than width = 16 mm"),
        ({"tilt": 1.0}, "tilt = 57.2958 deg: expected -45 to 45 deg"),
        ({"tilt": math.nan}, "tilt = nan: expected a finite number in rad"),
        ({"half": 1}, "half = 1: expected True or False"),
        ({"width": 3.0}, "the side walls overlap"),
    ],
)
def test_grippers_that_cannot_be_are_refused(changes, message):
    with pytest.raises(GeometryError, match=message):
        replace(Gripper(), **changes)


def test_a_gripper_has_no_solid_and_its_grid_only_a_size():
    with pytest.raises(GeometryError, match="no CAD solid"):
        Gripper().shape()
    with pytest.raises(MeshError, match=r"grading = 0\.5"):
        generate(Gripper(), grading=0.5)
