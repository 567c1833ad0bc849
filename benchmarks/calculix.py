"""CalculiX for the benchmarks: write a model of 10-node tetrahedra, run it, read what it says.

Standard library only, so that the process that measures stays small (see `measured.py`).
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PACKAGE = "calculix-ccx"
# corners (from 0) of the faces P1..P4 of C3D10; its nodes are numbered like VTK's quadratic tetrahedron
FACES = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
UNUSED = "1.e20"
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


def write_input(
    path: Path,
    points: Any,
    cells: Any,
    *,
    clamp: Iterable[int],
    tip: Iterable[int],
    pressed: Any,
    yeoh: tuple[float, float, float],
    bulk: float,
    pressure: float,
    first: float,
) -> None:
    """Write a clamped Yeoh body under a pressure that follows the surface.

    points (n, 3) in mm and cells (m, 10): arrays; clamp, tip: nodes; pressed (k, 3 or more): corners of the faces
    under pressure; yeoh: C10, C20, C30 in MPa; bulk, pressure: MPa; first: first increment of the step of length 1.
    CalculiX's volumetric energy is the sum of (J - 1)^2i / Di, so that D1 = 2 / bulk. A D2 or D3 of zero it replaces by
    a default; `UNUSED` switches these terms off.
    """
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(points.tolist(), 1)]
    lines.append("*ELEMENT, TYPE=C3D10, ELSET=BODY")
    lines += [", ".join(map(str, (i, *(n + 1 for n in cell)))) for i, cell in enumerate(cells.tolist(), 1)]
    lines += ["*NSET, NSET=CLAMP", *_rows(clamp), "*NSET, NSET=TIP", *_rows(tip)]
    c10, c20, c30 = yeoh
    lines += [
        "*MATERIAL, NAME=RUBBER",
        "*HYPERELASTIC, YEOH",
        f"{c10}, {c20}, {c30}, {2.0 / bulk!r}, {UNUSED}, {UNUSED}",
    ]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER", "*BOUNDARY", "CLAMP, 1, 3"]
    lines += ["*STEP, NLGEOM, INC=10000", "*STATIC", f"{first}, 1., 1.e-6", "*DLOAD"]
    lines += [f"{cell}, P{face}, {pressure!r}" for cell, face in _element_faces(cells, pressed)]
    lines += ["*NODE PRINT, NSET=TIP, FREQUENCY=10000", "U", "*END STEP", ""]
    path.write_text("\n".join(lines))


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


def _rows(nodes: Iterable[int]) -> list[str]:
    numbers = [str(int(n) + 1) for n in nodes]
    return [", ".join(numbers[i : i + 12]) for i in range(0, len(numbers), 12)]


def _element_faces(cells: Any, pressed: Any) -> list[tuple[int, int]]:
    """Return (element, face), both from 1, of faces given by their corners."""
    owner = {
        tuple(sorted(cell[i] for i in corners)): (number, face)
        for number, cell in enumerate(cells.tolist(), 1)
        for face, corners in enumerate(FACES, 1)
    }
    # a face of the boundary belongs to one cell, so that no entry above overwrites another that is asked for
    return [owner[tuple(sorted(face[:3]))] for face in pressed.tolist()]
