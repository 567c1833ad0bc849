"""Mesh and CAD files: valid small ones with changed bytes and lines. All are a box with a hollow in it."""

from __future__ import annotations

import functools
import itertools
import tempfile
from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
from hypothesis import strategies as st
from tests.fuzz.answers import Reader
from tests.fuzz.changes import changed_bytes

from pneumorph.geometry import occ
from pneumorph.geometry.stl_import import read_stl
from pneumorph.mesh import Imported

_CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
_SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def hollow_box() -> meshio.Mesh:
    """Return 26 hexahedra of 1 mm around a hollow."""
    places = list(itertools.product(range(4), repeat=3))
    number = {place: i for i, place in enumerate(places)}
    cells = [
        [number[tuple(np.add(cell, corner))] for corner in _CORNERS]
        for cell in itertools.product(range(3), repeat=3)
        if cell != (1, 1, 1)
    ]
    ends = [[number[(0, y, z)] for y, z in ((a, b), (a, b + 1), (a + 1, b + 1), (a + 1, b))]
            for a, b in itertools.product(range(3), repeat=2)]  # fmt: skip
    mesh = meshio.Mesh(np.array(places, dtype=float), [("hexahedron", np.array(cells)), ("quad", np.array(ends))])
    mesh.cell_data = {"gmsh:physical": [np.ones(26, int), np.full(9, 2)], "gmsh:geometrical": [np.ones(26, int)] * 1}
    mesh.cell_data["gmsh:geometrical"].append(np.full(9, 2))
    mesh.field_data = {"body": np.array([1, 3]), "clamp": np.array([2, 2])}
    return mesh


def _written(write: Callable[[str], object]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file"
        write(str(path))
        return path.read_bytes()


@functools.cache
def msh_files() -> tuple[bytes, ...]:
    mesh = hollow_box()
    return tuple(
        _written(lambda path, binary=binary: meshio.gmsh.write(path, mesh, fmt_version="2.2", binary=binary))
        for binary in (False, True)
    )


@functools.cache
def vtu_files() -> tuple[bytes, ...]:
    mesh = hollow_box()
    return tuple(
        _written(lambda path, binary=binary: meshio.vtu.write(path, mesh, binary=binary)) for binary in (False, True)
    )


@functools.cache
def inp_files() -> tuple[bytes, ...]:
    mesh = hollow_box()
    nodes = "\n".join(f"{i + 1}, {x:g}, {y:g}, {z:g}" for i, (x, y, z) in enumerate(mesh.points))
    cells = "\n".join(f"{i + 1}, {', '.join(str(n + 1) for n in row)}" for i, row in enumerate(mesh.cells[0].data))
    held = ", ".join(str(i + 1) for i in range(16))
    deck = (
        f"*HEADING\nhollow box\n** a comment\n*NODE, NSET=ALL\n{nodes}\n*ELEMENT, TYPE=C3D8, ELSET=BODY\n{cells}\n"
        f"*NSET, NSET=CLAMP\n{held}\n*ELSET, ELSET=SOME, GENERATE\n1, 9, 1\n"
        "*SURFACE, NAME=LEFT, TYPE=ELEMENT\nSOME, S5\n"
        "*MATERIAL, NAME=RUBBER\n*HYPERELASTIC, NEO HOOKE\n0.1, 0.01\n*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER\n"
    )
    return (deck.encode(),)


@functools.cache
def stl_files() -> tuple[bytes, ...]:
    facets = []
    for low, high, inward in ((0.0, 3.0, False), (1.0, 2.0, True)):
        corners = low + (high - low) * np.array(_CORNERS, dtype=float)
        for a, b, c, d in _SIDES:
            for one in ((a, b, c), (a, c, d)):
                facets.append(corners[list(one[::-1] if inward else one)])
    lines = [
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x:g} {y:g} {z:g}\n" for x, y, z in f)
        + "endloop\nendfacet"
        for f in facets
    ]
    table = np.zeros(len(facets), dtype=[("vectors", "<f4", (4, 3)), ("attribute", "<u2")])
    table["vectors"][:, 1:] = facets
    binary = b" " * 80 + len(facets).to_bytes(4, "little") + table.tobytes()
    return ("\n".join(["solid box", *lines, "endsolid box\n"]).encode(), binary)


def imported(suffix: str) -> Callable[[bytes], None]:
    """Return what reads a mesh, finds its cavity and names its faces."""

    def read(data: bytes) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"part{suffix}"
            path.write_bytes(data)
            body = Imported(str(path), "mm")
            assert body.face_names

    return read


def surface(data: bytes) -> None:
    """Read an STL file, without the mesh that Netgen would make of it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.stl"
        path.write_bytes(data)
        points, triangles = read_stl([path])
        assert len(points) >= 4
        assert len(triangles) >= 4


def solid(suffix: str) -> Callable[[bytes], None]:
    """Return what reads a CAD file, without the mesh that Netgen would make of it."""

    def read(data: bytes) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"part{suffix}"
            path.write_bytes(data)
            assert occ.read_cad(path).volume > 0.0

    return read


@functools.cache
def cad_file(suffix: str) -> tuple[bytes, ...]:
    return ((Path(__file__).parents[1] / "data" / f"finger_closed{suffix}").read_bytes(),)


def _of(files: Callable[[], tuple[bytes, ...]]) -> st.SearchStrategy[bytes]:
    # few changes: a reader stops at the first
    return st.deferred(lambda: changed_bytes(files(), most=3))


READERS = (
    Reader("mesh, .inp", _of(inp_files), imported(".inp"), 2),
    Reader("mesh, .msh", _of(msh_files), imported(".msh"), 2),
    Reader("mesh, .vtu", _of(vtu_files), imported(".vtu"), 2),
    Reader("surface, .stl", _of(stl_files), surface, 2),
    # each in a process of its own
    Reader("CAD, .step", _of(lambda: cad_file(".step")), solid(".step"), 1, 20),
    Reader("CAD, .iges", _of(lambda: cad_file(".iges")), solid(".iges"), 1, 20),
)
