"""Writing files so that a kill at any moment leaves the old file or the new one, never a part."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from pneumorph.errors import StorageError

TEMPORARY = ".part"


def write_atomically(path: Path, write: Callable[[Path], object]) -> None:
    """Let `write` fill a temporary file beside `path`, bring it to the disk, then put it in the place of `path`.

    Raises StorageError, naming the file, where the disk or its permissions do not allow it.
    """
    temporary = path.with_name(path.name + TEMPORARY)
    try:
        write(temporary)
        descriptor = os.open(temporary, os.O_RDWR)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
        os.replace(temporary, path)
        _sync_folder(path.parent)
    except OSError as error:
        raise StorageError(f"{path} cannot be written: {error}") from error


def _sync_folder(folder: Path) -> None:
    """Bring a rename to the disk; systems that cannot open folders (Windows) do without."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def make_folder(folder: Path) -> None:
    """Make a folder and its parents; raises StorageError where that is not possible."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StorageError(f"{folder} cannot be made: {error}") from error


def remove_parts(folder: Path) -> None:
    """Remove the temporary files that a killed run left."""
    for part in folder.glob(f"*{TEMPORARY}"):
        part.unlink(missing_ok=True)
