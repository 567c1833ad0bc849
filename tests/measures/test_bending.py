"""Angles, curvature and diameter of bodies moved by a formula; reactions and moments of small solves."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import NeoHookean
from pneumorph.measures import (
    CavityVolume,
    ChordAngle,
    Curvature,
    CurvatureResidual,
    Diameter,
    EnergyImbalance,
    LineLength,
    ReactionForce,
    ReactionMoment,
    TipRotation,
    TurnRate,
    centre_line,
    energy_check,
    fit_circle,
)
from pneumorph.measures.diameter import enclosing_diameter
from pneumorph.mechanics import Clamp, Energies, Force, Model, Phase, Programme, march
from pneumorph.mechanics.state import rest
from pneumorph.mesh import FaceBlock, Mesh, box, rectangle

LENGTH = 20.0
ENDS = {"clamp": "z0", "tip": "z1"}
Y = (0.0, 1.0, 0.0)


@pytest.fixture(scope="module")
def beam():
    mesh = box(2, 2, 20, mapping=lambda p: p - [1.0, 1.0, 0.0], lengths=(2.0, 2.0, LENGTH))
    sides = tuple(block for name in ("x0", "x1", "y0", "y1") for block in mesh.faces[name])
    faces = {"z0": mesh.faces["z0"], "z1": mesh.faces["z1"], "outer": sides}
    return Model(Mesh(mesh.points, mesh.blocks, faces), {"body": NeoHookean(0.1)}, (Clamp("z0"),))


def bent(model, angle):
    """Bend the beam uniformly about y, by `angle` from clamp to tip, towards +x."""
    x, y, z = model.mesh.points.T
    radius = LENGTH / angle
    turn = z / radius
    place = np.column_stack([2 * radius * np.sin(turn / 2) ** 2 + x * np.cos(turn), y, (radius - x) * np.sin(turn)])
    return replace(rest(model), displacement=place - model.mesh.points)


@pytest.mark.parametrize("angle", [1e-8, 1e-3, 0.7, 2.0, 3.5, 8.0])
def test_uniform_bending_gives_the_tip_rotation_half_of_it_as_chord_angle_and_the_curvature(beam, angle):
    state = bent(beam, angle)
    assert TipRotation(**ENDS, axis=Y)(state) == pytest.approx(angle, rel=1e-6)
    assert TipRotation(**ENDS, axis=(0.0, -2.0, 0.0))(state) == pytest.approx(-angle, rel=1e-6)
    if angle < np.pi:
        assert TipRotation(**ENDS)(state) == pytest.approx(angle, rel=1e-6)
        assert ChordAngle(**ENDS)(state) == pytest.approx(angle / 2, rel=1e-6)
        assert ChordAngle(**ENDS, axis=Y)(state) == pytest.approx(angle / 2, rel=1e-6)
    axis_line = ((0.0, 0.0, 0.5), (0.0, 0.0, LENGTH - 0.5))
    if angle > 1e-3:
        assert Curvature(**ENDS, line=axis_line)(state) == pytest.approx(angle / LENGTH, rel=1e-4)
        assert Curvature(**ENDS)(state) == pytest.approx(angle / LENGTH, rel=1e-2)
        assert Curvature(**ENDS, axis=Y)(state) == pytest.approx(angle / LENGTH, rel=1e-2)
        assert Curvature(**ENDS, axis=(0.0, -1.0, 0.0))(state) == pytest.approx(-angle / LENGTH, rel=1e-2)
    assert CurvatureResidual(Curvature(**ENDS))(state) < 1e-3 * LENGTH
    assert Diameter(0.5, **ENDS)(state) == pytest.approx(2 * np.sqrt(2), rel=2e-3)


def test_a_rigid_rotation_is_the_rotation_of_the_tip_and_leaves_a_straight_line(beam):
    c, s = np.cos(0.3), np.sin(0.3)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    state = replace(rest(beam), displacement=beam.mesh.points @ (turn - np.eye(3)).T)
    assert TipRotation(**ENDS)(state) == pytest.approx(0.3, rel=1e-12)
    assert TipRotation(**ENDS, axis=Y)(state) == pytest.approx(0.3, rel=1e-12)
    assert ChordAngle(**ENDS)(state) == pytest.approx(0.3, rel=1e-12)
    assert Curvature(**ENDS)(state) == pytest.approx(0.0, abs=1e-10)
    assert Diameter(None, **ENDS)(state) == pytest.approx(2 * np.sqrt(2), rel=1e-10)


def test_measures_at_rest_are_zero(beam):
    state = rest(beam)
    for measure in (TipRotation(**ENDS), TipRotation(**ENDS, axis=Y), ChordAngle(**ENDS), EnergyImbalance()):
        assert measure(state) == pytest.approx(0.0, abs=1e-12)
    assert Curvature(**ENDS)(state) == pytest.approx(0.0, abs=1e-12)


def test_a_plane_beam_turns_about_z(beam):
    model = Model(rectangle(10, 2, width=10.0), {"body": NeoHookean(0.1)}, (Clamp("left"),))
    x, y = model.mesh.points.T
    place = np.column_stack([(20.0 - y) * np.sin(x / 20.0), 20.0 - (20.0 - y) * np.cos(x / 20.0)])
    state = replace(rest(model), displacement=place - model.mesh.points)
    ends = {"clamp": "left", "tip": "right"}
    assert TipRotation(**ends)(state) == pytest.approx(0.5, rel=1e-9)
    assert ChordAngle(**ends)(state) == pytest.approx(0.25, rel=1e-3)
    assert Curvature(**ends)(state) == pytest.approx(1 / 19.5, rel=0.01)
    mesh = model.mesh
    both = {**mesh.faces, "outer": (*mesh.faces["top"], *mesh.faces["bottom"])}
    state = replace(
        state, model=Model(Mesh(mesh.points, mesh.blocks, both, mesh.space), model.materials, model.supports)
    )
    assert Diameter(0.5, **ends)(state) == pytest.approx(1.0, rel=1e-3)


def test_the_diameter_of_a_ring_is_twice_its_radius():
    model = Model(
        rectangle(1, 4, lambda p: np.add(p, [3.0, 0.0]), space="axisymmetric"),
        {"body": NeoHookean(0.1)},
        (Clamp("bottom"),),
    )
    state = replace(rest(model), displacement=0.25 * model.mesh.points * [1.0, 0.0])
    assert Diameter(0.4, "right", "bottom", "top")(state) == pytest.approx(10.0)


@pytest.mark.parametrize("turn", [0.01, 1.0, 4.0, 6.0])
def test_an_exact_arc_in_space_has_its_curvature(turn):
    t = np.linspace(0.0, turn, 12)
    frame = np.linalg.qr(np.array([[1.0, 2, 3], [0, 1, 4], [5, 6, 0]]))[0]
    points = 50.0 * np.column_stack([np.cos(t), np.sin(t), 0 * t]) @ frame.T + [100.0, -30.0, 7.0]
    circle = fit_circle(points)
    assert circle.curvature == pytest.approx(0.02, rel=1e-7)
    assert circle.residual < 1e-8
    assert abs(circle.normal @ frame[:, 2]) == pytest.approx(1.0)


def test_points_off_a_circle_have_their_distance_as_residual():
    t = np.arange(200) * 2 * np.pi / 200
    radius = 10.0 + 0.1 * (-1.0) ** np.arange(200)
    circle = fit_circle(np.column_stack([radius * np.cos(t), radius * np.sin(t)]))
    assert circle.residual == pytest.approx(0.1, rel=1e-6)
    assert circle.curvature == pytest.approx(0.1, rel=1e-4)


def test_a_straight_line_has_no_curvature():
    points = np.outer(np.linspace(0, 1, 7), [1.0, 2.0, 3.0])
    assert fit_circle(points).curvature == 0.0
    assert fit_circle(points[:, :2]).curvature == pytest.approx(0.0, abs=1e-9)


def test_circles_need_three_different_points():
    with pytest.raises(InputError, match="at least three"):
        fit_circle(np.zeros((2, 3)))
    with pytest.raises(InputError, match="coincide"):
        fit_circle(np.ones((4, 3)))


def test_the_smallest_circle_encloses_all_points():
    assert enclosing_diameter(np.array([[0.0, 0], [2, 0], [1, 0.5], [1, -0.5]])) == pytest.approx(2.0)
    assert enclosing_diameter(np.array([[0.0, 0], [3, 0], [0, 4]])) == pytest.approx(5.0)
    assert enclosing_diameter(np.array([[0.0, 0], [1, 1], [3, 3]])) == pytest.approx(3 * np.sqrt(2))
    t = np.linspace(0, 6, 30)
    assert enclosing_diameter(np.column_stack([np.cos(t), np.sin(t)])) == pytest.approx(2.0)


def test_a_transverse_force_has_its_moment_at_the_clamp():
    model = Model(
        box(4, 1, 1, lengths=(4.0, 1.0, 1.0)), {"body": NeoHookean(0.1)}, (Clamp("x0"),), (Force("x1", (0, 0, 1), "f"),)
    )
    states = list(march(model, Programme((Phase("push", {"f": 1e-4}, first=0.5, largest=0.5),))))
    assert ReactionMoment("x0", component="y")(states[-1]) == pytest.approx(4e-4, rel=1e-2)
    assert ReactionMoment("x0", about=(4.0, 0.5, 0.5))(states[-1]) == pytest.approx(0.0, abs=1e-5)
    assert energy_check(states) < 1e-3
    assert energy_check(states[:1]) == 0.0


def test_energy_check_sees_work_that_is_not_accounted_for():
    states = [SimpleNamespace(energies=Energies(strain=10.0, supply=8.0, load=1.0, viscous=0.5))]
    assert energy_check(states) == pytest.approx(0.15)


def test_cavity_volume_is_the_state_s():
    state = SimpleNamespace(
        volume={"cavity": 120.0}, model=SimpleNamespace(surfaces={"cavity": SimpleNamespace(reference_volume=100.0)})
    )
    assert CavityVolume("cavity")(state) == 120.0
    assert CavityVolume("cavity", added=True)(state) == pytest.approx(20.0)
    with pytest.raises(NameNotFoundError, match="cavity 'cavty'"):
        CavityVolume("cavty")(state)


def test_wrong_faces_axes_stations_and_components_are_refused(beam):
    state = bent(beam, 0.5)
    with pytest.raises(NameNotFoundError, match="face 'tip'"):
        TipRotation()(state)
    with pytest.raises(InputError, match="parallel"):
        TipRotation(**ENDS, axis=(0.0, 0.0, 1.0))(rest(beam))
    with pytest.raises(InputError, match="three numbers"):
        ChordAngle(**ENDS, axis=(0.0, 0.0, 0.0))(state)
    with pytest.raises(InputError, match="same centre"):
        ChordAngle("z0", "z0")(state)
    with pytest.raises(InputError, match="sections with nodes"):
        centre_line(state, **ENDS, sections=2)
    with pytest.raises(InputError, match="3 or more"):
        Curvature(sections=2)
    with pytest.raises(InputError, match="allowed: 0 to 1"):
        Diameter(1.5)
    with pytest.raises(InputError, match="1 or more"):
        Diameter(stations=0)
    with pytest.raises(InputError, match=r"no section at station 0\.5"):
        Diameter(0.5, "z1", **ENDS)(state)
    with pytest.raises(InputError, match="no section between"):
        Diameter(None, "z1", **ENDS)(state)
    with pytest.raises(InputError, match="axis = 'w'"):
        ReactionForce("z0", "w")(state)
    with pytest.raises(InputError, match="component = 'w'"):
        ReactionMoment("z0", component="w")
    with pytest.raises(InputError, match="expected 3 coordinates"):
        ReactionMoment("z0", about=(1.0, 2.0))(state)
    ring = Model(rectangle(1, 1, space="axisymmetric"), {"body": NeoHookean(0.1)}, (Clamp("bottom"),))
    with pytest.raises(InputError, match="no moment"):
        ReactionMoment("bottom")(rest(ring))


def test_a_closed_face_has_no_tip_rotation():
    mesh = box(1, 1, 1)
    closed = tuple(FaceBlock(b.kind, b.nodes) for blocks in mesh.faces.values() for b in blocks)
    model = Model(
        Mesh(mesh.points, mesh.blocks, {**mesh.faces, "all": closed}), {"body": NeoHookean(0.1)}, (Clamp("x0"),)
    )
    with pytest.raises(InputError, match="closed"):
        TipRotation(tip="all")(rest(model))


@pytest.mark.parametrize("angle", [1e-6, 0.7, 3.5])
def test_uniform_bending_turns_every_section_alike_and_keeps_the_length_of_the_line(beam, angle):
    state = bent(beam, angle)
    # slices of tetrahedra are not quite alike: their best rotations are off by a thousandth of the turn of a slice
    assert TurnRate(**ENDS, axis=Y)(state) == pytest.approx(angle / LENGTH, rel=1e-3)
    assert TurnRate(**ENDS, axis=(0.0, -1.0, 0.0))(state) == pytest.approx(-angle / LENGTH, rel=1e-3)
    # chords between sections: an angle a between two is short by a² / 24; section points lie inwards by as much
    assert LineLength(**ENDS)(state) == pytest.approx(LENGTH, rel=2.0 * (angle / 20) ** 2 / 24 + 1e-3)


def test_only_the_middle_half_counts_for_the_turn_rate(beam):
    """Straight up to a quarter and from three quarters on, bent between: all of the angle over half the length."""
    angle, quarter = 0.5, LENGTH / 4
    x, y, z = beam.mesh.points.T
    radius = 2 * quarter / angle
    turn = np.clip(z - quarter, 0.0, 2 * quarter) / radius
    before, after = np.minimum(z, quarter), np.maximum(z - 3 * quarter, 0.0)
    place = np.column_stack(
        [
            2 * radius * np.sin(turn / 2) ** 2 + x * np.cos(turn) + after * np.sin(turn),
            y,
            before + (radius - x) * np.sin(turn) + after * np.cos(turn),
        ]
    )
    state = replace(rest(beam), displacement=place - beam.mesh.points)
    assert TurnRate(**ENDS, axis=Y)(state) == pytest.approx(angle / (2 * quarter), rel=0.02)


def test_a_stretched_body_has_a_longer_line_and_no_turn(beam):
    state = replace(rest(beam), displacement=beam.mesh.points * [-0.1, -0.1, 0.3])
    assert LineLength(**ENDS)(state) == pytest.approx(1.3 * LENGTH, rel=1e-3)
    assert abs(TurnRate(**ENDS, axis=Y)(state)) < 1e-4
    with pytest.raises(InputError, match="sections in the middle half, expected 3 or more"):
        TurnRate(**ENDS, sections=4)(state)
