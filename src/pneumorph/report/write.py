"""From a solution to its report: the page, the figures and the comparison in the run's folder."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

from pneumorph.errors import EngineError, InputError
from pneumorph.mechanics import State
from pneumorph.mesh import inspect
from pneumorph.report import figures, findings, gait_figures
from pneumorph.report.asked import asked_tables
from pneumorph.report.comparison import comparison_table, read_comparison, write_comparison
from pneumorph.report.curves import default_curves
from pneumorph.report.figures import Curve
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.tables import Table
from pneumorph.solution import Solution, Status
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.comparison import Comparison, Profile, ReportedCurve

_log = logging.getLogger(__name__)
_MOST_STATES = 40  # that pictures and the animation read
_MOST_SHAPES = 9  # of a gait, side by side
_FILM = 20_000  # triangles of the surface in the small pictures of the animation


def write_report(
    solution: Solution,
    folder: Path | str | None = None,
    *,
    title: str | None = None,
    source: str = "",
    command: str = "",
    asked: Sequence[Table] | None = None,
    curves: Sequence[Curve] | None = None,
    reported: Sequence[ReportedCurve] = (),
    comparison: Sequence[Comparison] | None = None,
    profiles: Sequence[Profile] = (),
    notes: Sequence[str] = (),
) -> Path:
    """Write report.html, figures/ and, with rows to compare, comparison.csv into a folder; return the page's path.

    folder:     by default that of the solution. The run itself is only read, so that a report can be written anew.
    title, source, command: heading, where the data are from, how to repeat the run; by default what the run keeps.
    asked:      tables of what was asked; by default from model, programme and stored study.
    curves:     figures of the history; by default measures over pressure, and pressure over volume.
    reported:   curves to compare with, drawn into the figures of the same columns; those that no figure has get one.
    comparison: rows for comparison.csv; by default those of the comparison.csv that is there.
    profiles:   further figures at the head of the curves; their numbers are kept beside them as CSV.
    notes:      sentences at the head of 'What was asked'.

    Where pictures cannot be drawn the page says so and why; that is no error. Raises InputError without a folder or
    without states, NameNotFoundError for a column that the history does not have, StorageError where nothing can be
    written.
    """
    place = Path(folder) if folder is not None else solution.folder
    if place is None:
        raise InputError("the report needs a folder: the solution has none of its own")
    if len(solution.states) == 0:
        raise InputError(f"'{place}' holds no converged state: there is nothing to report")
    make_folder(place / "figures")
    if comparison is None:
        comparison = read_comparison(place)
    elif comparison:
        write_comparison(comparison, place)
    quality = inspect(solution.model.mesh)
    marked = findings.marked_rows(solution)
    everything = list(range(len(solution.history)))
    last = solution.states[-1]
    page = Page(
        title=title or str(solution.about.get("title") or place.name),
        version=_version("pneumorph"),
        status=solution.status.value,
        headline=_headline(solution),
        message=solution.message,
        tiles=_tiles(solution),
        results=findings.results_table(solution, marked, "At the marks and the ends of the phases"),
        mesh=findings.mesh_table(solution, quality),
        checks=findings.checks_table(solution, quality),
        versions=findings.versions_table(solution, {n: _version(n) for n in ("matplotlib", "pyvista", "vtk")}),
        all_states=findings.results_table(solution, everything, "") if len(everything) > len(marked) else None,
        source=source or str(solution.about.get("source", "")),
        command=command or str(solution.about.get("command", "")),
        notes=[*notes, *map(str, solution.about.get("notes", ()))],
        warnings=list(quality.warnings),
        asked=list(asked) if asked is not None else asked_tables(solution),
        comparison=comparison_table(comparison) if comparison else None,
        stress=findings.stress_table(last) if last.index > 0 else None,
    )
    keep = _Keeper(place / "figures")
    _add_figures(page, keep, solution, curves, reported)
    _add_gait(page, keep, solution)
    page.curves[:0] = [keep.svg(p.name, f"{p.title}.", figures.profile_figure(p), p.to_csv()) for p in profiles]
    try:
        _add_pictures(page, keep, solution, marked)
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))
    text = page.html()
    write_atomically(place / "report.html", lambda path: path.write_text(text, encoding="utf-8") and None)
    return place / "report.html"


class _Keeper:
    """Writes figures into a folder and gives them back for the page."""

    def __init__(self, folder: Path):
        self.folder = folder

    def svg(self, name: str, caption: str, content: bytes, table: str = "") -> Item:
        """Keep a curve, and a table of its numbers, if any, as CSV."""
        if table:
            numbers = table.encode("utf-8")
            write_atomically(self.folder / f"{name}.csv", lambda path: path.write_bytes(numbers) and None)
        write_atomically(self.folder / f"{name}.svg", lambda path: path.write_bytes(content) and None)
        return Item(caption, data_uri(content, "svg"))

    def picture(self, name: str, caption: str, picture: np.ndarray) -> Item:
        """Keep a picture as PNG; the page gets a smaller form of it."""
        from pneumorph.report.compose import encode

        content = encode(picture)
        write_atomically(self.folder / f"{name}.png", lambda path: path.write_bytes(content) and None)
        return Item(caption, data_uri(encode(picture, "webp"), "webp"))


def _add_figures(
    page: Page, keep: _Keeper, solution: Solution, curves: Sequence[Curve] | None, reported: Sequence[ReportedCurve]
) -> None:
    history = solution.history
    chosen = list(curves) if curves is not None else default_curves(solution)
    if curves is None and gait_figures.cycle_ends(solution):
        own = gait_figures.gait_curves(solution)
        chosen = own + [curve for curve in chosen if (curve.x, curve.y) not in [(one.x, one.y) for one in own]]
    for other in reported:
        if not any(other.x == curve.x and other.y in curve.y for curve in chosen):
            chosen.insert(0, Curve(history.column(other.y).label.capitalize(), other.x, (other.y,)))
    for number, curve in enumerate(chosen):
        others = [other for other in reported if other.x == curve.x and other.y in curve.y]
        name = (
            f"curve-{number + 1}-" + "-".join("".join(c if c.isalnum() else "_" for c in key) for key in curve.y)[:60]
        )
        caption = f"{curve.title}: {', '.join(history.column(key).label for key in curve.y)}"
        caption += f" over {history.column(curve.x).label}. Each mark is a converged state."
        page.curves.append(keep.svg(name, caption, figures.curve_figure(history, curve, others)))
    if len(history) < 2:
        return
    checks: list[tuple[str, str, Callable[..., bytes]]] = [
        ("energy", "Work done on the body against the energy it stores or loses.", figures.energy_figure),
        ("convergence", "Newton iterations and size of each increment.", figures.convergence_figure),
        ("stability", "Unstable modes at fixed targets, and the smallest volume ratio.", figures.stability_figure),
    ]
    page.check_figures += [keep.svg(name, caption, draw(history)) for name, caption, draw in checks]


def _add_gait(page: Page, keep: _Keeper, solution: Solution) -> None:
    """Add table and schedule of a run that repeats a cycle."""
    if not gait_figures.cycle_ends(solution):
        return
    page.cycles = gait_figures.gait_table(solution)
    driven = {name for phase in solution.programme.phases for name in phase.targets}
    cavities = [name for name, supply in solution.model.supplies.items() if name in driven and supply.sets_pressure]
    if cavities:
        caption = "The gauge pressure that each cavity is given through the programme."
        page.curves.insert(0, keep.svg("schedule", caption, gait_figures.schedule_figure(solution.programme, cavities)))


def _add_pictures(page: Page, keep: _Keeper, solution: Solution, marked: Sequence[int]) -> None:
    """Draw the mesh, the shapes and the animation; raises EngineError where that is impossible."""
    from pneumorph.report import animation, pictures
    from pneumorph.report.drawing import Drawing
    from pneumorph.report.fields import CONTACT_PRESSURE, FIELDS
    from pneumorph.report.part_pictures import part_pictures, touched_most
    from pneumorph.report.render import check

    check()
    states = _chosen(solution, marked)
    drawing = Drawing(states)
    caption = "The mesh at rest, its named faces in colours"
    caption += "." if drawing.flat else ": from outside, seen through, and cut through a cavity."
    page.mesh_pictures.append(keep.picture("mesh", caption, pictures.mesh_picture(drawing)))
    if len(states) < 2:
        return
    last = states[-1]
    rest = "The thin grey outline is the body at rest."
    shown = [states[i] for i in np.unique(np.linspace(0, len(states) - 1, 4).round().astype(int))]
    if gait_figures.cycle_ends(solution):  # a body that walks is back where it was after each cycle
        shown = [solution.states[row] for row in marked[:_MOST_SHAPES]]
    page.shapes.append(
        keep.picture("shapes", f"Shapes on one scale. {rest}", pictures.shapes_picture(drawing, FIELDS[0], shown))
    )
    for field in FIELDS:
        text = f"{field.label} in state {last.index}, at {pictures.caption(last)}. {rest}"
        page.shapes.append(keep.picture(field.key, text, pictures.field_picture(drawing, field, last)))
    if (touched := touched_most(solution)) is not None:
        text = f"{CONTACT_PRESSURE.label} in state {touched.index}, at {pictures.caption(touched)}: the run's largest."
        page.shapes.append(
            keep.picture("contact-pressure", text, pictures.field_picture(drawing, CONTACT_PRESSURE, touched))
        )
    page.shapes += [keep.picture(*item) for item in part_pictures(solution)]
    film = keep.folder / "animation.mp4"
    try:
        poster = animation.write_animation(Drawing(states, _FILM), FIELDS[2], states, film)
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))
        return
    text = (
        "The run as a film, coloured by the largest principal stretch; between the computed states it is interpolated."
    )
    page.films.append(Item(text, data_uri(film.read_bytes(), "mp4"), True, poster))


def _chosen(solution: Solution, marked: Sequence[int]) -> list[State]:
    """Return the states that are drawn: all, or an even choice of many that has those at the marks."""
    count = len(solution.states)
    numbers = set(np.linspace(0, count - 1, min(count, _MOST_STATES)).round().astype(int).tolist())
    return [solution.states[i] for i in sorted(numbers | {row for row in marked if row < count})]


def _headline(solution: Solution) -> str:
    if solution.status is Status.DONE:
        return "Done: the programme was computed to its end."
    reached = float(solution.history.values("time")[-1])
    phases = solution.programme.phases
    phase = phases[min(int(reached), len(phases) - 1)]
    part = 100.0 * (reached - min(int(reached), len(phases) - 1))
    where = f"after {part:.3g} % of phase '{phase.name}' ({min(int(reached) + 1, len(phases))} of {len(phases)})"
    if solution.status is Status.STOPPED:
        return f"Stopped before the target, {where}. Every state up to there is kept."
    return f"Not finished: the run stands {where}. Resume it to go on."


def _tiles(solution: Solution) -> list[tuple[str, str]]:
    history, meta = solution.history, solution.meta
    tiles = [
        (f"{len(solution.states)}", "converged states"),
        (f"{int(meta.get('iterations', 0))}", "Newton iterations"),
    ]
    tiles.append((f"{solution.model.mesh.cell_count:,}", "cells"))
    if "wall_time" in meta:
        tiles.append((_duration(float(meta["wall_time"])), "wall time"))
    tiles.append((f"{abs(float(history.values('energy_error')[-1])):.2%}", "energy balance error"))
    return tiles


def _duration(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.1f} s"
    return f"{seconds / 60.0:.1f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
