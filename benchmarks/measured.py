"""Run a command as a process of its own, with its wall time and peak memory.

A process inherits the peak memory of the one that starts it, so whoever calls this imports the standard library alone.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Measured:
    """Exit code, wall and processor time (s), and peak resident memory (MiB) of a process."""

    code: int
    wall: float
    processor: float
    memory: float


def run(command: Sequence[str], folder: Path, variables: Mapping[str, str], log: Path) -> Measured:
    """Run a command in a folder with extra environment variables; its output goes to `log`."""
    start = time.perf_counter()
    with log.open("wb") as output:
        process = subprocess.Popen(
            command, cwd=folder, env=os.environ | dict(variables), stdout=output, stderr=subprocess.STDOUT
        )
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            process.wait()
            raise
    wall = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)  # wait4 took it, Popen must not wait again
    unit = 1 << 20 if sys.platform == "darwin" else 1 << 10  # ru_maxrss is in bytes there, in KiB on Linux
    return Measured(process.returncode, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / unit)
