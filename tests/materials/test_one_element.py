"""One element pulled in the three tests: its forces give each law's nominal stress."""

import numpy as np
import pytest
from scipy.optimize import brentq

from pneumorph.materials import (
    ArrudaBoyce,
    ExtendedTube,
    Gent,
    LinearElastic,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    Yeoh,
)
from pneumorph.materials.tension import MODES
from pneumorph.mechanics import Model, Phase, Prescribed, Programme, Roller, march
from pneumorph.mechanics.fields import fields
from pneumorph.mechanics.volumetric import split_bulk
from pneumorph.mesh.structured import box

# so stiff in volume that the formulas, which are incompressible, hold to 1e-4
LAWS = [
    NeoHookean(0.3, bulk=1e5),
    MooneyRivlin(0.11, 0.04, bulk=1e5),
    MooneyRivlin(0.11, 0.05, 0.003, 0.002, 0.001, bulk=1e5),
    Yeoh(0.11, 0.02, 0.001, bulk=1e5),
    Gent(0.3, 30.0, bulk=1e5),
    ArrudaBoyce(0.25, 2.5, bulk=1e5),
    Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0), bulk=1e5),
    ExtendedTube(gc=0.2, ge=0.15, beta=0.2, delta=0.1, bulk=1e5),
]
LAW = pytest.mark.parametrize("law", LAWS, ids=lambda law: f"{type(law).__name__}-{law.shear_modulus:g}")
MODE = pytest.mark.parametrize("mode", MODES)


def pulled(law, mode, first, last):
    """Return stretches and nominal stresses of a cube of two wedges that is pulled to `last`, `first` on the way."""
    rollers = [Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z")]
    plates = [Prescribed("x1", "x", "pull")]
    if mode == "equibiaxial":
        plates.append(Prescribed("y1", "y", "pull y"))
    if mode == "planar":
        rollers.append(Roller("y1", "y"))
    model = Model(box(1, 1, 1, kind="wedge18"), {"body": law}, (*rollers, *plates))
    targets = {plate.name: last - 1.0 for plate in plates}
    halfway = (first - 1.0) / (last - 1.0)
    programme = Programme((Phase("pull", targets, marks=(halfway,), first=halfway, largest=1.0),))
    result = []
    _, *states = march(model, programme)
    for state in states:
        (part,) = fields(state)
        gradient, stress = part.gradient.reshape(-1, 3, 3), part.stress.reshape(-1, 3, 3)
        # P = J σ F^-T
        nominal = np.linalg.det(gradient)[:, None, None] * stress @ np.swapaxes(np.linalg.inv(gradient), 1, 2)
        assert np.ptp(nominal[:, 0, 0]) <= 1e-6 * np.abs(nominal).max()
        result.append((gradient[0, 0, 0], nominal[0, 0, 0]))
    return np.array(result).T


@LAW
@pytest.mark.parametrize(
    ("mode", "stretches"),
    [("uniaxial", (1.5, 2.2)), ("equibiaxial", (1.3, 1.6)), ("planar", (1.5, 2.2)), ("uniaxial", (0.85, 0.6))],
)
def test_one_element_gives_the_nominal_stress_of_the_law(law, mode, stretches):
    stretch, nominal = pulled(law, mode, *stretches)
    assert np.isclose(stretch[:, None], stretches).any(axis=0).all()
    expected = getattr(law, f"{mode}_tension")(stretch)
    assert np.abs(expected).min() > 0.02 * law.shear_modulus
    np.testing.assert_allclose(nominal, expected, rtol=1e-4)


def compressible(law, mode, stretch):
    """Nominal stress of a homogeneous block of this law and the solver's volumetric energy, side faces free."""
    mean, local = split_bulk(law)

    def cauchy(stretches):
        volume = np.prod(stretches)
        logs = np.log(stretches) - np.log(volume) / 3.0
        return 2.0 * law.shear_modulus / volume * logs + mean * (volume - 1.0) + 0.5 * local * (volume - 1.0 / volume)

    stretches = {"uniaxial": lambda s: (stretch, s, s), "equibiaxial": lambda s: (stretch, stretch, s)}.get(
        mode, lambda s: (stretch, 1.0, s)
    )
    free = brentq(lambda s: cauchy(np.array(stretches(s)))[2], 0.3, 2.0, xtol=1e-15)
    full = np.array(stretches(free))
    return cauchy(full)[0] * np.prod(full) / stretch


@MODE
@pytest.mark.parametrize("poisson", [0.0, 0.36])
def test_one_stiff_element_feels_its_change_of_volume(mode, poisson):
    law = LinearElastic(3500.0, poisson)
    stretch, nominal = pulled(law, mode, 1.01, 1.05)
    np.testing.assert_allclose(nominal, [compressible(law, mode, s) for s in stretch], rtol=1e-7)
    # the closed form has another volumetric energy: it differs by a share of the order of the strain
    small, value = stretch.min(), nominal[np.argmin(stretch)]
    assert value == pytest.approx(float(getattr(law, f"{mode}_tension")(small)), rel=2.0 * (small - 1.0))


@pytest.mark.parametrize(
    "law", [Gent(0.3, 2.0, bulk=1e5), ExtendedTube(0.3, 0.1, 0.3, 0.4, bulk=1e5)], ids=lambda law: type(law).__name__
)
def test_a_law_that_locks_is_followed_close_to_its_limit(law):
    stretch = np.linspace(1.2, 3.2, 1000)
    limit = stretch[np.isfinite(law.uniaxial_tension(stretch))].max()
    near = 1.0 + 0.9 * (limit - 1.0)
    reached, nominal = pulled(law, "uniaxial", 1.0 + 0.1 * (near - 1.0), near)
    assert reached.max() == pytest.approx(near)
    np.testing.assert_allclose(nominal, law.uniaxial_tension(reached), rtol=5e-3)
