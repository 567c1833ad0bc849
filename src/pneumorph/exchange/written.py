"""What an export wrote, and the checks that come before it writes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from pneumorph.errors import StorageError
from pneumorph.solution.files import write_atomically


@dataclass(frozen=True)
class Written:
    """A file that was written. counts: what it holds, name -> number; notes: what its reader must know."""

    path: Path
    counts: Mapping[str, int]
    notes: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """One line for people: 'finger.inp: 8,012 nodes, 4,443 elements; 0.9 MB'."""
        parts = ", ".join(f"{number:,} {name}" for name, number in self.counts.items())
        return f"{self.path}: {parts}; {_size(self.path.stat().st_size)}"


def put(path: str | Path, write: Callable[[Path], object]) -> Path:
    """Let `write` fill the file in one go; return its path. Raises StorageError where it cannot be written."""
    path = Path(path)
    if path.is_dir() or not path.resolve().parent.is_dir():
        reason = "is a folder" if path.is_dir() else f"there is no folder '{path.parent}'"
        raise StorageError(f"'{path}': cannot write ({reason})")
    write_atomically(path, write)
    return path


def _size(count: float) -> str:
    for unit in ("bytes", "kB", "MB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} GB"
