"""Static tests, stands and comparison rows of the reduced wheel, from the data of a known chain."""

from dataclasses import replace

import numpy as np
import pytest
from tests.terrain.limbs import data_of, known_limb

from pneumorph.studies.reduced_wheel import comparison, inwards_of, ramps, reduce_wheel, static_tests, worst
from pneumorph.terrain.limb_fit import fit_limb
from pneumorph.terrain.soft_wheel import SoftWheel

pytest.importorskip("mujoco")
pytest.importorskip("gymnasium")


def test_the_static_tests_of_exact_data_agree_and_of_a_stiffer_limb_do_not():
    data = data_of(held_out=((0.02, (-1.0, 1.0)),))
    wheel = SoftWheel(fit_limb(data).limb)
    tests = static_tests(data, wheel)
    assert len(tests) == 4 * 3 + 1  # three forces at each pressure, and the one held out
    assert max(test.apart for test in tests) < 1e-3
    assert worst(tests, True).force.tolist() == [-1.0, 1.0]
    stiffer = SoftWheel(replace(wheel.limb, compliance=0.5 * wheel.limb.compliance))
    small = [test for test in static_tests(data, stiffer) if np.linalg.norm(test.force) < 0.7]
    for test in small:
        assert test.difference == pytest.approx(-0.5, abs=0.12)
    assert worst([], True) is None


def test_the_way_inwards_is_that_from_the_load_point_to_the_axle_of_a_turned_limb():
    data = data_of()
    turned = replace(data, mount=(0.0, 25.0, 0.5 * np.pi))
    assert inwards_of(data) == pytest.approx(inwards_of(turned))
    axle = np.array([-25.0, 0.0])
    way = np.array([np.cos(inwards_of(data)), np.sin(inwards_of(data))])
    np.testing.assert_allclose(data.load_point + way * np.linalg.norm(data.load_point - axle), axle, atol=1e-9)


def test_the_schedule_goes_up_and_comes_down():
    schedule = ramps(0.03, 10.0)
    assert [schedule(t) for t in (0.0, 2.0, 3.0, 4.0, 6.9, 8.0, 10.0)] == pytest.approx(
        [0.0, 0.0, 0.015, 0.03, 0.03, 0.015, 0.0]
    )


def test_the_comparison_has_heights_tests_and_stands():
    limb = known_limb()
    inwards = inwards_of(data_of(limb))
    push = (1.25 * np.cos(inwards), 1.25 * np.sin(inwards))
    data = data_of(limb, forces=((0.0, 0.0), push, (0.3, 0.3)))
    result = reduce_wheel(data, duration=0.5)
    rows = comparison(result, data)
    heights = [row for row in rows if row.quantity == "height of the wheel"]
    assert [row.reported for row in heights] == [230.0, 280.0]
    stands = [row for row in rows if row.quantity.startswith("sinking")]
    on_foot = [
        f"{1e3 * p:g} kPa, 1.25 N" for p, stand in zip(result.pressures, result.stands, strict=True) if stand.on_foot
    ]
    assert stands
    assert {row.condition for row in stands} <= set(on_foot)
    # where the round foot touches moves a little as the limb turns, so that the lever differs
    for row in stands:
        assert row.computed == pytest.approx(row.reported, abs=1.0)
    assert result.roll.time[-1] == pytest.approx(0.5)
    assert len(result.roll.height) == len(result.roll.bending) == 11
