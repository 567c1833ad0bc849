"""The report of an inverse search: what was wanted, what was found, and how far the full model is from it."""

from __future__ import annotations

import logging
from importlib.metadata import version
from pathlib import Path

from pneumorph.errors import EngineError
from pneumorph.geometry import BendingSkin
from pneumorph.report import design_figures as figures
from pneumorph.report.compose import encode
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import FIELDS
from pneumorph.report.lattice_figure import lattice_figure
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.pictures import field_picture
from pneumorph.report.tables import Cell, Table
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.design import DesignTask, TableLaw, Verified
from pneumorph.studies.design.search import FRACTIONS, Deviation, Found
from pneumorph.studies.design.skin import SkinDesign
from pneumorph.units import show

_log = logging.getLogger(__name__)

FOUND = "found.toml"


def write_design_report(
    task: DesignTask, law: TableLaw, found: Found, verified: Verified | None, folder: Path, command: str = ""
) -> Path:
    """Write report.html, figures/ and found.toml, the study of the winner, into a folder; return the page's path.

    verified: None where the full model was not run. Raises StorageError.
    """
    study = task.verification(found.design)
    make_folder(folder / "figures")
    _write(folder / FOUND, study.resolved_text().encode())
    page = Page(
        title=task.title,
        version=version("pneumorph"),
        status="done" if verified is None else verified.solution.status.value,
        headline=_headline(task, found, verified),
        message="" if verified is None else verified.solution.message,
        tiles=_tiles(task, found, verified),
        results=_found_table(found.design),
        mesh=None,
        checks=_deviations(task, found, verified),
        versions=Table("", ("", ""), _versions(task, verified)),
        command=command,
        notes=_notes(task, law),
        shapes_head=("Lines and map", "Lines, map and search"),
        beside="The study of the winner (found.toml), the table of uniform tubes, the journal of the search, the run "
        "of the full model, and figures",
        asked=[_asked(task)],
    )
    lines = {"target": task.target.at(FRACTIONS), "surrogate": found.line}
    if verified is not None:
        lines["full model"] = verified.line
    assert isinstance(study.actuator, BendingSkin)
    for name, text, content in (
        ("lines", "Centre line that is wanted and found, from the clamp at 0.",
         figures.lines_figure(lines, task.target.planar)),
        ("map", "Planar map of the skin that was found.", lattice_figure(study.actuator.tube.lattice)),
        ("search", "The search on the surrogate.", figures.convergence_figure(found.trials)),
    ):  # fmt: skip
        _write(folder / "figures" / f"{name}.svg", content)
        page.shapes.append(Item(text, data_uri(content, "svg")))
    if verified is not None:
        _add_picture(page, verified, folder)
    _write(folder / "report.html", page.html().encode())
    return folder / "report.html"


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda temporary: temporary.write_bytes(content))


def _add_picture(page: Page, verified: Verified, folder: Path) -> None:
    """Add the deformed tube; where it cannot be drawn the page says why."""
    state = verified.solution.states[-1]
    try:
        field = next(field for field in FIELDS if field.key == "stretch")
        picture = field_picture(Drawing([verified.solution.states[0], state]), field, state)
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))
        return
    _write(folder / "figures" / "shape.png", encode(picture))
    page.shapes.append(Item("The full model at the end of its run.", data_uri(encode(picture, "webp"), "webp")))


def _headline(task: DesignTask, found: Found, verified: Verified | None) -> str:
    share = f"{found.deviation.rms / task.target.length:.1%} of its length"
    text = f"On the surrogate the centre line is {show(found.deviation.rms, 'length', 3)} from the target, {share}."
    if verified is None:
        return text + " The full model was not run."
    rms = verified.deviation.rms
    return f"{text} On the full model it is {show(rms, 'length', 3)}, {rms / task.target.length:.1%}."


def _tiles(task: DesignTask, found: Found, verified: Verified | None) -> list[tuple[str, str]]:
    tiles = [
        (show(found.design.pressure, "pressure", 3), "pressure"), (str(len(found.design.parts)), "segments"),
        (show(found.deviation.rms, "length", 3), "from the target, surrogate"),
    ]  # fmt: skip
    if verified is not None:
        tiles.append((show(verified.deviation.rms, "length", 3), "from the target, full model"))
    return [*tiles, (show(task.target.length, "length"), "length of the target")]


def _found_table(design: SkinDesign) -> Table:
    rows = tuple(
        (
            Cell(str(number), number=True), Cell(str(part.rows), number=True), Cell(f"{part.cg:.3g}", number=True),
            Cell(f"{part.reentrant} of {design.around}", number=True),
            Cell(f"{180.0 * part.middle / design.around:g}", number=True),
        )
        for number, part in enumerate(design.parts, 1)
    )  # fmt: skip
    head = ("Segment", "Cells along", "cg", "Re-entrant columns", "Their middle, around [deg]")
    note = "Segments from the clamp on; the seam of the map is at 0 degrees, the x axis of the figure of lines."
    return Table(f"Design found, at {show(design.pressure, 'pressure')}", head, rows, note)


def _deviations(task: DesignTask, found: Found, verified: Verified | None) -> Table:
    def row(what: str, deviation: Deviation) -> tuple[Cell | str, ...]:
        numbers = []
        for value in (deviation.rms, deviation.largest):
            numbers += [
                Cell(show(value, "length", 3), number=True),
                Cell(f"{value / task.target.length:.2%}", number=True),
            ]
        return (what, *numbers)

    rows = [row("Surrogate", found.deviation)]
    if verified is not None:
        history = verified.solution.history
        rows.append(row("Full model, at the end", verified.deviation))
        pressure = history.values("pressure:cavity")[history.values("index") == verified.nearest][0]
        rows.append(row(f"Full model, nearest on the way: at {show(float(pressure), 'pressure')}", verified.least))
    head = (
        "Distance of the centre line from the target",
        "Root mean square",
        "of its length",
        "Largest",
        "of its length",
    )
    return Table("", head, tuple(rows), "At equal fractions of the lengths of both lines, both from the clamp on.")


def _asked(task: DesignTask) -> Table:
    s = task.file.search
    target = task.target
    rows = [
        ("target", f"{target.name}, {show(target.length, 'length')}, {'plane' if target.planar else 'space'} curve"),
        ("segments", str(s.segments)), ("cells along", ", ".join(map(str, s.cells_along))),
        ("cells around", ", ".join(map(str, s.cells_around))),
        ("share of re-entrant columns", ", ".join(map(str, s.reentrant))), ("cg", ", ".join(map(str, s.cg))),
        ("pressure", " to ".join(show(p, "pressure") for p in s.pressure)), ("trials", str(s.trials)),
        ("uniform tubes", f"{s.model} model"), ("sampler", task.sampler), ("seed", str(s.seed)),
    ]  # fmt: skip
    return Table("", ("", ""), tuple(rows))


def _notes(task: DesignTask, law: TableLaw) -> list[str]:
    count = len(task.table.designs)
    notes = [
        f"Surrogate: a rod of pieces with constant curvature and stretch, interpolated in {count} runs of uniform "
        f"tubes ({task.file.search.model} model), straight over {show(law.end, 'length', 2)} at either end. It does "
        "not know how neighbouring segments hinder each other.",
    ]
    if float(law.pressure[-1]) < task.file.search.pressure[1] - 1e-12:
        notes.append(
            f"The runs of the table reached {show(float(law.pressure[-1]), 'pressure')}: searched up to there."
        )
    return notes


def _versions(task: DesignTask, verified: Verified | None) -> tuple[tuple[str, str], ...]:
    found = {} if verified is None else verified.solution.meta.get("versions", {})
    return tuple((name, str(text)) for name, text in {**found, "optuna": version("optuna")}.items())
