"""What `skin.py` runs in a process of its own: one inflation of a skinned half tube. Writes JSON.

`python skin_worker.py CASE.json RESULT.json`.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import pneumorph  # noqa: F401  (first: it limits the threads of the numerical libraries)
from pneumorph.geometry import BendingSkin
from pneumorph.materials import library
from pneumorph.measures import Curvature, Diameter
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, Symmetry, VolumeSupply, march
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.reference import MIDS
from pneumorph.mesh.skinned import mesh_skinned_tube
from pneumorph.mesh.topology import boundary

Nodes = NDArray[np.int64]

MATERIALS = {"tube": "ecoflex-00-30-tube", "skin": "hei-cast-8400-skin", "cap": "auxetic-end-cap"}
_PRISMS = {"wedge18": [(0, 1, 2, 3, 4, 5)], "hexahedron27": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)]}
_SPACE_DIAGONALS = [(0, 6), (1, 7), (2, 4), (3, 5)]
# corners of a prism as seen with its lowest node first
_TURNED = [
    (0, 1, 2, 3, 4, 5), (1, 2, 0, 4, 5, 3), (2, 0, 1, 5, 3, 4),
    (3, 5, 4, 0, 2, 1), (4, 3, 5, 1, 0, 2), (5, 4, 3, 2, 1, 0),
]  # fmt: skip
_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # of tetra10, behind its corners


def _middles(kind: str) -> dict[frozenset[int], int]:
    """Return the node half-way between two corners of a cell, along edges and all diagonals."""
    result = {}
    for node, corners in MIDS[kind].items():
        if len(corners) == 2:
            result[frozenset(corners)] = node
        elif len(corners) == 4:
            result[frozenset(corners[::2])] = result[frozenset(corners[1::2])] = node
        else:
            result |= {frozenset(pair): node for pair in _SPACE_DIAGONALS}
    return result


def split(points: NDArray[np.float64], kind: str, cells: Nodes) -> Nodes:
    """Return the tetra10 cells that wedges or hexahedra fall into, on the same nodes.

    Diagonals of upright faces start at the lowest node of their corners, so that neighbours agree.
    """
    middle, result = _middles(kind), []
    for cell in cells:
        for prism in _PRISMS[kind]:
            turned = _TURNED[int(np.argmin(cell[list(prism)]))]
            p = [prism[i] for i in turned]
            if min(cell[p[1]], cell[p[5]]) < min(cell[p[2]], cell[p[4]]):
                parts = [(0, 1, 2, 5), (0, 1, 5, 4), (0, 4, 5, 3)]
            else:
                parts = [(0, 1, 2, 4), (0, 4, 2, 5), (0, 4, 5, 3)]
            for part in parts:
                corners = [p[i] for i in part]
                x = points[cell[corners]]
                if np.linalg.det(x[1:] - x[0]) < 0.0:
                    corners[2:] = corners[:1:-1]
                mids = [middle[frozenset((corners[i], corners[j]))] for i, j in _EDGES]
                result.append(cell[[*corners, *mids]])
    return np.array(result, dtype=np.int64)


def tetrahedral(mesh: Mesh) -> Mesh:
    """Return the mesh with all wedges and hexahedra split into tetrahedra, faces named as before."""
    blocks = []
    for block in mesh.blocks:
        cells = block.nodes if block.kind == "tetra10" else split(mesh.points, block.kind, block.nodes)
        blocks.append(CellBlock("tetra10", block.domain, cells))
    names: dict[object, str] = {}
    for name, faces in mesh.faces.items():
        for face in faces:
            for row in face.nodes:  # both halves of a quadrilateral hold its centre
                names[int(row[8]) if face.kind == "quad9" else frozenset(row[:3].tolist())] = name
    parts: dict[str, list[Nodes]] = {}
    for skin in boundary(tuple(blocks)):
        for row in skin.nodes:
            key = next((int(n) for n in row[3:] if int(n) in names), frozenset(row[:3].tolist()))
            parts.setdefault(names[key], []).append(row)
    used = np.unique(np.concatenate([block.nodes.ravel() for block in blocks]))  # centres of some prisms are in none
    new = np.zeros(len(mesh.points), dtype=np.int64)
    new[used] = np.arange(len(used))
    faces = {name: (FaceBlock("triangle6", new[np.array(rows)]),) for name, rows in parts.items()}
    return Mesh(mesh.points[used], tuple(CellBlock(b.kind, b.domain, new[b.nodes]) for b in blocks), faces)


def solve(case: dict[str, Any]) -> dict[str, Any]:
    """Inflate by volume; return what it took and the curvature and diameter at the end."""
    start = time.perf_counter()
    height = 14.9
    tube = BendingSkin(cells_along=case["along"], length=height * case["along"], half=True).tube
    mesh = mesh_skinned_tube(tube, case["size"] * height, half=True, wall_layers=case["layers"])
    if case["kind"] == "tetrahedra":
        mesh = tetrahedral(mesh)
    model = Model(
        mesh,
        {domain: library.material(name) for domain, name in MATERIALS.items()},
        (Clamp("clamp"), Symmetry("symmetry_y")),
        cavities=(Cavity("cavity", ("cavity",), VolumeSupply(), ("symmetry_y",)),),
    )
    phase = Phase("inflate", {"cavity": case["added"]}, first=0.05, largest=0.1)
    iterations = increments = 0
    for state in march(model, Programme((phase,))):
        iterations, increments = iterations + state.iterations, state.index
    return {
        "cells": mesh.cell_count,
        "unknowns": int(mesh.points.size),
        "increments": increments,
        "iterations": iterations,
        "seconds": time.perf_counter() - start,
        "curvature": Curvature()(state),
        "diameter": Diameter()(state),
        "pressure": state.pressure["cavity"],
    }


if __name__ == "__main__":
    Path(sys.argv[2]).write_text(json.dumps(solve(json.loads(Path(sys.argv[1]).read_text()))))
