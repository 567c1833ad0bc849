"""The equations of gas in cavities: exact cases of the gas law, and every slope against differences."""

from types import SimpleNamespace

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.mechanics.supplies import (
    Atmosphere,
    FlowSupply,
    Gas,
    GasSupply,
    PressureSupply,
    SealedSupply,
    Tube,
    VolumeSupply,
)  # fmt: skip
from pneumorph.mechanics.supplies.contents import Contents
from pneumorph.mechanics.supplies.network import Network, gas_at_rest

AIR = Atmosphere()
R, T = 287.05e6, 293.15


def contents(exponent, pressure=0.15, volume=1000.0):
    return Contents(pressure * volume / (R * T), pressure, volume, exponent, AIR)


# --- the gas law


def test_a_litre_of_air_weighs_what_the_ideal_gas_law_says():
    """101325 Pa, 1e-3 m3, 287.05 J/(kg K), 293.15 K: 1.2041 g."""
    assert AIR.pressure * 1e6 / AIR.specific == pytest.approx(1.2041e-6, rel=1e-4)


@pytest.mark.parametrize("exponent", [1.0, 1.2, 1.4])
@pytest.mark.parametrize("volume", [700.0, 1500.0])
def test_a_sealed_gas_keeps_p_times_v_to_the_n(exponent, volume):
    pressure = 0.15 * (1000.0 / volume) ** exponent
    gained, by_pressure, _ = contents(exponent).gained(pressure, volume)
    assert abs(gained) < 1e-14 * contents(exponent).mass
    assert by_pressure > 0.0
    temperature, *_ = contents(exponent).temperature(pressure, volume)
    assert temperature == pytest.approx(T * (1000.0 / volume) ** (exponent - 1.0), rel=1e-12)


def test_gas_pressed_into_a_nearly_empty_rigid_vessel_without_heat_exchange_ends_at_n_times_its_temperature():
    vessel = contents(1.4, pressure=1e-9)
    gained, *_ = vessel.gained(0.5, 1000.0)
    assert gained * 1.4 * R * T == pytest.approx(0.5 * 1000.0, rel=1e-6)
    assert vessel.temperature(0.5, 1000.0)[0] == pytest.approx(1.4 * T, rel=1e-6)


def test_gas_let_out_of_a_rigid_vessel_without_heat_exchange_cools_like_one_that_expands():
    vessel = contents(1.4)
    gained, *_ = vessel.gained(0.1, 1000.0)
    assert 1.0 + gained / vessel.mass == pytest.approx((0.1 / 0.15) ** (1.0 / 1.4), rel=1e-12)
    assert vessel.temperature(0.1, 1000.0)[0] == pytest.approx(T * (0.1 / 0.15) ** (0.4 / 1.4), rel=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 1.3])
@pytest.mark.parametrize(("pressure", "volume"), [(0.2, 1100.0), (0.11, 900.0), (0.15, 1500.0)])
def test_slopes_of_mass_and_temperature_match_differences(exponent, pressure, volume):
    start = contents(exponent)
    for quantity in (start.gained, start.temperature):
        _, by_pressure, by_volume = quantity(pressure, volume)
        if exponent > 1.0:
            assert by_pressure != 0.0
        dp, dv = 1e-7, 1e-3
        change = quantity(pressure + dp, volume)[0] - quantity(pressure - dp, volume)[0]
        assert change / (2.0 * dp) == pytest.approx(by_pressure, rel=1e-6, abs=0.0)
        change = quantity(pressure, volume + dv)[0] - quantity(pressure, volume - dv)[0]
        assert change / (2.0 * dv) == pytest.approx(by_volume, rel=1e-6, abs=1e-9 * abs(by_pressure))


# --- the network


SUPPLIES = {
    "regulated": PressureSupply(),
    "liquid": VolumeSupply(),
    "blown": FlowSupply(conductance=3e6, critical_ratio=0.4, exponent=1.2, dead_volume=50.0),
    "plugged": SealedSupply(exponent=1.4),
    "metered": GasSupply(),
}
TUBES = (
    Tube(between=("blown", "plugged"), conductance=2e6),
    Tube(between=("metered", "plugged"), conductance=1e6, critical_ratio=0.5),
)
VALUES = {"regulated": 0.02, "liquid": 100.0, "blown": 0.3, "metered": 2e-10}
P, V = np.array([0.01, 0.03, 0.05, 0.02, 0.021]), np.array([900.0, 1200.0, 1100.0, 800.0, 1010.0])


def network(supplies=SUPPLIES, tubes=TUBES):
    surfaces = {
        name: SimpleNamespace(cavity=SimpleNamespace(supply=supply), reference_volume=1000.0)
        for name, supply in supplies.items()
    }
    return Network(surfaces, tubes, AIR, 0.3)


def start(net):
    surfaces = dict(zip(net.names, net.surfaces, strict=True))
    zero, whole = dict.fromkeys(net.names, 0.0), dict.fromkeys(net.names, 1000.0)
    gas = Gas(gas_at_rest(surfaces, AIR).mass, (1e-9, -2e-9, 3e-9)[: len(net.lines)], 0.05)
    return SimpleNamespace(gas=gas, pressure=zero, volume=whole, values={})


@pytest.mark.parametrize("pressure", [P, P[::-1], np.full(5, 0.02), np.array([0.0, 0.0, -0.09, -0.02, 0.5])])
def test_all_slopes_of_the_network_match_differences(pressure):
    net = network()
    increment = net.increment(start(net), 0.04, VALUES)
    at = increment.equations(pressure, V)
    assert np.count_nonzero(at.by_pressure) >= 5
    assert np.all(at.scale > 0.0)
    for slopes, which, size in ((at.by_pressure, 0, 1e-8), (at.by_volume, 1, 1e-3)):
        for column in range(5):
            step = size * np.eye(5)[column]
            moved = [increment.equations(*(x + s * step * (i == which) for i, x in enumerate((pressure, V)))).value
                     for s in (1.0, -1.0)]  # fmt: skip
            found = (moved[0] - moved[1]) / (2.0 * size)
            largest = np.abs(slopes).max(axis=1)
            # equal pressures: temperatures differ between the two directions of flow
            tolerance = 0.1 if pressure is not P and np.ptp(pressure) == 0.0 else 2e-5
            assert found == pytest.approx(slopes[:, column], abs=tolerance * largest.max())
            assert np.all(np.abs(found - slopes[:, column]) <= tolerance * np.maximum(largest, 1e-30))


def test_what_leaves_one_cavity_comes_in_at_the_other():
    net = network()
    before = start(net)
    gas = net.increment(before, 0.04, VALUES).gas(P, V)
    from_outside = gas.moved[0] + VALUES["metered"]
    assert abs(gas.moved[1]) > 1e-12 < abs(gas.moved[2])
    total = sum(gas.mass.values()) - sum(before.gas.mass.values())
    assert total / from_outside == pytest.approx(1.0, rel=1e-12)
    assert list(gas.mass) == ["blown", "plugged", "metered"]


def test_a_source_that_pulls_empties_and_one_that_blows_fills():
    for source, sign in ((0.3, 1.0), (-AIR.pressure, -1.0)):
        net = network({"c": FlowSupply(conductance=1e6)}, ())
        gas = net.increment(start(net), 0.01, {"c": source}).gas(np.zeros(1), np.full(1, 1000.0))
        assert sign * gas.moved[0] > 0.0


def test_no_iteration_turns_a_flow_round_or_leaves_no_pressure():
    net = network({"c": FlowSupply(conductance=1e6)}, ())
    increment = net.increment(start(net), 0.04, {"c": 0.1})
    assert increment.share(np.array([0.0]), np.array([0.4])) == pytest.approx(0.25)
    assert increment.share(np.array([0.0]), np.array([0.05])) == 1.0
    assert increment.share(np.array([0.2]), np.array([-0.2])) == pytest.approx(0.5)
    assert increment.share(np.array([0.1]), np.array([0.3])) == 1.0  # equal already: any direction
    assert increment.share(np.array([0.0]), np.array([-2.0 * AIR.pressure])) == pytest.approx(0.4)
    joined = network({"a": SealedSupply(), "b": SealedSupply()}, (Tube(between=("a", "b"), conductance=1.0),))
    increment = joined.increment(start(joined), 0.04, {})
    assert increment.share(np.array([0.1, 0.0]), np.array([-0.1, 0.1])) == pytest.approx(0.5)


def test_the_softness_of_a_filling_is_that_at_fixed_contents():
    net = network()
    softness = net.increment(start(net), 0.04, VALUES).equations(P, V).softness
    gas = np.array([1150.0 / (1.2 * (P[2] + AIR.pressure)), 800.0 / (1.4 * (P[3] + AIR.pressure)),
                    1010.0 / (P[4] + AIR.pressure)])  # fmt: skip
    assert softness == pytest.approx([np.inf, 0.0, *gas], rel=1e-12)


# --- refusals


@pytest.mark.parametrize("exponent", [0.9, 1.7, float("nan")])
def test_an_exponent_outside_its_range_is_refused(exponent):
    with pytest.raises(InputError, match=r"exponent = .*, allowed: 1 \(constant temperature\) to 5/3"):
        SealedSupply(exponent=exponent)


def test_a_negative_dead_volume_is_refused():
    with pytest.raises(InputError, match=r"dead_volume = -0.001 mL, allowed: 0 or more"):
        GasSupply(dead_volume=-1.0)


def test_a_flow_without_conductance_or_with_a_wrong_ratio_is_refused():
    with pytest.raises(InputError, match=r"conductance = 0 L/\(min·bar\), allowed: more than 0"):
        FlowSupply(conductance=0.0)
    with pytest.raises(InputError, match="critical_ratio = 1, allowed"):
        Tube(between=("a", "b"), conductance=1.0, critical_ratio=1.0)


@pytest.mark.parametrize("between", [("a", "a"), ("a",), ("a", "b", "c"), "ab"])
def test_a_tube_joins_two_different_cavities(between):
    with pytest.raises(InputError, match=r"between = .*, expected the names of two different cavities"):
        Tube(between=between, conductance=1.0)


@pytest.mark.parametrize(("name", "unit"), [("pressure", "kPa"), ("temperature", "K"), ("gas_constant", "J/.kg·K.")])
def test_an_atmosphere_without_substance_is_refused(name, unit):
    with pytest.raises(InputError, match=rf"atmosphere: {name} = 0 {unit}, allowed: more than 0"):
        Atmosphere(**{name: 0.0})
