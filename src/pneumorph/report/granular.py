"""The report of a sweep over beds of grains: tables, findings, figures, and pictures of vehicles on their beds."""

from __future__ import annotations

import csv
import io
import logging
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from pneumorph.errors import EngineError, InputError
from pneumorph.report import granular_figures as figures
from pneumorph.report.comparison import write_comparison
from pneumorph.report.compose import compose, encode
from pneumorph.report.granular_picture import bed_picture
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.tables import Cell as Shown
from pneumorph.report.tables import Table
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.granular import GranularRun, Means, means
from pneumorph.studies.reproductions import soft_wheel
from pneumorph.studies.reproductions import soft_wheel_granular as study
from pneumorph.studies.rolling import read_sweep, read_trajectory
from pneumorph.studies.run_table import DONE
from pneumorph.terrain.granular import SANDS

_log = logging.getLogger(__name__)

Rows = Mapping[str, Mapping[str, str]]


def write_granular_report(
    folder: Path, runs: Sequence[GranularRun], rows: Rows, *, quick: bool, outlines: str, command: str = ""
) -> Path:
    """Write report.html, figures/, distances.csv and comparison.csv into a sweep's folder; return the page's path.

    rows: the sweep's table by run. outlines: 'parametric' or 'files'. Raises InputError where no run is done,
    StorageError where something cannot be read or written.
    """
    known = [run for run in runs if run.name in rows]
    done = [run for run in known if rows[run.name]["status"] == DONE]
    if not done:
        raise InputError(f"'{folder}' holds no run that is done: there is nothing to report")
    table = means(rows[run.name] for run in known)
    found = study.findings(table, quick)
    make_folder(folder / "figures")
    _write_text(folder / "distances.csv", distances_csv(table))
    write_comparison([item.row for item in found], folder)
    record = read_sweep(folder)
    page = Page(
        title=soft_wheel.SYSTEM.title + ": soft wheels on loose ground",
        version=version("pneumorph"),
        status="done" if len(done) == len(runs) else "stopped" if len(known) == len(runs) else "running",
        headline=f"{len(done)} of {len(runs)} runs are done, {len(known) - len(done)} failed.",
        message=_verdict(found),
        tiles=_tiles(rows, done),
        results=_means_table(table),
        mesh=None,
        checks=_checks(rows, known, done),
        versions=Table("", ("", ""), tuple((name, text) for name, text in record["versions"].items())),
        source=soft_wheel.SYSTEM.source,
        command=command,
        notes=list(study.notes(outlines)),
        comparison=_findings_table(found),
        asked=[_sand_table()],
        shapes_head=("Ways and pictures", "Ways, energies and pictures"),
        beside="Table of runs, distances, models with their wheels, trajectories and figures",
    )
    _add_figures(page, folder, table, done, quick)
    _write_text(folder / "report.html", page.html())
    return folder / "report.html"


def distances_csv(table: Mapping[str, Mapping[str, Means]]) -> str:
    """Return wheel by sand: mean distance, ride height and sinkage, and the number of beds."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(["wheel", "sand", "beds", "distance [m]", "ride height [mm]", "sinkage [mm]"])
    for wheel, cells in table.items():
        for sand, cell in cells.items():
            values = (cell.distance, cell.ride_height, cell.sinkage)
            numbers = ["" if v is None else f"{v:.4g}" for v in values]
            writer.writerow([wheel, sand, len(cell.distances), *numbers])
    return buffer.getvalue()


def _write_text(path: Path, text: str) -> None:
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def _verdict(found: Sequence[soft_wheel.Finding]) -> str:
    stated = [item for item in found if item.statement and item.holds is not None]
    held = sum(item.holds is True for item in stated)
    words = f"{held} of {len(stated)} statements of the study on which shape is best hold here." if stated else ""
    return f"{words} Differences of a few per cent are within the chance of a bed: run several (--beds)."


def _tiles(rows: Rows, done: Sequence[GranularRun]) -> list[tuple[str, str]]:
    wall = sum(float(rows[run.name]["wall [s]"]) for run in done)
    far = max(done, key=lambda run: float(rows[run.name]["distance [m]"]))
    return [
        (f"{float(rows[far.name]['distance [m]']):.2f} m", f"farthest, {far.name}"),
        (f"{done[0].bed.grains}", "grains"),
        (f"{sum(run.drive.duration for run in done):.0f} s", "simulated"),
        (f"{wall / 60.0:.1f} min", "of one core"),
    ]


def _means_table(table: Mapping[str, Mapping[str, Means]]) -> Table:
    body: list[tuple[Shown | str, ...]] = []
    for wheel, cells in table.items():
        for sand, cell in cells.items():
            values = [cell.distance, cell.ride_height, cell.sinkage]
            texts = ["–" if v is None else f"{v:.3g}" for v in values]
            spread = max(cell.distances) - min(cell.distances) if len(cell.distances) > 1 else None
            texts.append("–" if spread is None else f"{spread:.2g}")
            body.append((wheel, sand, *(Shown(text, number=True) for text in texts)))
    note = "Ride height: mean height of the axles over the bed as it was. Spread: largest less smallest of the beds."
    head = ("Wheel", "Sand", "Distance [m]", "Ride height [mm]", "Sinkage [mm]", "Spread of the distance [m]")
    return Table("Distance and ride height", head, tuple(body), note)


def _findings_table(found: Sequence[soft_wheel.Finding]) -> Table:
    body = []
    for item in found:
        row = item.row
        reported = item.statement or f"{row.reported:g} {row.unit}"
        computed = "–" if row.computed is None else f"{row.computed:.3g} {row.unit}".strip()
        holds = {True: "holds", False: "does not hold", None: ""}[item.holds]
        tone = {True: "good", False: "off", None: "none"}[item.holds]
        body.append((row.quantity, row.condition, reported, Shown(computed, number=True), Shown(holds, tone), row.note))
    return Table("", ("Quantity", "Sand", "Reported", "Computed", "", "Note"), tuple(body))


def _sand_table() -> Table:
    body = [
        (
            item.name, item.title, Shown(f"{item.modulus:g}", number=True), Shown(f"{item.restitution:g}", number=True),
            Shown(f"{1e3 * item.surface_energy:g}", number=True), Shown(f"{item.friction:g}", number=True),
            Shown(f"{item.rolling:g}", number=True),
        )
        for item in SANDS.values()
    ]  # fmt: skip
    head = ("Sand", "", "Modulus [MPa]", "Restitution", "Surface energy [J/m²]", "Sliding", "Rolling")
    return Table("The four sands", head, tuple(body))


def _checks(rows: Rows, known: Sequence[GranularRun], done: Sequence[GranularRun]) -> Table:
    def most(column: str) -> tuple[float, str]:
        return max((float(rows[run.name][column]), run.name) for run in done)

    error, where = most("energy error [J]")
    work = float(rows[where]["motor work [J]"])
    kinetic, moving = most("grains' kinetic energy, most [J]")
    deep, touching = most("overlap [-]")
    least = min(float(rows[run.name]["least upright [-]"]) for run in done)
    load = [abs(float(rows[run.name]["load [N]"]) / _weight(run) - 1.0) for run in done]
    bed = done[0].bed
    limits = [item.bed.sand.rayleigh_time((1.0 - item.bed.spread) * item.bed.radius) for item in done]
    body = [
        ("Motor work that is neither in the vehicle nor given to the grains, most", f"{error:.3g} J of {work:.3g} J",
         where),
        ("Mean upward force of the grains against the weight, difference at most", f"{100.0 * max(load):.2g} %", ""),
        ("Kinetic energy of the grains, most", f"{kinetic:.3g} J", moving),
        ("Overlap of wheel and grain over the grain's radius, most", f"{deep:.3g}", touching),
        ("Least uprightness of the vehicle", f"{least:.3g}", ""),
        ("Time step and exchange interval over the Rayleigh time, most", f"{bed.step / min(limits):.3g}", ""),
        *((f"Failed: {run.name}", rows[run.name]["reason"], "") for run in known if run not in done),
    ]  # fmt: skip
    return Table("", ("Check", "Found", "Run"), tuple(body))


def _weight(run: GranularRun) -> float:
    from pneumorph.terrain.rover import GRAVITY

    return run.vehicle.mass * (0.25 if run.vehicle.single else 1.0) * GRAVITY


def _add_figures(
    page: Page, folder: Path, table: Mapping[str, Mapping[str, Means]], done: Sequence[GranularRun], quick: bool
) -> None:
    first = [run for run in done if run.number <= 1]
    reported = {} if quick else {"distance": study.REPORTED_DISTANCE, "ride height": study.REPORTED_RIDE}
    sands = [name for name in SANDS if any(name in cells for cells in table.values())]
    note = "" if quick else " Dashed lines: means over the sands that the study reports."
    drawn = [("distances", f"Each wheel on each sand.{note}", figures.bar_figure(table, sands, reported))]
    if first:
        ways: dict[str, dict[str, Mapping[str, figures.Array]]] = {}
        for run in first:
            ways.setdefault(run.bed.sand.name, {})[run.vehicle.surface.name] = read_trajectory(folder, run.name)
        drawn.append(("ways", "Ways forward and heights of the axles over time.", figures.way_figure(ways)))
        last = first[-1]
        drawn.append(
            ("energies", f"Where the motors' work went in {last.name}.",
             figures.energy_figure(read_trajectory(folder, last.name)))
        )  # fmt: skip
    for name, caption, content in drawn:
        write_atomically(folder / "figures" / f"{name}.svg", lambda path, c=content: path.write_bytes(c))  # type: ignore[misc]
        page.shapes.append(Item(caption, data_uri(content, "svg")))
    shown: dict[str, GranularRun] = {}
    for run in first:
        shown.setdefault(run.vehicle.surface.name, run)
    try:
        panels = [(run.name, bed_picture(run.vehicle, read_trajectory(folder, run.name))) for run in shown.values()]
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))
        return
    if panels:
        picture = compose(panels, columns=1)
        write_atomically(folder / "figures" / "beds.png", lambda path: path.write_bytes(encode(picture)))
        page.shapes.append(Item("Vehicles on their beds at the end.", data_uri(encode(picture, "webp"), "webp")))
