"""The report of a sweep over rigid terrain: tables, findings, figures, drawn robots, and films of single runs."""

from __future__ import annotations

import csv
import io
import logging
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

import numpy as np

from pneumorph.errors import EngineError, InputError
from pneumorph.report import rolling_figures as figures
from pneumorph.report.comparison import write_comparison
from pneumorph.report.compose import Picture, compose, encode
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.tables import Cell as Shown
from pneumorph.report.tables import Table
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.reproductions import soft_wheel
from pneumorph.studies.rolling import (
    MODELS,
    Cell,
    RollingRun,
    distances,
    ranking,
    read_sweep,
    read_trajectory,
)
from pneumorph.studies.run_table import DONE
from pneumorph.terrain.drawing import View, pictures
from pneumorph.threads import parallel

_log = logging.getLogger(__name__)

FILM_RATE = 10  # frames a second: drawing 50 m of ground takes a quarter of a second a picture
_PANEL = (480, 300)
_FILM = (800, 450)

Rows = Mapping[str, Mapping[str, str]]
Distances = Mapping[str, Mapping[str, Cell]]


def write_rolling_report(
    folder: Path, runs: Sequence[RollingRun], rows: Rows, *, command: str = "", films: Sequence[str] = ()
) -> Path:
    """Write report.html, figures/, distances.csv, ranking.csv and comparison.csv into a sweep's folder.

    rows: the sweep's table by run; runs that are not in it yet are left out. films: names of runs of which a film is
    drawn; films that are there are kept. Where robots cannot be drawn the page says why; that is no error. Returns the
    page's path. Raises InputError where no run is done, StorageError where something cannot be read or written.
    """
    known = [run for run in runs if run.name in rows]
    done = [run for run in known if rows[run.name]["status"] == DONE]
    if not done:
        raise InputError(f"'{folder}' holds no run that is done: there is nothing to report")
    table = distances(rows[run.name] for run in known)
    found = soft_wheel.findings(table)
    terrains = list(dict.fromkeys(run.ground.name for run in known))
    make_folder(folder / "figures")
    _write_text(folder / "distances.csv", distances_csv(table, terrains))
    _write_text(folder / "ranking.csv", ranking_csv(table))
    write_comparison([item.row for item in found], folder)
    record = read_sweep(folder)
    failed = [run for run in known if run not in done]
    page = Page(
        title=soft_wheel.SYSTEM.title + ": rigid wheels on rigid terrain",
        version=version("pneumorph"),
        status="done" if len(done) == len(runs) else "stopped" if len(known) == len(runs) else "running",
        headline=f"{len(done)} of {len(runs)} runs are done, {len(failed)} failed.",
        message=_verdict(found, rows, done),
        tiles=_tiles(table, rows, done),
        results=_distance_table(table, terrains),
        mesh=None,
        checks=_checks(rows, done, failed),
        versions=Table("", ("", ""), tuple((name, text) for name, text in record["versions"].items())),
        source=soft_wheel.SYSTEM.source,
        command=command,
        notes=list(soft_wheel.RIGID_NOTES),
        comparison=_findings_table(found),
        asked=[_ranking_table(table)],
        shapes_head=("Ways and pictures", "Ways and pictures"),
        beside="Table of runs, distances, MJCF models, terrain images, trajectories and figures",
    )
    _add_figures(page, folder, table, terrains, done)
    try:
        _add_pictures(page, folder, done)
        kept = [run.name for run in done if _film_file(folder, run.name).exists()]
        for name in dict.fromkeys([*films, *kept]):
            page.films.append(_film(folder, name))
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))
    _write_text(folder / "report.html", page.html())
    return folder / "report.html"


def distances_csv(table: Distances, terrains: Sequence[str]) -> str:
    """Return wheel by terrain: mean distance, and the spread where there are several drops, m."""
    many = [t for t in terrains if any(len(c[t].values) + c[t].failed > 1 for c in table.values() if t in c)]
    head = ["wheel", *(f"{t} [m]" for t in terrains), *(f"{t} spread [m]" for t in many)]
    lines = []
    for wheel, cells in table.items():
        means = [cells[t].mean if t in cells else None for t in terrains]
        spreads = [cells[t].spread if t in cells and cells[t].values else None for t in many]
        lines.append([wheel, *("" if v is None else f"{v:.4f}" for v in (*means, *spreads))])
    return _csv(head, lines)


def ranking_csv(table: Distances) -> str:
    """Return the wheels by their mean distance over the terrains, the best first."""
    head = ["rank", "wheel", "mean distance [m]", "least distance [m]"]
    ranked = enumerate(ranking(table), start=1)
    return _csv(head, [[str(n), wheel, f"{mean:.4f}", f"{least:.4f}"] for n, (wheel, mean, least) in ranked])


def _csv(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerows([head, *lines])
    return buffer.getvalue()


def _write_text(path: Path, text: str) -> None:
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def _verdict(found: Sequence[soft_wheel.Finding], rows: Rows, done: Sequence[RollingRun]) -> str:
    beats = [item for item in found if item.row.quantity.startswith("shortest distance")]
    lost = [item.row.condition for item in beats if item.holds is False]
    known = [item for item in beats if item.holds is not None]
    text = (
        f"On average over the drops three and more paddles do not beat one on: {', '.join(lost)}." if lost
        else f"On average over the drops three and more paddles beat one on all {len(known)} terrains computed."
    )  # fmt: skip
    beaten = _beaten(rows, done)
    text += f" In single runs they do not: {'; '.join(beaten)}." if beaten else ""
    held = sum(item.holds is True for item in found)
    return f"{text} {held} of {len(found)} statements of the study hold here, see the comparison."


def _beaten(rows: Rows, done: Sequence[RollingRun]) -> list[str]:
    """Return the runs with three and more paddles that end behind the best single paddle of the same start."""
    single: dict[tuple[str, int], float] = {}
    for run in done:
        if run.rover.wheel.paddles == 1:
            start = (run.ground.name, run.drop)
            single[start] = max(single.get(start, -np.inf), float(rows[run.name]["distance [m]"]))
    result = []
    for run in done:
        distance, best = float(rows[run.name]["distance [m]"]), single.get((run.ground.name, run.drop), -np.inf)
        if run.rover.wheel.paddles >= 3 and distance <= best:
            over = ", overturned" if float(rows[run.name]["least upright [-]"]) < 0.0 else ""
            result.append(f"{run.name} ({distance:.2f} m against {best:.2f} m{over})")
    return result


def _tiles(table: Distances, rows: Rows, done: Sequence[RollingRun]) -> list[tuple[str, str]]:
    best = ranking(table)
    simulated = sum(run.drive.duration for run in done)
    wall = sum(float(rows[run.name]["wall [s]"]) for run in done)
    tiles = [(best[0][0], "farthest on average"), (f"{best[0][1]:.2f} m", "its mean distance")] if best else []
    over = sum(float(rows[run.name]["least upright [-]"]) < 0.0 for run in done)
    return [*tiles, (f"{simulated:.0f} s", "simulated"), (f"{wall:.0f} s", "of one core"), (f"{over}", "overturned")]


def _distance_table(table: Distances, terrains: Sequence[str]) -> Table:
    body = []
    for wheel, cells in table.items():
        line: list[Shown | str] = [wheel]
        for terrain in terrains:
            cell = cells.get(terrain, Cell(()))
            text = "–" if cell.mean is None else f"{cell.mean:.2f}"
            text += f" (spread {cell.spread:.2f})" if len(cell.values) > 1 else ""
            text += " ↻" if cell.overturned else ""
            line.append(Shown(text + (" failed" if cell.failed else ""), number=True))
        body.append(tuple(line))
    note = "Mean over the drops, with the largest less the smallest. ↻: the robot overturned in at least one run."
    return Table("Distance [m]", ("Wheel", *(t.capitalize() for t in terrains)), tuple(body), note)


def _ranking_table(table: Distances) -> Table:
    body = tuple(
        (Shown(str(n), number=True), wheel, Shown(f"{mean:.2f}", number=True), Shown(f"{least:.2f}", number=True))
        for n, (wheel, mean, least) in enumerate(ranking(table), start=1)
    )
    return Table("Ranking", ("Rank", "Wheel", "Mean over the terrains [m]", "Least [m]"), body)


def _findings_table(found: Sequence[soft_wheel.Finding]) -> Table:
    body = []
    for item in found:
        row = item.row
        computed = "–" if row.computed is None else f"{row.computed:.2f} {row.unit}".strip()
        holds = {True: "holds", False: "does not hold", None: "not computed"}[item.holds]
        tone = {True: "good", False: "off", None: "none"}[item.holds]
        # what comes after the first part of the note: drops, failures, overturned robots
        rest = row.note.partition("; ")[2] or ("" if row.unit else row.note.removeprefix("reported: "))
        body.append(
            (row.quantity, row.condition, item.statement, Shown(computed, number=True), Shown(holds, tone), rest)
        )
    return Table("", ("Quantity", "Terrain", "Reported", "Computed", "", "Note"), tuple(body))


def _checks(rows: Rows, done: Sequence[RollingRun], failed: Sequence[RollingRun]) -> Table:
    def largest(column: str) -> tuple[str, float]:
        name = max((run.name for run in done), key=lambda name: float(rows[name][column]))
        return name, float(rows[name][column])

    wanted = {run.name: run.drive.wanted_turn / (2.0 * np.pi) for run in done}
    behind = {name: abs(float(rows[name]["turns [-]"]) - turns) for name, turns in wanted.items()}
    worst = max(behind, key=lambda name: behind[name])
    deep, depth = largest("penetration [mm]")
    body = [
        ("Turns of the wheels behind the wanted ones, most", f"{behind[worst]:.3f} of {wanted[worst]:g}", worst),
        ("Overlap of robot and ground, deepest recorded", f"{depth:.1f} mm", deep),
        *((f"Failed: {run.name}", rows[run.name]["reason"], "") for run in failed),
    ]
    note = (
        "The overlap comes from MuJoCo's default contact stiffness when a hopping robot lands: an impact at 1 m/s is "
        "taken up over about 20 ms."
    )
    return Table("", ("Check", "Found", "Run"), tuple(body), note)


def _add_figures(
    page: Page, folder: Path, table: Distances, terrains: Sequence[str], done: Sequence[RollingRun]
) -> None:
    ways: dict[str, dict[str, Mapping[str, np.ndarray]]] = {}
    for run in done:
        if run.drop <= 1:  # of several drops the first one is drawn
            ways.setdefault(run.ground.name, {})[run.rover.wheel.name] = read_trajectory(folder, run.name)
    grounds = {run.ground.name: run.ground.field for run in done}
    first = "" if all(run.drop == 0 for run in done) else " Of several drops the first one is drawn."
    drawn = [("distances", "Mean distance of each wheel on each terrain.", figures.distance_figure(table, terrains))]
    if ways:
        limits = (soft_wheel.NEAR, soft_wheel.FAR)
        drawn += [
            ("progress", f"Way forward over time; lines across at the study's 5 m and 8 m.{first}",
             figures.progress_figure(ways, limits)),
            ("maps", f"Ways seen from above; the grey relief is lit from the upper left.{first}",
             figures.map_figure(ways, grounds)),
        ]  # fmt: skip
    for name, caption, content in drawn:
        write_atomically(folder / "figures" / f"{name}.svg", lambda path, c=content: path.write_bytes(c))  # type: ignore[misc]
        page.shapes.append(Item(caption, data_uri(content, "svg")))


def _add_pictures(page: Page, folder: Path, done: Sequence[RollingRun]) -> None:
    """Draw each wheel on the first terrain, and one with three paddles on each; raises EngineError."""
    wheels: dict[str, RollingRun] = {}
    grounds: dict[str, RollingRun] = {}
    for run in done:
        wheels.setdefault(run.rover.wheel.name, run)
        if run.rover.wheel.paddles == 3:
            grounds.setdefault(f"{run.rover.wheel.name} on {run.ground.name}", run)
    drawn = {name: run for name, run in grounds.items() if not run.rover.wheel.curved} or grounds
    shots = [(name, run, 0.0) for name, run in wheels.items()] + [(name, run, 0.4) for name, run in drawn.items()]
    panels = parallel(lambda shot: (shot[0], _shot(folder, *shot[1:])), shots)
    for name, caption, chosen in (
        ("wheels", "The wheels, as they start.", panels[: len(wheels)]),
        ("terrains", "The terrains, each with a robot 4 s after its start.", panels[len(wheels) :]),
    ):
        if chosen:
            picture = compose(chosen, columns=min(3, len(chosen)))
            content = encode(picture)
            write_atomically(folder / "figures" / f"{name}.png", lambda path, c=content: path.write_bytes(c))  # type: ignore[misc]
            page.shapes.append(Item(caption, data_uri(encode(picture, "webp"), "webp")))


def _shot(folder: Path, run: RollingRun, moment: float) -> Picture:
    poses = read_trajectory(folder, run.name)["pose"]
    pose = poses[[round(moment * (len(poses) - 1))]]
    (picture,) = pictures(folder / MODELS / f"{run.name}.xml", pose, *_PANEL, View(1.9 if moment == 0.0 else 2.6))
    return picture


def _film(folder: Path, name: str) -> Item:
    """Return the film of a run, drawn if it is not there: a run that is done does not change."""
    path, poster = _film_file(folder, name), ""
    if not path.exists():
        poster = data_uri(encode(write_film(folder, name, path), "webp"), "webp")
    return Item(f"The run {name}, in real time.", data_uri(path.read_bytes(), "mp4"), True, poster)


def _film_file(folder: Path, name: str) -> Path:
    return folder / "figures" / f"{name}.mp4"


def write_film(folder: Path, name: str, path: Path) -> Picture:
    """Write the film of a run of a sweep's folder (H.264, MP4, real time); return its last picture.

    Raises StorageError for a run that has no trajectory, EngineError where nothing can be drawn or encoded.
    """
    way = read_trajectory(folder, name)
    every = max(1, round(1.0 / (FILM_RATE * (way["time"][1] - way["time"][0]))))
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise EngineError("the film cannot be written: imageio-ffmpeg is not installed") from error
    last = None
    writer = imageio_ffmpeg.write_frames(
        str(path), _FILM, fps=FILM_RATE, codec="libx264", pix_fmt_in="rgb24", pix_fmt_out="yuv420p",
        macro_block_size=2, ffmpeg_log_level="error", output_params=["-crf", "26", "-movflags", "+faststart"],
    )  # fmt: skip
    try:
        writer.send(None)
        for last in pictures(folder / MODELS / f"{name}.xml", way["pose"][::every], *_FILM):
            writer.send(np.ascontiguousarray(last))
        writer.close()
    except BaseException as error:
        writer.close()
        path.unlink(missing_ok=True)  # half a film would pass for a whole one
        if isinstance(error, OSError | RuntimeError):
            raise EngineError(f"the film cannot be written: {error}") from error
        raise
    assert last is not None
    return last
