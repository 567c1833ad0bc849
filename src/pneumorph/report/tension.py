"""The report of a study of flat sheets: curves, effective stiffness and Poisson's ratio."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

from pneumorph.geometry.lattice import Lattice
from pneumorph.homogenisation import TensionTest
from pneumorph.report.lattice_figure import lattice_figure
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.tables import Cell, Table
from pneumorph.report.tension_figure import tension_figure
from pneumorph.solution import History
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.solution.history import TEXT, Column
from pneumorph.studies.tension import MODELS, Pull, TensionStudy
from pneumorph.units import show

TABLE = "table.csv"
_COLUMNS = (
    Column("kind", "cells", TEXT), Column("direction", "pulled", TEXT), Column("model", "model", TEXT),
    Column("stiffness", "initial stiffness per width, N/mm", "number"),
    Column("modulus", "initial modulus, holes included", "stress"),
    Column("poisson_ratio", "initial Poisson's ratio", "number"),
    Column("last_strain", "last strain", "number"), Column("last_force", "last force", "force"),
    Column("last_lateral_displacement", "last lateral displacement", "length"),
)  # fmt: skip


def write_tension_report(
    study: TensionStudy, tests: Mapping[Pull, TensionTest], folder: Path, command: str = ""
) -> Path:
    """Write report.html, table.csv and figures/ into a folder; return the page's path.

    tests: those that ended, at least one. Raises StorageError.
    """
    make_folder(folder / "figures")
    table = tension_table(study, tests)
    table.write_csv(folder / TABLE)
    page = Page(
        title=study.title,
        version=version("pneumorph"),
        status="done" if len(tests) == len(study.pulls) else "stopped",
        headline=f"{len(tests)} of {len(study.pulls)} tension tests of flat sheets ended.",
        message="",
        tiles=[(str(len(tests)), "tests"), *_softest(table)],
        results=_shown(table),
        mesh=None,
        checks=Table("", ("", ""), tuple(_mesh_rows(study))),
        versions=Table("", ("", ""), (("pneumorph", version("pneumorph")),)),
        command=command,
        notes=list(_NOTES),
        asked=[_asked(study)],
        shapes_head=("Curves and sheets", "Curves and sheets"),
        beside=f"The study (study.toml), {TABLE}, curves/ (a CSV file for each test) and figures",
    )
    for model, meaning in MODELS.items():
        chosen = {pull.label: test for pull, test in tests.items() if pull.model == model}
        if chosen:
            _add(page, folder, f"tension-{model}", f"Force and lateral strain of {meaning}.", tension_figure(chosen))
    for kind, sheet in study.sheets.items():
        lattice = Lattice(*sheet.lengths, cells=((sheet.cell,) * sheet.columns,) * sheet.rows)
        _add(page, folder, f"sheet-{kind}", f"The sheet of {kind} cells.", lattice_figure(lattice))
    _write(folder / "report.html", page.html().encode())
    return folder / "report.html"


def tension_table(study: TensionStudy, tests: Mapping[Pull, TensionTest]) -> History:
    """Return a row for each test: initial stiffness, modulus and Poisson's ratio, and where it ended."""
    rows = []
    for pull, test in tests.items():
        last, depth = study.curve(pull, test).rows[-1], study.sheets[pull.kind].depth
        values = (pull.kind, pull.direction, pull.model, test.stiffness, test.stiffness / depth, test.poisson_ratio,
                  last["strain"], last["force"], last["lateral_displacement"])  # fmt: skip
        rows.append(dict(zip((column.key for column in _COLUMNS), values, strict=True)))
    return History(list(_COLUMNS), rows)


def _shown(table: History) -> Table:
    def cell(value: object, column: Column) -> Cell:
        return Cell(str(value)) if column.kind == TEXT else Cell(show(float(str(value)), column.kind, 3), number=True)

    rows = [tuple(cell(row[column.key], column) for column in table.columns) for row in table.rows]
    return Table("", tuple(column.label for column in table.columns), tuple(rows))


def _softest(table: History) -> list[tuple[str, str]]:
    values = table.values("modulus")
    names = [f"{row['kind']}, {row['direction']}" for row in table.rows]
    return [
        (show(float(values[place]), "stress", 3), f"{word}: {names[place]}")
        for word, place in (("softest", int(values.argmin())), ("stiffest", int(values.argmax())))
    ]


def _mesh_rows(study: TensionStudy) -> list[tuple[Cell | str, ...]]:
    return [("largest edge of the mesh", show(study.size, "length", 3)), ("cells through the half depth", "1")]


def _asked(study: TensionStudy) -> Table:
    s, pull = study.file.sheet, study.file.pull
    rows = [
        ("sheet", f"{s.columns} columns of {show(s.width, 'length')}, {s.rows} rows of {show(s.height, 'length')}"),
        ("cg", f"{s.cg:g}"), ("beam", show(s.beam, "length")), ("depth", show(s.depth, "length")),
        ("least beam", "as cg makes it" if not s.least_beam else f"{show(s.least_beam, 'length')}, assumed"),
        ("material", type(study.material).__name__), ("strain", f"{pull.strain:g}"),
    ]  # fmt: skip
    return Table("", ("", ""), tuple(rows))


def _add(page: Page, folder: Path, name: str, text: str, content: bytes) -> None:
    _write(folder / "figures" / f"{name}.svg", content)
    page.shapes.append(Item(text, data_uri(content, "svg")))


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda temporary: temporary.write_bytes(content))


_NOTES = (
    "Quasi-static, at finite strain; grips hold the ends of a sheet along the pull and let them slide across it. "
    "Strain is that between the grips; gauge and lateral strains are means over the inner half of the cells. Lateral "
    "displacement is the mean lateral strain times the width of the whole sheet, widening positive.",
    "Modulus: initial force over width, depth and strain of the inner cells, holes included.",
    "An endless sheet is one periodic cell without stress across the pull; it has no cut edges.",
)
