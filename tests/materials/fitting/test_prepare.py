"""From records to points: cycles, rupture, preload, noise, signs. Records are made from laws with known constants."""

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.materials.fitting import SpecimenTest, fit, prepare
from pneumorph.materials.fitting.legs import legs, turning_points
from pneumorph.materials.fitting.specimen import nominal_stress

LAW = Yeoh(0.03, 0.0004, 0.00001)


def record(stretch, stress, mode="uniaxial"):
    return SpecimenTest(mode, np.asarray(stretch), np.asarray(stress), "made.csv", 2 + np.arange(len(stretch)))


def cycles(softening=(1.0, 0.85, 0.8), peak=3.0, count=60, back=0.9):
    """Return cycles to a peak, each loading softened, each unloading `back` of it."""
    up = np.linspace(1.0, peak, count)
    down = up[-2:0:-1]
    stretch = np.concatenate([np.concatenate([up, down]) for _ in softening])
    stress = np.concatenate(
        [np.concatenate([s * LAW.uniaxial_tension(up), back * s * LAW.uniaxial_tension(down)]) for s in softening]
    )
    return record(stretch, stress)


def test_turning_points_overlook_noise_below_the_tolerance():
    assert turning_points(np.array([0.0, 1.0, 0.95, 2.0, 3.0, 1.5, 1.52, 0.0]), 0.1) == [0, 4, 7]
    assert turning_points(np.array([2.0, 1.0, 0.0]), 0.1) == [0, 2]
    assert turning_points(np.array([1.0, 0.0, 1.0]), 0.1) == [0, 1, 2]


@pytest.mark.parametrize(("branch", "factor"), [("last-loading", 0.8), ("first-loading", 1.0), ("mean", 0.8 * 0.95)])
def test_the_branch_asked_for_is_taken_from_cycles(branch, factor):
    test = prepare(cycles(), branch)
    expected = factor * LAW.uniaxial_tension(test.stretch)
    # the peak is the loading's and the unloading's; close to the start the zero of softened cycles is the record's
    np.testing.assert_allclose(test.stress[2:-1], expected[2:-1], rtol=1e-9)
    assert len(test.notes) == 1


def test_all_points_of_cycles_may_be_kept():
    assert len(prepare(cycles(), "all").stretch) == len(cycles().stretch)


def test_only_cycles_to_the_largest_strain_count():
    low, high = cycles((1.0,), peak=2.0), cycles((0.7,), peak=3.0)
    test = record(
        np.concatenate([low.stretch, high.stretch, low.stretch]), np.concatenate([low.stress, high.stress, low.stress])
    )
    prepared = prepare(test)
    assert prepared.stretch.max() == 3.0
    np.testing.assert_allclose(prepared.stress, 0.7 * LAW.uniaxial_tension(prepared.stretch))


def test_cycles_through_zero_give_the_loading_of_both_sides():
    path = np.concatenate([np.linspace(1, 1.5, 30), np.linspace(1.5, 0.7, 50)[1:], np.linspace(0.7, 1.5, 50)[1:]])
    loading = np.concatenate([[True], np.diff(path) * (path[1:] - 1.0) > 0.0])
    test = prepare(record(path, np.where(loading, 1.0, 0.8) * LAW.uniaxial_tension(path)), keep_offset=True)
    inner = np.abs(test.stretch - 1.0) > 0.05
    inner &= (test.stretch < 1.48) & (test.stretch > 0.72)
    np.testing.assert_allclose(test.stress[inner], LAW.uniaxial_tension(test.stretch)[inner])
    assert test.stretch.min() == pytest.approx(0.7)
    assert test.stretch.max() == pytest.approx(1.5)


def test_a_mean_without_unloading_is_refused():
    stretch = np.linspace(1.0, 2.0, 20)
    with pytest.raises(InputError, match="needs an unloading"):
        prepare(record(stretch, LAW.uniaxial_tension(stretch)), "mean")


def test_a_record_read_downwards_is_used_whole():
    stretch = np.linspace(2.0, 1.0, 20)
    np.testing.assert_allclose(prepare(record(stretch, LAW.uniaxial_tension(stretch))).stretch, stretch[::-1])


@pytest.mark.parametrize(
    ("stretch", "lines"),
    [
        ([1.0, 1.2, 1.4, 1.6, 1.3, 1.8, 2.0], "line 5 to made.csv line 6"),  # one point astray
        ([1.0, 1.5, 1.1, 1.9, 1.2, 2.0, 1.3], "line 2 to made.csv line 3"),  # shuffled rows
        ([*np.linspace(1, 3, 9), *np.linspace(3, 2.4, 9), *np.linspace(2.4, 3, 9)], "line 10 to made.csv line 19"),
    ],
)
def test_a_stretch_that_goes_back_and_forth_is_refused_with_its_lines(stretch, lines):
    with pytest.raises(InputError, match=f"{lines}.*allowed: a stretch that grows all the way, or whole cycles"):
        prepare(record(stretch, LAW.uniaxial_tension(stretch)))


def test_a_stress_that_falls_and_recovers_is_refused_with_its_lines():
    stretch = np.linspace(1.0, 2.0, 11)
    stress = LAW.uniaxial_tension(stretch)
    stress[6] *= 0.5
    with pytest.raises(InputError, match=r"made.csv line 7 to made.csv line 8: the stress falls from .* MPa to .* MPa"):
        prepare(record(stretch, stress))


def test_one_stress_far_too_large_is_no_rupture():
    stretch = np.linspace(1.0, 2.0, 11)
    stress = LAW.uniaxial_tension(stretch)
    stress[3] *= 5.0
    with pytest.raises(InputError, match=r"line 5 to made.csv line 6: the stress falls"):
        prepare(record(stretch, stress))


def test_what_comes_after_rupture_is_left_out():
    stretch = np.linspace(1.0, 3.0, 41)
    stress = np.where(stretch <= 2.5, LAW.uniaxial_tension(stretch), 0.002)
    test = prepare(record(stretch, stress))
    assert test.stretch.max() == pytest.approx(2.5)
    assert "after rupture at stretch 2.5" in test.notes[0]


@pytest.mark.parametrize("mode", ["uniaxial", "equibiaxial", "planar"])
@pytest.mark.parametrize("zero", [0.97, 1.04])
def test_preload_and_slack_are_found_and_removed(mode, zero):
    """A record with the wrong zero: λ = λ0 λ', P = P'/λ0, and no stress before the specimen is taut."""
    stretch = np.linspace(1.0, 3.0, 201)
    law = NeoHookean(0.1)
    stress = np.where(stretch > zero, nominal_stress(law, mode, np.maximum(stretch / zero, 1.0)) / zero, 0.0)
    test = prepare(record(stretch, stress, mode))
    assert f"zero moved to stretch {zero:.4f}" in test.notes[0]
    taut = test.stretch >= 1.0
    np.testing.assert_allclose(test.stress[taut], nominal_stress(law, mode, test.stretch[taut]), atol=1e-6)
    assert fit([test], "neo-hookean").material.mu == pytest.approx(0.1, rel=1e-3)
    kept = prepare(record(stretch, stress, mode), keep_offset=True)
    assert kept.notes == ()
    assert fit([kept], "neo-hookean").material.mu != pytest.approx(0.1, rel=1e-2)


def test_preload_of_a_softening_law_is_found_closely():
    stretch = np.linspace(1.0, 4.0, 301)
    test = prepare(record(stretch, LAW.uniaxial_tension(stretch / 0.96) / 0.96))
    zero = float(test.notes[0].split()[4])
    assert zero == pytest.approx(0.96, abs=0.004)


def test_data_that_begin_at_the_origin_or_beside_it_are_not_shifted():
    for stretch in (np.linspace(1.0, 3.0, 50), np.array([1.03, 1.07, 1.12, 1.2, 1.31, 1.42, 1.7, 2.0, 2.5, 3.0])):
        assert prepare(record(stretch, LAW.uniaxial_tension(stretch))).notes == ()


def test_an_offset_too_large_to_be_one_is_refused():
    stretch = np.linspace(1.0, 1.5, 50)
    with pytest.raises(InputError, match=r"line 2: stress = .* allowed: a shift of up to 25%.*--keep-offset"):
        prepare(record(stretch, 0.1 + LAW.uniaxial_tension(stretch)))


def test_noise_of_many_points_is_averaged():
    rng = np.random.default_rng(3)
    stretch = np.linspace(1.0, 4.0, 20_000) + rng.normal(0.0, 0.002, 20_000)
    stress = LAW.uniaxial_tension(stretch) + rng.normal(0.0, 0.005, 20_000)
    test = prepare(record(stretch, stress))
    assert len(test.stretch) == 200
    assert "20000 points averaged to 200" in test.notes[-1]
    # a hundred points a step: a tenth of the noise, and the fit gets the constants back
    assert np.std(test.stress - LAW.uniaxial_tension(test.stretch)) < 0.0008
    assert fit([test], "yeoh").material.c10 == pytest.approx(LAW.c10, rel=0.02)


def test_a_stress_of_the_wrong_sign_is_refused():
    stretch = np.linspace(1.0, 0.6, 20)
    with pytest.raises(InputError, match=r"stress = .* allowed: compression \(-\) under stretch 1"):
        prepare(record(stretch, np.abs(LAW.uniaxial_tension(stretch))))
    stretch = np.linspace(1.0, 1.6, 20)
    with pytest.raises(InputError, match=r"stress = -.* allowed: tension \(\+\) over stretch 1"):
        prepare(record(stretch, -LAW.uniaxial_tension(stretch)))


def test_compression_of_a_sheet_is_refused():
    stretch = np.linspace(1.0, 0.6, 20)
    with pytest.raises(InputError, match="in a planar test, allowed: 1 and more"):
        prepare(record(stretch, LAW.planar_tension(stretch), "planar"))


@pytest.mark.parametrize(
    ("stretch", "stress", "words"),
    [([1.0, 1.5, 2.0], [0.0] * 3, "stress is 0 in every row"), ([1.5] * 3, [1.0] * 3, "stretch is 1.5 in every row")],
)
def test_a_test_that_was_not_loaded_is_refused(stretch, stress, words):
    with pytest.raises(InputError, match=words):
        prepare(record(stretch, stress))


def test_an_unknown_branch_is_refused():
    with pytest.raises(NameNotFoundError, match="last-loading"):
        prepare(cycles(), "last")


def test_a_small_movement_before_the_test_is_no_leg():
    stretch = np.concatenate([[1.05, 1.0], np.linspace(1.01, 2.0, 30)])
    assert legs(record(stretch, LAW.uniaxial_tension(stretch))) == [(1, 31)]
