"""Volumes of chambers that share a cavity, and quantiles of stress."""

from dataclasses import replace

import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.geometry import SoftLimb
from pneumorph.materials import NeoHookean
from pneumorph.measures import ChamberSpread, LargestStress, StressQuantile
from pneumorph.mechanics import Cavity, Clamp, Model, Prescribed, Roller, Symmetry
from pneumorph.mechanics.state import rest
from pneumorph.mesh import box, generate

RUBBER = NeoHookean(0.2)


def limb_model(limb):
    mirrors = ("symmetry_y",) if limb.half else ()
    return Model(
        generate(limb, 10.0, detail=0.2), {"body": RUBBER, "base": RUBBER},
        (Clamp("clamp"), *(Symmetry(name) for name in mirrors)), (), (Cavity("cavity", ("cavity",), mirrors=mirrors),),
    )  # fmt: skip


LIMB = SoftLimb(chambers=3, length=75.0, half=True)


@pytest.fixture(scope="module")
def model():
    return limb_model(LIMB)


def moved(model, positions):
    return replace(rest(model), displacement=positions - model.mesh.points)


def spread_of(limb):
    return ChamberSpread("cavity", limb.centre, limb.cuts)


def test_the_volumes_of_the_chambers_add_up_to_that_of_the_cavity(model):
    rng = np.random.default_rng(1)
    x = model.mesh.points + rng.uniform(-0.2, 0.2, model.mesh.points.shape) * [1.0, 0.0, 1.0]
    volumes = spread_of(LIMB).volumes(rest(model), x)
    assert len(volumes) == 3
    assert volumes.sum() == pytest.approx(model.surfaces["cavity"].volume(x), rel=1e-12)


def test_equal_chambers_have_equal_volumes_in_a_half_and_twice_that_in_the_whole(model):
    half = spread_of(LIMB).volumes(rest(model))
    assert np.ptp(half[[0, 2]]) < 0.05 * half.mean()  # the middle one has two halves of the airway
    whole = replace(LIMB, half=False)
    double = spread_of(whole).volumes(rest(limb_model(whole)))
    assert double == pytest.approx(2.0 * half, rel=0.03)


def test_chambers_that_grow_alike_have_no_spread_and_one_that_grows_alone_has_its_own(model):
    spread = spread_of(LIMB)
    assert spread(moved(model, 1.1 * model.mesh.points)) == pytest.approx(0.0, abs=1e-9)
    x = model.mesh.points
    angle = np.arctan2(x[:, 0], x[:, 2] + LIMB.radius)
    first = angle < LIMB.cuts[0]
    deeper = x.copy()
    deeper[first, 1] *= 1.2  # no volume lies across the cut but that of the airway
    assert spread(moved(model, deeper)) == pytest.approx(0.2 / (3.2 / 3.0), rel=0.05)


@pytest.mark.parametrize(
    ("cuts", "message"), [((), r"cuts = \(\)"), ((0.5, 0.5), r"expected one or more, each larger than the last")]
)
def test_cuts_that_do_not_grow_are_refused(cuts, message):
    with pytest.raises(InputError, match=message):
        ChamberSpread("cavity", LIMB.centre, cuts)


def test_an_unknown_cavity_and_a_chamber_without_faces_are_refused(model):
    with pytest.raises(NameNotFoundError, match="cavety"):
        ChamberSpread("cavety", LIMB.centre, LIMB.cuts)(rest(model))
    with pytest.raises(InputError, match="no face of 'cavity' lies in chamber 2"):
        ChamberSpread("cavity", LIMB.centre, (LIMB.cuts[0], LIMB.cuts[0] + 1e-9)).volumes(rest(model))


def test_a_cavity_in_two_mirror_planes_is_refused(model):
    cavity = Cavity("cavity", ("cavity",), mirrors=("symmetry_y", "clamp"))
    quarter = Model(model.mesh, model.materials, model.supports, (), (cavity,))
    with pytest.raises(InputError, match="at most one mirror plane"):
        spread_of(LIMB).volumes(rest(quarter))


def test_the_quantile_of_stress_is_the_value_below_which_a_share_of_the_volume_lies():
    """A bar whose stretch grows linearly along it: the stretch itself is spread evenly over the volume."""
    mesh = box(20, 1, 1, lengths=(20.0, 1.0, 1.0))
    model = Model(
        mesh, {"body": NeoHookean(0.2, bulk=2.0)}, (Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z"),
        Prescribed("x1", "x", "pull")),
    )  # fmt: skip
    x = mesh.points
    along = x[:, 0] + 0.5 * 0.02 * x[:, 0] ** 2  # stretch 1 + 0.02 x, up to 1.4
    state = moved(model, np.column_stack([along, x[:, 1], x[:, 2]]))
    for share in (0.25, 0.5, 0.9):
        stretch = StressQuantile("largest_stretch", share=share)(state)
        assert stretch == pytest.approx(1.0 + 0.4 * share, abs=0.01)
    assert StressQuantile("largest_stretch")(state) <= LargestStress("largest_stretch")(state)
    assert StressQuantile("largest_stretch").name == "99_percent_largest_stretch"


@pytest.mark.parametrize("share", [0.0, 1.0, -0.5])
def test_a_share_outside_zero_to_one_is_refused(share):
    with pytest.raises(InputError, match="allowed: between 0 and 1"):
        StressQuantile(share=share)
