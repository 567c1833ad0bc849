"""VTU files (VTK's XML unstructured grid) of a mesh or a state, for programs that do not read VTKHDF."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from pneumorph.exchange.written import Written, put
from pneumorph.mechanics import Model, State
from pneumorph.mechanics.fields import fields, principal, to_nodes, von_mises

_Values = dict[str, np.ndarray]


def write_vtu(path: str | Path, model: Model, state: State | None = None) -> Written:
    """Write the mesh in its reference places, mm, with the cell field Domain; of a state also the nodal fields
    Displacement [mm], VonMises, LargestPrincipalStress [MPa] and LargestStretch, named as in the run folder."""
    mesh = model.mesh
    data: _Values = {}
    if state is not None:
        parts = fields(state)
        stress = to_nodes(mesh, parts, lambda part: part.stress)
        strain = to_nodes(mesh, parts, lambda part: part.right_cauchy_green)
        data = {
            "Displacement": _three(state.displacement),
            "VonMises": von_mises(stress),
            "LargestPrincipalStress": principal(stress)[:, 0],
            "LargestStretch": np.sqrt(np.maximum(principal(strain)[:, 0], 0.0)),
        }
    domain = [np.full(len(block.nodes), mesh.domains.index(block.domain), dtype=np.int32) for block in mesh.blocks]
    cells = [(block.kind, block.nodes) for block in mesh.blocks]
    grid = meshio.Mesh(_three(mesh.points), cells, point_data=data, cell_data={"Domain": domain})
    put(path, lambda part: meshio.write(part, grid, file_format="vtu"))
    return Written(Path(path), {"nodes": len(mesh.points), "cells": mesh.cell_count})


def _three(values: np.ndarray) -> np.ndarray:
    result = np.zeros((len(values), 3))
    result[:, : values.shape[1]] = values
    return result
