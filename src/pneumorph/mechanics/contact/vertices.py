"""The points that can touch: nodes of the mesh, and the surface points of free bodies that their frames carry."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.mechanics.contact.facets import Points, force_points, nodal_areas, split
from pneumorph.mechanics.contact.free_body import Frame
from pneumorph.mesh.mesh import FaceBlock, Mesh
from pneumorph.units import EARTH

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Vertices:
    """Numbers the nodes of a mesh first, then the surface points of its free bodies.

    Wherever names are taken, they are those of faces of the mesh or of free bodies.
    """

    def __init__(self, mesh: Mesh, frames: Sequence[Frame] = ()):
        self.mesh = mesh
        self.frames = {frame.name: frame for frame in frames}
        sizes = [len(frame.points) for frame in frames]
        self._start = dict(zip(self.frames, len(mesh.points) + np.cumsum([0, *sizes])[:-1], strict=True))
        self.count = len(mesh.points) + sum(sizes)

    def __contains__(self, name: str) -> bool:
        return name in self.frames or name in self.mesh.faces

    def blocks(self, names: Iterable[str]) -> list[FaceBlock]:
        """Return the faces of the mesh among some names; raises NameNotFoundError for what is neither."""
        for name in names:
            if name not in self:
                raise NameNotFoundError(unknown_name("face", name, [*self.mesh.faces, *self.frames]))
        return [block for name in names if name not in self.frames for block in self.mesh.face_blocks(name)]

    def bodies(self, names: Iterable[str]) -> list[Frame]:
        """Return the free bodies among some names."""
        return [self.frames[name] for name in names if name in self.frames]

    def numbers(self, name: str) -> Integers:
        """Return the vertices (n,) on the surface of a free body."""
        return int(self._start[name]) + np.arange(len(self.frames[name].points))

    def facets(self, names: Sequence[str]) -> Integers:
        """Return the linear facets (m, d) on vertices."""
        blocks, bodies = self.blocks(names), self.bodies(names)
        parts = [split(blocks)] if blocks else []
        return np.concatenate([*parts, *(body.facets + int(self._start[body.name]) for body in bodies)])

    def nodes(self, names: Sequence[str]) -> Integers:
        """Return the nodes of the mesh that faces and free bodies move with, sorted, each once."""
        return np.unique(np.concatenate([self.mesh.face_nodes(name) for name in names]))

    def areas(self, names: Sequence[str], position: Array | None = None) -> Array:
        """Return the area (vertices,) that each vertex bears, mm2: see `nodal_areas`; thirds of triangles on bodies."""
        result = np.zeros(self.count)
        if blocks := self.blocks(names):
            result[: len(self.mesh.points)] = nodal_areas(self.mesh, blocks, position)
        for body in self.bodies(names):
            result[self.numbers(body.name)] = _areas(body, body.facets)
        return result

    def force_points(self, names: Sequence[str], position: Array | None = None) -> list[Points]:
        """Return the force points of faces, see `facets`, and for free bodies the points of their surfaces."""
        blocks = self.blocks(names)
        found = force_points(self.mesh, blocks, position) if blocks else []
        for body in self.bodies(names):
            nodes = np.broadcast_to(body.nodes, body.weights.shape)
            found.append(Points(nodes, body.weights, _areas(body, body.facets)))
        return found

    def bearing(self, body: Frame, force: Array) -> tuple[float, float]:
        """Return the area of a body's facets that are pressed all round, mm2, and the largest pressure, MPa.

        force (n,): size of the normal force on each point of its surface, N. A point that is pressed without any
        whole facet, as on an edge, bears its force with all of its area.
        """
        pressed = force > 1e-9 * float(force.max(initial=0.0))
        whole = body.facets[pressed[body.facets].all(axis=1)]
        area = _areas(body, whole)
        borne = np.where(area > 0.0, area, _areas(body, body.facets))
        return float(area.sum()), float((force / borne).max())

    def resting(self, names: Sequence[str]) -> float:
        """Return a stiffness, MPa, for free bodies that touch nothing soft; infinite where faces are among the names.

        About three times the pressure on the side that the lightest one stands on: much stiffer contacts throw it off.
        """
        bodies = self.bodies(names)
        if len(bodies) < len(names):
            return np.inf
        return min(20.0 * body.mass * EARTH / float(_areas(body, body.facets).sum()) for body in bodies)

    def at(self, position: Array) -> Array:
        """Return the places (vertices, d) at positions (nodes, d) of the mesh."""
        return np.concatenate([position, *(frame.surface(position) for frame in self.frames.values())])

    def carried(self, chosen: Integers) -> sparse.csr_matrix | None:
        """Return how some vertices (k,) follow from nodes, (k, nodes); None where all of them are nodes."""
        nodes = len(self.mesh.points)
        if not len(chosen) or chosen.max() < nodes:
            return None
        blocks = [sparse.eye(nodes, format="csr")]
        for frame in self.frames.values():
            rows = np.repeat(np.arange(len(frame.points)), len(frame.nodes))
            columns = np.tile(frame.nodes, len(frame.points))
            shape = (len(frame.points), nodes)
            blocks.append(sparse.csr_matrix((frame.weights.ravel(), (rows, columns)), shape=shape))
        return sparse.vstack(blocks, format="csr")[chosen]


def _areas(body: Frame, facets: Integers) -> Array:
    """Return the area (n,) of some facets (m, d) that each point of a body's surface bears, mm2."""
    corners = body.points[facets]
    edges = corners[:, 1:] - corners[:, :1]
    if edges.shape[1] == 1:
        size = np.linalg.norm(edges[:, 0], axis=1)
    else:
        size = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    result = np.zeros(len(body.points))
    np.add.at(result, facets, size[:, None] / facets.shape[1])
    return result
