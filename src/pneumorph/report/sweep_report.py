"""The report of a sweep: a page with its table and figures, and the figures as files."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from pneumorph.report.page import data_uri
from pneumorph.report.sweep_figures import MOST, sweep_figures
from pneumorph.report.tables import Cell, Table
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.solution.history import TEXT
from pneumorph.studies.sweeps import Sweep, SweepTable
from pneumorph.units import show

PAGE, FIGURES = "report.html", "figures"
_TONES = {"done": "good", "stopped": "fair", "failed": "off", "refused": "none", "not computed": "none"}


def write_sweep_report(sweep: Sweep, table: SweepTable, folder: Path, command: str = "") -> Path:
    """Write `report.html` and figures/*.svg into the folder of a sweep; return the path of the page.

    command: that repeats the sweep. Raises StorageError.
    """
    figures = sweep_figures(table)
    make_folder(folder / FIGURES)
    for figure in figures:
        _write(folder / FIGURES / f"{figure.name}.svg", figure.svg)
    page = Environment(
        loader=PackageLoader("pneumorph.report", "."), autoescape=True, undefined=StrictUndefined
    ).get_template("sweep.html")
    counts = [(str(table.count(status)), status) for status in _TONES if table.count(status)]
    text = page.render(
        title=sweep.title,
        version=version("pneumorph"),
        tiles=[(str(len(table)), "designs"), *counts],
        figures=[(figure.caption, data_uri(figure.svg, "svg")) for figure in figures],
        left_out=max(0, sum(map(table.varies, table.results)) - MOST),
        asked=_asked(sweep),
        designs=_designs(table),
        command=command,
    )
    _write(folder / PAGE, text.encode())
    return folder / PAGE


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda temporary: temporary.write_bytes(content))


def _asked(sweep: Sweep) -> Table:
    sampling = sweep.file.sampling
    rows = [("study", sweep.study.title), ("method", sampling.method)]
    if sampling.samples is not None:
        rows += [("samples", str(sampling.samples)), ("seed", str(sampling.seed))]
    for parameter in sweep.parameters:
        values = ", ".join(map(str, parameter.values))
        rows.append((parameter.path, values or " to ".join(map(str, parameter.bounds or ()))))
    return Table("", ("", ""), tuple(rows))


def _designs(table: SweepTable) -> Table:
    columns = [column for column in table.rows.columns if column.key != "identity"]
    rows = []
    for row in table.rows.rows:
        cells = []
        for column in columns:
            value = row[column.key]
            if column.kind == TEXT:
                cells.append(Cell(str(value), _TONES.get(str(value), "") if column.key == "status" else ""))
            else:
                cells.append(Cell(show(float(value), column.kind) if np.isfinite(value) else "", number=True))
        rows.append(tuple(cells))
    return Table("", tuple(column.label for column in columns), tuple(rows), "All digits are in table.csv.")
