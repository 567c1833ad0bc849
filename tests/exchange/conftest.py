"""CalculiX in the tests of its input files."""

import os
import shutil
import subprocess

import numpy as np
import pytest

CCX = shutil.which("ccx")


@pytest.fixture
def calculix():
    """Return a function that solves an .inp file as it is and gives the printed displacements.

    The result has a (node from 0 -> displacement) dictionary for each time that was printed, in order.
    """
    if CCX is None:
        pytest.skip("ccx (CalculiX) is not on the PATH: apt-get install calculix-ccx")

    def run(path, timeout=60):
        environment = os.environ | dict.fromkeys(("OMP_NUM_THREADS", "CCX_NPROC_STIFFNESS"), "1")
        done = subprocess.run(
            [CCX, "-i", path.stem], cwd=path.parent, env=environment, capture_output=True, text=True, timeout=timeout
        )
        assert done.returncode == 0, done.stdout[-2000:]
        assert "*ERROR" not in done.stdout, done.stdout[-2000:]
        return printed_displacements(path.with_suffix(".dat"))

    return run


def printed_displacements(path):
    """Return the displacements in a .dat file: one dictionary for each time printed, node from 0 -> (3,)."""
    times, blocks = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["displacements"]:
            time = float(words[-1])
            if not times or time != times[-1]:
                times.append(time)
                blocks.append({})
        elif words and blocks:
            blocks[-1][int(words[0]) - 1] = np.array(words[1:4], dtype=float)
    return dict(zip(times, blocks, strict=True))
