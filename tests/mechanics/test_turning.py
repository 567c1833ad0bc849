"""Where stiff parts turn and buckle: stresses carried along Newton's steps, and the shift of unstable tangents."""

import numpy as np
import pytest

from pneumorph.errors import NotConvergedError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Clamp, Model, Phase, Prescribed, Programme, Roller, Settings, Traction, march
from pneumorph.mechanics.body import Body
from pneumorph.mechanics.shift import Shift
from pneumorph.mesh.structured import rectangle

STIFF = NeoHookean(1.0)
LENGTH, DEPTH = 20.0, 1.0


def strip(bow=0.0, depth=DEPTH, columns=16):
    """A slender strip along x, with half a wave of cosine as its imperfection."""

    def placed(x):
        rise = 0.5 * bow * (1.0 - np.cos(2.0 * np.pi * x[:, 0]))
        return np.column_stack([LENGTH * x[:, 0], depth * (x[:, 1] - 0.5) + rise])

    return rectangle(columns, 1, placed)


def last_of(model, name, value, settings=None):
    phase = Phase("load", {name: value}, first=1.0, largest=1.0, smallest=0.5)
    *_, last = march(model, Programme((phase,)), settings)
    return last


def cantilever():
    return Model(strip(), {"body": STIFF}, (Clamp("left"),), (Traction("right", (0, 1), "lift"),))


# an elastica under a dead load of 2.6 EI / L2 rises by 0.56 L (Bisshopp, Drucker, Q. Appl. Math. 3 (1945) 272)
FORCE = 2.6 * 4.0 * STIFF.mu * DEPTH**3 / 12.0 / LENGTH**2 / DEPTH
FREE = Settings(largest_step=1.0, viscosity=0.0, iterations=100)


def test_a_slender_cantilever_bends_by_half_its_length_in_one_increment_of_few_iterations():
    state = last_of(cantilever(), "lift", FORCE, FREE)
    tip = np.linalg.norm(state.model.mesh.points - [LENGTH, 0.0], axis=1).argmin()
    assert state.displacement[tip, 1] == pytest.approx(0.56 * LENGTH, rel=0.02)
    assert state.iterations <= 9


def test_with_the_stresses_of_the_place_in_the_tangent_the_same_increment_fails(monkeypatch):
    assemble = Body.assemble

    def plain(self, position, pressure, tangent=True, *, memory=None, seconds=0.0, carried=None):
        return assemble(self, position, pressure, tangent, memory=memory, seconds=seconds)

    monkeypatch.setattr(Body, "assemble", plain)
    with pytest.raises(NotConvergedError):
        last_of(cantilever(), "lift", FORCE, FREE)


def test_a_column_pressed_far_beyond_eulers_load_buckles_within_one_increment():
    """Clamped at both ends; y = A / 2 (1 - cos 2 pi x / L) is longer than its chord by (pi A)2 / (4 L)."""
    depth, shortening = 0.4, 0.02
    supports = (Clamp("left"), Prescribed("right", "x", "press"), Roller("right", "y"))
    state = last_of(Model(strip(1e-3, depth, 32), {"body": STIFF}, supports), "press", -shortening * LENGTH)
    force = -state.reactions.reshape(-1, 2)[state.model.mesh.face_nodes("right"), 0].sum()
    strain = 4.0 * np.pi**2 * depth**2 / 12.0 / LENGTH**2  # at which it buckles, Euler
    assert state.unstable_modes == 0
    assert force == pytest.approx(4.0 * STIFF.mu * depth * strain, rel=0.05)
    rise = np.abs(state.displacement[:, 1]).max()
    assert rise == pytest.approx(2.0 * LENGTH / np.pi * np.sqrt(shortening - strain), rel=0.02)


def test_a_shift_waits_for_three_unstable_tangents_rises_until_none_is_and_falls():
    shift = Shift(np.ones(2), 10.0)
    assert not shift
    assert [shift.wanted(1), shift.wanted(0), shift.wanted(2), shift.wanted(1)] == [False] * 4
    assert shift.wanted(1)
    assert shift.raised() == pytest.approx([10.0, 10.0])
    assert shift.wanted(1)
    assert shift.raised() == pytest.approx([10.0, 10.0])  # 20 in all
    assert not shift.wanted(0)
    assert shift
    assert shift.relaxed(1.0) == pytest.approx([np.sqrt(200.0)] * 2)  # between what was not enough and what was
    assert not shift.wanted(0)
    assert shift.relaxed(1.0) == pytest.approx([0.3 * np.sqrt(200.0)] * 2)
    assert not shift.wanted(0)
    assert shift.relaxed(1e-4) == pytest.approx([0.0, 0.0])
    assert not shift
    assert shift.used
    assert shift.wanted(1)  # without patience now
    assert shift.iterations == 3


def test_a_shift_of_zero_is_never_wanted():
    shift = Shift(np.ones(1), 0.0)
    assert not any(shift.wanted(3) for _ in range(10))
    assert not shift.again(5)


def test_a_saddle_is_left_once():
    shift = Shift(np.ones(1), 1.0)
    assert shift.again(7)
    assert shift.iterations == 7
    assert shift.wanted(1)
    assert not shift.again(9)
