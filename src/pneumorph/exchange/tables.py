"""Tables (CSV): nodes of a state, and pressure against volume of the cavities."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.exchange.inp_steps import PressureTable
from pneumorph.exchange.written import Written, put
from pneumorph.mechanics import State
from pneumorph.mechanics.fields import fields, principal, to_nodes, von_mises
from pneumorph.solution import History

Array = NDArray[np.float64]

PASCAL = 1e6  # Pa in an MPa
CUBIC_METRE = 1e-9  # m3 in a mm3
_PAIRS = (("x", "x"), ("y", "y"), ("z", "z"), ("x", "y"), ("y", "z"), ("z", "x"))
_STILL = 1e-9  # steps below this share of the range are round-off


def write_nodes(path: str | Path, state: State) -> Written:
    """Write one line for each node of a state: number, place in the reference, displacement, Cauchy stress, stretch.

    Numbers count from 1, as in an .inp file of the same mesh. Stress is continued from the integration points and
    averaged over the cells that meet in a node, also where two materials do.
    """
    mesh = state.model.mesh
    axes = "xyz"[: mesh.dimension]
    parts = fields(state)
    stress = to_nodes(mesh, parts, lambda part: part.stress)
    right = to_nodes(mesh, parts, lambda part: part.right_cauchy_green)
    header = ["node", *(f"{axis} [mm]" for axis in axes), *(f"u{axis} [mm]" for axis in axes)]
    header += [f"stress_{i}{j} [MPa]" for i, j in _PAIRS] + ["von_mises [MPa]", "largest_stretch"]
    columns = [mesh.points, state.displacement]
    columns += [stress[:, "xyz".index(i), "xyz".index(j)][:, None] for i, j in _PAIRS]
    columns += [von_mises(stress)[:, None], np.sqrt(np.maximum(principal(right)[:, 0], 0.0))[:, None]]
    table = np.hstack(columns).tolist()
    _write(path, header, ([number, *map(repr, line)] for number, line in enumerate(table, 1)))
    return Written(Path(path), {"nodes": len(table)})


def write_pressure_volume(path: str | Path, history: History, cavities: Sequence[str] = ()) -> Written:
    """Write gauge pressure [Pa], volume [m3] and compliance dV/dp [m3/Pa] of cavities, one line for each state.

    cavities: which, by default all. The compliance is the slope along the run, through a state and its neighbours: with
    several cavities it holds for the way in which they were driven together. It is left empty where the pressure stands
    still or turns (there the slope has no value).

    Raises NameNotFoundError for a cavity that the run does not have, InputError where it has none.
    """
    known = [key.removeprefix("pressure:") for key in history.keys if key.startswith("pressure:")]
    if not known:
        raise InputError("the run has no cavity: no pressure-volume curve to write")
    for name in cavities:
        if name not in known:
            raise NameNotFoundError(unknown_name("cavity", name, known))
    header, columns = ["state"], [[str(int(index)) for index in history.values("index")]]
    for name in cavities or known:
        pressure = PASCAL * history.values(f"pressure:{name}")
        volume = CUBIC_METRE * history.values(f"volume:{name}")
        header += [f"pressure:{name} [Pa]", f"volume:{name} [m3]", f"compliance:{name} [m3/Pa]"]
        columns += [[_number(value) for value in values] for values in (pressure, volume, slope(pressure, volume))]
    _write(path, header, zip(*columns, strict=True))
    return Written(Path(path), {"states": len(history), "cavities": len(cavities or known)})


def slope(x: Array, y: Array) -> Array:
    """Return dy/dx (n,) at points in order: of the parabola through a point and its neighbours, of the line to the only
    neighbour where there is one, or where x stands still on the other side; nan where x turns or stands still."""
    step = np.diff(x)
    step[np.abs(step) <= _STILL * np.ptp(x)] = 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        secant = np.where(step != 0.0, np.diff(y) / step, np.nan)
    before, after = np.concatenate([[np.nan], secant]), np.concatenate([secant, [np.nan]])
    left, right = np.concatenate([[0.0], step]), np.concatenate([step, [0.0]])
    with np.errstate(invalid="ignore", divide="ignore"):
        middle = (before * right + after * left) / (left + right)
    result = np.where(np.isnan(before), after, np.where(np.isnan(after), before, middle))
    return np.where(left * right < 0.0, np.nan, result)


def pressures_of(history: History, cavities: Iterable[str], end: float | None = None) -> dict[str, PressureTable]:
    """Return cavity -> pressures over time of a run, for `write_inp`.

    end: time at which the programme is cut (see `up_to`): the times of its last phase are stretched as that is.
    """
    time = history.values("time")
    last = time[-1] if end is None else end
    kept = time <= last
    whole = np.ceil(last) - 1.0
    stretched = np.where(time > whole, whole + (time - whole) / (last - whole), time)
    return {name: PressureTable(stretched[kept], history.values(f"pressure:{name}")[kept]) for name in cavities}


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.12g}"


def _write(path: str | Path, header: Sequence[str], lines: Iterable[Sequence[object]]) -> None:
    def write(part: Path) -> None:
        with part.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows(lines)

    put(path, write)
