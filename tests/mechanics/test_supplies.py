"""Cavities that are filled with gas, against closed forms: balloons, tanks, cavities joined by a tube."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.optimize import brentq

from pneumorph.closed_form.tank import filling_ratio
from pneumorph.closed_form.thick_wall import sphere_pressure
from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Atmosphere,
    Cavity,
    Clamp,
    FlowSupply,
    Gas,
    GasSupply,
    Model,
    Phase,
    PressureSupply,
    Programme,
    SealedSupply,
    Settings,
    Symmetry,
    Traction,
    Tube,
    VolumeSupply,
    march,
)
from pneumorph.mechanics.newton import Increment, Newton, Trial
from pneumorph.mechanics.state import rest
from pneumorph.mechanics.supplies.orifice import REFERENCE_DENSITY
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.structured import rectangle

AIR = Atmosphere()
OUTSIDE = AIR.pressure
RUBBER = NeoHookean(0.3, bulk=3000.0)


def bowl(thickness=4.0, cells=(3, 8)):
    """A quarter of a sphere's section, revolved: inner radius 10 mm; its cavity is a hemisphere."""

    def bent(x):
        radius, angle = 10.0 + thickness * x[:, 0], 0.5 * np.pi * x[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    return rectangle(*cells, bent, space="axisymmetric")


def sphere(supply, loads=(), mesh=None):
    cavity = Cavity("c", ("left",), supply, mirrors=("bottom",))
    supports = (Symmetry("bottom"), Symmetry("top"))
    return Model(mesh or bowl(), {"body": RUBBER}, supports, loads, (cavity,))


def balloon(supply):
    return sphere(supply, mesh=bowl(0.5, (1, 6)))


def tank(supply, **changes):
    """A rigid vessel: all of its inner face is held."""
    cavities = (Cavity("c", ("left",), supply, mirrors=("bottom",)),)
    return Model(bowl(cells=(1, 6)), {"body": RUBBER}, (Clamp("left"),), cavities=cavities, **changes)


TANK = tank(PressureSupply()).surfaces["c"].reference_volume
# with this conductance the rate k of filling the tank is 1/s
ONE = TANK / (REFERENCE_DENSITY * AIR.specific)


def run(model, *phases, settings=None):
    return list(march(model, Programme(phases), settings))


def even(name, targets, count):
    """A phase of equal increments."""
    return Phase(name, targets, first=1.0 / count, largest=1.0 / count)


def at_once(name, targets, seconds=1e-9):
    """A phase of one increment."""
    return Phase(name, targets, first=1.0, largest=1.0, duration=seconds)


def absolute(states):
    return np.array([state.pressure["c"] + OUTSIDE for state in states])


# --- gas in balloons


@pytest.mark.parametrize("dead", [0.0, 5000.0])
def test_a_balloon_filled_with_a_mass_of_gas_at_constant_temperature_matches_its_closed_form(dead):
    added = 4e-9
    states = run(sphere(GasSupply(dead_volume=dead)), even("fill", {"c": added}, 5))
    filled = OUTSIDE * (2.0 / 3.0 * pi * 1e3 + dead) / AIR.specific + added

    def excess(radius):
        pressure = float(sphere_pressure(NeoHookean(0.3), 10.0, 14.0, radius))
        return (pressure + OUTSIDE) * (2.0 / 3.0 * pi * radius**3 + dead) - filled * AIR.specific

    radius = brentq(excess, 10.0, 25.0)
    pressure = float(sphere_pressure(NeoHookean(0.3), 10.0, 14.0, radius))
    assert radius > 10.5
    assert states[-1].pressure["c"] == pytest.approx(pressure, rel=1e-3)
    assert states[-1].volume["c"] == pytest.approx(2.0 / 3.0 * pi * radius**3, rel=1e-3)
    assert states[-1].gas.mass["c"] / (states[0].gas.mass["c"] + added) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 1.4])
@pytest.mark.parametrize("pull", [0.1, -0.06])
def test_a_sealed_gas_answers_to_loads_with_p_times_v_to_the_n(exponent, pull):
    """The load goes outward along the axis, then inward."""
    load = Traction("right", (0, 1), "pull")
    states = run(sphere(SealedSupply(exponent=exponent), (load,)), even("pull", {"pull": pull}, 3))
    kept = [(s.pressure["c"] + OUTSIDE) * s.volume["c"] ** exponent for s in states]
    assert kept == pytest.approx([kept[0]] * len(kept), rel=1e-8)
    assert abs(states[-1].volume["c"] / states[0].volume["c"] - 1.0) > 0.01
    assert states[-1].pressure["c"] * pull < 0.0
    assert len({state.gas.mass["c"] for state in states}) == 1


def test_pressure_volume_mass_and_flow_supplies_agree_on_pressure_at_one_volume():
    target = 0.05
    by_pressure = run(sphere(PressureSupply()), even("fill", {"c": target}, 3))[-1]
    volume = by_pressure.volume["c"]
    rest = sphere(PressureSupply()).surfaces["c"].reference_volume
    assert volume > 1.2 * rest
    mass = ((target + OUTSIDE) * volume - OUTSIDE * rest) / AIR.specific
    found = {"pressure": by_pressure}
    found["volume"] = run(sphere(VolumeSupply()), even("fill", {"c": volume - rest}, 3))[-1]
    found["gas by mass"] = run(sphere(GasSupply()), even("fill", {"c": mass}, 3))[-1]
    found["adiabatic"] = run(sphere(GasSupply(exponent=1.4)), even("fill", {"c": mass / 1.4}, 3))[-1]
    source = FlowSupply(conductance=100.0 * ONE)
    wait = Phase("wait", {"c": target}, largest=1.0, duration=1.0)
    found["flow"] = run(sphere(source), Phase("open", {"c": target}, duration=0.1), wait)[-1]
    # the volume at which mass without heat exchange ends is another: compare at its pressure
    warm = found.pop("adiabatic")
    again = run(sphere(PressureSupply()), even("fill", {"c": warm.pressure["c"]}, 3))[-1]
    assert warm.volume["c"] == pytest.approx(again.volume["c"], rel=1e-6)
    # a sealed gas under a load: the pressure that it finds gives the same volume as a regulator
    load = Traction("right", (0, 1), "pull")
    sealed = run(sphere(SealedSupply(), (load,)), even("pull", {"pull": -0.05}, 3))[-1]
    held = {"pull": -0.05, "c": sealed.pressure["c"]}
    again = run(sphere(PressureSupply(), (load,)), even("pull", held, 3))[-1]
    assert sealed.pressure["c"] > 1e-3
    assert sealed.volume["c"] == pytest.approx(again.volume["c"], rel=1e-6)
    for name, state in found.items():
        off = state.pressure["c"] / target - 1.0
        print(f"{name}: {state.volume['c']:.6f} mm3 at {1e3 * state.pressure['c']:.9f} kPa, off by {off:.1e}")
        assert state.volume["c"] == pytest.approx(volume, rel=1e-6), name
        assert state.pressure["c"] == pytest.approx(target, rel=1e-6), name


def test_a_balloon_past_its_maximum_is_as_stable_as_its_gas_is_stiff():
    """A small volume of gas holds it like a liquid, a large reservoir lets it go like a regulator."""
    states = run(balloon(VolumeSupply()), even("fill", {"c": 8.0 * 2094.4}, 20))
    late = states[-4]
    counts = []
    for dead in (0.0, 1e5, 1e6, 1e7, 1e9):
        model = balloon(GasSupply(dead_volume=dead))
        mass = (late.pressure["c"] + OUTSIDE) * (late.volume["c"] + dead) / AIR.specific
        start = replace(late, model=model, gas=Gas({"c": mass}), values={})
        newton = Newton(model, Settings())
        trial = Trial(late.displacement, late.pressure_modes, np.array([late.pressure["c"]]))
        found = newton.solve(trial, {}, Increment(start))
        assert found.trial.displacement == pytest.approx(late.displacement, abs=1e-5)
        counts.append(found.unstable_modes)
        assert counts[-1] == negative_eigenvalues(model, newton, found, dead)
    assert counts[0] == 0
    assert counts[-1] == 1


def negative_eigenvalues(model, newton, found, dead):
    """Count those of the tangent stiffened by the gas, K + P/V s s^T, as a dense matrix of the free unknowns."""
    position = model.mesh.points + found.trial.displacement
    surface = model.surfaces["c"]
    assembly = model.body.assemble(position, found.trial.modes)
    n = model.body.unknowns
    values = newton._tangent(assembly, position, found.trial.pressure, None)
    upper = sparse.csr_matrix((values, model.body.pattern.indices, model.body.pattern.indptr), shape=(n, n))
    dense = (upper + sparse.triu(upper, 1).T).toarray()
    slope = surface.gradient(position)
    stiffness = (found.trial.pressure[0] + OUTSIDE) / (surface.volume(position) + dead)
    free = np.setdiff1d(np.arange(n), model.held)
    dense += stiffness * np.outer(slope, slope)
    return int(np.sum(np.linalg.eigvalsh(dense[np.ix_(free, free)]) < 0.0))


def test_a_balloon_goes_over_its_pressure_maximum_with_gas_by_mass():
    states = run(balloon(GasSupply()), Phase("blow", {"c": 2.2e-8}, first=0.05, largest=0.05))
    pressure = [state.pressure["c"] for state in states]
    assert 2 < int(np.argmax(pressure)) < len(states) - 3
    assert [state.unstable_modes for state in states] == [0] * len(states)


# --- flow in and out of a rigid tank


@pytest.mark.parametrize(("ratio", "source"), [(0.3, 0.6), (0.5, 0.3), (0.3, 0.02)])
def test_a_tank_fills_as_the_formula_of_iso_6358_integrates(ratio, source):
    """Choked at first in the first two cases, subsonic to the end at small pressures."""
    supply = FlowSupply(conductance=ONE, critical_ratio=ratio)
    phases = (at_once("open", {"c": source}), Phase("fill", {"c": source}, (0.3, 0.6), largest=1.0, duration=1.2))
    states = run(tank(supply), *phases)[1:]
    whole = source + OUTSIDE
    exact = whole * filling_ratio(OUTSIDE / whole, ratio, 1.0, [state.clock for state in states])
    print(f"tank filled from {source} MPa: largest error {np.abs(absolute(states) / exact - 1.0).max():.2e}")
    assert np.abs(absolute(states) / exact - 1.0).max() < 0.005
    assert absolute(states)[-1] > 1.1 * OUTSIDE
    assert {state.volume["c"] for state in states} == {states[0].volume["c"]}
    settings = Settings(flow_accuracy=1e-5)
    states = run(tank(supply), *phases, settings=settings)[1:]
    exact = whole * filling_ratio(OUTSIDE / whole, ratio, 1.0, [state.clock for state in states])
    assert np.abs(absolute(states) / exact - 1.0).max() < 0.0005


@pytest.mark.parametrize("exponent", [1.0, 1.4])
def test_a_vacuum_pump_empties_a_tank_as_choked_flow_integrates(exponent):
    """Into empty space flow is choked: dP/dt = -n k P sqrt(T/T0), T/T0 = (P/P0)^((n-1)/n)."""
    supply = FlowSupply(conductance=ONE, exponent=exponent)
    phases = (at_once("open", {"c": -OUTSIDE}), Phase("pump", {"c": -OUTSIDE}, largest=1.0, duration=2.0))
    states = run(tank(supply), *phases)[1:]
    time = np.array([state.clock for state in states])
    n = exponent
    ratio = np.exp(-time) if n == 1.0 else (1.0 + 0.5 * (n - 1.0) * time) ** (-2.0 * n / (n - 1.0))
    assert ratio[-1] < 0.2
    assert np.abs(absolute(states) / (OUTSIDE * ratio) - 1.0).max() < 0.005


def test_a_wide_line_follows_its_source():
    """Pressures differ by less than the thousandth of laminar flow, forth and back, whatever the increments."""
    supply = FlowSupply(conductance=1e5 * ONE)
    phases = (Phase("up", {"c": 0.2}, largest=1.0, duration=1.0), Phase("down", {"c": -0.05}, duration=0.5))
    for state in run(tank(supply), *phases)[1:]:
        assert state.pressure["c"] == pytest.approx(state.values["c"], abs=2e-6)


def test_a_single_long_increment_through_a_wide_line_converges():
    model = tank(FlowSupply(conductance=10.0 * ONE))
    newton, start = Newton(model, Settings()), rest(model)
    trial = Trial(start.displacement, start.pressure_modes, np.zeros(1))
    for source in (0.5, 0.05, 1e-3, -0.05):
        found = newton.solve(trial, {"c": source}, Increment(start, 100.0))
        # the flow is laminar at the end: its slope is more than phi(0.999)/0.001 = 53 times k, and k t is 1000
        assert abs(found.trial.pressure[0] - source) < abs(source) / (53.0 * 1000.0)
        assert found.trial.pressure[0] != source


def test_a_narrow_line_lags_and_a_soft_cavity_fills_later_than_a_rigid_one():
    supply = FlowSupply(conductance=ONE)
    model = sphere(supply)
    states = run(model, Phase("fill", {"c": 0.05}, duration=1.0), Phase("wait", {"c": 0.05}, duration=1.0))
    end = next(state for state in states if state.time == 1.0)
    assert 0.0 < end.pressure["c"] < 0.045
    assert states[-1].pressure["c"] > end.pressure["c"]
    volume = states[0].volume["c"]
    assert end.gas.mass["c"] * AIR.specific / volume > 1.05 * (end.pressure["c"] + OUTSIDE)
    for state in states:  # the gas law holds in every state
        filled = (state.pressure["c"] + OUTSIDE) * state.volume["c"] / AIR.specific
        assert state.gas.mass["c"] / filled == pytest.approx(1.0, rel=1e-7)


# --- cavities joined by a tube


def joined(first, second, conductance=0.3 * ONE):
    """Two like spheres side by side, each free of the other."""
    one = bowl(cells=(2, 5))
    (block,), count = one.blocks, len(one.points)
    blocks = (CellBlock(block.kind, "body", np.vstack([block.nodes, block.nodes + count])),)
    faces = {
        f"{name}_{side}": tuple(FaceBlock(part.kind, part.nodes + shift) for part in parts)
        for side, shift in (("a", 0), ("b", count))
        for name, parts in one.faces.items()
    }
    mesh = Mesh(np.vstack([one.points, one.points + np.array([0.0, 40.0])]), blocks, faces, one.space)
    cavities = tuple(
        Cavity(side, (f"left_{side}",), supply, mirrors=(f"bottom_{side}",))
        for side, supply in (("a", first), ("b", second))
    )
    supports = tuple(Symmetry(f"{face}_{side}") for face in ("bottom", "top") for side in "ab")
    tubes = (Tube(between=("a", "b"), conductance=conductance),)
    return Model(mesh, {"body": RUBBER}, supports, (), cavities, tubes=tubes)


def test_joined_cavities_end_at_one_pressure_and_keep_their_gas():
    model = joined(GasSupply(), SealedSupply())
    added = 2e-9
    states = run(
        model,
        Phase("fill", {"a": added}, duration=0.2),
        Phase("wait", {"a": added}, largest=1.0, duration=20.0),
    )
    full = next(state for state in states if state.time == 1.0)
    assert full.pressure["a"] > 2.0 * full.pressure["b"] > 0.0
    assert states[-1].pressure["a"] == pytest.approx(states[-1].pressure["b"], rel=1e-6)
    assert states[-1].pressure["a"] > 0.01
    start = sum(states[0].gas.mass.values())
    for state in states:
        given = state.values.get("a", 0.0)
        assert sum(state.gas.mass.values()) / (start + given) == pytest.approx(1.0, rel=1e-12)
    assert states[-1].gas.mass["b"] > 1.2 * states[0].gas.mass["b"]


# --- refusals


def refuse(model, phase):
    Programme((phase,)).check(model)


def test_a_pressure_below_empty_space_is_refused():
    for supply in (PressureSupply(), FlowSupply(conductance=ONE)):
        with pytest.raises(InputError, match=r"phase 'p': target c = -102 kPa, allowed: -101\.325 kPa \(vacuum\)"):
            refuse(tank(supply), Phase("p", {"c": -0.102}, duration=1.0))
    refuse(tank(PressureSupply()), Phase("p", {"c": -OUTSIDE}))
    with pytest.raises(InputError, match=r"target c = -90 kPa, allowed: -80 kPa \(vacuum\) or more"):
        refuse(tank(PressureSupply(), atmosphere=Atmosphere(pressure=0.08)), Phase("p", {"c": -0.09}))


def test_taking_out_more_gas_than_there_is_is_refused():
    with pytest.raises(InputError, match=r"phase 'p': target c = -4 mg, allowed: more than -2\.52\d mg, all"):
        refuse(tank(GasSupply()), Phase("p", {"c": -4e-9}))


def test_a_flow_without_a_duration_is_refused():
    with pytest.raises(InputError, match="phase 'p': duration missing; the flow of gas into cavity 'c' takes time"):
        refuse(tank(FlowSupply(conductance=ONE)), Phase("p", {"c": 0.1}))
    with pytest.raises(InputError, match="phase 'p': duration missing; the flow of gas into cavity 'a' takes time"):
        refuse(joined(GasSupply(), SealedSupply()), Phase("p", {"a": 1e-10}))


def test_a_sealed_cavity_cannot_be_driven():
    with pytest.raises(InputError, match="phase 'p': target c: the cavity is sealed and cannot be driven"):
        refuse(tank(SealedSupply()), Phase("p", {"c": 0.1}))


def test_a_tube_to_an_unknown_cavity_or_one_without_gas_is_refused():
    with pytest.raises(NameNotFoundError, match="tube: unknown cavity 'd'"):
        tank(SealedSupply(), tubes=(Tube(between=("c", "d"), conductance=1.0),))
    with pytest.raises(InputError, match=r"tube between a and b: the cavity 'b' has a VolumeSupply, allowed: Sealed"):
        joined(SealedSupply(), VolumeSupply())


def test_an_increment_that_misses_the_accuracy_of_flow_is_cut():
    phases = (at_once("open", {"c": 0.6}), Phase("fill", {"c": 0.6}, first=1.0, largest=1.0, duration=1.2))
    states = list(march(tank(FlowSupply(conductance=ONE)), Programme(phases)))
    assert len(states) > 6
