"""How good a mesh is: counts, shapes of cells, volume, and elements across the walls that bend."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.reference import jacobians, quadrature, shape
from pneumorph.mesh.topology import CORNERS

Array = NDArray[np.float64]

# simplices that make up a cell, by local corners
_SIMPLICES: dict[str, list[tuple[int, ...]]] = {
    "tetra10": [(0, 1, 2, 3)],
    "wedge18": [(0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)],
    "hexahedron27": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)],
    "triangle6": [(0, 1, 2)],
}
_RAYS = 4000  # enough to hit every kind of wall; more cost time only
# elements wanted -> least mean that counts as so many: unstructured cells vary, and rays at corners lower the mean
_ENOUGH = {1: 0.95, 2: 1.5}
_ALONG: tuple[float, ...] = (0.1, 0.3, 0.5, 0.7, 0.9)


@dataclass(frozen=True)
class Quality:
    """What `inspect` finds; lengths in mm, volume in mm³ (area in mm² times 1 mm in plane strain).

    smallest_jacobian: least ratio of smallest to largest det J in a cell at the quadrature points; 1 is a straight
    cell, 0 or less an inverted one. worst_aspect: largest ratio of longest edge to smallest height of a cell's
    simplices, scaled to 1 for a regular one. elements_across: for each wall of the mesh's `bending_walls`, the mean
    number of elements through its thickness; nan where no such wall was found. warnings: sentences for a reader,
    empty if all is well.
    """

    cells: int
    nodes: int
    unknowns: int
    smallest_jacobian: float
    worst_aspect: float
    volume: float
    smallest_edge: float
    median_edge: float
    elements_across: Mapping[str, float]
    warnings: tuple[str, ...]


def inspect(mesh: Mesh) -> Quality:
    """Return the quality of a mesh.

    A wall that bends should have one quadratic element across its thickness, a thick one two; a wall is thick if it
    measures more than a fifth of the smallest side of the mesh's bounding box. Elements across are found with rays
    shot inward from the boundary: a ray that leaves the solid after the wall's thickness (within 2 %) sums, along its
    way, 1 / (extent of the element that it is in, along the ray).
    """
    ratio, volume = _jacobian_ratio_and_volume(mesh)
    simplices = _simplices(mesh)
    edges = _edges(mesh.points[simplices])
    across = {name: elements_across(mesh, thickness) for name, thickness in mesh.bending_walls.items()}
    nodes = len(np.unique(np.concatenate([block.nodes.ravel() for block in mesh.blocks])))
    return Quality(
        cells=mesh.cell_count,
        nodes=nodes,
        unknowns=nodes * mesh.dimension,
        smallest_jacobian=ratio,
        worst_aspect=float(_aspects(mesh.points[simplices], edges).max()),
        volume=volume,
        smallest_edge=float(edges.min()),
        median_edge=float(np.median(edges)),
        elements_across=MappingProxyType(across),
        warnings=_warnings(mesh, ratio, across),
    )


def elements_across(mesh: Mesh, thickness: float) -> float:
    """Return the mean number of elements through walls of a thickness (mm), nan if there is no such wall."""
    origin, direction = _rays(mesh)
    locate = _Locator(mesh)
    # the wall's other side lies where it should: inside just before it, outside just behind it
    hit = (locate(origin + 0.98 * thickness * direction) >= 0) & (locate(origin + 1.02 * thickness * direction) < 0)
    origin, direction = origin[hit], direction[hit]
    if len(origin) == 0:
        return float("nan")
    inverse = np.zeros((len(_ALONG), len(origin)))
    for i, share in enumerate(_ALONG):
        cell = locate(origin + share * thickness * direction)
        heights = np.einsum("rni,ri->rn", locate.corners[cell], direction)
        inverse[i] = np.where(cell >= 0, 1.0 / np.ptp(heights, axis=1), np.nan)
    whole = ~np.isnan(inverse).any(axis=0)
    return float(thickness * inverse[:, whole].mean()) if whole.any() else float("nan")


class _Locator:
    """Finds the cell that contains a point, by straight simplices; -1 outside."""

    def __init__(self, mesh: Mesh):
        places, owners, corners, first = [], [], [], 0
        most = max(CORNERS[block.kind] for block in mesh.blocks)
        for block in mesh.blocks:
            pattern = _SIMPLICES[block.kind]
            places.append(mesh.points[block.nodes[:, pattern]].reshape(-1, mesh.dimension + 1, mesh.dimension))
            owners.append(np.repeat(np.arange(len(block.nodes)) + first, len(pattern)))
            local = np.resize(np.arange(CORNERS[block.kind]), most)
            corners.append(mesh.points[block.nodes[:, local]])
            first += len(block.nodes)
        self.corners: Array = np.concatenate(corners)
        simplices = np.concatenate(places)
        self._owner = np.concatenate(owners)
        self._origin = simplices[:, 0]
        self._inverse = np.linalg.inv((simplices[:, 1:] - simplices[:, :1]).transpose(0, 2, 1))
        centres = simplices.mean(axis=1)
        self._tree = cKDTree(centres)
        self._reach = float(np.linalg.norm(simplices - centres[:, None], axis=2).max())

    def __call__(self, points: Array) -> NDArray[np.int64]:
        """Return the cell numbers (n,) of points (n, dim)."""
        found = np.full(len(points), -1, dtype=np.int64)
        near = min(80, len(self._origin))
        distance, candidate = self._tree.query(points, k=near, distance_upper_bound=self._reach * 1.001)
        distance, candidate = distance.reshape(len(points), -1), candidate.reshape(len(points), -1)
        for column in range(near):
            open_ = np.flatnonzero((found < 0) & np.isfinite(distance[:, column]))
            if len(open_) == 0:
                continue
            simplex = candidate[open_, column]
            local = np.einsum("nij,nj->ni", self._inverse[simplex], points[open_] - self._origin[simplex])
            inside = (local.min(axis=1) > -1e-9) & (local.sum(axis=1) < 1.0 + 1e-9)
            found[open_[inside]] = self._owner[simplex[inside]]
        return found


def _rays(mesh: Mesh) -> tuple[Array, Array]:
    """Return origins on the boundary (r, dim) and unit directions into the solid, evenly thinned out."""
    origins, directions = [], []
    for blocks in mesh.faces.values():
        for block in blocks:
            corner = mesh.points[block.nodes[:, : CORNERS[block.kind]]]
            if mesh.dimension == 2:
                along = corner[:, 1] - corner[:, 0]
                # the solid lies on the left of its boundary
                inward = np.column_stack([-along[:, 1], along[:, 0]])
            else:
                inward = -np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
            origins.append(corner.mean(axis=1))
            directions.append(inward / np.linalg.norm(inward, axis=1, keepdims=True))
    origin, direction = np.concatenate(origins), np.concatenate(directions)
    step = -(-len(origin) // _RAYS)
    return origin[::step], direction[::step]


def _jacobian_ratio_and_volume(mesh: Mesh) -> tuple[float, float]:
    ratio, volume = 1.0, 0.0
    for block in mesh.blocks:
        places, weights = quadrature(block.kind)
        det = jacobians(mesh.points, block.kind, block.nodes)
        ratio = min(ratio, float((det.min(axis=1) / np.abs(det).max(axis=1)).min()))
        if mesh.space == "axisymmetric":
            det = det * _radii(mesh, block.kind, block.nodes, places)
        volume += float((det @ weights).sum())
    return ratio, volume


def _radii(mesh: Mesh, kind: str, nodes: NDArray[np.int64], places: Array) -> Array:
    """Return 2 pi times the radius (cells, q) at reference points."""
    return np.asarray(2.0 * np.pi * mesh.points[nodes][:, :, 0] @ shape(kind, places).T)


def _simplices(mesh: Mesh) -> NDArray[np.int64]:
    return np.concatenate([b.nodes[:, _SIMPLICES[b.kind]].reshape(-1, mesh.dimension + 1) for b in mesh.blocks])


def _edges(corners: Array) -> Array:
    first, second = np.triu_indices(corners.shape[1], 1)
    return np.asarray(np.linalg.norm(corners[:, first] - corners[:, second], axis=2))


def _aspects(corners: Array, edges: Array) -> Array:
    """Return longest edge / smallest height, 1 for a regular simplex."""
    dimension = corners.shape[2]
    # the rows of the inverse are the gradients of the barycentric coordinates: 1 / height
    gradients = np.linalg.inv((corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1))
    all_gradients = np.concatenate([gradients, -gradients.sum(axis=1, keepdims=True)], axis=1)
    regular = np.sqrt(2.0 / 3.0) if dimension == 3 else np.sqrt(3.0) / 2.0
    return np.asarray(edges.max(axis=1) * np.linalg.norm(all_gradients, axis=2).max(axis=1) * regular)


def _warnings(mesh: Mesh, ratio: float, across: Mapping[str, float]) -> tuple[str, ...]:
    warnings = []
    if ratio <= 0.0:
        warnings.append("there are inverted cells: det J changes its sign in them")
    thick = float(np.ptp(mesh.points, axis=0).min()) / 5.0
    for name, number in across.items():
        thickness = mesh.bending_walls[name]
        wanted = 2 if thickness > thick else 1
        if np.isnan(number):
            warnings.append(
                f"wall '{name}' of {thickness:g} mm was not found in the mesh, so elements across it are unknown"
            )
        elif number < _ENOUGH[wanted]:
            kind = "thick " if wanted == 2 else ""
            warnings.append(
                f"{kind}wall '{name}' of {thickness:g} mm has {number:.2g} quadratic elements across it, expected at "
                f"least {wanted}: choose a smaller size or wall_size"
            )
    return tuple(warnings)
