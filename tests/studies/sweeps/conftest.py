from pathlib import Path

import pytest
from tests.studies.sweeps.pretend import SPHERE

from pneumorph.studies.sweeps import Sweep, load_sweep


@pytest.fixture
def sweep_file(tmp_path):
    """Write a sweep of the sphere; return its path."""

    def write(text: str, study: str = SPHERE) -> Path:
        (tmp_path / "sphere.toml").write_text(study)
        path = tmp_path / "sweep.toml"
        path.write_text(text if text.lstrip().startswith("study") else f'study = "sphere.toml"\n{text}')
        return path

    return write


@pytest.fixture
def sweep(sweep_file):
    """Return the sweep with a text."""

    def load(text: str, study: str = SPHERE) -> Sweep:
        return load_sweep(sweep_file(text, study))

    return load
