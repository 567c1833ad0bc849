"""Where Newton's method begins in contact: at a prediction that pushes into a barrier, or at the last state."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Contact, Gravity, HalfSpace, Model, Phase, Programme, Settings, Symmetry, march
from pneumorph.mechanics.increments import Increment, Trial
from pneumorph.mechanics.newton import Newton
from pneumorph.mesh import box

RUBBER = NeoHookean(0.3, bulk=30.0, density=1.1e-9)
SIDES = (Symmetry("x0"), Symmetry("y0"))
HEAVY = 2e7  # mm/s2: the weight of a cube of 1 mm is 0.022 N then
REACH = 0.01


@pytest.fixture(scope="module")
def states():
    """A cube on the ground that gets heavier."""
    ground = Contact("ground", ("z0",), HalfSpace((0, 0, -0.5 * REACH), (0, 0, 1)), reach=REACH)
    model = Model(box(2, 2, 2), {"body": RUBBER}, SIDES, loads=(Gravity((0, 0, -1)),), contacts=(ground,))
    programme = Programme((Phase("load", {"gravity": HEAVY}, first=0.25, largest=0.25),))
    return list(march(model, programme))


def begun(states, displacement):
    """Return where the increment from the third state to the fourth begins, given a predicted displacement."""
    last, after = states[2], states[3]
    prediction = Trial(displacement, after.pressure_modes, np.zeros(0), last.model.contact.ways(after.values))
    newton = Newton(last.model, Settings())
    return newton.start(prediction, after.values, Increment(last, 0.0, None, 0.25)).displacement


def test_a_prediction_that_is_in_balance_is_kept(states):
    assert begun(states, states[3].displacement) == pytest.approx(states[3].displacement, abs=1e-12)


def test_a_prediction_deep_in_a_barrier_gives_way_to_the_last_state(states):
    pushed = states[2].displacement.copy()
    pushed[:, 2] -= 0.6 * states[2].touches["ground"].distance
    assert begun(states, pushed) == pytest.approx(states[2].displacement, abs=0.0)


def test_a_prediction_through_an_obstacle_does_not_go_through(states):
    pushed = states[2].displacement.copy()
    pushed[:, 2] -= 1.0
    start = begun(states, pushed)
    assert (states[2].model.mesh.points + start)[:, 2].min() > -0.5 * REACH


def test_without_contact_the_prediction_counts(states):
    model = Model(box(2, 2, 2), {"body": RUBBER}, (*SIDES, Symmetry("z0")))
    last = replace(states[2], model=model, values={}, touches={})
    predicted = Trial(np.full_like(last.displacement, 0.3), last.pressure_modes, np.zeros(0))
    assert Newton(model, Settings()).start(predicted, {}, Increment(last, 0.0, None, 0.25)) is predicted
