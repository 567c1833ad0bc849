"""A soft tube is filled with gas, sealed and dropped on rough ground, where it bounces: every energy is found again."""

from math import log

import numpy as np
import pytest

from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Atmosphere,
    Cavity,
    Contact,
    GasSupply,
    Gravity,
    HalfSpace,
    Model,
    Phase,
    Programme,
    Symmetry,
    march,
)
from pneumorph.mesh import rectangle

RUBBER = NeoHookean(0.05, bulk=5.0, density=1.1e-9)
FILLING = 4e-12  # t of air


def tube():
    """Return the right half of a tube, 20 mm wide with walls of 2 mm, 0.5 mm above ground."""

    def bent(points):
        angle, radius = np.pi * (points[:, 0] - 0.5), 10.0 - 2.0 * points[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    ground = Contact("ground", ("bottom",), HalfSpace((0, -10.5), (0, 1)), 0.5, reach=0.1, stiffness=0.01)
    return Model(
        rectangle(12, 1, bent),
        {"body": RUBBER},
        (Symmetry("left"), Symmetry("right")),
        (Gravity((0, -1)),),
        (Cavity("gas", ("top",), GasSupply(), mirrors=("left", "right")),),
        contacts=(ground, Contact("inside", ("top",), friction=0.3)),
    )


def test_kinetic_strain_gas_friction_and_numerical_energy_of_a_sealed_tube_that_bounces_add_up():
    falling = {"gravity": 2.0 * 9810.0}
    phases = (
        Phase("fill", {"gas": FILLING}, duration=0.1, inertia="quasi-static", first=0.25, largest=0.5),
        Phase("let go", falling, duration=0.001, inertia="moderate", first=0.5, largest=0.5),
        Phase("bounce", falling, duration=0.03, inertia="moderate", first=0.02, largest=0.02),
    )
    states = list(march(tube(), Programme(phases)))
    sealed = next(state for state in states if state.time == 1.0)
    after = states[states.index(sealed) :]
    air = Atmosphere()
    filled = air.pressure * sealed.volume["gas"] + sealed.pressure["gas"] * sealed.volume["gas"]  # p V = m R T
    kinds = ("strain", "kinetic", "contact", "viscous", "numerical", "friction")
    fall = max(state.energies.load for state in after) - sealed.energies.load
    works = []
    for state in after:
        volume = state.volume["gas"], sealed.volume["gas"]
        gas = filled * log(volume[0] / volume[1]) - air.pressure * (volume[0] - volume[1])
        works.append(gas)
        kept = sum(getattr(state.energies, kind) - getattr(sealed.energies, kind) for kind in kinds)
        assert state.energies.load - sealed.energies.load + gas == pytest.approx(kept, abs=0.003 * fall)
    # it touched, it was flung back, and no term is so small that it could be missing
    assert max(state.touches["ground"].area for state in after) > 1.0
    assert after[-1].touches["ground"].area == 0.0
    least = 0.003 * fall
    assert min(works) < -10.0 * least
    assert after[-1].energies.friction > least
    assert after[-1].energies.numerical > least
    assert max(state.energies.kinetic for state in after) > 10.0 * least
