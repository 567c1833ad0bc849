"""Settled beds: LAMMPS lets the grains fall until they rest, and the result is kept on disk by what it depends on."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError, StorageError
from pneumorph.solution.files import make_folder
from pneumorph.terrain.granular.bed import (
    GRAINS_FILE,
    RESTART_FILE,
    SPACE,
    Bed,
    solid_fraction,
    surface_level,
)
from pneumorph.terrain.granular.engine import Session
from pneumorph.terrain.rover import GRAVITY
from pneumorph.terrain.si import METRE

Array = NDArray[np.float64]

PATIENCE = 3.0  # s of simulated time in which a bed must come to rest
_PIECE = 0.05  # s between looks at the kinetic energy
_REST = 1e-5  # kinetic energy of a grain at rest, in its weight times its diameter
_LEVEL_CELL = 3.0  # in mean radii: cells in which the surface is looked for
_INPUT, RECORD = "settle.in", "bed.json"


@dataclass(frozen=True)
class Settled:
    """A bed at rest. folder: its files; time: how long it took, s; level: height of its surface, mm; solid: the part of
    the space that grains fill between a diameter above the floor and two below the surface (or all of it, if shallow).
    """

    bed: Bed
    folder: Path
    time: float
    level: float
    solid: float

    @property
    def restart(self) -> Path:
        """LAMMPS's restart file, with the history of all contacts."""
        return self.folder / RESTART_FILE


def cache_folder() -> Path:
    """Return where settled beds are kept: PNEUMORPH_CACHE, else pneumorph/ in the user's folder for caches."""
    chosen = os.environ.get("PNEUMORPH_CACHE")
    if chosen:
        return Path(chosen)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "pneumorph"


def settled(bed: Bed, listen: Callable[[float], None] | None = None) -> Settled:
    """Return a bed at rest, from the cache where it is there, else by LAMMPS.

    listen(time): called each 0.05 s of simulated time. A kill leaves no part of a bed behind. Raises EngineError where
    LAMMPS is missing or the grains do not come to rest, StorageError where the cache cannot be written.
    """
    with Session() as session:
        folder = cache_folder() / "beds" / f"{bed.digest}-{session.version}"
        kept = _kept(bed, folder)
        if kept is not None:
            return kept
        make_folder(folder.parent)
        try:
            part = Path(tempfile.mkdtemp(prefix=f"{folder.name}.", suffix=".part", dir=folder.parent))
        except OSError as error:
            raise StorageError(f"{folder.parent} cannot be written: {error}") from error
        try:
            record = settle_into(session, bed, part, listen)
            try:
                os.replace(part, folder)
            except OSError as error:
                if not (folder / RECORD).exists():  # else another process was faster, with the same bed
                    raise StorageError(f"{folder} cannot be written: {error}") from error
        finally:
            shutil.rmtree(part, ignore_errors=True)
    return Settled(bed, folder, **record)


def settle_into(
    session: Session, bed: Bed, folder: Path, listen: Callable[[float], None] | None = None
) -> dict[str, float]:
    """Settle a bed with a session whose processes share it; return time, level and solid fraction.

    folder gets the grains, an input for LAMMPS's own program, the restart file and, from the first process, the record.
    """
    if session.rank == 0:
        (folder / GRAINS_FILE).write_text(bed.data_text(), encoding="utf-8")
    session.commands(bed.strewing().replace(GRAINS_FILE, _quoted(folder / GRAINS_FILE)) + bed.physics())
    # without the turning: nothing stops a grain that spins about the only contact it has
    session.commands("compute kinetic all ke\nthermo_style custom step c_kinetic\nthermo 100000000")
    session.commands("variable energy equal c_kinetic")
    steps, time, first = round(_PIECE / bed.step), 0.0, True
    mass = bed.sand.density * 4.0 / 3.0 * np.pi * bed.radius**3 * 1e3  # kg
    rest = _REST * bed.grains * mass * GRAVITY * METRE * 2.0 * bed.radius * METRE
    while True:
        session.commands(f"run {steps} pre {'yes' if first else 'no'} post no")
        first, time = False, time + steps * bed.step
        energy = session.variable("energy")
        if listen is not None:
            listen(time)
        # grains that have not landed yet start slow too
        if energy < rest and time > 2.0 * (2.0 * bed.height / GRAVITY) ** 0.5:
            break
        if time >= PATIENCE:
            raise EngineError(
                f"the bed of {bed.grains} grains of '{bed.sand.name}' is not at rest after {time:g} s: kinetic energy "
                f"{energy:.3g} J, expected under {rest:.3g} J"
            )
    session.commands(f"write_restart {_quoted(folder / RESTART_FILE)}")
    places, radii = session.gathered("x", 3) / METRE, session.gathered("radius", 1) / METRE
    level = surface_level(places, radii, _LEVEL_CELL * bed.radius)
    low, high = 2.0 * bed.radius, level - 4.0 * bed.radius
    low, high = (low, high) if high - low > 2.0 * bed.radius else (0.0, level)
    record = {
        "time": time,
        "level": level,
        "solid": solid_fraction(places, radii, bed.length * bed.width, low, high),
    }
    if session.rank == 0:
        (folder / _INPUT).write_text(bed.settling_input(time), encoding="utf-8")
        content = {"bed": asdict(bed), **record}
        (folder / RECORD).write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    return record


def wake(session: Session, still: Settled) -> None:
    """Load a settled bed into a session, with its contacts' history."""
    session.commands(
        SPACE
        + f"read_restart {_quoted(still.restart)}\n"
        + still.bed.physics()
        + "reset_timestep 0\nthermo 100000000\n"
    )


def _kept(bed: Bed, folder: Path) -> Settled | None:
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        found = Settled(bed, folder, record["time"], record["level"], record["solid"])
    except (OSError, ValueError, KeyError):
        return None
    return found if found.restart.exists() else None


def _quoted(path: Path) -> str:
    return f'"{path}"'
