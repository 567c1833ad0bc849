"""Every example runs, and ends with the number that its text promises."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

from pneumorph.closed_form.thick_wall import sphere_pressure
from pneumorph.materials import NeoHookean
from pneumorph.solution import Status
from pneumorph.studies import load_study, run_study

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_balloon_follows_its_closed_form_through_the_pressure_maximum():
    solution = run_study(load_study(EXAMPLES / "balloon.toml"))
    assert solution.status is Status.DONE
    pressure = solution.history.values("pressure:cavity")[1:]
    radius = np.cbrt(6.0 / np.pi * solution.history.values("volume:cavity")[1:])
    np.testing.assert_allclose(pressure, sphere_pressure(NeoHookean(0.1), 10.0, 12.0, radius), rtol=0.005)
    assert 0 < pressure.argmax() < len(pressure) - 1


def test_the_pneunet_bends_further_with_every_state():
    solution = run_study(load_study(EXAMPLES / "pneunet.toml"))
    angle = np.degrees(solution.history.values("tip_rotation"))
    assert np.all(np.diff(angle) > 0.0)
    # recorded from this example; no published value
    assert angle[-1] == pytest.approx(86.0, rel=0.02)


def test_the_script_bends_a_pneunet(capsys):
    runpy.run_path(str(EXAMPLES / "bending.py"))
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("3 kPa ")
    # recorded from this example; no published value
    assert float(re.search(r"([\d.]+) deg", last)[1]) == pytest.approx(18.14, rel=0.02)


def test_the_finger_is_asked_for_its_snapshots():
    phases = load_study(EXAMPLES / "finger.toml").programme.phases
    assert [phase.name for phase in phases] == ["gravity", "inflate"]
    assert phases[1].marks == pytest.approx((0.5, 0.6, 0.7, 0.8, 0.9))


def test_every_example_stands_in_the_gallery():
    gallery = (EXAMPLES / "README.md").read_text()
    for path in (*EXAMPLES.glob("*.toml"), *EXAMPLES.glob("*.py")):
        assert f"]({path.name})" in gallery, path.name
