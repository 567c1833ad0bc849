"""Measures of a body in a pipe: its circumscribed diameter, and how hard it is pressed on all around."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import NeoHookean
from pneumorph.measures import CircumscribedDiameter, NormalForce
from pneumorph.mechanics import Contact, HalfSpace, Model, Pipe, Symmetry
from pneumorph.mechanics.contact.barrier import barrier
from pneumorph.mechanics.state import rest
from pneumorph.mesh import box, rectangle

RUBBER = {"body": NeoHookean(0.3)}
REACH = 0.1


def ring(quarter, turned=0.0):
    """Return a tube of radii 8 and 10, 5 long, or a quarter of it."""
    span = 0.5 * np.pi if quarter else 1.5 * np.pi

    def bent(points):
        radius, angle = 8.0 + points[:, 0], turned + points[:, 1] * span
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), points[:, 2]])

    return box(1, 6 if quarter else 18, 1, "hexahedron27", bent, lengths=(2.0, 1.0, 5.0))


def cut():
    return (Symmetry("y0"), Symmetry("y1"))


def test_the_circle_around_a_quarter_with_its_images_is_that_around_the_whole():
    state = rest(Model(ring(True), RUBBER, cut(), contacts=(far(),)))
    assert CircumscribedDiameter(("x1",))(state) == pytest.approx(20.0, rel=1e-9)


def test_the_circle_goes_through_the_corners_of_a_box_and_looks_along_its_axis():
    mesh = box(1, 1, 1, "hexahedron27", lengths=(3.0, 4.0, 12.0))
    state = rest(Model(mesh, RUBBER, contacts=(Contact("far", ("x0",), HalfSpace((-5, 0, 0), (1, 0, 0))),)))
    faces = ("x0", "x1")
    assert CircumscribedDiameter(faces)(state) == pytest.approx(5.0)
    assert CircumscribedDiameter(faces, axis=(2.0, 0.0, 0.0))(state) == pytest.approx(np.hypot(4.0, 12.0))
    stretched = replace(state, displacement=mesh.points * [1.0, 0.0, 0.0])
    assert CircumscribedDiameter(faces)(stretched) == pytest.approx(np.hypot(6.0, 4.0))


def far():
    return Contact("far", ("x1",), Pipe((0, 0, 0), 50.0, (0, 0, 1)))


@pytest.mark.parametrize("quarter", [True, False])
def test_normal_forces_add_up_around_a_pipe_though_their_resultant_vanishes(quarter):
    mesh = ring(quarter)
    supports = cut() if quarter else ()
    contact = Contact("bore", ("x1",), Pipe((0, 0, 0), 10.0 + 0.5 * REACH, (0, 0, 1)), reach=REACH, stiffness=0.2)
    state = rest(Model(mesh, RUBBER, supports, contacts=(contact,)))
    _, slope, _ = barrier(np.array([0.5 * REACH]), REACH, 0.2)  # pressure at this gap
    area = 2.0 * np.pi * 10.0 * 5.0 * (1.0 if quarter else 0.75)
    assert NormalForce("bore")(state) == pytest.approx(-slope[0] * area, rel=0.02)


def test_it_is_zero_out_of_reach():
    assert NormalForce("far")(rest(Model(ring(True), RUBBER, cut(), contacts=(far(),)))) == 0.0


def test_unknown_names_and_models_that_do_not_fit_are_refused():
    state = rest(Model(ring(True), RUBBER, cut(), contacts=(far(),)))
    with pytest.raises(NameNotFoundError, match="unknown contact 'near'"):
        NormalForce("near")(state)
    with pytest.raises(NameNotFoundError, match="unknown face 'skin'"):
        CircumscribedDiameter(("skin",))(state)
    with pytest.raises(InputError, match="no faces, expected at least one"):
        CircumscribedDiameter(())
    with pytest.raises(InputError, match="not all zero"):
        CircumscribedDiameter(axis=(0.0, 0.0, 0.0))
    plane = Contact("far", ("left",), HalfSpace((-5, 0), (1, 0)))
    with pytest.raises(InputError, match="expected a model in three dimensions"):
        CircumscribedDiameter(("left",))(rest(Model(rectangle(1, 1), RUBBER, contacts=(plane,))))
