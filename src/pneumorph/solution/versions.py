"""What a run was computed with."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from pneumorph.mechanics import Model
from pneumorph.mechanics.linear import linear_solver
from pneumorph.threads import thread_count

# name in the report -> distribution; those that are not installed are left out
_PACKAGES = {
    "pneumorph": "pneumorph", "numpy": "numpy", "scipy": "scipy", "numba": "numba", "netgen": "netgen-mesher",
    "basix": "fenics-basix", "h5py": "h5py", "pypardiso": "pypardiso", "mkl": "mkl",
}  # fmt: skip


def versions() -> dict[str, str]:
    """Return the versions of Python, pneumorph and its engines."""
    found = {"python": platform.python_version()}
    for name, package in _PACKAGES.items():
        try:
            found[name] = version(package)
        except PackageNotFoundError:
            continue
    return found


def meta(model: Model) -> dict[str, Any]:
    """Return versions, platform, threads, linear solver and the sizes of the mesh."""
    mesh = model.mesh
    return {
        "versions": versions(),
        "platform": platform.platform(),
        "threads": thread_count(),
        "linear_solver": linear_solver().name,
        "mesh": {
            "nodes": len(mesh.points),
            "cells": mesh.cell_count,
            "unknowns": int(mesh.points.size),
            "space": mesh.space,
            "domains": {d: sum(len(b.nodes) for b in mesh.blocks if b.domain == d) for d in mesh.domains},
        },
    }
