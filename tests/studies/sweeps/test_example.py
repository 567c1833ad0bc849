"""The sweep among the examples: its corners against the closed form of a thick-walled balloon."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

from pneumorph.closed_form.thick_wall import sphere_pressure
from pneumorph.materials import NeoHookean
from pneumorph.studies.sweeps import load_sweep
from pneumorph.studies.sweeps.compute import Record, compute

EXAMPLE = Path(__file__).parents[3] / "examples" / "sweeps" / "balloon.toml"


@pytest.mark.parametrize("number", [1, 12])
def test_the_largest_pressure_of_a_design_is_that_of_the_closed_form(number):
    sweep = load_sweep(EXAMPLE)
    assert len(sweep.designs) == 12
    study = sweep.designs[number - 1].study
    outer, mu = [(12.5, 0.08), (14.0, 0.12)][number == 12]
    assert (study.actuator.outer_radius, study.materials["body"].mu) == (outer, pytest.approx(mu))
    record = Record.of_plain(compute(study.resolved(), study.name, None))
    found = {result.name: result.of_run(record.history, True) for result in sweep.results}
    closed = pi / 6.0 * 1e3  # mm3, one eighth of the sphere
    volume = closed + np.linspace(1.0, 4000.0, 4000)
    pressure = sphere_pressure(NeoHookean(mu), 10.0, outer, np.cbrt(6.0 / pi * volume))
    assert found["largest_pressure"] == pytest.approx(pressure.max(), rel=0.01)
    assert found["last_pressure"] == pytest.approx(pressure[-1], rel=0.01)
    # linear between states that lie 0.1 of the phase apart
    assert found["pressure_at_1_mL"] == pytest.approx(np.interp(closed + 1e3, volume, pressure), rel=0.02)
