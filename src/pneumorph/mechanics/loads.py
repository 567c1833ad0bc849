"""Dead loads: gravity, traction and force on a face, each scaled by what the programme sets under its name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.materials import Material
from pneumorph.mechanics.body import cell_volumes
from pneumorph.mechanics.tables import cell_table, face_sizes, face_table
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]


def _unit(direction: tuple[float, ...], mesh: Mesh, owner: str) -> Array:
    """Return a direction of length 1 that fits the mesh."""
    vector = np.asarray(direction, dtype=float)
    if vector.shape != (mesh.dimension,) or not np.isfinite(vector).all() or not vector.any():
        raise InputError(f"{owner}: direction = {direction!r}, expected {mesh.dimension} numbers, not all zero")
    return vector / np.linalg.norm(vector)


@dataclass(frozen=True)
class Gravity:
    """Weight of all cells; the programme sets the acceleration (mm/s2) along `direction`. Needs densities."""

    direction: tuple[float, ...]
    name: str = "gravity"
    kind: ClassVar[str] = "acceleration"

    def weights(self, mesh: Mesh, masses: Mapping[str, float]) -> Array:
        """Return nodal forces (nodes * d,) on free bodies of given masses, tonne, for 1 mm/s2."""
        mass = np.zeros(len(mesh.points))
        for name, value in masses.items():
            nodes = mesh.frames[name]
            mass[nodes] = value / len(nodes)  # the frame's centre is that of mass
        return np.outer(mass, _unit(self.direction, mesh, f"gravity '{self.name}'")).ravel()

    def pattern(self, mesh: Mesh, materials: Mapping[str, Material]) -> Array:
        """Return nodal forces (nodes * d,) on the cells for an acceleration of 1 mm/s2."""
        direction = _unit(self.direction, mesh, f"gravity '{self.name}'")
        densities = {name: density_of(material, name, "gravity") for name, material in materials.items()}
        mass = lumped_mass(mesh, densities, False)
        return np.outer(mass, direction).ravel()


@dataclass(frozen=True)
class Traction:
    """Force per reference area on a face along `direction`; the programme sets it in MPa. It does not follow."""

    face: str
    direction: tuple[float, ...]
    name: str
    kind: ClassVar[str] = "stress"

    def pattern(self, mesh: Mesh, materials: Mapping[str, Material]) -> Array:
        """Return nodal forces (nodes * d,) for a traction of 1 MPa."""
        return np.outer(_areas(mesh, self.face), _unit(self.direction, mesh, f"traction '{self.name}'")).ravel()


@dataclass(frozen=True)
class Force:
    """A force spread evenly over the reference area of a face, or at the centre of mass of a free body.

    The programme sets its size in N.
    """

    face: str
    direction: tuple[float, ...]
    name: str
    kind: ClassVar[str] = "force"

    def pattern(self, mesh: Mesh, materials: Mapping[str, Material]) -> Array:
        """Return nodal forces (nodes * d,) for a force of 1 N."""
        if self.face in mesh.frames:
            areas = np.zeros(len(mesh.points))
            areas[mesh.frames[self.face]] = 1.0
        else:
            areas = _areas(mesh, self.face)
        return np.outer(areas / areas.sum(), _unit(self.direction, mesh, f"force '{self.name}'")).ravel()


Load = Gravity | Traction | Force


def density_of(material: Material, domain: str, use: str) -> float:
    """Return the density, tonne/mm3; raises InputError, naming what it is needed for, where there is none."""
    if material.density is None:
        raise InputError(f"{use} needs a density for the material of '{domain}', which has none")
    return material.density


def lumped_mass(mesh: Mesh, density: Mapping[str, float], positive: bool = True) -> Array:
    """Return mass by node (nodes,), tonne, for densities by domain.

    `positive` spreads each cell's mass in the ratio of the squared shape functions (Hinton, Rock and Zienkiewicz 1976):
    corner nodes of quadratic cells would otherwise get a share of zero or less. Without it, shares are work-equivalent.
    """
    mass = np.zeros(len(mesh.points))
    for block in mesh.blocks:
        table = cell_table(block.kind)
        weights = density[block.domain] * cell_volumes(mesh, block)
        if positive:
            share = np.einsum("eq,qm->em", weights, table.shape**2)
            share *= (weights.sum(axis=1) / share.sum(axis=1))[:, None]
        else:
            share = np.einsum("eq,qm->em", weights, table.shape)
        np.add.at(mass, block.nodes, share)
    return mass


def _areas(mesh: Mesh, face: str) -> Array:
    """Return the reference area that each node bears of a face (nodes,), mm2."""
    areas = np.zeros(len(mesh.points))
    for block in mesh.face_blocks(face):
        shape, gradient, weight = face_table(block.kind)
        x = mesh.points[block.nodes]
        size = face_sizes(x, gradient)
        if mesh.space == "axisymmetric":
            size = size * 2 * np.pi * np.einsum("qm,em->eq", shape, x[:, :, 0])
        np.add.at(areas, block.nodes, np.einsum("eq,q,qm->em", size, weight, shape))
    return areas
