"""CalculiX for the benchmarks: find it, limit its threads, read what it says. `pneumorph.exchange` writes its input.

Standard library only, so that the process that measures stays small (see `measured.py`).
"""

from __future__ import annotations

import math
import shutil
from dataclasses import dataclass
from pathlib import Path

PACKAGE = "calculix-ccx"
VARIABLES = (
    "OMP_NUM_THREADS", "NUMBER_OF_CPUS", "CCX_NPROC_EQUATION_SOLVER", "CCX_NPROC_RESULTS", "CCX_NPROC_STIFFNESS",
)  # fmt: skip


class CalculixError(Exception):
    """CalculiX is missing or did not finish; the message says which."""


@dataclass(frozen=True)
class Progress:
    """What a run did: increments and iterations, those of failed attempts apart, and the part of the step reached."""

    increments: int
    iterations: int
    failed_iterations: int
    reached: float


def executable() -> str:
    """Return the path of ccx; raises CalculixError with the name of the package."""
    path = shutil.which("ccx")
    if path is None:
        raise CalculixError(f"ccx (CalculiX) is not on the PATH: install it with 'apt-get install {PACKAGE}'")
    return path


def environment(threads: int) -> dict[str, str]:
    """Return the variables that give CalculiX its threads."""
    return dict.fromkeys(VARIABLES, str(threads))


def progress(job: Path) -> Progress:
    """Return how far a run came, from its .sta (converged increments) and .cvg (all iterations)."""
    rows = [line.split() for line in job.with_suffix(".sta").read_text().splitlines()]
    # the attempt's number ends in U where the attempt failed
    done = [row for row in rows if len(row) == 7 and row[0].isdigit() and not row[2].endswith("U")]
    every = [line.split() for line in job.with_suffix(".cvg").read_text().splitlines()]
    iterations = sum(1 for row in every if len(row) > 4 and row[0].isdigit())
    good = sum(int(row[3]) for row in done)
    return Progress(len(done), good, iterations - good, float(done[-1][5]) if done else 0.0)


def mean_displacement(job: Path) -> tuple[float, float, float]:
    """Return the last displacement that was printed to the .dat, averaged over its nodes, mm."""
    blocks: list[list[list[float]]] = []
    for line in job.with_suffix(".dat").read_text().splitlines():
        if line.strip().startswith("displacements"):
            blocks.append([])
        elif line.strip() and blocks:
            blocks[-1].append([float(word) for word in line.split()[1:4]])
    if not blocks or not blocks[-1]:
        raise CalculixError(f"{job.with_suffix('.dat')}: no displacements in it")
    x, y, z = (math.fsum(column) / len(column) for column in zip(*blocks[-1], strict=True))
    return x, y, z
