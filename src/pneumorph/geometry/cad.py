"""Export of actuators to CAD and 3-D printing formats, in mm."""

from __future__ import annotations

from pathlib import Path

from pneumorph.errors import InputError, StorageError, unknown_name
from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator
from pneumorph.geometry.stl import stl_bytes

SUFFIXES = (".step", ".stl", ".stp")


def export(actuator: Actuator, path: str | Path, *, size: float | None = None) -> Path:
    """Write an actuator's solid by the suffix of the path, in mm, and return the path.

    .step and .stp hold the exact solid; .stl (binary) holds its surface in triangles no longer than `size` (mm;
    automatic: the actuator's default size), outward normals, inner walls of the cavities included.

    Raises InputError for another suffix, StorageError if the file cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"'{path}': {unknown_name('suffix of a CAD file', suffix, SUFFIXES)}")
    try:
        if suffix == ".stl":
            path.write_bytes(_stl(actuator, size))
        else:
            path.touch()  # the engine does not say when it cannot write
            occ.write_step(actuator.shape(), path)
    except OSError as error:
        raise StorageError(f"'{path}': cannot write ({error.strerror or error})") from error
    return path


def _stl(actuator: Actuator, size: float | None) -> bytes:
    """Return the surface of an actuator as a binary STL file."""
    points, triangles = occ.surface(actuator.shape(), size=size or actuator.default_size)
    return stl_bytes(points, triangles, type(actuator).__name__)
