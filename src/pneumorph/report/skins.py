"""The report of the sweep over lattice skins: findings, trends, maps, and the table of designs on a page of its own."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from pneumorph.geometry import BendingSkin
from pneumorph.report import style
from pneumorph.report.comparison import write_comparison
from pneumorph.report.figure_file import figure_file
from pneumorph.report.lattice_figure import lattice_figure
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.sweep_report import write_sweep_report
from pneumorph.report.tables import Cell, Table
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.reproductions import auxetic_skin as skins
from pneumorph.studies.reproductions.soft_wheel import Finding
from pneumorph.studies.sweeps import SweepTable
from pneumorph.units import printed_unit, show, to_printed

_RESULTS = (("edge_curvature", "curvature"), ("diameter", "length"), ("pressure", "pressure"))


def write_skin_report(
    study: skins.SkinStudy, table: SweepTable, found: Sequence[Finding], folder: Path, command: str = ""
) -> Path:
    """Write report.html, comparison.csv and figures/ into a sweep's folder, the sweep's own page into sweep/ of it.

    found: all statements of the study against what was computed. Returns the path of the page. Raises StorageError.
    """
    make_folder(folder / "figures")
    sweep = study.sweep
    designs = write_sweep_report(sweep, table, folder / "sweep", command)
    write_comparison([item.row for item in found], folder)
    held = sum(item.holds is True for item in found)
    known = sum(item.holds is not None for item in found)
    done = table.count("done")
    page = Page(
        title=skins.SYSTEM.title,
        version=version("pneumorph"),
        status="done" if done == len(table) else "stopped",
        headline=f"{held} of {len(found)} statements of the study hold here, {known - held} do not, "
        f"{len(found) - known} were not computed.",
        message=""
        if done == len(table)
        else f"{len(table) - done} of {len(table)} designs did not reach their volume.",
        tiles=[(f"{held} of {len(found)}", "statements hold"), (str(done), "designs done"), *_times(table)],
        results=_design_table(study, table),
        mesh=None,
        checks=_ends(study, table),
        versions=Table("", ("", ""), (("pneumorph", version("pneumorph")),)),
        source=skins.SYSTEM.source,
        command=command,
        notes=list(skins.NOTES),
        comparison=findings_table(found),
        shapes_head=("Trends and map", "Trends and map"),
        beside=f"Table of designs, the page {designs.relative_to(folder)} of the sweep, their histories, and figures",
    )
    at = f"at {study.volume:g} mL; over re-entrant columns at {show(study.pressure, 'pressure')}"
    for name, caption, content in (
        ("trends", f"Curvature of the outer edge, diameter at mid-length, pressure {at}.", trend_figure(study, table)),
        ("map", "Planar map of the first design of the study: 7 cells along, 12 around, cg 0.2.",
         lattice_figure(BendingSkin().tube.lattice)),
    ):  # fmt: skip
        _write(folder / "figures" / f"{name}.svg", content)
        page.shapes.append(Item(caption, data_uri(content, "svg")))
    _write(folder / "report.html", page.html().encode())
    return folder / "report.html"


def trend_figure(study: skins.SkinStudy, table: SweepTable) -> bytes:
    """Return curvature, diameter and pressure (rows) over what is varied (columns) as SVG."""
    known, trends = skins.Measured(study, table), skins.trends(study)
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(2.4 * len(trends), 2.0 * len(_RESULTS)), layout="constrained")
        grid = figure.subplots(len(_RESULTS), len(trends), squeeze=False)
        for row, (key, kind) in enumerate(_RESULTS):
            for column, trend in enumerate(trends):
                # all at one pressure: the volume takes its place
                fixed = key == "pressure" and bool(trend.place)
                axes = grid[row, column]
                if fixed:
                    axes.set_axis_off()
                    continue
                values = known.values(trend.skins, key + trend.place)
                axes.plot(trend.over, [to_printed(v, kind) for v in values], "o-", color=style.LINES[row])
                axes.set_xticks(trend.over)
                if column == 0:
                    unit = printed_unit(kind)
                    axes.set_ylabel(f"{key.replace('_', ' ')} [{unit}]")
                if row == len(_RESULTS) - 1 or (trend.place and row == len(_RESULTS) - 2):
                    axes.set_xlabel(trend.x)
        return figure_file(figure)


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda temporary: temporary.write_bytes(content))


def _times(table: SweepTable) -> list[tuple[str, str]]:
    seconds = table.values("wall_time")
    return [(f"{np.nansum(seconds) / 60.0:.0f} min", "of one core")]


def findings_table(found: Sequence[Finding]) -> Table:
    """Return the table of statements: what was computed, and whether it holds."""
    rows = []
    for item in found:
        row = item.row
        computed = "–" if row.computed is None else f"{row.computed:.4g} {row.unit}".strip()
        verdict = {True: "holds", False: "does not hold", None: "not computed"}[item.holds]
        tone = {True: "good", False: "off", None: "none"}[item.holds]
        rows.append((row.quantity, row.condition, item.statement, Cell(computed, number=True), Cell(verdict, tone)))
    return Table("", ("Quantity", "Between", "Reported", "Computed", ""), tuple(rows), "All rows: comparison.csv.")


def _design_table(study: skins.SkinStudy, table: SweepTable) -> Table:
    known = skins.Measured(study, table)
    rows: list[tuple[Cell | str, ...]] = []
    for skin in study.skins:
        cells = [
            Cell("–" if np.isnan(value := known.value(skin, key)) else show(value, kind), number=True)
            for key, kind in (*_RESULTS, ("tip_rotation", "angle"))
        ]
        rows.append((skin.name, *cells))
    head = ("Cells along x around, gap, ratio of moduli, columns", "Curvature", "Diameter", "Pressure", "Tip rotation")
    return Table(f"Designs at {study.volume:g} mL", head, tuple(rows))


def _ends(study: skins.SkinStudy, table: SweepTable) -> Table:
    """Return how each design ended, with the reason where it did not reach its volume."""
    tones = {"done": "good", "stopped": "fair", "failed": "off"}
    rows = []
    for (skin, volume), row in zip(study.skins.items(), table.rows.rows, strict=True):
        status = str(row["status"])
        time = "" if np.isnan(row["wall_time"]) else show(float(row["wall_time"]), "time", 3)
        rows.append((skin.name, f"{volume:g} mL", Cell(status, tones.get(status, "none")), time, str(row["message"])))
    return Table("", ("Design", "Inflated to", "Ended", "Time of one core", "Reason"), tuple(rows))
