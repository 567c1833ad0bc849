import math

import numpy as np
import pytest

from pneumorph.errors import EngineError
from pneumorph.geometry import ThickSphere
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, Roller, Symmetry, Traction, VolumeSupply
from pneumorph.mesh import box, generate, rectangle
from pneumorph.report import render
from pneumorph.solution import Solution, solve

RUBBER = NeoHookean(mu=0.1)


def shell(points):
    """A quarter circle of radii 10 and 15 mm from the unit square."""
    radius, angle = 10.0 + 5.0 * points[:, 0], 0.5 * math.pi * points[:, 1]
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


@pytest.fixture(scope="session")
def balloon(tmp_path_factory) -> Solution:
    """A run in a folder: a sphere with axial symmetry, inflated by volume."""
    model = Model(
        rectangle(2, 5, mapping=shell, space="axisymmetric"),
        {"body": RUBBER},
        supports=(Symmetry("bottom"), Roller("top", "x")),
        cavities=(Cavity("cavity", ("left",), VolumeSupply(), mirrors=("bottom",)),),
    )
    programme = Programme((Phase("inflate", {"cavity": 4000.0}, marks=(0.5,), first=0.25, largest=0.25),))
    folder = tmp_path_factory.mktemp("balloon") / "run"
    return solve(model, programme, folder=folder, about={"title": "Balloon <b>& more</b>", "notes": ["one <note>"]})


@pytest.fixture(scope="session")
def beam() -> Solution:
    """A run in memory: a clamped block bent by a traction, 10 x 2 x 2 mm."""
    model = Model(
        box(5, 1, 1, lengths=(10.0, 2.0, 2.0)),
        {"body": RUBBER},
        supports=(Clamp("x0"),),
        loads=(Traction("x1", (0.0, 0.0, -1.0), "push"),),
    )
    programme = Programme((Phase("push", {"push": 0.0015}, first=0.5, largest=0.5),))
    return solve(model, programme)


@pytest.fixture(scope="session")
def octant():
    return generate(ThickSphere(octant=True), 4.0)


@pytest.fixture
def drawable() -> None:
    """Skip where pictures cannot be drawn."""
    try:
        render.check()
    except EngineError as error:
        pytest.skip(str(error))
