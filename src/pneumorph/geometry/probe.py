"""Whether Open CASCADE survives a CAD file: damaged ones make it end the process instead of raising an error."""

from __future__ import annotations

import subprocess
import sys
from functools import lru_cache
from pathlib import Path

from pneumorph.errors import GeometryError

_READ = """
import sys
from pathlib import Path
from pneumorph.errors import GeometryError
from pneumorph.geometry import occ
try:
    occ.read_cad(Path(sys.argv[1]), probed=True)
except GeometryError:
    pass
"""


def check_survives(path: Path) -> None:
    """Read a CAD file in a process of its own, once; raises GeometryError where that process breaks down."""
    if path.is_file():
        _check(str(path.resolve()), path.stat().st_mtime_ns)


@lru_cache(maxsize=16)
def _check(path: str, time_of_change: int) -> None:
    result = subprocess.run([sys.executable, "-c", _READ, path], capture_output=True, stdin=subprocess.DEVNULL)
    # 1 is a Python error, which shows again where the file is read
    if result.returncode not in (0, 1):
        raise GeometryError(
            f"'{path}': Open CASCADE breaks down while it reads this file, so the file is damaged; export it again"
        )
