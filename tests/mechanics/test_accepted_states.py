"""No state whose surfaces intersect is ever accepted, and creases are kept from folding through themselves."""

from itertools import pairwise

import numpy as np
import pytest

from pneumorph.errors import NotConvergedError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Block, Clamp, Contact, HalfSpace, Model, Motion, Phase, Programme, Settings, march
from pneumorph.mechanics.contact.contacts import Contacts
from pneumorph.mechanics.newton import Newton
from pneumorph.mechanics.touching import Touching
from pneumorph.mesh import rectangle

RUBBER = NeoHookean(0.3, bulk=30.0)
DOWN = Motion("press", (0, -1))
OBSTACLES = {
    "a punch": Block((0.32, 1.005), (0.68, 2.005), motion=DOWN),
    "a lid": HalfSpace((0, 1.005), (0, -1), motion=DOWN),
}


def pressed(obstacle, smallest):
    """Return a block that is touched by an obstacle, then pressed by 0.1 mm in one increment, if nothing cuts it."""
    contact = Contact("lid", ("top",), OBSTACLES[obstacle], reach=0.004)
    model = Model(rectangle(2, 2), {"body": RUBBER}, (Clamp("bottom"),), contacts=(contact,))
    phases = (
        Phase("touch", {"press": 0.005}, first=1.0, largest=1.0),
        Phase("press", {"press": 0.105}, first=1.0, largest=1.0, smallest=smallest),
    )
    return model, Programme(phases), Settings(viscosity=0.0)


def follow(model, programme, settings):
    """Return the states of a run, and how it failed or None."""
    states = []
    try:
        for state in march(model, programme, settings):
            states.append(state)
    except NotConvergedError as error:
        return states, str(error)
    return states, None


@pytest.fixture
def jumping(monkeypatch):
    """Let the predictions and steps of the solver jump over surfaces."""
    monkeypatch.setattr(Contacts, "limit", lambda self, start, end: 1.0)
    monkeypatch.setattr(
        Newton, "start", lambda self, trial, values, increment: self._reachable(trial, increment.start, values)
    )


def apart(states):
    contacts = states[0].model.contact
    return all(contacts.distance(state.positions, contacts.ways(state.values)) > 0.0 for state in states)


def test_a_run_that_would_only_go_on_through_a_surface_stops_with_its_states_and_names_the_contact(jumping):
    states, failure = follow(*pressed("a punch", smallest=0.6))
    assert states[-1].time == 1.0
    assert apart(states)
    assert "surfaces of contact 'lid' between top and Block intersect at (0.32, 1) mm" in failure


def test_an_increment_that_jumped_over_a_surface_is_cut_as_any_that_fails(jumping, caplog):
    caplog.set_level("INFO", logger="pneumorph")
    states, failure = follow(*pressed("a punch", smallest=0.01))
    assert failure is None
    assert states[-1].time == 2.0
    assert len(states) > 3
    assert apart(states)
    assert "intersect at" in caplog.text


@pytest.mark.parametrize("obstacle", OBSTACLES)
def test_no_obstacle_is_crossed_as_it_is(obstacle):
    states, failure = follow(*pressed(obstacle, smallest=0.01))
    assert failure is None
    assert apart(states)
    contacts, low = states[0].model.contact, states[0].positions
    ways = contacts.ways({"press": 0.105})
    assert contacts.crossing(states[-1].positions, ways) is None
    assert "'lid' between top and " in contacts.crossing(low, ways)  # where the block would be if it did not give way


@pytest.mark.parametrize(("cells", "reach"), [(10, 0.02), (200, None)])
def test_the_sides_of_a_crease_are_kept_apart_down_to_its_root(cells, reach):
    """A notch with a node in its root: its first two facets may close to no angle, and no step folds them over.

    They are not five times as large as the reach, which the default one gives way to.
    """

    def notched(points):
        x, y = points[:, 0] - 0.5, points[:, 1]
        return np.column_stack([points[:, 0], y * (1.0 - np.maximum(0.4 - 2.0 * np.abs(x), 0.0))])

    mesh = rectangle(cells, 1, notched)
    contacts = Contacts(mesh, (Contact("notch", ("top",), reach=reach),), 0.3)
    nodes = mesh.face_nodes("top")
    nodes = nodes[np.argsort(mesh.points[nodes, 0])]
    middle = int(np.argmin(np.abs(mesh.points[nodes, 0] - 0.5)))
    beside, root, other = nodes[middle - 1 : middle + 2]
    folded = mesh.points.copy()
    below = 0.2 * (mesh.points[other, 0] - mesh.points[root, 0]) * np.array([1.0, -1.0])
    folded[beside] = 0.5 * (mesh.points[root] + mesh.points[other]) + below  # the flank
    none = np.zeros(1)
    assert contacts.evaluate(mesh.points, none, None, hessian=False).energy == 0.0
    closing = mesh.points
    for _ in range(5):
        share = contacts.limit((closing, none), (folded, none))
        assert share < 1.0
        closing = closing + share * (folded - closing)
    assert contacts.crossing(closing, none) is None
    assert contacts.evaluate(closing, none, None, hessian=False).energy > 0.0
    assert contacts.crossing(folded, none) is not None


def test_where_the_exact_barrier_makes_the_tangent_indefinite_the_projected_one_leads_on(monkeypatch):
    """Else steps go to and fro about a fold in contact for ever, however small the increment."""
    asked, tangent = [], Touching.tangent

    def watched(self, values, position, ways, rubbing, exact):
        asked.append(exact)
        return tangent(self, values, position, ways, rubbing, exact)

    monkeypatch.setattr(Touching, "tangent", watched)
    monkeypatch.setattr(Newton, "_unstable", lambda self, compliance, softness: int(asked[-1]))
    states, failure = follow(*pressed("a punch", smallest=0.01))
    assert failure is None
    assert any(asked)
    for exact, after in pairwise(asked):
        assert not (exact and after)  # each exact one, indefinite, was followed by a projected one
    monkeypatch.undo()
    honest, _ = follow(*pressed("a punch", smallest=0.01))
    assert states[-1].displacement == pytest.approx(honest[-1].displacement, abs=1e-6)
