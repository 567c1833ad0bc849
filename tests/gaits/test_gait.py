"""Schedules: names, times, mirrored gaits, the published patterns, and what is refused."""

import math

import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.gaits import Gait, crawling, earthworm, inchworm, undulation
from pneumorph.mechanics import Phase

UP, DOWN = Phase("up", {"PN1": 0.01}), Phase("down", {"PN1": 0.0})


def test_a_cycle_repeats_under_names_that_say_which_it_is_and_its_ends_are_known():
    gait = Gait((UP, DOWN), (Phase("gravity", {"gravity": 9810.0}),), cycles=3)
    names = [phase.name for phase in gait.programme.phases]
    assert names == ["gravity", "up", "down", "up, cycle 2", "down, cycle 2", "up, cycle 3", "down, cycle 3"]
    assert gait.ends == (1, 3, 5, 7)
    assert len(gait.programme.phases) == gait.ends[-1]


def test_a_later_cycle_starts_from_where_the_last_one_ends():
    gait = Gait((Phase("a", {"PN1": 0.01}), Phase("b", {"PN2": 0.02}), Phase("c", {"PN1": 0.0})), cycles=2)
    at = gait.programme.values
    assert at(0.5) == {"PN1": 0.005}
    assert at(3.0) == {"PN1": 0.0, "PN2": 0.02}
    assert at(3.5) == pytest.approx({"PN1": 0.005, "PN2": 0.02})  # PN2 was never released


def test_an_undulation_fills_from_the_rear_and_releases_in_the_same_order():
    gait = undulation(("PN1", "PN2", "PN3"), 0.013, duration=1.0, inertia="quasi-static")
    assert [phase.name for phase in gait.phases] == ["+PN1", "+PN2", "+PN3", "-PN1", "-PN2", "-PN3"]
    filled = [sum(p > 0.0 for p in gait.programme.values(time).values()) for time in range(1, 7)]
    assert filled == [1, 2, 3, 2, 1, 0]
    assert all(phase.duration == 1.0 and phase.inertia == "quasi-static" for phase in gait.phases)


def test_a_crawl_holds_the_centre_and_one_leg_and_ends_in_its_first_posture():
    gait = crawling(("PN1", "PN2", "PN3", "PN4"), "PN5", 0.02, cycles=2)
    assert [phase.name for phase in gait.settle] == ["+PN5", "+PN1"]
    assert [phase.name for phase in gait.phases] == ["+PN3 -PN1", "+PN2 -PN3", "+PN4 -PN2", "+PN1 -PN4"]
    postures = [gait.programme.values(time) for time in range(2, 11)]
    for posture in postures:
        assert posture["PN5"] == 0.02
        assert [value for name, value in posture.items() if name != "PN5" and value] == [0.02]
    first = {name: value for name, value in postures[0].items() if value}
    for time in gait.ends:
        assert {name: value for name, value in gait.programme.values(time).items() if value} == first


def test_an_earthworm_always_holds_with_one_end_and_lengthens_and_shortens_between():
    settle = (Phase("gravity", {"gravity": 9810.0}),)
    gait = earthworm(("r1", "r2"), "m", ("f1", "f2"), 0.1, 0.02, settle=settle, cycles=2)
    assert [phase.name for phase in gait.settle] == ["hold", "gravity"]  # it holds before it has a weight
    assert [phase.name for phase in gait.phases] == ["+m", "+front", "-rear", "-m", "+rear", "-front"]
    at = gait.programme.values
    for time in range(2, 15):
        values = at(time)
        ends = (values["r1"] == values["r2"] == 0.1, values.get("f1", 0.0) == values.get("f2", 0.0) == 0.1)
        assert any(ends)
        if values.get("m", 0.0) != at(time - 1).get("m", 0.0):  # while the body changes its length, one end is free
            assert sum(ends) == 1
    assert at(2)["r1"] == at(8)["r1"] == at(14)["r1"] == 0.1
    assert at(8)["m"] == at(8)["f1"] == 0.0


def test_an_inchworm_lies_down_before_it_holds():
    settle = (Phase("gravity", {"gravity": 9810.0}),)
    gait = inchworm(("r",), "m", ("f",), 0.1, 0.02, settle=settle)
    assert [phase.name for phase in gait.settle] == ["gravity", "hold"]
    assert gait.phases == earthworm(("r",), "m", ("f",), 0.1, 0.02).phases


def test_a_mirrored_gait_swaps_its_cavities_and_mirroring_twice_changes_nothing():
    gait = undulation(("PN1", "PN2", "PN3"), 0.013, settle=(Phase("gravity", {"gravity": 9810.0}),))
    swap = {"PN1": "PN3", "PN3": "PN1"}
    mirrored = gait.renamed(swap)
    assert [dict(phase.targets) for phase in mirrored.phases[:3]] == [{"PN3": 0.013}, {"PN2": 0.013}, {"PN1": 0.013}]
    assert mirrored.settle == gait.settle
    assert mirrored.renamed(swap) == gait


@pytest.mark.parametrize("cycles", [0, -1, 1.5, math.inf, math.nan, True])
def test_a_cycle_without_end_is_refused(cycles):
    with pytest.raises(InputError, match=r"cycles = .*, allowed: a whole number of at least 1; every cycle has an end"):
        Gait((UP, DOWN), cycles=cycles)


def test_other_schedules_that_are_wrong_are_refused_with_one_message():
    with pytest.raises(InputError, match="a cycle without phases"):
        Gait(())
    with pytest.raises(InputError, match="expected each once"):
        Gait((UP, UP))
    with pytest.raises(NameNotFoundError, match="unknown target 'PN9'"):
        Gait((UP,)).renamed({"PN9": "PN1"})
    with pytest.raises(InputError, match="give one name to two targets"):
        Gait((Phase("a", {"PN1": 0.0}), Phase("b", {"PN2": 0.0}))).renamed({"PN1": "PN2"})
    with pytest.raises(InputError, match="PN1, PN1, expected each once"):
        undulation(("PN1", "PN1"), 0.01)
    with pytest.raises(InputError, match="expected each once"):
        undulation((), 0.01)
    with pytest.raises(InputError, match="r, m, r, expected each once"):
        earthworm(("r",), "m", ("r",), 0.1, 0.02)
    with pytest.raises(InputError, match="no cavities in the front"):
        inchworm(("r",), "m", (), 0.1, 0.02)
    with pytest.raises(InputError, match="no cavities in the rear"):
        earthworm((), "m", ("f",), 0.1, 0.02)
    with pytest.raises(InputError, match="3 legs, PN1, PN2, PN3, expected 4"):
        crawling(("PN1", "PN2", "PN3"), "PN5", 0.01)
