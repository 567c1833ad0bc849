"""Linear and serendipity cells -> the full quadratic kinds that are computed with, by adding the nodes they lack."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mesh.mesh import CELL_NODES, CellBlock
from pneumorph.mesh.reference import MIDS
from pneumorph.mesh.topology import CORNERS

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]

# kinds of solid cells by the names of meshio -> the kind that they become
QUADRATIC = {
    "tetra": "tetra10", "tetra10": "tetra10", "wedge": "wedge18", "wedge15": "wedge18", "wedge18": "wedge18",
    "hexahedron": "hexahedron27", "hexahedron20": "hexahedron27", "hexahedron27": "hexahedron27",
}  # fmt: skip
_MOST = max(CORNERS[kind] for kind in QUADRATIC.values())


def quadratic(points: Array, blocks: Sequence[CellBlock]) -> tuple[Array, tuple[CellBlock, ...]]:
    """Return the points with the added ones behind them, and the blocks as kinds of `QUADRATIC`.

    Nodes that a cell has stay where they are, so edges may be curved. A new node lies in the middle of its edge; that
    of a face or a hexahedron where the serendipity functions of the nodes around it put it. Neighbours share new nodes.
    blocks: of the kinds of `QUADRATIC`, nodes in the order of VTK.
    """
    wanted: list[tuple[int, int, Nodes, Array]] = []  # block, local node, corners that it belongs to, places
    result = []
    for number, block in enumerate(blocks):
        kind = QUADRATIC[block.kind]
        nodes = np.full((len(block.nodes), CELL_NODES[kind]), -1, dtype=np.int64)
        given = block.nodes.shape[1]
        nodes[:, :given] = block.nodes
        for local in range(given, CELL_NODES[kind]):
            corners = MIDS[kind][local]
            key = np.full((len(nodes), _MOST), -1, dtype=np.int64)
            key[:, : len(corners)] = nodes[:, corners]
            wanted.append((number, local, np.sort(key, axis=1), _place(points, kind, nodes, corners, given)))
        result.append(CellBlock(kind, block.domain, nodes))
    if wanted:
        keys = np.concatenate([key for _, _, key, _ in wanted])
        places = np.concatenate([place for _, _, _, place in wanted])
        _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        inverse = inverse.ravel() + len(points)
        start = 0
        for number, local, key, _ in wanted:
            result[number].nodes[:, local] = inverse[start : start + len(key)]
            start += len(key)
        points = np.vstack([points, places[first]])
    return points, tuple(result)


def positive(points: Array, cells: Nodes) -> Nodes:
    """Return 10-node tetrahedra with the second and third corner exchanged where their volume is negative."""
    a, b, c, d = (points[cells[:, i]] for i in range(4))
    negative = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0.0
    cells = cells.copy()
    cells[negative] = cells[negative][:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
    return cells


def _place(points: Array, kind: str, nodes: Nodes, corners: tuple[int, ...], given: int) -> Array:
    """Return where the node between some corners of each cell lies."""
    mean: Array = points[nodes[:, corners]].mean(axis=1)
    mids = [m for m, ends in MIDS[kind].items() if m < given and len(ends) == 2 and set(ends) < set(corners)]
    if len(corners) == 2 or not mids:
        return mean
    around: Array = points[nodes[:, mids]].mean(axis=1)
    # serendipity functions in the middle: corners -1/4 each; mids 1/2 each of a face, 1/4 each of a hexahedron
    return 2.0 * around - mean if len(corners) == 4 else 3.0 * around - 2.0 * mean
