"""Inertia and viscosity: mass, free vibration against beam theory, energy, order of the time step, relaxation."""

import numpy as np
import pytest
import scipy.sparse as sparse

from pneumorph.errors import InputError
from pneumorph.materials import NeoHookean, Prony
from pneumorph.mechanics import (
    Clamp,
    Force,
    Model,
    Phase,
    Prescribed,
    Programme,
    Roller,
    Symmetry,
    march,
)  # fmt: skip
from pneumorph.mechanics.dynamics import SCHEMES, Scheme
from pneumorph.mechanics.mass import Mass
from pneumorph.mesh.structured import box, rectangle

DENSITY = 1.1e-9
RUBBER = NeoHookean(0.3, bulk=300.0, density=DENSITY)
LENGTH, THICKNESS = 40.0, 2.0


def cantilever(material=RUBBER):
    mesh = rectangle(40, 2, width=LENGTH, height=THICKNESS)
    return Model(mesh, {"body": material}, (Clamp("left"),), (Force("right", (0, 1), "pull"),))


def swing(model, seconds, *, inertia="transient", force=2e-5, **phase):
    """Pull slowly, let go within a hundredth of the time, watch."""
    return list(
        march(
            model,
            Programme((
                Phase("pull", {"pull": force}, first=1.0, largest=1.0),
                Phase("release", {"pull": 0.0}, duration=seconds / 100, inertia=inertia),
                Phase("swing", {"pull": 0.0}, duration=seconds, inertia=inertia, **phase),
            )),
        )
    )  # fmt: skip


def tip(state):
    return float(state.displacement[state.model.mesh.face_nodes("right"), 1].mean())


def first_period():
    """Euler-Bernoulli cantilever in plane strain, incompressible: E' = 4 mu; 1.8751 is the first root."""
    inertia = THICKNESS**3 / 12.0
    stiffness, line = 4.0 * 0.3 * inertia, DENSITY * THICKNESS
    return 2.0 * np.pi / (1.875104**2 * np.sqrt(stiffness / (line * LENGTH**4)))


@pytest.mark.parametrize("mesh", [box(2, 1, 1), rectangle(2, 3)], ids=["solid", "plane"])
def test_the_mass_matrix_holds_the_whole_mass_and_is_the_same_in_the_pattern(mesh):
    held = Clamp("x0") if mesh.dimension == 3 else Clamp("left")
    model = Model(mesh, {"body": RUBBER}, (held,))
    mass = Mass(model)
    ones = np.ones_like(mesh.points)
    assert mass.times(ones).sum(axis=0) == pytest.approx(np.full(mesh.dimension, DENSITY), rel=1e-12)
    values = np.zeros(model.body.pattern.indptr[-1])
    mass.add(2.0, values)
    pattern = model.body.pattern
    upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr))
    full = upper + sparse.triu(upper, 1).T
    vector = np.random.default_rng(1).normal(size=mesh.points.shape)
    assert full @ vector.ravel() == pytest.approx(2.0 * mass.times(vector).ravel(), rel=1e-12, abs=1e-24)
    # the moment of inertia of a unit square about x = 0: exact, because x is in the shape functions
    x = np.zeros_like(mesh.points)
    x[:, 0] = mesh.points[:, 0]
    assert np.sum(x * mass.times(x)) == pytest.approx(DENSITY / 3.0, rel=1e-12)


def test_a_cantilever_swings_with_the_period_of_beam_theory():
    period = first_period()
    states = [s for s in swing(cantilever(), 2.2 * period, first=0.01, largest=0.02) if s.phase == "swing"]
    clock, height = np.array([s.clock for s in states]), np.array([tip(s) for s in states])
    up = np.flatnonzero((height[:-1] < 0.0) & (height[1:] >= 0.0))
    crossings = clock[up] - height[up] * (clock[up + 1] - clock[up]) / (height[up + 1] - height[up])
    assert len(crossings) == 2
    assert crossings[1] - crossings[0] == pytest.approx(period, rel=0.01)


def test_energy_is_conserved_but_for_the_damping_of_the_integration():
    states = swing(cantilever(), 2.0 * first_period(), first=0.01, largest=0.02)
    released = [s.energies for s in states if s.phase == "swing"]
    total = np.array([e.strain + e.kinetic for e in released])
    assert max(e.kinetic for e in released) > 0.9 * total[0]
    assert max(e.strain for e in released) > 0.9 * total[0]
    assert total[-1] == pytest.approx(total[0], rel=0.01)
    assert max(abs(e.supply + e.load - e.strain - e.kinetic - e.numerical) for e in released) < 0.005 * total[0]


def test_more_damping_by_name_loses_more_energy():
    def left(name):
        states = swing(cantilever(), first_period(), inertia=name, first=0.02, largest=0.02)
        return states[-1].energies.strain + states[-1].energies.kinetic, states[-1].energies

    transient, _ = left("transient")
    moderate, _ = left("moderate")
    settled, energies = left("quasi-static")
    assert transient > moderate > settled
    assert energies.numerical > 0.3 * energies.load


def test_the_quasi_static_scheme_ends_at_rest_in_the_static_state():
    model = cantilever()
    programme = Programme((
        Phase("pull", {"pull": 2e-5}, duration=0.1, inertia="quasi-static", largest=1.0),
        Phase("wait", {"pull": 2e-5}, duration=1e3 * first_period(), inertia="quasi-static", largest=1.0),
    ))  # fmt: skip
    *_, moved = march(model, programme)
    *_, static = march(model, Programme((Phase("pull", {"pull": 2e-5}),)))
    assert moved.displacement == pytest.approx(static.displacement, abs=1e-6)
    assert moved.reactions == pytest.approx(static.reactions, abs=1e-10)
    assert moved.energies.kinetic < 1e-6 * moved.energies.strain


def stepped(scheme, w, state):
    """Return (u, v, a) of u'' + w u = 0 one step of 1 s later."""
    u, v, a = state
    base = u + v + scheme.past * a
    new = -(scheme.alpha_m * a + w * (scheme.alpha_f * u + (1.0 - scheme.alpha_f) * base))
    new /= 1.0 - scheme.alpha_m + w * (1.0 - scheme.alpha_f) * scheme.beta
    return base + scheme.beta * new, v + (1.0 - scheme.gamma) * a + scheme.gamma * new, new


@pytest.mark.parametrize(("name", "order"), [("transient", 2.0), ("moderate", 2.0), ("quasi-static", 1.0)])
def test_the_steps_have_the_order_of_their_scheme(name, order):
    def error(count):
        w = (2.0 / count) ** 2  # two radians in all
        state = (1.0, 0.0, -w)
        for _ in range(count):
            state = stepped(SCHEMES[name], w, state)
        return abs(state[0] - np.cos(2.0))

    assert np.log2(error(200) / error(400)) == pytest.approx(order, abs=0.05)


@pytest.mark.parametrize("radius", [0.0, 0.5, 0.9, 1.0])
def test_the_spectral_radius_at_high_frequency_is_the_one_named(radius):
    matrix = np.column_stack([stepped(Scheme(radius, None), 1e8, unit) for unit in np.eye(3)])
    assert max(abs(np.linalg.eigvals(matrix))) == pytest.approx(radius, abs=1e-2)  # a triple root is ill-conditioned


def test_a_step_of_the_body_is_that_of_its_scheme():
    """One node free along x: a mass on a spring."""
    mesh = rectangle(1, 1)
    held = (Clamp("left"), Roller("bottom", "y"), Roller("top", "y"), Roller("right", "y"))
    model = Model(mesh, {"body": RUBBER}, held, (Force("right", (1, 0), "pull"),))
    small = 1e-4
    phases = (
        Phase("pull", {"pull": small}, first=1.0, largest=1.0),
        Phase("go", {"pull": small}, duration=1e-4, inertia="moderate", first=0.25, largest=0.25),
    )
    *_, before, after = march(model, Programme(phases))
    mass, scheme = Mass(model), SCHEMES["moderate"]
    free = np.ones(model.body.unknowns, dtype=bool)
    free[model.held] = False
    inertia = mass.times((1.0 - scheme.alpha_m) * after.acceleration + scheme.alpha_m * before.acceleration).ravel()
    forces = (1.0 - scheme.alpha_f) * after.imbalance + scheme.alpha_f * before.imbalance
    assert (inertia + forces)[free] == pytest.approx(np.zeros(free.sum()), abs=1e-7 * small)


def test_a_static_phase_after_motion_books_the_lost_motion():
    states = swing(cantilever(), 0.3 * first_period())
    moving = states[-1]
    assert moving.energies.kinetic > 0.0
    programme = Programme((
        Phase("pull", {"pull": 2e-5}, duration=0.02, inertia="transient"), Phase("stop", {"pull": 0.0}),
    ))  # fmt: skip
    states = list(march(cantilever(), programme))
    before = next(s for s in reversed(states) if s.phase == "pull")
    after = next(s for s in states if s.phase == "stop")
    assert before.energies.kinetic > 0.0
    assert after.velocity is None
    assert after.energies.kinetic == 0.0
    assert after.energies.numerical == pytest.approx(before.energies.numerical + before.energies.kinetic, rel=1e-12)


# --- viscous materials

PRONY = Prony((0.3, 0.2), (0.05, 2.0))


def held_stretch(*phases):
    mesh = rectangle(1, 1)
    material = NeoHookean(0.3, bulk=3000.0, prony=PRONY)
    moved = Prescribed("right", "x", "stretch")
    model = Model(mesh, {"body": material}, (Symmetry("left"), Roller("bottom", "y"), moved))
    return list(march(model, Programme(phases)))


def pull(state):
    return float(state.reactions.reshape(-1, 2)[state.model.mesh.face_nodes("right"), 0].sum())


def test_the_force_of_a_held_stretch_relaxes_as_the_prony_series():
    states = held_stretch(
        Phase("jump", {"stretch": 0.5}, first=1.0, largest=1.0, duration=1e-6),
        Phase("hold", {"stretch": 0.5}, duration=6.0, first=0.001, largest=0.05),
        Phase("rest", {"stretch": 0.5}),
    )
    slow = pull(states[-1])
    jumped = [s for s in states if s.phase == "jump"][-1]
    assert pull(jumped) / slow == pytest.approx(1.0 / PRONY.long_term_share, rel=1e-4)
    held = [s for s in states if s.phase == "hold"]
    expected = PRONY.relaxation([s.clock for s in held])
    assert [pull(s) / slow for s in held] == pytest.approx(expected, rel=1e-4)


def test_a_cycle_loses_energy_in_the_overstresses_and_the_balance_closes():
    count = 100
    step = {"first": 1.0 / count, "largest": 1.0 / count}
    states = held_stretch(
        Phase("out", {"stretch": 0.3}, duration=0.5, **step),
        Phase("back", {"stretch": 0.0}, duration=0.5, **step),
        Phase("rest", {"stretch": 0.0}, duration=100.0, first=0.01, largest=0.2),
    )
    energies = states[-1].energies
    assert energies.viscous > 0.05 * max(s.energies.strain for s in states)
    assert abs(energies.load - energies.viscous - energies.strain) < 0.01 * energies.viscous


def test_without_time_a_viscous_material_answers_with_its_long_term_stiffness():
    slow = held_stretch(Phase("pull", {"stretch": 0.5}))[-1]
    model = slow.model
    elastic = Model(model.mesh, {"body": NeoHookean(0.3, bulk=3000.0)}, model.supports)
    *_, plain = march(elastic, Programme((Phase("pull", {"stretch": 0.5}),)))
    assert slow.displacement == pytest.approx(plain.displacement, abs=1e-12)


# --- bad input


def test_inertia_without_a_density_is_refused():
    model = cantilever(NeoHookean(0.3, bulk=300.0))
    with pytest.raises(InputError, match="inertia needs a density for the material of 'body', which has none"):
        next(march(model, Programme((Phase("p", {"pull": 1e-5}, duration=1.0, inertia="moderate"),))))


def test_an_unknown_scheme_and_inertia_without_a_duration_are_refused():
    with pytest.raises(InputError, match=r"inertia = 'fast', allowed: transient, moderate, quasi-static"):
        Phase("p", {"pull": 1.0}, duration=1.0, inertia="fast")
    with pytest.raises(InputError, match="phase 'p': inertia needs a duration"):
        Phase("p", {"pull": 1.0}, inertia="moderate")
