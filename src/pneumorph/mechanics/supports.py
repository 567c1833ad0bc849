"""Supports: named faces whose nodes are held or moved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.mesh.mesh import Mesh

AXES = ("x", "y", "z")


def axis_index(axis: str, mesh: Mesh, owner: str) -> int:
    """Return 0, 1 or 2 for 'x', 'y' or 'z'; raises InputError for an axis that the mesh does not have."""
    allowed = AXES[: mesh.dimension]
    if axis not in allowed:
        raise InputError(f"{owner}: axis = {axis!r}, allowed: {', '.join(allowed)}")
    return allowed.index(axis)


@dataclass(frozen=True)
class Clamp:
    """All displacements of a face are zero."""

    face: str

    def held(self, mesh: Mesh) -> NDArray[np.int64]:
        """Return the unknowns that are held at zero."""
        d = mesh.dimension
        return (d * mesh.face_nodes(self.face)[:, None] + np.arange(d)).ravel()


@dataclass(frozen=True)
class Roller:
    """The displacement of a face along one axis ('x', 'y', 'z'; radius is x with axial symmetry) is zero."""

    face: str
    axis: str

    def held(self, mesh: Mesh) -> NDArray[np.int64]:
        """Return the unknowns that are held at zero."""
        return mesh.dimension * mesh.face_nodes(self.face) + axis_index(self.axis, mesh, f"roller on '{self.face}'")


@dataclass(frozen=True)
class Symmetry:
    """A plane face in a mirror plane normal to a coordinate axis: no displacement across it.

    Raises InputError where the face is not plane, or its normal is oblique to the axes.
    """

    face: str

    def held(self, mesh: Mesh) -> NDArray[np.int64]:
        """Return the unknowns that are held at zero."""
        nodes = mesh.face_nodes(self.face)
        spread = np.ptp(mesh.points[nodes], axis=0)
        axis = int(np.argmin(spread))
        if spread[axis] > 1e-6 * mesh.size:
            raise InputError(f"symmetry on '{self.face}': expected a plane face normal to x, y or z")
        return mesh.dimension * nodes + axis


@dataclass(frozen=True)
class Prescribed:
    """A face moved along one axis by the distance (mm) that the programme sets under `name`; free across it."""

    face: str
    axis: str
    name: str
    kind: ClassVar[str] = "length"

    def driven(self, mesh: Mesh) -> NDArray[np.int64]:
        """Return the unknowns that move."""
        return mesh.dimension * mesh.face_nodes(self.face) + axis_index(self.axis, mesh, f"prescribed '{self.name}'")


Support = Clamp | Roller | Symmetry | Prescribed
