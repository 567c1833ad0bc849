from pathlib import Path

import pytest
from typer.testing import CliRunner

from pneumorph.cli.app import app

SPHERE = """
title = "Octant of a sphere"
[actuator]
template = "thick-sphere"
octant = true
[material]
law = "neo-hookean"
mu = "100 kPa"
[mesh]
size = "coarse"
[[phase]]
name = "inflate"
targets = { cavity = "20 kPa" }
first_increment = 0.5
largest_increment = 0.5
"""


@pytest.fixture
def pneumorph():
    """Run the command line in this process; an exception that is not an exit shows."""

    def run(*arguments):
        return CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)

    return run


@pytest.fixture
def study(tmp_path) -> Path:
    """A study that is solved in a second."""
    path = tmp_path / "sphere.toml"
    path.write_text(SPHERE)
    return path
