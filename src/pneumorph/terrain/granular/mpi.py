"""One bed settled by several processes: LAMMPS cuts the box into parts, one for each, as on a cluster.

    mpiexec -n 2 python -m pneumorph.terrain.granular.mpi FOLDER

settles the bed that FOLDER/bed-wanted.json describes. The same input for LAMMPS's own program lies in the folder
afterwards, as settle.in.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

from pneumorph.errors import EngineError, InputError
from pneumorph.solution.files import make_folder
from pneumorph.terrain.granular.bed import Bed
from pneumorph.terrain.granular.engine import EXTRA, Session, installed_file
from pneumorph.terrain.granular.sands import Sand
from pneumorph.terrain.granular.settling import RECORD, Settled, settle_into

_WANTED = "bed-wanted.json"
_LAUNCHER = "mpiexec.hydra"


def settled_by(ranks: int, bed: Bed, folder: Path) -> Settled:
    """Return a bed that `ranks` processes settled together; `folder` gets its files.

    Raises InputError for less than one process, EngineError where mpiexec is missing or LAMMPS fails.
    """
    if ranks < 1:
        raise InputError(f"ranks = {ranks}: expected at least 1")
    launcher = installed_file(_LAUNCHER)
    if launcher is None:
        raise EngineError(f"mpiexec is missing: pip install 'pneumorph[{EXTRA}]'")
    make_folder(folder)
    (folder / _WANTED).write_text(json.dumps(asdict(bed)), encoding="utf-8")
    words = [str(launcher), "-n", str(ranks), sys.executable, "-m", __name__, str(folder)]
    result = subprocess.run(words, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if result.returncode != 0:
        lines = [line for line in (result.stdout + result.stderr).splitlines() if line.strip()]
        raise EngineError(f"{ranks} processes did not settle the bed: {lines[-1] if lines else 'no reason given'}")
    record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
    return Settled(bed, folder, record["time"], record["level"], record["solid"])


def main(folder: Path) -> None:
    """Settle the bed that a folder asks for, with all processes that run this."""
    wanted = json.loads((folder / _WANTED).read_text(encoding="utf-8"))
    bed = Bed(**{**wanted, "sand": Sand(**wanted["sand"])})
    with Session() as session:
        settle_into(session, bed, folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
