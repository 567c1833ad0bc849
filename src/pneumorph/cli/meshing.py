"""What `mesh` does: find the body that is meant, print what it holds, and write picture, mesh and study file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from pneumorph.cli.output import console
from pneumorph.errors import EngineError, InputError, StorageError, unknown_name
from pneumorph.geometry import Actuator
from pneumorph.mesh import Imported, Mesh, MeshSize, generate, inspect
from pneumorph.mesh.body import SUFFIXES
from pneumorph.mesh.findings import CavityFound, cavities_found, domains_found, faces_found
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.solution.vtkhdf import write_mesh
from pneumorph.studies import load_study
from pneumorph.studies.parts import Assembly
from pneumorph.studies.schema import TEMPLATES
from pneumorph.studies.writing import to_toml
from pneumorph.units import parse, show

_WIDTH = 120  # of tables that go to a file or another program


@dataclass(frozen=True, eq=False)
class Subject:
    """What is looked at: its name, the actuator and its mesh; assembly: all bodies in it, where they are several."""

    name: str
    actuator: Actuator
    mesh: Mesh
    assembly: Assembly | None = None


def subject_of(file: str, more: Sequence[Path], unit: str | None, size: str | None) -> Subject:
    """Return the body of a CAD or mesh file, of a study file, or of a template's default dimensions. InputErrors."""
    coarse = size == "coarse"
    largest = None if size is None or coarse else parse(size, "length", "--size")
    suffix = Path(file).suffix.lower()
    if suffix == ".toml" or file in TEMPLATES:
        if unit is not None or more:
            raise InputError(f"'{file}': --unit and more files go with CAD and mesh files only")
        if file in TEMPLATES:
            actuator = TEMPLATES[file]()
            return Subject(file, actuator, generate(actuator, largest, coarse=coarse))
        if size is not None:
            raise InputError(f"'{file}': the study says the size of its mesh, leave --size out")
        study = load_study(Path(file))
        return Subject(study.name, study.actuator, study.mesh(), study.assembly)
    if not suffix and not Path(file).exists():
        raise InputError(f"{unknown_name('template', file, TEMPLATES)}; or a file with {', '.join(SUFFIXES)}, .toml")
    names = (file, *map(str, more))
    body = Imported(names if more else file, unit, meshing=MeshSize(largest, coarse))
    return Subject(Path(file).stem, body, body.mesh)


def inspect_file(subject: Subject, folder: Path, *, draw: bool, study: Path | None) -> None:
    """Print tables, and write picture, mesh and, if wanted, a study file. Raises StorageError."""
    out = console()
    if not out.is_terminal:
        out.width = _WIDTH
    cavities = cavities_found(subject.mesh, subject.assembly or subject.actuator)
    _print_tables(out, subject, cavities)
    make_folder(folder)
    write_mesh(folder / "mesh.vtkhdf", subject.mesh)
    out.print(f"mesh: {folder / 'mesh.vtkhdf'}", markup=False)
    if draw:
        try:
            path = _draw(subject.mesh, cavities, folder)
            out.print(f"picture: {path}", markup=False)
        except EngineError as error:
            out.print(f"no picture: {error}", markup=False)
    if study is not None:
        _write_study(study, subject, cavities)
        out.print(f"study: {study}; run it with 'pneumorph run {study}'", markup=False)


def _print_tables(out: Console, subject: Subject, cavities: Sequence[CavityFound]) -> None:
    mesh, quality = subject.mesh, inspect(subject.mesh)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    out.print(f"{subject.name}: {_place(low)} to {_place(high)} mm", markup=False)
    rows = [(d.name, ", ".join(d.kinds), str(d.cells), show(d.volume, "volume")) for d in domains_found(mesh)]
    out.print(_table("Domains", ("name", "cells of kind", "cells", "volume"), rows))
    faces = [
        (
            f.name, str(f.facets), f"{f.area:.4g} mm²", "curved or bent" if f.normal is None else _place(f.normal),
            _place(f.centre),
        )
        for f in faces_found(mesh)
    ]  # fmt: skip
    out.print(_table("Faces", ("name", "facets", "area", "normal", "centre, mm"), faces))
    hollow = [(c.name, show(c.volume, "volume", 6), _closed(c), ", ".join(c.faces), _place(c.middle)) for c in cavities]
    if hollow:
        out.print(_table("Cavities", ("name", "volume", "closed", "faces", "middle, mm"), hollow))
    else:
        out.print("Cavities: none, no closed inner shell")
        for opening in subject.actuator.openings() if isinstance(subject.actuator, Imported) else ():
            out.print(f"  an opening that a cap could close: {opening}", markup=False)
    out.print(
        f"Mesh: {quality.cells} cells, {quality.nodes} nodes, {quality.unknowns} unknowns; edges "
        f"{show(quality.smallest_edge, 'length', 3)} least, {show(quality.median_edge, 'length', 3)} median; "
        f"det J ratio {quality.smallest_jacobian:.2g}, worst aspect {quality.worst_aspect:.3g}",
        markup=False,
    )
    notes = subject.actuator.notes if isinstance(subject.actuator, Imported) else ()
    for warning in (*notes, *quality.warnings):
        out.print(f"note: {warning}", markup=False)


def _closed(cavity: CavityFound) -> str:
    if cavity.gap is not None:
        return f"open at {_place(cavity.gap)} mm"
    return f"by {', '.join(cavity.caps)}" if cavity.caps else "yes"


def _table(title: str, columns: Iterable[str], rows: Iterable[Sequence[str]]) -> Table:
    table = Table(*columns, box=None, pad_edge=False, title=title, title_justify="left")
    for row in rows:
        table.add_row(*row)
    return table


def _place(values: NDArray[np.float64]) -> str:
    return "(" + ", ".join(f"{round(float(v), 4) + 0.0:.4g}" for v in values) + ")"


def _draw(mesh: Mesh, cavities: Sequence[CavityFound], folder: Path) -> Path:
    from pneumorph.report.compose import encode
    from pneumorph.report.named_faces import named_faces_picture

    data = encode(named_faces_picture(mesh, cavities))
    write_atomically(folder / "faces.png", lambda path: path.write_bytes(data) and None)
    return folder / "faces.png"


def _write_study(path: Path, subject: Subject, cavities: Sequence[CavityFound]) -> None:
    """Write a study of an imported body: its ends along the longest side become clamp and tip, as far as unnamed."""
    body = subject.actuator
    if not isinstance(body, Imported):
        raise InputError("--study goes with CAD and mesh files; 'pneumorph new TEMPLATE' writes one of a template")
    axis = "xyz"[int(np.argmax(np.ptp(subject.mesh.points, axis=0)))]
    files = [str(file.resolve()) for file in body.paths]
    ends = {"clamp": f"-{axis}", "tip": axis}
    actuator = {
        "file": files if len(files) > 1 else files[0],
        "unit": body.unit,
        "faces": {
            name: {"normal": way, "largest_planar": True} for name, way in ends.items() if name not in body.face_names
        },
    }
    mesh = {
        "size": show(body.meshing.size, "length") if body.meshing.size else "coarse" if body.meshing.coarse else None
    }
    table = {
        "title": subject.name,
        "actuator": {key: value for key, value in actuator.items() if value},
        "material": {"name": "shore-a45-platinum"},
        "mesh": mesh if mesh["size"] else None,
        "phase": [{"name": "inflate", "targets": {cavity.name: "10 kPa" for cavity in cavities}}],
    }
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(to_toml({key: value for key, value in table.items() if value}))
    except FileExistsError as error:
        raise StorageError(f"'{path}' exists already: choose another file, or remove it first") from error
    except OSError as error:
        raise StorageError(f"'{path}': cannot write ({error.strerror or error})") from error
