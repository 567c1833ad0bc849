"""Refuse what does not fit into memory before reading or meshing it."""

from __future__ import annotations

from pathlib import Path

import psutil

from pneumorph.errors import MeshError

# bytes in memory for a byte of file: 17 measured on an input deck of 22,000 hexahedra
_TEXT = 17
# bytes for a cell: on 13,000 10-node tetrahedra 5 kB were measured for the tangent, 44 kB with its factor. That is no
# less on larger meshes; half of it, so that nothing is refused that might just fit
_CELL = 20_000


def check_file(path: Path) -> None:
    """Raise MeshError for a file that cannot be read into the memory that is free."""
    size, free = path.stat().st_size, psutil.virtual_memory().available
    if _TEXT * size > free:
        raise MeshError(
            f"'{path}' has {_gigabytes(size)}; reading it takes about {_gigabytes(_TEXT * size)} of memory, "
            f"{_gigabytes(free)} are free"
        )


def check_cells(count: float, what: str) -> None:
    """Raise MeshError if about `count` cells do not fit into the memory that is free."""
    free = psutil.virtual_memory().available
    if _CELL * count > free:
        raise MeshError(
            f"{what}: about {count:.3g} cells take at least {_gigabytes(_CELL * count)} of memory, "
            f"{_gigabytes(free)} are free; choose a larger size"
        )


def _gigabytes(count: float) -> str:
    return f"{count / 1e9:.3g} GB"
