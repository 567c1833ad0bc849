"""Volumes of the chambers that share one cavity, and how evenly they grow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.mechanics import State
from pneumorph.mechanics.surface import enclosed_volume
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]

_EDGES = ((0, 1, 3), (1, 2, 4), (2, 0, 5))  # end, end, middle of a triangle6


@dataclass(frozen=True)
class ChamberSpread:
    """How unevenly the chambers of a row have grown: (largest - smallest) / mean of volume over volume at rest.

    cavity: the one that they share. centre: (x, z), mm, of the line along y about which the row is bent. cuts: angles
    about it, rad, from +z towards +x, growing; the k - 1 cuts between k chambers. A face belongs to a chamber by the
    reference place of its middle, and each cut is closed by triangles to the mean of its points, so that the volumes
    add up to the cavity's. Six-node faces; at most one mirror plane.
    Raises NameNotFoundError for a cavity, InputError for cuts that do not grow, other faces or a chamber without any.
    """

    cavity: str
    centre: tuple[float, float]
    cuts: tuple[float, ...]
    name: str = "chamber_spread"
    kind: str = "number"

    def __post_init__(self) -> None:
        if not self.cuts or any(b <= a for a, b in zip(self.cuts, self.cuts[1:], strict=False)):
            raise InputError(f"{self.name}: cuts = {self.cuts}, expected one or more, each larger than the last")

    def __call__(self, state: State) -> float:
        """Return the spread."""
        growth = self.volumes(state) / self.volumes(state, state.model.mesh.points)
        return float(np.ptp(growth) / growth.mean())

    def volumes(self, state: State, positions: Array | None = None) -> Array:
        """Return the volume of each chamber (k,), mm3, at given positions (nodes, 3), or those of the state."""
        model = state.model
        if self.cavity not in model.surfaces:
            raise NameNotFoundError(f"{self.name}: " + unknown_name("cavity", self.cavity, model.surfaces))
        x = state.positions if positions is None else positions
        surface = model.surfaces[self.cavity]
        if any(block.kind != "triangle6" for block in surface.blocks) or len(surface.cavity.mirrors) > 1:
            raise InputError(f"{self.name}: expected six-node faces, and at most one mirror plane")
        nodes = np.concatenate([block.nodes for block in surface.blocks])
        label = self._labels(model.mesh, nodes)
        plane, normal = _plane(model.mesh, surface.cavity.mirrors)
        # the straight edges of the caps miss curved ones a little: an origin in the middle makes little of that
        middle = x[nodes].reshape(-1, 3).mean(axis=0)
        point = middle - normal * ((middle - plane) @ normal)
        project = np.eye(3) - np.outer(normal, normal)
        volumes = np.array([
            enclosed_volume("triangle6", nodes[label == i], x, point, project, False, 0)[0]
            for i in range(len(self.cuts) + 1)
        ])  # fmt: skip
        for low, high, edges in _cut_edges(nodes, label):
            apex = x[edges].reshape(-1, 3).mean(axis=0)
            apex = apex - normal * ((apex - point) @ normal)
            flux = 0.0
            for a, b in ((0, 2), (2, 1)):  # by way of the middle node
                first, second = x[edges[:, a]], x[edges[:, b]]
                area = 0.5 * np.cross(second - apex, first - apex)
                field = ((apex + first + second) / 3.0 - point) @ project / np.trace(project)
                flux -= float((area * field).sum())
            volumes[low] += flux
            volumes[high] -= flux
        return volumes

    def _labels(self, mesh: Mesh, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        middle = mesh.points[nodes[:, :3]].mean(axis=1)
        angle = np.arctan2(middle[:, 0] - self.centre[0], middle[:, 2] - self.centre[1])
        start = 0.5 * (self.cuts[0] + self.cuts[-1]) - np.pi  # the row may be bent by more than half a turn
        label = np.searchsorted(self.cuts, start + (angle - start) % (2.0 * np.pi))
        empty = np.setdiff1d(np.arange(len(self.cuts) + 1), label)
        if len(empty):
            raise InputError(f"{self.name}: no face of '{self.cavity}' lies in chamber {empty[0] + 1}")
        return np.asarray(label, dtype=np.int64)


def _plane(mesh: Mesh, mirrors: tuple[str, ...]) -> tuple[Array, Array]:
    """Return a point and the unit normal of the mirror plane; without one the normal is zero."""
    if not mirrors:
        return mesh.points.mean(axis=0), np.zeros(3)
    points = mesh.points[mesh.face_nodes(mirrors[0])]
    return points[0], np.linalg.svd(points - points.mean(axis=0))[2][-1]


def _cut_edges(nodes: NDArray[np.int64], label: NDArray[np.int64]) -> list[tuple[int, int, NDArray[np.int64]]]:
    """Return (chamber, later chamber, edges (m, 3) as the faces of the former run) for each cut."""
    edges = np.concatenate([nodes[:, edge] for edge in _EDGES])
    owner = np.tile(label, 3)
    ends = np.sort(edges[:, :2], axis=1)
    _, number = np.unique(ends, axis=0, return_inverse=True)
    number = number.ravel()
    lowest, highest = np.full(number.max() + 1, len(label)), np.full(number.max() + 1, -1)
    np.minimum.at(lowest, number, owner)
    np.maximum.at(highest, number, owner)
    shared = (lowest < highest)[number] & (owner == lowest[number])
    pairs = np.column_stack([lowest[number], highest[number]])[shared]
    chosen = edges[shared]
    return [(int(low), int(high), chosen[(pairs == (low, high)).all(axis=1)]) for low, high in np.unique(pairs, axis=0)]
