"""Mesh of an .inp file: nodes, elements by material domain, and the named faces as node sets and surfaces.

Node n of the mesh (from 0) is node n + 1 of the file, so results go back without a table. Element types, node orders
and face numbers are those of the CalculiX manual (2.20, "Element Types" and *SURFACE); Abaqus numbers them alike.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, MeshError
from pneumorph.mesh.mesh import CellBlock, Mesh
from pneumorph.mesh.reference import MIDS
from pneumorph.mesh.topology import CORNERS

Array = NDArray[np.float64]
Nodes = NDArray[np.int64]

CALCULIX, ABAQUS = "calculix", "abaqus"
DIALECTS = (CALCULIX, ABAQUS)
ALL = "EALL"


@dataclass(frozen=True)
class Element:
    """How a kind of cell is written.

    names: space -> element type; nodes: how many of the cell's nodes it has, the first ones; faces: corners (from 0) of
    the faces 1, 2, ...
    """

    names: Mapping[str, str]
    nodes: int
    faces: tuple[tuple[int, ...], ...]


# the nodes in the middle of quadrilateral sides and of cells, which come last, have no place in these types
ELEMENTS = {
    "tetra10": Element({"3d": "C3D10"}, 10, ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))),
    "wedge18": Element({"3d": "C3D15"}, 15, ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))),
    # reduced integration: the full one locks where nearly incompressible
    "hexahedron27": Element(
        {"3d": "C3D20R"},
        20,
        ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    ),
    "triangle6": Element({"plane_strain": "CPE6", "axisymmetric": "CAX6"}, 6, ((0, 1), (1, 2), (2, 0))),
}


def plain_names(kind: str, names: Iterable[str], taken: Iterable[str] = ()) -> dict[str, str]:
    """Return name -> name for the file: capitals, digits and underscores, a letter first, at most 60 long.

    Raises InputError where two become one.
    """
    result: dict[str, str] = {}
    owner = dict.fromkeys(taken, "the exporter itself")
    for name in names:
        plain = re.sub(r"[^A-Z0-9_]", "_", name.upper())[:60]
        plain = plain if plain[:1].isalpha() else f"X{plain}"
        if plain in owner:
            raise InputError(f"{kind} '{name}': in an .inp file it would be called {plain}, as {owner[plain]} is")
        owner[plain] = f"{kind} '{name}'"
        result[name] = plain
    return result


def rows(values: Sequence[object], width: int = 12) -> list[str]:
    """Return values as data lines of `width` entries."""
    return [", ".join(map(str, values[i : i + width])) for i in range(0, len(values), width)]


@dataclass(frozen=True, eq=False)
class InpMesh:
    """The mesh of an .inp file. hybrid: domains that Abaqus shall solve with hybrid elements (none in CalculiX).

    Raises MeshError for a kind of cell that neither program has, InputError for names that become one.
    """

    mesh: Mesh
    hybrid: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        for block in self.mesh.blocks:
            if block.kind not in ELEMENTS:
                raise MeshError(f"{block.kind} cells of '{block.domain}' cannot be written: known are {_known()}")
        _ = self.domains, self.faces

    @cached_property
    def domains(self) -> dict[str, str]:
        """Domain -> name of its element set and material."""
        return plain_names("domain", self.mesh.domains, (ALL,))

    @cached_property
    def faces(self) -> dict[str, str]:
        """Face -> name of its node set and surface."""
        return plain_names("face", self.mesh.faces)

    @cached_property
    def used(self) -> NDArray[np.bool_]:
        """Whether a node is in the file (nodes,)."""
        used = np.zeros(len(self.mesh.points), dtype=bool)
        for block in self.mesh.blocks:
            used[block.nodes[:, : ELEMENTS[block.kind].nodes]] = True
        return used

    def kept(self, nodes: Nodes) -> Nodes:
        """Return those of the nodes that are in the file."""
        return nodes[self.used[nodes]]

    def lines(self) -> list[str]:
        """Return nodes, elements, node sets and surfaces."""
        points = np.zeros((len(self.mesh.points), 3))
        points[:, : self.mesh.dimension] = self.mesh.points
        result = ["*NODE"]
        result += [
            f"{i + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(points.tolist()) if self.used[i]
        ]
        for block, first in zip(self.mesh.blocks, self._first, strict=True):
            result.append(f"*ELEMENT, TYPE={self._type(block)}, ELSET={self.domains[block.domain]}")
            cells = block.nodes[:, : ELEMENTS[block.kind].nodes] + 1
            for number, cell in enumerate(cells.tolist(), first):
                line = rows([number, *cell], 16)
                result += [text + "," for text in line[:-1]] + line[-1:]
        result += [f"*ELSET, ELSET={ALL}", *rows(list(self.domains.values()), 8)]
        for face, name in self.faces.items():
            result += [f"*NSET, NSET={name}", *rows((self.kept(self.mesh.face_nodes(face)) + 1).tolist())]
        for face, name in self.faces.items():
            result.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
            result += [f"{cell}, S{number}" for cell, number in self._sides(face)]
        return result

    def moved_forces(self, forces: Array) -> Array:
        """Return nodal forces (nodes, d) with those of nodes that are left out handed to their neighbours.

        The shares, -1/4 a corner and 1/2 (middle of a side) or 1/4 (middle of the cell) a mid-edge node, are the values
        that the shape functions of the written element have there: so the forces do the same work.
        """
        result = forces.copy()
        moved = self.used.copy()
        for block in self.mesh.blocks:
            for local in range(ELEMENTS[block.kind].nodes, block.nodes.shape[1]):
                corners, mids = _around(block.kind, local)
                share = (1.0 + 0.25 * len(corners)) / len(mids)
                node, index = np.unique(block.nodes[:, local], return_index=True)
                fresh = ~moved[node]
                node, cell = node[fresh], block.nodes[index[fresh]]
                moved[node] = True
                np.add.at(result, cell[:, corners], -0.25 * forces[node][:, None])
                np.add.at(result, cell[:, mids], share * forces[node][:, None])
        result[~self.used] = 0.0
        return result

    @cached_property
    def _first(self) -> list[int]:
        """Number of the first element of each block."""
        sizes = [len(block.nodes) for block in self.mesh.blocks]
        return np.cumsum([1, *sizes[:-1]]).tolist()

    def _type(self, block: CellBlock) -> str:
        name = ELEMENTS[block.kind].names[self.mesh.space]
        return f"{name}H" if block.domain in self.hybrid else name

    @cached_property
    def _owners(self) -> dict[tuple[int, ...], tuple[int, int]]:
        """Sorted corners of each face of a cell -> (element, face), from 1; boundary faces have one owner."""
        return {
            tuple(sorted(cell[i] for i in corners)): (number, face)
            for block, first in zip(self.mesh.blocks, self._first, strict=True)
            for number, cell in enumerate(block.nodes.tolist(), first)
            for face, corners in enumerate(ELEMENTS[block.kind].faces, 1)
        }

    def _sides(self, face: str) -> list[tuple[int, int]]:
        return [
            self._owners[tuple(sorted(nodes[: CORNERS[block.kind]]))]
            for block in self.mesh.face_blocks(face)
            for nodes in block.nodes.tolist()
        ]


def _around(kind: str, node: int) -> tuple[list[int], list[int]]:
    """Return the corners, and the mid-edge nodes between them, of the side or cell in whose middle a node lies."""
    corners = MIDS[kind][node]
    return list(corners), [mid for mid, ends in MIDS[kind].items() if len(ends) == 2 and set(ends) <= set(corners)]


def _known() -> str:
    return ", ".join(ELEMENTS)
