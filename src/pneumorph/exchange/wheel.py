"""Surface of a whole wheel of soft limbs at any pressure, from the run of one limb."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.exchange.surface import OUTER, Surface, completed_surface, surface_of
from pneumorph.exchange.written import Written, put
from pneumorph.geometry.soft_limb import SoftLimb
from pneumorph.geometry.stl import stl_bytes
from pneumorph.solution import Solution
from pneumorph.units import show

Array = NDArray[np.float64]

LIMBS = 4
_MIRROR = "symmetry_y"


def positions_at(solution: Solution, cavity: str, pressure: float) -> Array:
    """Return the nodes (n, 3), mm, at a gauge pressure, MPa: linear between the first states on its two sides.

    Raises InputError for a pressure that the run does not come to, with its range.
    """
    values = solution.history.values(f"pressure:{cavity}")
    if len(values) == 0:
        raise InputError("the run has no states yet")
    low, high = float(values.min()), float(values.max())
    slack = 1e-6 * max(abs(low), abs(high))
    if not low - slack <= pressure <= high + slack:
        raise InputError(
            f"pressure = {show(pressure, 'pressure')}, allowed: {show(low, 'pressure')} to {show(high, 'pressure')}, "
            "what the run computed"
        )
    wanted = min(max(pressure, low), high)
    after = int(np.argmax((values[:-1] - wanted) * (values[1:] - wanted) <= 0.0)) + 1 if len(values) > 1 else 0
    before = max(after - 1, 0)
    step = values[after] - values[before]
    share = (wanted - values[before]) / step if step else 1.0
    first, second = solution.states[before].positions, solution.states[after].positions
    return np.asarray((1.0 - share) * first + share * second)


def limb_surface(solution: Solution, pressure: float, part: str = OUTER) -> Surface:
    """Return the closed surface of the whole limb at a gauge pressure, MPa, in the run's axes.

    part: 'outer', as if it were filled, or 'whole', with the walls of its cavity. Raises as `positions_at`.
    """
    model = solution.model
    positions = positions_at(solution, model.cavities[0].name, pressure)
    if _MIRROR in model.mesh.faces:
        return completed_surface(model, _MIRROR, positions, part)
    return surface_of(model, positions, part)


def wheel_surface(
    run: Solution | Path | str, pressure: float, *, limb: SoftLimb | None = None, limbs: int = LIMBS, part: str = OUTER
) -> tuple[Array, NDArray[np.int64]]:
    """Return a wheel of equal limbs at one pressure: points (n, 3), mm, triangles (m, 3) with outward normals.

    The axle is the y axis, the middle plane y = 0; the first limb leaves the hub along +x, the others follow at equal
    angles. Every limb is a closed surface of its own; there is no hub, and limbs that swell may overlap.

    run: of a limb of the template `soft-limb`, or its folder. pressure: gauge, MPa. limb: its dimensions; default:
    those that the run keeps (`about["limb"]`). part: as for `limb_surface`.

    Raises InputError for a pressure beyond the run, fewer than one limb, a run that keeps no limb; StorageError for a
    folder that cannot be read.
    """
    solution = run if isinstance(run, Solution) else Solution.open(run)
    if limb is None:
        if "limb" not in solution.about:
            raise InputError("the run does not say which limb it is of: give limb, or take the run of a soft limb")
        limb = SoftLimb(**solution.about["limb"])
    if limbs < 1:
        raise InputError(f"limbs = {limbs}, allowed: 1 or more")
    surface = limb_surface(solution, pressure, part)
    points, triangles = [], []
    for number in range(limbs):
        angle = 2.0 * math.pi * number / limbs
        turn = np.array([[math.cos(angle), 0, math.sin(angle)], [0, 1, 0], [-math.sin(angle), 0, math.cos(angle)]])
        points.append((surface.points - np.array(limb.axle)) @ turn.T)
        triangles.append(surface.triangles + number * len(surface.points))
    return np.concatenate(points), np.concatenate(triangles)


def wheel_height(points: Array) -> float:
    """Return the height of a wheel, mm: twice the largest distance of its points (n, 3) from the axle, the y axis."""
    return 2.0 * float(np.hypot(points[:, 0], points[:, 2]).max())


def write_wheel(
    path: str | Path, run: Solution | Path | str, pressure: float, *, limb: SoftLimb | None = None, limbs: int = LIMBS
) -> Written:
    """Write a wheel at a pressure as a binary STL file in mm; see `wheel_surface` for its axes and errors."""
    points, triangles = wheel_surface(run, pressure, limb=limb, limbs=limbs)
    put(path, lambda file: file.write_bytes(stl_bytes(points, triangles, f"wheel, {show(pressure, 'pressure')}")))
    note = f"{limbs} closed limbs, each as if it were filled, without a hub; the axle is the y axis"
    return Written(Path(path), {"triangles": len(triangles)}, (note,))
