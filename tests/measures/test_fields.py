"""Stress and stretch against closed forms: homogeneous stretch, rigid rotation, thick-walled tube."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.closed_form import thick_wall
from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.measures import LargestStress, MeanStress, ReactionForce, StressAt, along_path, at_points
from pneumorph.mechanics import Cavity, Clamp, Force, Model, Phase, Prescribed, Programme, Roller, Traction, march
from pneumorph.mechanics.fields import fields, principal_stretches, to_nodes
from pneumorph.mechanics.state import rest
from pneumorph.mesh import box, rectangle


@pytest.fixture(scope="module")
def pulled():
    """A block 2 x 1 x 1 mm stretched to 1.5 times its length, free across."""
    model = Model(
        box(2, 1, 1, lengths=(2.0, 1.0, 1.0), distortion=0.2),
        {"body": Yeoh(0.11, 0.03, bulk=1e4)},
        (Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z"), Prescribed("x1", "x", "pull")),
    )
    *_, state = march(model, Programme((Phase("pull", {"pull": 1.0}, first=0.2, largest=0.5),)))
    return state


def test_a_uniaxial_pull_has_the_exact_stress_and_stretches(pulled):
    stress = 1.5 * Yeoh(0.11, 0.03).uniaxial_tension(1.5)
    for part in fields(pulled):
        np.testing.assert_allclose(part.stress[..., 0, 0], stress, rtol=1e-4)
        np.testing.assert_allclose(part.stress[..., 1, 1], 0.0, atol=1e-4 * stress)
        stretches = principal_stretches(part.gradient)
        np.testing.assert_allclose(
            stretches, [[[1.5, 1.5**-0.5, 1.5**-0.5]]] * np.ones((*stretches.shape[:2], 1)), rtol=1e-4
        )
    for quantity in ("von_mises", "largest_principal_stress", "stress_xx"):
        for measure in (LargestStress(quantity), MeanStress(quantity), StressAt((0.7, 0.3, 0.4), quantity)):
            assert measure(pulled) == pytest.approx(stress, rel=1e-4)
            assert measure.kind == "stress"
    assert MeanStress("mean_stress")(pulled) == pytest.approx(stress / 3, rel=1e-4)
    assert MeanStress("smallest_stretch", domain="body")(pulled) == pytest.approx(1.5**-0.5, rel=1e-4)
    assert MeanStress("smallest_stretch", domain="body").name == "average_smallest_stretch:body"


def test_reaction_balances_the_pull(pulled):
    force = Yeoh(0.11, 0.03).uniaxial_tension(1.5)
    assert ReactionForce("x1", "x")(pulled) == pytest.approx(force, rel=1e-4)
    assert ReactionForce("x0", "x")(pulled) == pytest.approx(-force, rel=1e-4)
    assert ReactionForce("x0")(pulled) == pytest.approx(force, rel=1e-4)


@pytest.mark.parametrize("kind", ["tetra10", "wedge18"])
def test_a_rigid_rotation_has_no_stress(kind):
    model = Model(box(1, 1, 2, kind), {"body": NeoHookean(0.1)}, (Clamp("z0"),))
    c, s = np.cos(2.0), np.sin(2.0)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    state = replace(rest(model), displacement=model.mesh.points @ (turn - np.eye(3)).T)
    (part,) = fields(state)
    np.testing.assert_allclose(part.stress, 0.0, atol=1e-14)
    np.testing.assert_allclose(part.gradient, np.broadcast_to(turn, part.gradient.shape), atol=1e-13)
    assert LargestStress("largest_stretch")(state) == pytest.approx(1.0)


def tube(space):
    """A wall of 10 to 15 mm under pressure: a quarter ring in plane strain, or a ring about the axis."""
    if space == "plane_strain":

        def mapping(p):
            return np.column_stack([p[:, 0] * np.cos(p[:, 1]), p[:, 0] * np.sin(p[:, 1])])

        mesh = rectangle(6, 10, lambda p: mapping(p * [5.0, np.pi / 2] + [10.0, 0.0]))
        supports = (Roller("bottom", "y"), Roller("top", "x"))
        cavity = Cavity("cavity", ("left",), mirrors=("bottom", "top"))
    else:
        mesh = rectangle(6, 2, lambda p: p * [5.0, 4.0] + [10.0, 0.0], space="axisymmetric")
        supports = (Roller("bottom", "y"), Roller("top", "y"))
        cavity = Cavity("cavity", ("left",), mirrors=("bottom", "top"))
    return Model(mesh, {"body": NeoHookean(0.1)}, supports, (), (cavity,))


@pytest.mark.parametrize("space", ["plane_strain", "axisymmetric"])
def test_the_stress_of_a_thick_tube_is_the_exact_one(space):
    model = tube(space)
    *_, state = march(model, Programme((Phase("inflate", {"cavity": 0.03}, first=0.5, largest=0.5),)))
    material = model.materials["body"]
    inner = thick_wall.tube_inner_radius(material, 10.0, 15.0, 0.03)
    height = 2.0 if space == "axisymmetric" else 0.0
    path = along_path(
        state, [[10.0, height], [15.0, height]], ("stress_xx", "stress_yy", "stress_zz", "largest_stretch"), samples=9
    )
    exact = thick_wall.tube_state(material, 10.0, 15.0, inner, path.place[:, 0])
    scale = exact.hoop_stress.max()
    hoop, axial = ("stress_zz", "stress_yy") if space == "axisymmetric" else ("stress_yy", "stress_zz")
    np.testing.assert_allclose(path.values["stress_xx"], exact.radial_stress, atol=0.03 * scale)
    np.testing.assert_allclose(path.values[hoop], exact.hoop_stress, atol=0.03 * scale)
    np.testing.assert_allclose(path.values[axial], exact.axial_stress, atol=0.03 * scale)
    np.testing.assert_allclose(path.values["largest_stretch"], exact.position / path.place[:, 0], rtol=5e-3)
    assert path.distance[-1] == pytest.approx(5.0)
    value, place = LargestStress("largest_principal_stress").place(state)
    assert np.hypot(*(place if space == "plane_strain" else (place[0], 0.0))) < 10.6
    assert value == pytest.approx(exact.hoop_stress[0], rel=0.1)


def test_the_axis_of_a_ring_has_the_radial_stretch_as_hoop_stretch():
    model = Model(rectangle(2, 2, space="axisymmetric"), {"body": NeoHookean(0.1)}, (Roller("bottom", "y"),))
    state = replace(rest(model), displacement=model.mesh.points * [0.1, 0.0])
    np.testing.assert_allclose(at_points(state, np.array([[0.0, 0.5]]), "largest_stretch"), 1.1, rtol=1e-12)


def test_a_force_on_a_face_gives_its_opposite_as_reaction():
    model = Model(
        box(3, 1, 1, lengths=(3.0, 1.0, 1.0)),
        {"body": NeoHookean(0.1)},
        (Clamp("x0"),),
        (Force("x1", (0, 0, 1), "tip"),),
    )
    *_, state = march(model, Programme((Phase("push", {"tip": 1e-3}, first=0.5, largest=0.5),)))
    assert ReactionForce("x0", "z")(state) == pytest.approx(-1e-3, rel=1e-6)
    assert ReactionForce("x0", "x")(state) == pytest.approx(0.0, abs=1e-9)


def test_averages_at_nodes_leave_other_domains_out():
    mesh = box(1, 1, 1)
    model = Model(mesh, {"body": NeoHookean(0.1)}, (Clamp("x0"),), (Traction("x1", (1, 0, 0), "t"),))
    with pytest.raises(ValueError, match="at least one block"):
        to_nodes(mesh, [], lambda part: part.stress)
    with pytest.raises(NameNotFoundError, match=r"domain 'bdy'.*'body'"):
        MeanStress(domain="bdy")(rest(model))


def test_wrong_quantities_points_and_paths_are_refused(pulled):
    for make in (LargestStress, MeanStress, lambda q: StressAt((0.0, 0.0, 0.0), q)):
        with pytest.raises(NameNotFoundError, match=r"quantity 'vonmises'.*'von_mises'"):
            make("vonmises")
    with pytest.raises(InputError, match=r"\(9, 0, 0\) mm lies outside"):
        StressAt((9.0, 0.0, 0.0))(pulled)
    with pytest.raises(InputError, match=r"expected \(n, 3\)"):
        StressAt((9.0, 0.0))(pulled)
    with pytest.raises(InputError, match="at least two corners"):
        along_path(pulled, [[0.0, 0.0, 0.0]])
    with pytest.raises(InputError, match="corners coincide"):
        along_path(pulled, [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
