"""Pipe robot in blocks: volumes of silicone and air against the drawing, faces, cuts and their images."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import PipeRobot
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity
from pneumorph.mechanics.body import Body, cell_volumes
from pneumorph.mechanics.cavity import CavitySurface
from pneumorph.mesh import generate

SHORT = PipeRobot(chambers=2, length=22.0, rings=2)
ALONE = replace(SHORT, modules=1)
PARTS = {"whole": 1, "half": 2, "quarter": 4, "eighth": 8}


def cut(robot, part):
    return robot if part == "whole" else replace(robot, **{part: True})


def silicone(mesh):
    return sum(float(cell_volumes(mesh, block).sum()) for block in mesh.blocks)


def volumes(robot, mesh):
    """Return cavity -> air in it; raises LeakingCavityError for one that is not closed."""
    pattern = Body(mesh, {"body": NeoHookean(0.2)}, "constant").pattern
    return {
        name: CavitySurface(Cavity(name, (name,), mirrors=robot.cuts), mesh, pattern).reference_volume
        for name in robot.cavities
    }


def column(robot):
    return (1.5 * math.sqrt(3.0) * robot.side**2 - math.pi * robot.core_radius**2) * robot.length


@pytest.mark.parametrize("part", PARTS)
def test_a_prism_alone_has_the_silicone_of_the_drawing_whatever_is_cut_away(part):
    robot = cut(ALONE, part)
    block = robot.block_length * robot.block_width * robot.block_height
    air = robot.chamber_length * robot.chamber_width * robot.chamber_height
    expected = column(robot) + 6 * robot.chambers * (block - air)
    mesh = generate(robot)
    assert PARTS[part] * silicone(mesh) == pytest.approx(expected, rel=2e-4)  # the core is a quadratic polygon
    assert set(mesh.faces) == set(robot.face_names)


@pytest.mark.parametrize("part", PARTS)
def test_parts_of_the_robot_have_the_same_silicone_and_air_as_the_whole(part):
    whole, robot = generate(SHORT), cut(SHORT, part)
    mesh = generate(robot)
    assert PARTS[part] * silicone(mesh) == pytest.approx(silicone(whole), rel=1e-9)
    assert set(mesh.faces) == set(robot.face_names)
    top = robot.robot_length / (2.0 if part == "eighth" else 1.0)
    assert np.ptp(mesh.points[:, 2]) == pytest.approx(top)


def test_rows_and_bellows_hold_the_air_of_the_drawing():
    robot = replace(SHORT, quarter=True)
    mesh = generate(robot)
    air = volumes(robot, mesh)
    assert air["rear_2"] == pytest.approx(robot.cavity_volume, rel=1e-9)
    assert air["rear_1"] == pytest.approx(robot.cavity_volume / 2.0, rel=1e-9)  # the cut goes through it
    assert air["front_1"] == pytest.approx(air["rear_1"], rel=1e-12)
    inside = robot.bellows_length - 2.0 * robot.end_disc
    core = math.pi * robot.core_radius**2 * inside
    hexagon = 1.5 * math.sqrt(3.0) * robot.side**2
    rings = robot.rings * robot.ring_air
    outer = math.pi * (robot.ring_radius - robot.ring_wall) ** 2
    # beyond the neck's hexagon the rings' inside is between a hexagon and a circle
    assert core + rings * (hexagon - math.pi * robot.core_radius**2) < 4.0 * air["middle"]
    assert 4.0 * air["middle"] < core + rings * (outer - math.pi * robot.core_radius**2)


def test_airways_add_their_air_and_close_the_rows():
    robot = replace(ALONE, quarter=True, airways=True)
    air = volumes(robot, generate(robot))
    assert air["cavity_2"] == pytest.approx(robot.cavity_volume, rel=1e-9)
    assert robot.cavity_volume > replace(robot, airways=False).cavity_volume


def test_the_ends_fit_together_and_the_outside_reaches_as_far_as_it_says():
    mesh = generate(SHORT)
    outside = np.unique(np.concatenate([mesh.face_nodes("rear"), mesh.face_nodes("front")]))
    assert np.hypot(*mesh.points[outside, :2].T).max() == pytest.approx(SHORT.reach)
    assert np.hypot(*mesh.points[mesh.face_nodes("outer"), :2].T).max() == pytest.approx(SHORT.ring_radius)


def test_a_finer_mesh_has_more_cells_of_the_same_body():
    coarse, fine = generate(ALONE, 20.0), generate(ALONE, 5.0)
    assert fine.cell_count > coarse.cell_count
    assert silicone(fine) == pytest.approx(silicone(coarse), rel=1e-3)


def test_settings_of_other_meshes_and_wrong_dimensions_are_refused():
    with pytest.raises(MeshError, match="grading"):
        generate(SHORT, grading=0.5)
    with pytest.raises(GeometryError, match="end_plate = 4 mm: expected 0, robots have none"):
        PipeRobot(end_plate=4.0)
    with pytest.raises(GeometryError, match="modules = 2: expected 1 or 3"):
        PipeRobot(modules=2)
    with pytest.raises(GeometryError, match="half and quarter are both set"):
        PipeRobot(half=True, quarter=True)
    with pytest.raises(GeometryError, match="quarter = 1: expected True or False"):
        PipeRobot(quarter=1)
    with pytest.raises(GeometryError, match="airways = 1: expected True or False"):
        PipeRobot(airways=1)
    with pytest.raises(GeometryError, match="leaves no air in the rings: expected more than 23 mm"):
        PipeRobot(ring_radius=22.0)
    with pytest.raises(GeometryError, match="has no CAD solid"):
        SHORT.shape()
