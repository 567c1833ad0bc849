"""The report of the soft wheel's limb: comparison, curves, shapes of the limb and the wheel, STL files of the wheel."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

import numpy as np

from pneumorph.errors import EngineError, InputError
from pneumorph.exchange.wheel import wheel_surface, write_wheel
from pneumorph.mesh import inspect
from pneumorph.report import figures, findings, pictures
from pneumorph.report.comparison import comparison_table, write_comparison
from pneumorph.report.compose import Picture, compose, encode
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import FIELDS
from pneumorph.report.figures import Curve
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.render import Layer, Scene, check
from pneumorph.report.tables import Cell, Table
from pneumorph.report.view import View
from pneumorph.solution import Solution, Status
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.reproductions import soft_wheel_limb as limb_part
from pneumorph.studies.reproductions.soft_wheel import SYSTEM
from pneumorph.units import show

_log = logging.getLogger(__name__)

WHEELS = "wheels"
_OVER = limb_part.PRESSURE
_STRESS = next(field for field in FIELDS if field.key == "von_mises")
_SILICONE = (0.85, 0.65, 0.45)


def write_limb_report(
    folder: Path, study: limb_part.LimbStudy, solutions: Mapping[str, Solution], *, command: str = ""
) -> Path:
    """Write report.html, figures/, comparison.csv and wheels/*.stl into the folder of the part; return the page's path.

    solutions: of the cases that were run, by name. Where pictures cannot be drawn the page says why; that is no error.
    Raises InputError where no case has states, StorageError where something cannot be written.
    """
    known = {name: solution for name, solution in solutions.items() if len(solution.states)}
    if not known:
        raise InputError(f"'{folder}' holds no converged state: there is nothing to report")
    make_folder(folder / "figures")
    rows = limb_part.compare(study, known)
    write_comparison(rows, folder)
    done = [name for name in known if known[name].status is Status.DONE]
    first = next(iter(known.values()))
    page = Page(
        title=f"{SYSTEM.title}: soft limb",
        version=version("pneumorph"),
        status="done" if len(done) == len(limb_part.CASES) else "stopped",
        headline=f"{len(done)} of {len(limb_part.CASES)} cases were computed to their end.",
        message=_message(known),
        tiles=_tiles(known),
        results=_results(known),
        mesh=findings.mesh_table(first, inspect(first.model.mesh)),
        checks=_checks(known),
        versions=findings.versions_table(first, {name: version(name) for name in ("matplotlib", "pyvista", "vtk")}),
        source=SYSTEM.source,
        command=command,
        notes=list(limb_part.NOTES),
        comparison=comparison_table(rows),
        asked=[_dimensions(study)],
        shapes_head=("Shapes of limb and wheel", "Shapes of limb and wheel"),
        beside="Run folders of the cases (states, history), wheels/ (STL), comparison.csv and figures",
    )
    _add_curves(page, folder, study, known)
    _add_wheels(folder, study, known)
    try:
        check()
        _add_pictures(page, folder, study, known)
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))
    text = page.html()
    write_atomically(folder / "report.html", lambda path: path.write_text(text, encoding="utf-8"))
    return folder / "report.html"


def _message(known: Mapping[str, Solution]) -> str:
    texts = [f"{name} stopped: {solution.message}." for name, solution in known.items() if solution.message]
    if "blocked" in known:
        touch, limit = limb_part.first_touch(known["blocked"]), limb_part.uniform_until(known["blocked"])
        texts.append(
            f"With the foot held, walls touch from {show(touch, 'pressure')} on."
            if touch is not None else "With the foot held, no walls touch."
        )  # fmt: skip
        if limit is not None:
            texts.append(
                f"The chambers grow evenly (within {limb_part.UNEVEN:.0%}) up to {show(limit, 'pressure')}, "
                "the operating limit by this rule."
            )
    return " ".join(texts)


def _tiles(known: Mapping[str, Solution]) -> list[tuple[str, str]]:
    tiles = []
    if "bending" in known:
        last = known["bending"].history
        angle = show(float(last.values("tip_rotation")[-1]), "angle", 3)
        tiles.append((angle, f"at {show(float(last.values(_OVER)[-1]), 'pressure')}"))
    if "blocked" in known:
        last = known["blocked"].history
        force = show(float(last.values("blocked_force")[-1]), "force", 3)
        tiles.append((force, f"blocked, at {show(float(last.values(_OVER)[-1]), 'pressure')}"))
    seconds = sum(float(solution.meta.get("wall_time", 0.0)) for solution in known.values())
    cells = next(iter(known.values())).model.mesh.cell_count
    return [*tiles, (f"{cells:,}", "cells"), (f"{seconds:.0f} s", "wall time")]


def _results(known: Mapping[str, Solution]) -> Table:
    """Return the last state of each case."""
    body = []
    for name, solution in known.items():
        line: list[Cell | str] = [limb_part.CASES[name]]
        for key in ("tip_rotation", "peak_stress", "stress_99", "peak_stretch", "stretch_99", "chamber_spread"):
            column = solution.history.column(key)
            line.append(Cell(show(float(solution.history.values(key)[-1]), column.kind, 4), number=True))
        body.append(tuple(line))
    head = ("Case, last state", "Angle", "Largest von Mises", "99 % under", "Largest stretch", "99 % under", "Spread")
    note = "Spread of the chambers' growth: (largest - smallest) / mean of volume over volume at rest."
    return Table("", head, tuple(body), note)


def _checks(known: Mapping[str, Solution]) -> Table:
    body: list[tuple[Cell | str, ...]] = []
    for name, solution in known.items():
        history = solution.history
        error = float(np.nanmax(np.abs(history.values("energy_error"))))
        area = float(np.nanmax(history.values("contact_area:walls")))
        numbers = (f"{len(history)}", f"{int(history.values('iterations').sum())}", f"{error:.2%}")
        body.append((name, *(Cell(text, number=True) for text in (*numbers, show(area, "area", 3)))))
    head = ("Case", "States", "Iterations", "Largest error of the energy balance", "Largest contact area (half)")
    return Table("", head, tuple(body))


def _dimensions(study: limb_part.LimbStudy) -> Table:
    body = []
    for item in study.limb.dimensions():
        text = f"{item.value:g}" + (" mm" if item.kind == "length" else "")
        body.append((item.help, item.symbol, Cell(text, number=True), "given" if item.given else "assumed"))
    return Table("Limb", ("What", "Symbol", "Value", "Source"), tuple(body))


def _add_curves(page: Page, folder: Path, study: limb_part.LimbStudy, known: Mapping[str, Solution]) -> None:
    angle, force = limb_part.reported_curves(study)
    wanted = [
        ("bending", Curve("Bending, foot free", _OVER, ("tip_rotation",)), (angle,)),
        ("blocked", Curve("Blocked force, foot held", _OVER, ("blocked_force", "force_from_axle")), (force,)),
        ("bending", Curve("Stress, foot free", _OVER, ("peak_stress", "stress_99")), ()),
        ("blocked", Curve("Stress, foot held", _OVER, ("peak_stress", "stress_99")), ()),
        ("bending", Curve("Spread of the chambers, foot free", _OVER, ("chamber_spread",)), ()),
        ("blocked", Curve("Spread of the chambers, foot held", _OVER, ("chamber_spread",)), ()),
        ("blocked", Curve("Contact of the walls, foot held", _OVER, ("contact_area:walls",)), ()),
    ]  # fmt: skip
    for number, (name, curve, reported) in enumerate(wanted, start=1):
        if name not in known or len(known[name].history) < 2:
            continue
        content = figures.curve_figure(known[name].history, curve, reported)
        path = folder / "figures" / f"curve-{number}.svg"
        _write(path, content)
        page.curves.append(Item(f"{curve.title}. Each mark is a converged state.", data_uri(content, "svg")))


def _add_wheels(folder: Path, study: limb_part.LimbStudy, known: Mapping[str, Solution]) -> None:
    """Write the wheels of the granular part, as far as the run came."""
    if "bending" not in known:
        return
    make_folder(folder / WHEELS)
    reached = float(known["bending"].history.values(_OVER).max())
    for name, pressure in limb_part.WHEEL_PRESSURES.items():
        if pressure <= reached * (1.0 + 1e-9):
            write_wheel(folder / WHEELS / f"{name}.stl", known["bending"], pressure, limb=study.limb)


def _add_pictures(page: Page, folder: Path, study: limb_part.LimbStudy, known: Mapping[str, Solution]) -> None:
    for name, solution in known.items():
        numbers = np.unique(np.linspace(0, len(solution.states) - 1, 4).round().astype(int))
        states = [solution.states[i] for i in numbers]
        drawing = Drawing(states)
        if name == "bending":
            _keep(page.mesh_pictures, folder, "mesh", "Half of the limb at rest.", pictures.mesh_picture(drawing))
        if len(states) > 1:
            picture = pictures.shapes_picture(drawing, FIELDS[0], states)
            _keep(page.shapes, folder, f"shapes-{name}", f"{limb_part.CASES[name]}.", picture)
            picture = pictures.field_picture(drawing, _STRESS, states[-1])
            _keep(page.shapes, folder, f"stress-{name}", f"{limb_part.CASES[name]}, last state.", picture)
    if "bending" in known:
        reached = float(known["bending"].history.values(_OVER).max())
        pressures = [p for p in limb_part.WHEEL_PRESSURES.values() if p <= reached * (1.0 + 1e-9)]
        picture = wheel_picture(known["bending"], study, pressures)
        _keep(page.shapes, folder, "wheel", "Wheel of four limbs, without its hub, on one scale.", picture)


def _keep(items: list[Item], folder: Path, name: str, caption: str, picture: Picture) -> None:
    content = encode(picture)
    _write(folder / "figures" / f"{name}.png", content)
    items.append(Item(caption, data_uri(encode(picture, "webp"), "webp")))


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write_bytes(content))


def wheel_picture(solution: Solution, study: limb_part.LimbStudy, pressures: list[float]) -> Picture:
    """Return the wheel at pressures, MPa, side by side, seen along its axle from a little aside."""
    wheels = [wheel_surface(solution, pressure, limb=study.limb) for pressure in pressures]
    view = View((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)).turned(20.0, 15.0).fitted([points for points, _ in wheels])
    with Scene(view, pictures.height_of(view, 310_000)) as scene:
        panels = [
            (show(pressure, "pressure", 3), scene.draw([Layer(points, triangles, colour=_SILICONE)]))
            for pressure, (points, triangles) in zip(pressures, wheels, strict=True)
        ]
    return compose(panels)
