"""The run folder: run.json, mesh.vtkhdf, states/state_00000.vtkhdf and on, history.csv.

Every file is replaced in one go. run.json is written after the mesh, so where it stands a run can be resumed; a state
file counts when it has its final name; history.csv is only a copy of the rows that the states hold.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np

from pneumorph.errors import PneumorphError, StorageError
from pneumorph.mechanics import Model, Programme, State
from pneumorph.mesh.mesh import Mesh
from pneumorph.solution import vtkhdf
from pneumorph.solution.codec import decode, encode
from pneumorph.solution.files import make_folder, remove_parts, write_atomically
from pneumorph.solution.history import Column, History

FORMAT = 1
RUN, MESH, STATES, HISTORY = "run.json", "mesh.vtkhdf", "states", "history.csv"
_KEPT = 8  # states that a sequence remembers


class RunFolder:
    """Paths of a run, and its files in and out; nothing is touched when it is made."""

    def __init__(self, folder: str | Path):
        self.path = Path(folder)
        self.run, self.mesh = self.path / RUN, self.path / MESH
        self.states, self.history = self.path / STATES, self.path / HISTORY

    @property
    def holds_run(self) -> bool:
        """Whether anything of a run lies there."""
        return self.run.exists() or self.mesh.exists() or self.states.exists()

    def start(self, mesh: Mesh, record: Mapping[str, Any]) -> None:
        """Write the mesh and the record of a new run."""
        make_folder(self.states)
        self.clean()
        vtkhdf.write_mesh(self.mesh, mesh)
        self.write_record(record)

    def clean(self) -> None:
        """Remove what a killed run left half-written."""
        remove_parts(self.path)
        remove_parts(self.states)

    def write_record(self, record: Mapping[str, Any]) -> None:
        """Write run.json."""
        text = json.dumps({"format": FORMAT, **record}, indent=1, ensure_ascii=False)
        write_atomically(self.run, lambda path: path.write_text(text + "\n", encoding="utf-8"))

    def read_record(self) -> dict[str, Any]:
        """Return run.json; raises StorageError where it is missing, damaged or of another format."""
        if not self.run.is_file():
            raise StorageError(f"{self.run} is missing: '{self.path}' is not the folder of a run")
        try:
            record = json.loads(self.run.read_text(encoding="utf-8"))
            number = record["format"]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise StorageError(f"{self.run} is damaged: {error}") from error
        if number != FORMAT:
            raise StorageError(f"{self.run} has format {number}, this version reads {FORMAT}")
        return dict(record)

    def state_file(self, index: int) -> Path:
        """Return the path of a state."""
        return self.states / f"state_{index:05d}.vtkhdf"

    def count(self) -> int:
        """Return how many states there are; raises StorageError where one between them is missing."""
        found = sorted(self.states.glob("state_*.vtkhdf"))
        for index, path in enumerate(found):
            if path != self.state_file(index):
                raise StorageError(f"{self.state_file(index)} is missing, but {path.name} is there")
        return len(found)

    def write_state(self, state: State, row: dict[str, Any], elapsed: float) -> None:
        """Write a state with its line of the history."""
        vtkhdf.write_state(self.state_file(state.index), state, row, elapsed, f"../{MESH}")

    def read_model(self, record: Mapping[str, Any]) -> Model:
        """Return the model; raises StorageError."""
        mesh = vtkhdf.read_mesh(self.mesh)
        if digest(mesh) != record.get("mesh_digest"):
            raise StorageError(f"{self.mesh} is not the mesh with which {self.run} was written")
        try:
            return Model(mesh=mesh, **decode(record["model"]))
        except (KeyError, TypeError, AttributeError, PneumorphError) as error:
            raise StorageError(f"{self.run} is damaged, its model cannot be restored: {error}") from error

    def read_programme(self, record: Mapping[str, Any]) -> Programme:
        """Return the programme; raises StorageError."""
        try:
            programme = decode(record["programme"])
        except (KeyError, PneumorphError) as error:
            raise StorageError(f"{self.run} is damaged, its programme cannot be restored: {error}") from error
        if not isinstance(programme, Programme):
            raise StorageError(f"{self.run} is damaged: it holds no programme")
        return programme

    def read_history(self, record: Mapping[str, Any]) -> tuple[History, float]:
        """Return the history as the states hold it and the wall time until the last of them, s."""
        try:
            columns = [Column(**column) for column in record["columns"]]
        except (KeyError, TypeError) as error:
            raise StorageError(f"{self.run} is damaged, its columns cannot be restored: {error}") from error
        rows, elapsed = [], 0.0
        for index in range(self.count()):
            row, elapsed = vtkhdf.read_row(self.state_file(index))
            rows.append(row)
        return History(columns, rows), elapsed


class StoredStates(Sequence[State]):
    """The states of a folder, read when they are asked for; the last few are remembered."""

    def __init__(self, folder: RunFolder, model: Model):
        self._folder = folder
        self._model = model
        self._count = folder.count()
        self._kept: dict[int, State] = {}

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> State: ...
    @overload
    def __getitem__(self, index: slice) -> list[State]: ...
    def __getitem__(self, index: int | slice) -> State | list[State]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        number = range(len(self))[index]
        if number not in self._kept:
            self.add(vtkhdf.read_state(self._folder.state_file(number), self._model))
        return self._kept[number]

    def __iter__(self) -> Iterator[State]:
        return (self[number] for number in range(len(self)))

    def add(self, state: State) -> None:
        """Remember a state that the folder holds; the oldest one is forgotten."""
        self._count = max(self._count, state.index + 1)
        self._kept[state.index] = state
        while len(self._kept) > _KEPT:
            del self._kept[next(iter(self._kept))]


def describe(model: Model) -> dict[str, Any]:
    """Return everything of a model but its mesh, encoded."""
    result = {
        "materials": encode(model.materials, "materials"),
        "supports": encode(model.supports, "supports"),
        "loads": encode(model.loads, "loads"),
        "cavities": encode(model.cavities, "cavities"),
        "pressure": model.pressure,
        "tubes": encode(model.tubes, "tubes"),
        "atmosphere": encode(model.atmosphere, "atmosphere"),
        "contacts": encode(model.contacts, "contacts"),
    }
    if model.free_bodies:
        result["free_bodies"] = encode(model.free_bodies, "free_bodies")
    return result


def digest(mesh: Mesh) -> str:
    """Return a checksum (SHA-256) of everything in a mesh."""
    total = hashlib.sha256()

    def add(*texts: object) -> None:
        total.update("\0".join(map(str, texts)).encode() + b"\1")

    add(mesh.space, sorted(mesh.bending_walls.items()), mesh.points.shape)
    total.update(np.ascontiguousarray(mesh.points, dtype=np.float64).tobytes())
    everything = [(block.kind, block.domain, block.nodes) for block in mesh.blocks]
    everything += [(block.kind, name, block.nodes) for name in sorted(mesh.faces) for block in mesh.faces[name]]
    for kind, name, nodes in everything:
        add(kind, name, nodes.shape)
        total.update(np.ascontiguousarray(nodes, dtype=np.int64).tobytes())
    return total.hexdigest()
