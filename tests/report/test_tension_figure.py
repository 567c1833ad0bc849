"""Tension tests as a picture."""

import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.homogenisation import TensionTest
from pneumorph.report.tension_figure import tension_figure

RISING = np.linspace(0.0, 0.3, 4)
TESTS = {"re-entrant": TensionTest(RISING, RISING, RISING, 0.2 * RISING)}


def test_picture_names_its_tests_and_axes():
    text = tension_figure(TESTS).decode()
    assert "re-entrant" in text
    assert "lateral strain" in text
    assert tension_figure(TESTS, "png").startswith(b"\x89PNG")


def test_what_cannot_be_drawn_is_refused():
    with pytest.raises(InputError, match="form = 'pdf', allowed: svg, png"):
        tension_figure(TESTS, "pdf")
    with pytest.raises(InputError, match="no tests, expected at least one"):
        tension_figure({})
