"""Sweeps of robots over rigid terrain: what each run is, running them into a folder, and tables of distances."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from pneumorph.errors import PneumorphError, StorageError
from pneumorph.solution.files import make_folder, remove_parts, write_atomically
from pneumorph.studies.run_table import DONE, FAILED, RunTable
from pneumorph.studies.sweeps.cluster import Workers
from pneumorph.terrain import (
    Drive,
    HeightField,
    Rover,
    Travel,
    check_course,
    course,
    ground_bytes,
    load,
    mjcf,
    simulate,
)
from pneumorph.terrain.courses import EXTENT
from pneumorph.terrain.height_field import from_image_bytes, to_image

FORMAT = 1
SWEEP, TABLE = "sweep.json", "runs.csv"
MODELS, TERRAINS, TRAJECTORIES = "models", "terrains", "trajectories"
# distances in m: what the study speaks of; penetration in mm
COLUMNS = (
    "wheel", "paddles", "shape", "terrain", "drop", "start x [m]", "start y [m]", "distance [m]", "sideways [m]",
    "as the crow flies [m]", "least upright [-]", "turns [-]", "penetration [mm]", "wall [s]",
)  # fmt: skip
_MILLIMETRE = 1e-3


@dataclass(frozen=True)
class Ground:
    """A terrain by name: one of `terrain.COURSES`, or an image file's content with the height of white, mm."""

    name: str
    image: bytes = b""
    relief: float = 0.0

    @property
    def field(self) -> HeightField:
        """Its height field; made once in a process."""
        return _field(self)


@lru_cache(maxsize=8)
def _field(ground: Ground) -> HeightField:
    if not ground.image:
        return course(ground.name)
    return from_image_bytes(ground.image, ground.name, length=EXTENT, width=EXTENT, relief=ground.relief)


@lru_cache(maxsize=8)
def _ground_bytes(ground: Ground) -> bytes:
    return ground_bytes(ground.field)


@dataclass(frozen=True)
class RollingRun:
    """One robot on one terrain, dropped at a place (x, y in mm); `drop` counts the places from 1, 0 if there is one."""

    rover: Rover
    drive: Drive
    ground: Ground
    drop: int = 0
    place: tuple[float, float] = (0.0, 0.0)

    @property
    def name(self) -> str:
        """Such as 'curved-3_smooth-2'."""
        return f"{self.rover.wheel.name}_{self.ground.name}" + (f"-{self.drop}" if self.drop else "")

    @property
    def ground_file(self) -> str:
        """Name of the file with the ground's heights, beside the model."""
        return f"{self.ground.name}.hfield"

    def model_text(self) -> str:
        """Return the MJCF of the run; raises InputError where the terrain is too small for it."""
        check_course(self.rover, self.drive, self.ground.field, self.place)
        return mjcf(self.rover, self.drive, self.ground.field, self.ground_file, self.place)


def travel(run: RollingRun) -> tuple[Travel, float]:
    """Return the way of a run and the wall time, s; needs no file, so that it may run on another machine."""
    start = time.perf_counter()
    model = load(run.model_text(), {run.ground_file: _ground_bytes(run.ground)})
    return simulate(model, run.drive), time.perf_counter() - start


@dataclass(frozen=True)
class RollingNews:
    """After a run: how many are finished of how many, its row, and the time elapsed and expected to be left, s."""

    finished: int
    total: int
    row: Mapping[str, object]
    elapsed: float
    remaining: float


def run_rolling(
    runs: Sequence[RollingRun],
    folder: Path,
    settings: Mapping[str, Any],
    *,
    resume: bool = False,
    workers: Workers | None = None,
    progress: Callable[[RollingNews], None] | None = None,
    command: str = "",
) -> dict[str, dict[str, str]]:
    """Run all into a folder and return the rows of its table by name of the run.

    The folder gets sweep.json (`settings`, `command` and versions), models/ (MJCF that MuJoCo's viewer opens),
    terrains/ (16-bit images), trajectories/ and runs.csv, to which each run adds its row when it ends; one that fails
    adds its reason. With `resume` what is done is left out and what failed is tried again.

    workers: who does the work, by default processes of this machine; pneumorph must be installed where they are.

    Raises StorageError for a folder that holds a sweep without `resume`, or one of other settings; InputError for a
    run that its terrain is too small for; both before anything is computed.
    Raises EngineError where no scheduler answers.
    """
    table = RunTable(folder / TABLE, COLUMNS)
    begun = (folder / SWEEP).exists()
    if (begun or (folder / "run.json").exists()) and not resume:
        raise StorageError(f"'{folder}' already holds a run: resume it (--resume) or choose another folder")
    texts = {run.name: run.model_text() for run in runs}
    kept = json.loads(json.dumps(settings))
    if begun:
        if read_sweep(folder)["settings"] != kept:
            raise StorageError(f"'{folder}' holds a sweep with other settings: choose another folder")
    else:
        _prepare(folder, runs, texts, {"settings": kept, "command": command})
    for part in (folder, folder / TRAJECTORIES):
        remove_parts(part)
    rows = table.rows()
    left = [run for run in runs if rows.get(run.name, {}).get("status") != DONE]
    start = time.perf_counter()
    calls = [(run,) for run in left]
    for number, (which, result) in enumerate((workers or Workers()).compute(travel, calls), start=1):
        run = left[which]
        row = _row(run)
        if isinstance(result, Exception):
            if not isinstance(result, PneumorphError):
                result = PneumorphError(f"{type(result).__name__}: {result}")
            row |= {"status": FAILED, "reason": str(result)}
        else:
            way, wall = result
            _write_trajectory(folder, run.name, way)
            row |= {"status": DONE, "wall [s]": wall, **_numbers(way)}
        table.append(row)
        if progress is not None:
            elapsed = time.perf_counter() - start
            finished = len(runs) - len(left) + number
            progress(RollingNews(finished, len(runs), row, elapsed, elapsed / number * (len(left) - number)))
    return table.rows()


def _prepare(folder: Path, runs: Sequence[RollingRun], texts: Mapping[str, str], about: Mapping[str, Any]) -> None:
    for part in (MODELS, TERRAINS, TRAJECTORIES):
        make_folder(folder / part)
    for ground in dict.fromkeys(run.ground for run in runs):
        content = _ground_bytes(ground)
        write_atomically(folder / MODELS / f"{ground.name}.hfield", lambda path, c=content: path.write_bytes(c))  # type: ignore[misc]
        picture = BytesIO()
        to_image(ground.field).save(picture, "PNG")
        image = ground.image or picture.getvalue()
        write_atomically(folder / TERRAINS / f"{ground.name}.png", lambda path, c=image: path.write_bytes(c))  # type: ignore[misc]
    for name, text in texts.items():
        write_atomically(folder / MODELS / f"{name}.xml", lambda path, t=text: path.write_text(t, encoding="utf-8"))  # type: ignore[misc]
    record = {"format": FORMAT, **about, "versions": _versions()}
    write_atomically(
        folder / SWEEP, lambda path: path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    )


def read_sweep(folder: Path) -> dict[str, Any]:
    """Return what sweep.json holds; raises StorageError where it is missing, damaged or of another format."""
    path = folder / SWEEP
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        number, _, _, _ = record["format"], record["settings"]["reproduction"], record["versions"], record["command"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise StorageError(f"{path} cannot be read: {error}") from error
    if number != FORMAT:
        raise StorageError(f"{path} has format {number}, this version reads {FORMAT}")
    return dict(record)


def _versions() -> dict[str, str]:
    def of(name: str) -> str:
        try:
            return version(name)
        except PackageNotFoundError:
            return "not installed"

    return {name: of(name) for name in ("pneumorph", "mujoco", "numpy")}


def _row(run: RollingRun) -> dict[str, object]:
    wheel = run.rover.wheel
    return {
        "run": run.name,
        "wheel": wheel.name,
        "paddles": wheel.paddles,
        "shape": "curved" if wheel.curved else "straight" if wheel.paddles else "plain",
        "terrain": run.ground.name,
        "drop": run.drop,
        "start x [m]": run.place[0] * _MILLIMETRE,
        "start y [m]": run.place[1] * _MILLIMETRE,
    }


def _numbers(way: Travel) -> dict[str, float]:
    return {
        "distance [m]": way.distance * _MILLIMETRE,
        "sideways [m]": way.sideways * _MILLIMETRE,
        "as the crow flies [m]": way.as_the_crow_flies * _MILLIMETRE,
        "least upright [-]": float(way.upright.min()),
        "turns [-]": float(way.turn[-1].mean()) / (2.0 * np.pi),
        "penetration [mm]": way.penetration,
    }


def _write_trajectory(folder: Path, name: str, way: Travel) -> None:
    buffer = BytesIO()
    np.savez_compressed(buffer, **{key: value for key, value in asdict(way).items() if key != "penetration"})
    write_atomically(folder / TRAJECTORIES / f"{name}.npz", lambda path: path.write_bytes(buffer.getvalue()))


def read_trajectory(folder: Path, name: str) -> dict[str, np.ndarray]:
    """Return time, centre, upright, turn, turn_speed and pose of a run, as in `Travel`; raises StorageError."""
    path = folder / TRAJECTORIES / f"{name}.npz"
    try:
        with np.load(path) as arrays:
            return {key: arrays[key] for key in arrays.files}
    except (OSError, ValueError, KeyError) as error:
        raise StorageError(f"{path} cannot be read: {error}") from error


@dataclass(frozen=True)
class Cell:
    """The distances, m, of one wheel on one terrain over its drops; failed: how many runs have none."""

    values: tuple[float, ...]
    failed: int = 0
    overturned: int = 0

    @property
    def mean(self) -> float | None:
        """Mean over the drops that were computed, None where there is none."""
        return sum(self.values) / len(self.values) if self.values else None

    @property
    def spread(self) -> float:
        """Largest less smallest, 0 of a single one."""
        return max(self.values) - min(self.values) if self.values else 0.0


def distances(rows: Iterable[Mapping[str, str]]) -> dict[str, dict[str, Cell]]:
    """Return wheel -> terrain -> distances, in the order of the rows."""
    result: dict[str, dict[str, Cell]] = {}
    for row in rows:
        cells = result.setdefault(row["wheel"], {})
        old = cells.get(row["terrain"], Cell(()))
        if row["status"] == DONE:
            over = old.overturned + (float(row["least upright [-]"]) < 0.0)
            cells[row["terrain"]] = Cell((*old.values, float(row["distance [m]"])), old.failed, over)
        else:
            cells[row["terrain"]] = Cell(old.values, old.failed + 1, old.overturned)
    return result


def ranking(table: Mapping[str, Mapping[str, Cell]]) -> list[tuple[str, float, float]]:
    """Return (wheel, mean, least distance in m) over the terrains, the best mean first.

    A wheel with a terrain of which nothing was computed is left out.
    """
    ranked = []
    for wheel, cells in table.items():
        means = [cell.mean for cell in cells.values()]
        known = [mean for mean in means if mean is not None]
        if len(known) == len(means):
            ranked.append((wheel, sum(known) / len(known), min(known)))
    return sorted(ranked, key=lambda item: -item[1])
