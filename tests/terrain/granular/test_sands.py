from dataclasses import replace
from math import atan, exp, pi, radians, sqrt

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.terrain.granular import SANDS, sand
from pneumorph.terrain.granular.sands import damping_factor, hertz_overlap
from pneumorph.terrain.granular.virtual_tests import (
    Compression,
    angle_of_slip,
    calibrated_damping,
    confined_compression,
    restitution,
)

DRY, STICKY, SOFT = SANDS["dry"], SANDS["sticky"], SANDS["dry-compressible"]


def test_restitution_falls_linearly_in_the_order_of_the_study():
    order = ["dry", "sticky", "dry-compressible", "sticky-compressible"]
    assert [SANDS[name].restitution for name in order] == pytest.approx([0.48, 0.44, 0.40, 0.36])


def test_dry_grains_rebound_with_their_restitution_at_any_speed():
    for speed in (50.0, 500.0, 2000.0):
        assert restitution(DRY, speed) == pytest.approx(0.48, abs=0.005)
    assert restitution(SOFT, 500.0) == pytest.approx(0.40, abs=0.005)


@pytest.mark.parametrize("name", ["sticky", "sticky-compressible"])
def test_the_damping_of_sticky_sands_is_the_one_that_gives_their_restitution(name):
    assert restitution(SANDS[name], 500.0) == pytest.approx(SANDS[name].restitution, abs=0.005)


def test_a_damping_is_found_for_another_restitution():
    wanted = replace(STICKY, restitution=0.6)
    found = replace(wanted, damping=calibrated_damping(wanted))
    assert found.damping < STICKY.damping
    assert restitution(found, 500.0) == pytest.approx(0.6, abs=0.005)


def test_sticky_grains_come_apart_under_the_force_of_johnson_kendall_and_roberts():
    """3/2 pi w R* with w twice the surface energy; without damping, and slowly enough to be seen."""
    still = replace(STICKY, damping=1e-3)
    pull_off = 1.5 * pi * 2.0 * still.surface_energy * 10.0
    assert restitution(still, 500.0, pull=True) == pytest.approx(pull_off, rel=0.08)


def test_sticky_grains_that_meet_slowly_stay_together():
    assert restitution(SANDS["sticky-compressible"], 50.0) == 0.0


def test_the_damping_factor_is_none_without_loss_and_that_of_the_closed_form():
    assert damping_factor(1.0) == pytest.approx(0.0)
    assert damping_factor(exp(-pi)) == pytest.approx(sqrt(2.5))


def test_hertz_overlap_follows_its_power_law():
    assert hertz_overlap(DRY, 20.0, 8.0) == pytest.approx(4.0 * hertz_overlap(DRY, 20.0, 1.0))
    assert hertz_overlap(SOFT, 20.0, 1.0) == pytest.approx(10.0 ** (2.0 / 3.0) * hertz_overlap(DRY, 20.0, 1.0))


def test_the_rayleigh_time_is_that_of_the_wave_on_the_grain():
    """Here G = 2 MPa, rho = 1500 kg/m3, r = 20 mm."""
    expected = pi * 0.020 * sqrt(1500.0 / 2e6) / (0.1631 * 0.25 + 0.8766)
    assert DRY.rayleigh_time(20.0) == pytest.approx(expected)


def test_an_unstable_time_step_is_refused_with_its_limit():
    with pytest.raises(
        InputError, match=r"time step 0.001 s is not stable in 'dry': expected at most 0.000\d+ s, 0.3 of"
    ):
        DRY.check_step(1e-3, 18.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"modulus": 0.0}, "sand 'dry': modulus = 0 MPa, expected more than 0"),
        ({"density": -1.0}, "density = "),
        ({"friction": -0.1}, "friction = -0.1, expected at least 0"),
        ({"restitution": 1.0}, "restitution = 1, expected between 0 and 1"),
        ({"poisson": 0.5}, "poisson = 0.5, expected at least 0 and below 0.5"),
        ({"damping": 5.0}, "damping = 5 /.mm s., expected 0: dry sand has its restitution"),
        ({"surface_energy": 1e-3}, "expected more than 0, as the sand is sticky"),
    ],
)
def test_impossible_sands_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(DRY, **change)


def test_sands_are_known_by_name():
    assert sand("sticky") is STICKY
    with pytest.raises(NameNotFoundError, match="unknown sand 'stiky': did you mean 'sticky'"):
        sand("stiky")


def test_impossible_virtual_tests_are_refused():
    with pytest.raises(InputError, match="impact speed = 0 mm/s"):
        restitution(DRY, 0.0)
    with pytest.raises(InputError, match="dry sand has its restitution"):
        calibrated_damping(DRY)
    with pytest.raises(InputError, match=r"expected at most 0\.9"):
        calibrated_damping(replace(STICKY, restitution=0.999))
    with pytest.raises(InputError, match=r"stress up to 0.5 kPa, expected to pass 5 kPa"):
        Compression(np.array([0.0, 0.1]), np.array([0.0, 5e-4]), 0.5).modulus()


@pytest.mark.slow
def test_sticky_sand_stands_steeper_and_a_lower_modulus_yields_more():
    slopes = {name: angle_of_slip(SANDS[name]) for name in ("dry", "sticky")}
    # steeper than a plane of that friction would let one block slide, for walls and rolling friction hold grains too
    assert atan(0.55) < slopes["dry"] < radians(65.0)
    assert slopes["sticky"] > slopes["dry"] + radians(5.0)
    hard, soft = confined_compression(DRY), confined_compression(SOFT)
    # Hertz: strain as (stress / modulus)^(2/3), so 10^(2/3) = 4.6 if the grains did not move past each other
    assert 1.3 < hard.modulus() / soft.modulus() < 10.0 ** (2.0 / 3.0)
