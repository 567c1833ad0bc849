"""Which cell a material point lies in, and fields there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.mechanics.tables import reference_nodes, tabulate
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]
_ITERATIONS = 30


@dataclass(frozen=True, eq=False)
class Places:
    """Points in a mesh. block (n,): number of the block of cells; nodes, weights: lists of n arrays, the nodes of the
    cell and their shape functions there."""

    block: NDArray[np.int64]
    nodes: list[NDArray[np.int64]]
    weights: list[Array]

    def interpolate(self, values: Array, chosen: NDArray[np.bool_] | None = None) -> Array:
        """Return the field (n, ...) at the points, or at the chosen ones, from its values at the nodes (nodes, ...)."""
        numbers = range(len(self.nodes)) if chosen is None else np.flatnonzero(chosen)
        return np.array([np.tensordot(self.weights[i], values[self.nodes[i]], axes=1) for i in numbers])


def locate(mesh: Mesh, points: Array, tolerance: float = 1e-4) -> Places:
    """Return where reference points (n, d), mm, lie.

    tolerance: how far outside a cell a point may be, as a fraction of the cell: curved surfaces lie a little outside
    their chords. Raises InputError with the first point that lies in no cell.
    """
    points = np.atleast_2d(np.asarray(points, dtype=float))
    if points.shape[1:] != (mesh.dimension,) or not np.isfinite(points).all():
        raise InputError(f"points of shape {points.shape}: expected (n, {mesh.dimension}), finite, mm")
    boxes = []
    for block in mesh.blocks:
        corners = mesh.points[block.nodes]
        low, high = corners.min(axis=1), corners.max(axis=1)
        margin = 0.05 * (high - low).max(axis=1)[:, None]
        boxes.append((low - margin, high + margin))
    blocks, nodes, weights = [], [], []
    for point in points:
        best, inside = None, -np.inf
        for number, (block, (low, high)) in enumerate(zip(mesh.blocks, boxes, strict=True)):
            near = np.flatnonzero(((point >= low) & (point <= high)).all(axis=1))
            if not len(near):
                continue
            depth, local = _invert(block.kind, mesh.points[block.nodes[near]], point)
            deepest = int(np.argmax(depth))
            if depth[deepest] > inside:
                inside = float(depth[deepest])
                shape, _ = tabulate(block.kind, local[deepest : deepest + 1])
                best = (number, block.nodes[near[deepest]], shape[0])
        if best is None or inside < -tolerance:
            place = ", ".join(f"{x:.6g}" for x in point)
            raise InputError(f"the point ({place}) mm lies outside the body")
        blocks.append(best[0])
        nodes.append(best[1])
        weights.append(best[2])
    return Places(np.array(blocks), nodes, weights)


def _invert(kind: str, cells: Array, point: Array) -> tuple[Array, Array]:
    """Return for cells (m, n, d) how deep a point lies in each, and its reference coordinates (m, d); by Newton."""
    local = np.tile(reference_nodes(kind).mean(axis=0), (len(cells), 1))
    for _ in range(_ITERATIONS):
        shape, gradient = tabulate(kind, local)
        error = np.einsum("em,emi->ei", shape, cells) - point
        jacobian = np.einsum("emj,emi->eij", gradient, cells)
        step = np.linalg.solve(jacobian + 1e-14 * np.eye(len(point)), error[..., None])[..., 0]
        step *= np.minimum(1.0, 0.5 / np.maximum(np.linalg.norm(step, axis=1), 1e-300))[:, None]
        local = np.clip(local - step, -1.0, 2.0)
        if np.abs(step).max() < 1e-12:
            break
    shape, _ = tabulate(kind, local)
    missed = np.abs(np.einsum("em,emi->ei", shape, cells) - point).max(axis=1)
    depth = _depth(kind, local)
    depth[missed > 1e-6 * np.ptp(cells, axis=1).max(axis=1)] = -np.inf
    return depth, local


def _depth(kind: str, local: Array) -> Array:
    """Return the smallest distance to the sides of the reference cell, negative outside."""
    x, y = local[:, 0], local[:, 1]
    if kind == "tetra10":
        sides = [x, y, local[:, 2], 1.0 - local.sum(axis=1)]
    elif kind == "wedge18":
        sides = [x, y, 1.0 - x - y, local[:, 2], 1.0 - local[:, 2]]
    elif kind == "hexahedron27":
        z = local[:, 2]
        sides = [x, y, z, 1.0 - x, 1.0 - y, 1.0 - z]
    else:
        sides = [x, y, 1.0 - x - y]
    result: Array = np.min(sides, axis=0)
    return result
