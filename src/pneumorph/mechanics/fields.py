"""Fields of a state: deformation gradient, Cauchy stress and stretches, at quadrature points, nodes and any point.

One code for solids, plane strain and axial symmetry: tensors always have three rows, the third is the direction across
the plane, in which F_33 is 1 (plane strain) or r / R, the hoop stretch (axial symmetry).

    sigma = F S F' / J + (q + U'(J)) I,
with S the isochoric second Piola-Kirchhoff stress of the material at C = F'F, q the pressure field of the mixed
formulation, positive in tension (see `mechanics.kernels`), and U' the pointwise share (see `mechanics.volumetric`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.body import cell_volumes, quadrature_places
from pneumorph.mechanics.state import State
from pneumorph.mechanics.tables import cell_table, reference_nodes
from pneumorph.mechanics.volumetric import local_pressure, split_bulk
from pneumorph.mesh.mesh import CellBlock, Mesh

Array = NDArray[np.float64]
_VOIGT = ((0, 1, 2, 1, 0, 0), (0, 1, 2, 2, 2, 1))


@dataclass(frozen=True, eq=False)
class BlockFields:
    """Fields at the quadrature points of one block of cells.

    volume (cells, q): reference volume that each point stands for, mm3; place (cells, q, d): reference position, mm;
    gradient (cells, q, 3, 3): F; stress (cells, q, 3, 3): Cauchy stress, MPa.
    """

    block: CellBlock
    volume: Array
    place: Array
    gradient: Array
    stress: Array

    @property
    def right_cauchy_green(self) -> Array:
        """C = F'F (cells, q, 3, 3)."""
        return np.einsum("eqki,eqkj->eqij", self.gradient, self.gradient)


@lru_cache(maxsize=1)  # several measures look at one state in turn; states are told apart by identity
def fields(state: State) -> list[BlockFields]:
    """Return the fields of a state, one entry for each block of cells of its mesh."""
    model, result = state.model, []
    for number, block in enumerate(model.mesh.blocks):
        table = cell_table(block.kind, model.pressure)
        gradient = deformation_gradient(model.mesh, block, state.positions, table.shape, table.gradient)
        material = model.materials[block.domain]
        c = np.einsum("eqki,eqkj->eqij", gradient, gradient)
        law = material.at(quadrature_places(model.mesh, block.nodes, table))
        voigt, _ = law.stress_and_tangent(c[..., _VOIGT[0], _VOIGT[1]].reshape(-1, 6))
        second = np.empty_like(c)
        for column, (i, j) in enumerate(zip(*_VOIGT, strict=True)):
            second[..., i, j] = second[..., j, i] = voigt[:, column].reshape(c.shape[:2])
        ratio = np.linalg.det(gradient)
        stress = gradient @ second @ np.swapaxes(gradient, 2, 3) / ratio[..., None, None]
        pressure = state.pressure_modes[number] @ table.modes.T + local_pressure(ratio, split_bulk(material)[1])
        stress[..., range(3), range(3)] += pressure[..., None]
        place = np.einsum("qm,emi->eqi", table.shape, model.mesh.points[block.nodes])
        result.append(BlockFields(block, cell_volumes(model.mesh, block), place, gradient, stress))
    return result


def deformation_gradient(mesh: Mesh, block: CellBlock, positions: Array, shape: Array, gradient: Array) -> Array:
    """Return F (cells, q, 3, 3) at tabulated points: shape (q, n) and reference gradient (q, n, d)."""
    d = mesh.dimension
    points, moved = mesh.points[block.nodes], positions[block.nodes]
    reference = np.einsum("emi,qmj->eqij", points, gradient)
    deformed = np.einsum("emi,qmj->eqij", moved, gradient)
    result = np.zeros((*reference.shape[:2], 3, 3))
    result[..., :d, :d] = deformed @ np.linalg.inv(reference)
    if d == 2:
        result[..., 2, 2] = 1.0
    if mesh.space == "axisymmetric":
        radius = points[:, :, 0] @ shape.T
        with np.errstate(invalid="ignore", divide="ignore"):
            hoop = (moved[:, :, 0] @ shape.T) / radius
        result[..., 2, 2] = np.where(radius > 0.0, hoop, result[..., 0, 0])  # on the axis both are the same
    return result


def von_mises(stress: Array) -> Array:
    """Return the von Mises stress (...) of Cauchy stresses (..., 3, 3)."""
    mean = np.trace(stress, axis1=-2, axis2=-1) / 3.0
    deviator = stress - mean[..., None, None] * np.eye(3)
    result: Array = np.sqrt(1.5 * np.einsum("...ij,...ij->...", deviator, deviator))
    return result


def principal(tensor: Array) -> Array:
    """Return the principal values (..., 3) of symmetric tensors (..., 3, 3), the largest first."""
    values: Array = np.asarray(np.linalg.eigvalsh(tensor)[..., ::-1], dtype=np.float64)
    return values


def principal_stretches(gradient: Array) -> Array:
    """Return the principal stretches (..., 3) of deformation gradients (..., 3, 3), the largest first."""
    right = np.einsum("...ki,...kj->...ij", gradient, gradient)
    return np.sqrt(np.maximum(principal(right), 0.0))


def to_nodes(mesh: Mesh, parts: list[BlockFields], of: Callable[[BlockFields], Array]) -> Array:
    """Return a field averaged to the nodes (nodes, ...), nan where none of the blocks in `parts` has a cell.

    It is zero on the nodes that carry free rigid bodies.
    of: takes the fields of a block, gives (cells, q, ...). In each cell it is continued linearly (least squares) from
    the quadrature points to the nodes; cells that meet at a node are weighted by their volumes. Leave out blocks of
    other domains where the field jumps between materials.
    """
    total, weight = None, np.zeros(len(mesh.points))
    for part in parts:
        values = of(part)
        at_nodes = np.einsum("mq,eq...->em...", _continuation(part.block.kind), values)
        cell = part.volume.sum(axis=1)
        if total is None:
            total = np.zeros((len(mesh.points), *values.shape[2:]))
        share = cell.reshape(-1, *[1] * (at_nodes.ndim - 1)) * at_nodes
        np.add.at(total, part.block.nodes, share)
        np.add.at(weight, part.block.nodes, np.broadcast_to(cell[:, None], part.block.nodes.shape))
    if total is None:
        raise ValueError("parts: expected at least one block")
    with np.errstate(invalid="ignore", divide="ignore"):
        averaged: Array = total / weight.reshape(-1, *[1] * (total.ndim - 1))
    averaged[mesh.solid :] = 0.0
    return averaged


def _continuation(kind: str) -> Array:
    """Return the matrix (nodes, q) that continues values at quadrature points linearly to the nodes of a cell."""
    nodes = reference_nodes(kind)
    places = cell_table(kind).shape @ nodes
    at_points = np.hstack([np.ones((len(places), 1)), places])
    at_nodes = np.hstack([np.ones((len(nodes), 1)), nodes])
    matrix: Array = at_nodes @ np.linalg.pinv(at_points)
    return matrix
