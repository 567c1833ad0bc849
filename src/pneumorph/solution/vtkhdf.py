"""VTKHDF files (h5py): the mesh once, and small states that link to its geometry. ParaView and PyVista open both.

Beside the group VTKHDF that the format asks for, a group `pneumorph` holds what restores the objects bit for bit.
Format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf-file-format
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields as dataclass_fields
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import PneumorphError, StorageError
from pneumorph.mechanics import Model, State
from pneumorph.mechanics.fields import fields, principal, to_nodes, von_mises
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.solution.codec import decode, encode
from pneumorph.solution.files import write_atomically

GROUP, OWN = "VTKHDF", "pneumorph"
VTK_TYPES = {"tetra10": 24, "wedge18": 32, "hexahedron27": 29, "triangle6": 22}
_GEOMETRY = (
    "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Points", "Connectivity", "Offsets", "Types",
)  # fmt: skip
_PACKED = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
Result = TypeVar("Result")


def write_mesh(path: Path, mesh: Mesh) -> None:
    """Write a mesh; its domains become the cell field 'Domain' (their number in order)."""

    def write(temporary: Path) -> None:
        with h5py.File(temporary, "w") as file:
            grid = _grid(file)
            nodes = [block.nodes for block in mesh.blocks]
            sizes = np.concatenate([np.full(len(n), n.shape[1]) for n in nodes])
            grid["NumberOfPoints"] = np.array([len(mesh.points)], dtype=np.int64)
            grid["NumberOfCells"] = np.array([mesh.cell_count], dtype=np.int64)
            grid["NumberOfConnectivityIds"] = np.array([sizes.sum()], dtype=np.int64)
            grid["Points"] = _three(mesh.points)
            grid["Connectivity"] = np.concatenate([n.ravel() for n in nodes]).astype(np.int64)
            grid["Offsets"] = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
            kinds = [np.full(len(b.nodes), VTK_TYPES[b.kind], dtype=np.uint8) for b in mesh.blocks]
            grid["Types"] = np.concatenate(kinds)
            numbers = [np.full(len(b.nodes), mesh.domains.index(b.domain), dtype=np.int32) for b in mesh.blocks]
            grid.create_group("CellData")["Domain"] = np.concatenate(numbers)
            own = file.create_group(OWN)
            own.attrs["mesh"] = json.dumps(
                {
                    "space": mesh.space,
                    "dimension": mesh.dimension,
                    "bending_walls": dict(mesh.bending_walls),
                    "blocks": [[block.kind, block.domain, len(block.nodes)] for block in mesh.blocks],
                    "faces": {name: [block.kind for block in blocks] for name, blocks in mesh.faces.items()},
                    "caps": {name: [block.kind for block in blocks] for name, blocks in mesh.caps.items()},
                    "frames": {name: nodes.tolist() for name, nodes in mesh.frames.items()},
                }
            )
            for group, named in (("faces", mesh.faces), ("caps", mesh.caps)):
                for number, blocks in enumerate(named.values()):
                    for part, block in enumerate(blocks):
                        own[f"{group}/{number}/{part}"] = block.nodes

    write_atomically(path, write)


def read_mesh(path: Path) -> Mesh:
    """Return the mesh of a file; raises StorageError where it is missing or damaged."""

    def read(file: h5py.File) -> Mesh:
        grid, own = file[GROUP], file[OWN]
        about = json.loads(own.attrs["mesh"])
        points = np.ascontiguousarray(grid["Points"][:, : about["dimension"]])
        connectivity, start, blocks = grid["Connectivity"][:], 0, []
        widths = np.diff(grid["Offsets"][:])
        first = 0
        for kind, domain, count in about["blocks"]:
            size = count * int(widths[first])
            blocks.append(CellBlock(kind, domain, connectivity[start : start + size].reshape(count, -1)))
            start, first = start + size, first + count
        faces, caps = (
            {
                name: tuple(FaceBlock(kind, own[f"{group}/{number}/{part}"][:]) for part, kind in enumerate(kinds))
                for number, (name, kinds) in enumerate(about.get(group, {}).items())
            }
            for group in ("faces", "caps")
        )
        frames = {name: np.array(nodes, dtype=np.int64) for name, nodes in about.get("frames", {}).items()}
        return Mesh(points, tuple(blocks), faces, about["space"], about["bending_walls"], caps, frames)

    return _read(path, "mesh", read)


def write_state(path: Path, state: State, row: dict[str, Any], elapsed: float, mesh_file: str) -> None:
    """Write a state: displacement, nodal stress and stretch for pictures, and all that restores it.

    row: its line of the history; elapsed: wall time of the run so far, s; mesh_file: relative path to the mesh.
    """
    mesh = state.model.mesh
    parts = fields(state)
    stress = to_nodes(mesh, parts, lambda part: part.stress)
    strain = to_nodes(mesh, parts, lambda part: part.right_cauchy_green)

    def write(temporary: Path) -> None:
        with h5py.File(temporary, "w") as file:
            grid = _grid(file)
            for name in _GEOMETRY:
                grid[name] = h5py.ExternalLink(mesh_file, f"/{GROUP}/{name}")
            points = grid.create_group("PointData")
            points["Displacement"] = _three(state.displacement)
            points["VonMises"] = von_mises(stress).astype(np.float32)
            points["LargestPrincipalStress"] = principal(stress)[:, 0].astype(np.float32)
            points["LargestStretch"] = np.sqrt(np.maximum(principal(strain)[:, 0], 0.0)).astype(np.float32)
            cells = grid.create_group("CellData")
            cells["Domain"] = h5py.ExternalLink(mesh_file, f"/{GROUP}/CellData/Domain")
            own = file.create_group(OWN)
            plain = {}
            for item in dataclass_fields(State):
                value = getattr(state, item.name)
                if item.name in ("model", "displacement"):
                    continue
                if isinstance(value, np.ndarray):
                    own.create_dataset(item.name, data=value, **_PACKED)
                elif isinstance(value, list):
                    for number, array in enumerate(value):
                        own.create_dataset(f"{item.name}/{number}", data=array, **_PACKED)
                else:
                    plain[item.name] = encode(value, item.name)
            own.attrs["state"] = json.dumps(plain)
            own.attrs["row"] = json.dumps(row)
            own.attrs["elapsed"] = elapsed

    write_atomically(path, write)


def read_state(path: Path, model: Model) -> State:
    """Return the state of a file, equal to the one that was written bit for bit; raises StorageError."""

    def read(file: h5py.File) -> State:
        own = file[OWN]
        values: dict[str, Any] = decode(json.loads(own.attrs["state"]))
        for name, item in own.items():
            if isinstance(item, h5py.Group):
                values[name] = [item[str(number)][:] for number in range(len(item))]
            else:
                values[name] = item[:]
        displacement = file[GROUP]["PointData"]["Displacement"][:, : model.mesh.dimension]
        if displacement.shape != model.mesh.points.shape:
            raise ValueError(f"{len(displacement)} nodes, the mesh has {len(model.mesh.points)}")
        return State(model=model, displacement=np.ascontiguousarray(displacement), **values)

    return _read(path, "state", read)


def read_row(path: Path) -> tuple[dict[str, Any], float]:
    """Return the line of the history that a state file holds and the wall time until then, s; raises StorageError."""

    def read(file: h5py.File) -> tuple[dict[str, Any], float]:
        own = file[OWN]
        return json.loads(own.attrs["row"]), float(own.attrs["elapsed"])

    return _read(path, "state", read)


def _read(path: Path, kind: str, read: Callable[[h5py.File], Result]) -> Result:
    if not path.is_file():
        raise StorageError(f"{path} is missing: expected the {kind} of a run")
    try:
        with h5py.File(path, "r") as file:
            return read(file)
    except (OSError, KeyError, ValueError, TypeError, IndexError, PneumorphError) as error:
        raise StorageError(f"{path} is damaged or not the {kind} of a run: {error}") from error


def _grid(file: h5py.File) -> h5py.Group:
    """Return the root group of an unstructured grid."""
    group = file.create_group(GROUP)
    group.attrs["Version"] = np.array([1, 0], dtype=np.int64)
    group.attrs.create("Type", np.bytes_("UnstructuredGrid"))
    return group


def _three(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points or vectors with a third component, 0 in plane problems."""
    result = np.zeros((len(values), 3))
    result[:, : values.shape[1]] = values
    return result
