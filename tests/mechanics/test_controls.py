"""What holds whatever the control, the step, the place in space: curves, energies, reactions and stability."""

import numpy as np
import pytest

from pneumorph.errors import InputError, NotConvergedError
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Force,
    Gravity,
    Model,
    Phase,
    Prescribed,
    Programme,
    Roller,
    Settings,
    Symmetry,
    Traction,
    VolumeSupply,
    march,
)  # fmt: skip
from pneumorph.mechanics.newton import Increment, Newton, Trial
from pneumorph.mechanics.state import rest
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.structured import box, rectangle
from pneumorph.mesh.topology import boundary

RUBBER = NeoHookean(0.3, bulk=300.0)


def without(mesh, removed):
    """Return the mesh without its cells whose centres `removed` names, the new faces under the names it gives.

    removed: centres (cells, d) -> name of each cell's hole, '' for those that stay.
    """
    (block,) = mesh.blocks
    names = removed(mesh.points[block.nodes].mean(axis=1))
    kept, inverse = np.unique(block.nodes[names == ""], return_inverse=True)
    number = np.full(len(mesh.points), -1)
    number[kept] = np.arange(len(kept))
    blocks = (CellBlock(block.kind, block.domain, inverse.reshape(-1, block.nodes.shape[1])),)
    faces = {
        name: tuple(FaceBlock(part.kind, number[part.nodes]) for part in parts) for name, parts in mesh.faces.items()
    }
    skin = boundary(blocks)
    for name in np.unique(names[names != ""]):
        inside = np.isin(kept, block.nodes[names == name])
        faces[name] = tuple(FaceBlock(part.kind, part.nodes[inside[part.nodes].all(axis=1)]) for part in skin)
    return Mesh(mesh.points[kept], blocks, faces, mesh.space)


def hollow(mapping=None):
    """A box of 3 x 3 x 3 mm with a cube of 1 mm missing in its middle."""
    holes = without(
        box(3, 3, 3, lengths=(3.0, 3.0, 3.0)),
        lambda x: np.where((np.abs(x - 1.5) < 0.5).all(axis=1), "hole", ""),
    )
    points = holes.points if mapping is None else mapping(holes.points)
    return Mesh(points, holes.blocks, holes.faces)


def two_holes():
    """A plane beam with one hole in each half, the lower one nearer to the bottom."""

    def removed(x):
        row = (x[:, 1] > 1.0) & (x[:, 1] < 2.0)
        return np.where(
            row & (np.abs(x[:, 0] - 1.5) < 0.5), "a", np.where(row & (np.abs(x[:, 0] - 4.5) < 0.5), "b", "")
        )

    return without(rectangle(6, 4, width=6.0, height=4.0), removed)


def ring(cells=2, supply=None):
    def bent(x):
        radius, angle = 5.0 + 2.0 * x[:, 0], 0.5 * np.pi * x[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    mesh = rectangle(cells, 3 * cells, bent)
    cavity = Cavity("c", ("left",), *([supply] if supply else []), mirrors=("bottom", "top"))
    return Model(mesh, {"body": Yeoh(0.11, 0.03, bulk=200.0)}, (Symmetry("bottom"), Symmetry("top")), (), (cavity,))


def run(model, *phases, settings=None):
    return list(march(model, Programme(phases), settings))


def even(name, targets, count, marks=()):
    """A phase of equal increments."""
    return Phase(name, targets, marks, first=1.0 / count, largest=1.0 / count)


# --- control and step size


def test_pressure_and_volume_control_give_one_curve_whatever_the_steps():
    marks = (0.25, 0.6)
    curve = {}
    for first, largest in ((0.05, 0.1), (0.3, 0.5), (1.0, 1.0)):
        states = run(ring(), Phase("inflate", {"c": 0.04}, marks, first, largest))
        at = [state for state in states if any(abs(state.time - mark) < 1e-12 for mark in (*marks, 1.0))]
        found = np.array([state.volume["c"] for state in at])
        assert len(found) == 3
        assert found == pytest.approx(curve.setdefault("volume", found), rel=1e-6)
    added = curve["volume"] - states[0].volume["c"]
    for first, largest in ((0.05, 0.1), (0.5, 0.5)):
        marked = tuple(added[:2] / added[2])
        states = run(ring(supply=VolumeSupply()), Phase("fill", {"c": added[2]}, marked, first, largest))
        at = [state for state in states if any(abs(state.time - mark) < 1e-12 for mark in (*marked, 1.0))]
        assert [state.pressure["c"] for state in at] == pytest.approx([0.01, 0.024, 0.04], rel=1e-6)


def test_marks_and_the_ends_of_phases_are_hit_exactly():
    states = run(
        ring(1),
        Phase("up", {"c": 0.02}, (1.0 / 3.0, 0.7, 0.71), first=0.3, largest=0.3),
        Phase("down", {"c": -0.005}, (0.5,)),
    )
    times = [state.time for state in states]
    assert {0.0, 1.0 / 3.0, 0.7, 0.71, 1.0, 1.5, 2.0} <= set(times)
    assert times == sorted(times)
    pressures = {state.time: state.pressure["c"] for state in states}
    expected = {1.0 / 3.0: 0.02 / 3.0, 0.7: 0.014, 0.71: 0.0142, 1.0: 0.02, 1.5: 0.0075, 2.0: -0.005}
    assert {time: pressures[time] for time in expected} == pytest.approx(expected, rel=1e-9)
    assert [state.index for state in states] == list(range(len(states)))
    assert {state.phase for state in states} == {"rest", "up", "down"}
    assert states[-1].volume["c"] < states[0].volume["c"]


def test_a_way_back_to_zero_ends_at_rest():
    states = run(ring(1), even("up", {"c": 0.03}, 2), even("down", {"c": 0.0}, 2))
    assert np.abs(states[2].displacement).max() > 0.1
    assert np.abs(states[-1].displacement).max() < 1e-6
    assert states[-1].energies.strain == pytest.approx(0.0, abs=1e-9)


# --- invariance


def rotation(axis, angle):
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def test_a_rigid_rotation_of_the_whole_model_changes_nothing():
    turn = rotation((1.0, -2.0, 0.5), 1.1)
    results = []
    for mapping in (None, lambda x: x @ turn.T + [3.0, -20.0, 7.0]):
        cavity = Cavity("c", ("hole",))
        model = Model(hollow(mapping), {"body": RUBBER}, (Clamp("x0"),), (), (cavity,))
        results.append(run(model, even("inflate", {"c": 0.3}, 2))[-1])
    still, turned = results
    assert np.abs(still.displacement).max() > 0.1
    assert still.volume["c"] > 1.2
    assert turned.volume["c"] == pytest.approx(still.volume["c"], rel=1e-8)
    assert turned.energies.strain == pytest.approx(still.energies.strain, rel=1e-8)
    assert turned.energies.supply == pytest.approx(still.energies.supply, rel=1e-8)
    assert turned.displacement == pytest.approx(still.displacement @ turn.T, abs=1e-7)
    assert turned.smallest_volume_ratio == pytest.approx(still.smallest_volume_ratio, rel=1e-8)


def test_two_like_cavities_answer_alike_and_each_has_its_own_pressure():
    mesh = two_holes()
    supports = (Roller("left", "x"), Roller("right", "x"), Roller("bottom", "y"))
    cavities = (Cavity("a", ("a",)), Cavity("b", ("b",), VolumeSupply()))
    both = run(Model(mesh, {"body": RUBBER}, supports, (), cavities), even("fill", {"a": 0.1, "b": 0.2}, 2))[-1]
    assert both.pressure["a"] == pytest.approx(0.1)
    assert both.volume["b"] == pytest.approx(1.2, rel=1e-9)
    assert both.volume["a"] > 1.02
    # at the pressure that the second found, pressure control gives the same state
    cavities = (Cavity("a", ("a",)), Cavity("b", ("b",)))
    targets = {"a": 0.1, "b": both.pressure["b"]}
    again = run(Model(mesh, {"body": RUBBER}, supports, (), cavities), even("fill", targets, 2))[-1]
    assert again.displacement == pytest.approx(both.displacement, abs=1e-7)
    assert again.volume == pytest.approx(dict(both.volume), rel=1e-7)
    # the one that stays at zero pressure while the other is filled is squeezed
    alone = run(Model(mesh, {"body": RUBBER}, supports, (), cavities), even("fill", {"b": 0.3}, 2))[-1]
    assert alone.pressure["a"] == 0.0
    assert alone.volume["a"] < 1.0 < alone.volume["b"]


# --- energies, loads and reactions


def imbalance(model, targets, count):
    state = run(model, even("load", targets, count))[-1]
    energies = state.energies
    assert energies.strain > 0.0
    left = energies.supply + energies.load - energies.strain - energies.viscous
    assert energies.relative_error == pytest.approx(left / max(energies.strain, energies.supply, energies.load))
    return abs(left) / energies.strain


@pytest.mark.parametrize("control", ["pressure", "volume", "displacement", "force"])
def test_the_energy_balance_closes_with_the_square_of_the_step(control):
    block = rectangle(3, 3)
    if control == "pressure":
        model, targets = ring(), {"c": 0.04}
    elif control == "volume":
        model, targets = ring(supply=VolumeSupply()), {"c": 8.0}
    elif control == "displacement":
        model = Model(block, {"body": RUBBER}, (Clamp("left"), Prescribed("right", "x", "pull")))
        targets = {"pull": 0.6}
    else:
        model = Model(block, {"body": RUBBER}, (Clamp("left"),), (Force("right", (1, 0.3), "pull"),))
        targets = {"pull": 0.25}
    coarse, middle, fine = (imbalance(model, targets, count) for count in (4, 8, 16))
    assert coarse < 0.05
    assert 3.0 < coarse / middle < 5.5
    assert 3.0 < middle / fine < 5.5


def total(state):
    return state.reactions.reshape(state.displacement.shape).sum(axis=0)


def test_reactions_add_up_to_the_loads():
    heavy = NeoHookean(0.3, bulk=300.0, density=1e-9)
    mesh = hollow()
    loads = (
        Gravity((0, 0, -2)), Traction("x1", (1, 0, 0), "pull"), Force("y1", (0, 3, 4), "push"),
    )  # fmt: skip
    model = Model(mesh, {"body": heavy}, (Clamp("x0"),), loads, (Cavity("c", ("hole",)),))
    targets = {"gravity": 2e7, "pull": 0.03, "push": 0.1, "c": 0.05}
    state = run(model, even("load", targets, 2))[-1]
    weight = 26.0 * 1e-9 * 2e7
    applied = np.array([0.03 * 9.0, 0.1 * 0.6, 0.1 * 0.8 - weight])
    assert weight == pytest.approx(0.52)
    assert total(state) == pytest.approx(-applied, rel=1e-6)  # the pressure in a closed cavity has no resultant
    held = np.zeros(model.body.unknowns, dtype=bool)
    held[model.held] = True
    assert not state.reactions[~held].any()


def test_a_revolved_face_bears_its_force_over_the_whole_ring():
    mesh = rectangle(2, 2, width=2.0, height=1.0, space="axisymmetric")
    heavy = NeoHookean(0.3, bulk=300.0, density=1e-9)
    supports = (Roller("left", "x"), Roller("bottom", "y"))
    loads = (Traction("top", (0, 1), "pull"), Gravity((0, -1)))
    state = run(Model(mesh, {"body": heavy}, supports, loads), even("load", {"pull": 0.02, "gravity": 1e6}, 1))[-1]
    volume = np.pi * 4.0
    assert total(state)[1] == pytest.approx(-0.02 * np.pi * 4.0 + volume * 1e-9 * 1e6, rel=1e-6)


def test_a_prescribed_displacement_does_the_work_that_is_stored():
    model = Model(box(2, 2, 2), {"body": RUBBER}, (Clamp("x0"), Prescribed("x1", "x", "pull")))
    state = run(model, even("pull", {"pull": 0.4}, 16))[-1]
    moved = state.displacement[model.mesh.face_nodes("x1")]
    assert moved[:, 0] == pytest.approx(np.full(len(moved), 0.4), rel=1e-9)
    assert np.abs(moved[:, 1]).max() > 0.01
    assert state.energies.load == pytest.approx(state.energies.strain, rel=2e-3)
    assert state.energies.supply == 0.0


# --- stability


def arch():
    """A shallow arch between clamps, pushed down from above: it snaps through."""

    def raised(x):
        return np.column_stack([10.0 * x[:, 0], 1.5 * np.sin(np.pi * x[:, 0]) + 0.3 * (x[:, 1] - 0.5)])

    mesh = rectangle(16, 1, raised)
    load = Traction("top", (0, -1), "push")
    return Model(mesh, {"body": RUBBER}, (Clamp("left"), Clamp("right")), (load,))


def test_an_arch_snaps_through_under_its_load_and_the_lost_energy_is_recorded():
    states = run(arch(), Phase("push", {"push": 0.004}, first=0.05, largest=0.05))
    assert states[-1].time == 1.0
    lost = np.array([state.energies.viscous for state in states])
    assert lost[-1] > 0.0
    assert (np.diff(lost) >= 0.0).all()
    snapped = int(np.argmax(lost > 0.0))
    assert not lost[:snapped].any()
    assert [state.unstable_modes for state in states] == [0] * len(states)
    # symmetric rest: the crown rises 1.5 mm above the clamps, and hangs below them in the end
    crown = np.argmin(np.abs(states[0].model.mesh.points - [5.0, 1.65]).sum(axis=1))
    assert states[-1].positions[crown, 1] < -1.0


def test_the_energy_lost_in_a_snap_closes_the_balance():
    """One increment goes over the whole snap: nearly all that the load gives at its new value is lost."""
    state = run(arch(), even("push", {"push": 0.002}, 1))[-1]
    assert state.energies.viscous > 0.5 * state.energies.load
    assert abs(state.energies.relative_error) < 0.1


def balloon(supply=None):
    def bent(x):
        radius, angle = 10.0 + 0.5 * x[:, 0], 0.5 * np.pi * x[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    mesh = rectangle(1, 6, bent, space="axisymmetric")
    cavity = Cavity("c", ("left",), *([supply] if supply else []), mirrors=("bottom",))
    return Model(mesh, {"body": RUBBER}, (Symmetry("bottom"), Symmetry("top")), (), (cavity,))


def test_a_balloon_past_its_maximum_is_stable_at_fixed_volume_and_unstable_at_fixed_pressure():
    model = balloon(VolumeSupply())
    states = run(model, even("fill", {"c": 8.0 * 2094.4}, 20))
    pressure = [state.pressure["c"] for state in states]
    top = int(np.argmax(pressure))
    assert 2 < top < 18
    free = balloon()
    for state, expected in ((states[top - 2], 0), (states[top + 2], 1), (states[-1], 1)):
        trial = Trial(state.displacement, state.pressure_modes, np.array([state.pressure["c"]]))
        found = Newton(free, Settings()).solve(trial, state.pressure, Increment(state))
        assert found.trial.displacement == pytest.approx(state.displacement, abs=1e-5)
        assert state.unstable_modes == 0
        assert found.unstable_modes == expected


@pytest.mark.parametrize("viscosity", [0.0, 100.0])
def test_a_balloon_over_its_pressure_maximum_stops_with_the_reason_and_its_states(viscosity):
    states = []
    programme = Programme((Phase("blow", {"c": 0.02}, first=0.2, largest=0.2, smallest=0.01),))
    with pytest.raises(NotConvergedError, match=r"stopped in phase 'blow' at 0\.\d+ of it, state \d+: .+increment"):
        states.extend(march(balloon(), programme, Settings(viscosity=viscosity)))
    assert len(states) > 4
    assert 0.8 < states[-1].time < 1.0
    assert states[-1].pressure["c"] == pytest.approx(0.02 * states[-1].time)


def test_near_the_solution_one_factorisation_serves_several_iterations(monkeypatch):
    model = Model(hollow(), {"body": RUBBER}, (Clamp("x0"),), cavities=(Cavity("hole", ("hole",)),))
    newton = Newton(model, Settings(tolerance=1e-12))
    calls = []
    factorise = newton.linear.factorise
    monkeypatch.setattr(newton.linear, "factorise", lambda matrix: (calls.append(1), factorise(matrix)))
    zero = np.zeros_like(model.mesh.points)
    start = Trial(zero, model.body.zero_pressure(), np.zeros(1))
    found = newton.solve(start, {"hole": 0.05}, Increment(rest(model)))
    assert len(calls) < found.iterations
    # the same state as full steps alone lead to
    exact = newton.solve(found.trial, {"hole": 0.05}, Increment(rest(model)))
    assert found.trial.displacement == pytest.approx(exact.trial.displacement, abs=1e-9)


def test_the_clock_adds_up_the_durations_of_the_phases():
    programme = Programme((
        Phase("a", {"x": 1.0}, duration=2.0), Phase("b", {"x": 0.5}), Phase("c", {"x": 0.0}, duration=0.5),
    ))  # fmt: skip
    assert [programme.clock(t) for t in (0.0, 0.5, 1.0, 1.7, 2.0, 2.5, 3.0)] == [0.0, 1.0, 2.0, 2.0, 2.0, 2.25, 2.5]


def test_a_duration_that_is_not_positive_is_refused():
    with pytest.raises(InputError, match=r"phase 'a': duration = 0.0 s, allowed: more than 0"):
        Phase("a", {"x": 1.0}, duration=0.0)
