"""Mesh files -> points, quadratic cells by material domain, and the file's own sets of nodes and faces."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import meshio
import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import MeshError
from pneumorph.mesh.inp import Deck, read_deck, sides
from pneumorph.mesh.mesh import CellBlock
from pneumorph.mesh.quadratic import QUADRATIC

Array = NDArray[np.float64]
Index = NDArray[np.int64]

MESH_SUFFIXES = (".inp", ".msh", ".vtu")

_DIMENSION = {"vertex": 0, "line": 1, "line3": 1, "triangle": 2, "triangle6": 2, "quad": 2, "quad8": 2, "quad9": 2}
# cell fields of a .vtu that number material domains and, on triangles and quadrilaterals, faces; the first found counts
_TAGS = ("domain", "material", "region", "gmsh:physical", "medit:ref", "cell_tags")


@dataclass(frozen=True, eq=False)
class FileMesh:
    """What a mesh file holds, in its own unit.

    points (n, 3); cells: blocks of kinds of `quadratic.QUADRATIC`, by domain; faces: name -> sorted corners (k, 4),
    -1 first for triangles, of what the file names as surface; other: the same for sets of elements that mark faces;
    nodes: name -> node numbers of node sets.
    """

    points: Array
    cells: tuple[CellBlock, ...]
    faces: Mapping[str, Index] = field(default_factory=dict)
    other: Mapping[str, Index] = field(default_factory=dict)
    nodes: Mapping[str, Index] = field(default_factory=dict)


def read_mesh_file(path: Path) -> FileMesh:
    """Return what a .msh, .inp or .vtu file holds. Raises MeshError for one that is damaged or has no solid cells."""
    if path.suffix.lower() == ".inp":
        return _from_deck(path, read_deck(path))
    reader = meshio.gmsh if path.suffix.lower() == ".msh" else meshio.vtu
    try:
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
            mesh = reader.read(str(path))
        return _from_meshio(path, mesh)
    except MeshError:
        raise
    except (Exception, SystemExit) as error:  # damaged files make the readers raise whatever comes
        raise MeshError(f"'{path}': meshio cannot read this file: {type(error).__name__} {error}".strip()) from error


def _from_meshio(path: Path, mesh: Any) -> FileMesh:
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    if not np.isfinite(points).all():
        raise MeshError(f"'{path}': a node without finite coordinates")
    names = {(int(dim), int(tag)): name for name, (tag, dim) in mesh.field_data.items()}
    tags = next((mesh.cell_data[name] for name in _TAGS if name in mesh.cell_data), None)
    cells: dict[tuple[str, str], list[Index]] = {}
    faces: dict[str, list[Index]] = {}
    odd: set[str] = set()
    solid_tags = set()
    for number, block in enumerate(mesh.cells):
        nodes = np.asarray(block.data, dtype=np.int64)
        tag = (
            np.zeros(len(nodes), dtype=np.int64) if tags is None else np.asarray(tags[number]).astype(np.int64).ravel()
        )
        if block.type in QUADRATIC:
            for value in np.unique(tag):
                solid_tags.add(int(value))
                cells.setdefault((block.type, _tag_name(names, 3, value, "body")), []).append(nodes[tag == value])
        elif _DIMENSION.get(block.type) == 2:
            for value in np.unique(tag[tag != 0]):
                count = 3 if block.type.startswith("triangle") else 4
                faces.setdefault(_tag_name(names, 2, value, "surface"), []).append(_keys(nodes[tag == value, :count]))
        elif block.type not in _DIMENSION:
            odd.add(block.type)
    if odd or not cells:
        raise MeshError(
            f"'{path}': cells that are not supported: {', '.join(sorted(odd)) or 'none'}; solid cells: "
            f"{sum(len(n) for parts in cells.values() for n in parts)}. Supported: {', '.join(QUADRATIC)}"
        )
    if len(solid_tags) == 1 and (3, *solid_tags) not in names:  # one number without a name says nothing
        cells = {(kind, "body"): parts for (kind, _), parts in cells.items()}
    blocks = tuple(CellBlock(kind, domain, np.concatenate(parts)) for (kind, domain), parts in cells.items())
    return FileMesh(points, blocks, {name: np.concatenate(parts) for name, parts in faces.items()})


def _tag_name(names: Mapping[tuple[int, int], str], dimension: int, tag: int, what: str) -> str:
    return names.get((dimension, int(tag)), f"{what}_{tag}" if tag else what)


def _from_deck(path: Path, deck: Deck) -> FileMesh:
    numbers = sorted(deck.nodes)
    points = np.array([deck.nodes[number] for number in numbers])
    if not np.isfinite(points).all():
        raise MeshError(f"'{path}': a node without finite coordinates")
    position = {number: i for i, number in enumerate(numbers)}
    domain = _domains(deck)
    cells: dict[tuple[str, str], list[list[int]]] = {}
    try:
        for number, (kind, nodes) in deck.elements.items():
            cells.setdefault((kind, domain.get(number, "body")), []).append([position[n] for n in nodes])
        faces, other = {}, {}
        node_sets = {
            name: np.array([position[n] for n in nodes], dtype=np.int64) for name, nodes in deck.node_sets.items()
        }
        for name, entries in deck.surfaces.items():
            if entries and all(not side for _, side in entries):
                marked = [deck.node_sets.get(first) or [int(first)] for first, _ in entries]
                node_sets.setdefault(name, np.array([position[n] for part in marked for n in part], dtype=np.int64))
            else:
                faces[name] = _ragged_keys([position[n] for n in corners] for corners in sides(deck, name))
        for name, elements in deck.element_sets.items():
            flat = [deck.flat[number] for number in elements if number in deck.flat]
            if flat:
                other[name] = _ragged_keys([position[n] for n in corners] for corners in flat)
    except KeyError as error:
        raise MeshError(f"'{path}': node or element {error} is named, but not defined") from None
    except ValueError as error:
        raise MeshError(f"'{path}': a *SURFACE refers to what is not there: {error}") from None
    blocks = tuple(CellBlock(kind, name, np.array(rows, dtype=np.int64)) for (kind, name), rows in cells.items())
    return FileMesh(points, blocks, faces, other, node_sets)


def _domains(deck: Deck) -> dict[int, str]:
    """Return element -> domain: the element set of its *SOLID SECTION or else the sets named with *ELEMENT.

    Sets without a section that all solid elements are in, or that share elements, are no domains.
    """
    named = {name.upper(): name for name in deck.element_sets}
    chosen = [named[name.upper()] for name in dict.fromkeys(deck.sections) if name.upper() in named]
    if not chosen:
        solid = {n: [e for e in members if e in deck.elements] for n, members in deck.element_sets.items()}
        chosen = [name for name, members in solid.items() if members]
        if sum(len(set(solid[name])) for name in chosen) != len(deck.elements):
            chosen = []
    return {element: name for name in chosen for element in deck.element_sets[name]}


def _keys(corners: Index) -> Index:
    """Return the sorted corners (k, 4) of triangles or quadrilaterals, -1 first for triangles."""
    padded = np.full((len(corners), 4), -1, dtype=np.int64)
    padded[:, 4 - corners.shape[1] :] = corners
    return np.sort(padded, axis=1)


def _ragged_keys(corners: Iterable[list[int]]) -> Index:
    rows = [sorted([-1] * (4 - len(nodes)) + nodes) for nodes in corners]
    return np.array(rows, dtype=np.int64).reshape(-1, 4)
