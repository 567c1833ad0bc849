"""The mesh: points, blocks of quadratic cells by material domain, and named sets of boundary faces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError, NameNotFoundError, unknown_name

Space = Literal["3d", "plane_strain", "axisymmetric"]

# kind of cell or face -> number of nodes; names and node order are those of meshio and VTK
CELL_NODES = {"tetra10": 10, "wedge18": 18, "hexahedron27": 27, "triangle6": 6}
FACE_NODES = {"triangle6": 6, "quad9": 9, "line3": 3}
# virtual faces on nodes of a rim: plane triangle; the area between a quadratic edge (end, end, middle) and its chord
CAP_NODES = {"triangle3": 3, "lens3": 3}


@dataclass(frozen=True, eq=False)
class CellBlock:
    """Cells of one kind in one material domain: `nodes` (cells, nodes a cell), int64."""

    kind: str
    domain: str
    nodes: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class FaceBlock:
    """Boundary faces of one kind, oriented so that their normal leaves the solid: `nodes` (faces, nodes a face)."""

    kind: str
    nodes: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh of quadratic cells with named boundary faces.

    points: (n, 3) in 3-D; (n, 2) in plane strain (x, y) and with axial symmetry (radius, height), in mm.
    blocks: the cells, by kind and material domain.
    faces:  name -> blocks of faces (edges in two dimensions); a face has one name only.
    space:  "3d", "plane_strain" (1 mm thick) or "axisymmetric" (about the axis x = 0).
    bending_walls: name -> thickness in mm of the walls that bend, for the check of elements across a wall.
    caps:   name -> virtual membranes that close cavities where the body leaves them open; no part of the body.
    frames: name -> the nodes (d + 1,) that carry a free rigid body, the last ones of all; they belong to no cell.

    Raises MeshError for arrays of the wrong shape, nodes out of range or values that are not finite.
    """

    points: NDArray[np.float64]
    blocks: tuple[CellBlock, ...]
    faces: Mapping[str, tuple[FaceBlock, ...]]
    space: Space = "3d"
    bending_walls: Mapping[str, float] = field(default_factory=dict)
    caps: Mapping[str, tuple[FaceBlock, ...]] = field(default_factory=dict)
    frames: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        dimension = 3 if self.space == "3d" else 2
        if self.points.ndim != 2 or self.points.shape[1] != dimension or not np.isfinite(self.points).all():
            raise MeshError(f"points of shape {self.points.shape}: expected finite (n, {dimension}) for {self.space}")
        if not self.blocks:
            raise MeshError("a mesh needs at least one block of cells")
        everything: list[tuple[str, NDArray[np.int64], Mapping[str, int]]] = [
            (block.kind, block.nodes, CELL_NODES) for block in self.blocks
        ]
        everything += [(face.kind, face.nodes, FACE_NODES) for faces in self.faces.values() for face in faces]
        everything += [(face.kind, face.nodes, CAP_NODES) for faces in self.caps.values() for face in faces]
        for kind, nodes, known in everything:
            if kind not in known:
                raise MeshError(unknown_name("kind of cell or face", kind, known))
            if nodes.ndim != 2 or nodes.shape[1] != known[kind] or len(nodes) == 0:
                raise MeshError(f"{kind}: nodes of shape {nodes.shape}, expected (at least 1, {known[kind]})")
            if nodes.min() < 0 or nodes.max() >= len(self.points):
                raise MeshError(f"{kind}: node numbers must lie in 0..{len(self.points) - 1}")
        framed = np.concatenate([np.empty(0, dtype=np.int64), *self.frames.values()])
        if not np.array_equal(framed, np.arange(len(self.points) - len(framed), len(self.points))):
            raise MeshError("frames: expected their nodes to be the last ones of the mesh, each once")

    @property
    def dimension(self) -> int:
        """3, or 2 in plane strain and with axial symmetry."""
        return int(self.points.shape[1])

    @property
    def cell_count(self) -> int:
        """How many cells there are in all blocks."""
        return sum(len(block.nodes) for block in self.blocks)

    @property
    def domains(self) -> tuple[str, ...]:
        """Names of the material domains, each once, in order of the blocks."""
        return tuple(dict.fromkeys(block.domain for block in self.blocks))

    def face_blocks(self, name: str) -> tuple[FaceBlock, ...]:
        """Return the faces of a name; raises NameNotFoundError with the nearest name."""
        if name not in self.faces:
            raise NameNotFoundError(unknown_name("face", name, self.faces))
        return self.faces[name]

    def face_nodes(self, name: str) -> NDArray[np.int64]:
        """Return the sorted node numbers of a named face, or of the frame of a free body, each once."""
        if name in self.frames:
            return self.frames[name]
        return np.unique(np.concatenate([block.nodes.ravel() for block in self.face_blocks(name)]))

    @cached_property
    def size(self) -> float:
        """Length of the diagonal of the bounding box of the cells, mm."""
        return float(np.linalg.norm(np.ptp(self.points[: self.solid], axis=0)))

    @property
    def solid(self) -> int:
        """How many of the nodes, the first ones, belong to cells; all but those of free bodies."""
        return len(self.points) - self.framed

    @property
    def framed(self) -> int:
        """How many of the nodes, the last ones, carry free rigid bodies."""
        return sum(len(nodes) for nodes in self.frames.values())
