"""Contact pressure: where a block is pressed evenly it is the pressure, on both kinds of contact."""

import numpy as np
import pytest

from pneumorph.errors import NameNotFoundError
from pneumorph.materials import LinearElastic
from pneumorph.measures import LargestDisplacement, MeanContactPressure, contact_pressure
from pneumorph.mechanics import Clamp, Contact, HalfSpace, Model, Phase, Programme, Roller, Traction
from pneumorph.mechanics.state import rest
from pneumorph.mesh import box
from pneumorph.mesh.assembly import Placement, assembled
from pneumorph.solution import solve

PRESSURE, SIDE, GAP = 0.01, 4.0, 0.05
SOFT = LinearElastic(1.0, 0.0)  # without Poisson's ratio an even pressure stays even


def model(kind, below, reach=2.0 * GAP):
    """Return a block that a traction may press evenly on the ground, or on another block."""
    block = box(2, 2, 1, kind, lengths=(SIDE, SIDE, 2.0))
    mesh, extra, against = block, (), HalfSpace((0.0, 0.0, -GAP), (0.0, 0.0, 1.0))
    if below == "block":
        mesh = assembled(block, {"low": Placement(shift=(0.0, 0.0, -2.0 - GAP))(block)})
        extra, against = (Clamp("low.z0"),), ("low.z1",)
    sides = tuple(Roller(face, axis) for face, axis in (("x0", "x"), ("y0", "y")))
    return Model(
        mesh,
        dict.fromkeys(mesh.domains, SOFT),
        (*sides, *extra),
        (Traction("z1", (0.0, 0.0, -1.0), "press"),),
        contacts=(Contact("ground", ("z0",), against, reach=reach, stiffness=0.01),),
    )


def pressed(kind, below):
    """Return the last state of that block when it is pressed."""
    return solve(model(kind, below), Programme((Phase("press", {"press": PRESSURE}),))).states[-1]


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron27"])
@pytest.mark.parametrize("below", ["ground", "block"])
def test_an_even_pressure_is_found_as_mean_and_at_the_nodes(kind, below):
    state = pressed(kind, below)
    assert MeanContactPressure("ground")(state) == pytest.approx(PRESSURE, rel=0.02)
    field = contact_pressure(state)
    here = state.model.mesh.face_nodes("z0")
    elsewhere = np.ones(len(field), dtype=bool)
    elsewhere[here] = False
    if below == "block":
        elsewhere[state.model.mesh.face_nodes("low.z1")] = False
    assert (field[elsewhere] == 0.0).all()
    assert np.median(field[here]) == pytest.approx(PRESSURE, rel=0.1)
    np.testing.assert_array_equal(contact_pressure(state, "ground"), field)


def test_nothing_bears_before_anything_touches():
    state = rest(model("hexahedron27", "block", reach=0.5 * GAP))
    assert MeanContactPressure("ground")(state) == 0.0
    assert not contact_pressure(state).any()


def test_unknown_contacts_and_domains_are_refused_with_the_nearest():
    state = pressed("hexahedron27", "ground")
    with pytest.raises(NameNotFoundError, match="unknown contact 'grund': did you mean 'ground'"):
        contact_pressure(state, "grund")
    with pytest.raises(NameNotFoundError, match="unknown domain 'bdy': did you mean 'body'"):
        LargestDisplacement(("bdy",))(state)
    assert LargestDisplacement(("body",))(state) == LargestDisplacement()(state) > 0.0
