"""The report of the programmed shapes: findings, angles and stresses beside the reported ranges, pictures and maps."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from pneumorph.errors import EngineError, InputError
from pneumorph.report.comparison import write_comparison
from pneumorph.report.compose import encode
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import FIELDS
from pneumorph.report.findings import versions_table
from pneumorph.report.lattice_figure import lattice_figure
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.pictures import shapes_picture
from pneumorph.report.render import check
from pneumorph.report.skins import findings_table
from pneumorph.report.tables import Cell, Table
from pneumorph.solution import Solution, Status
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.reproductions import auxetic_shapes as shapes
from pneumorph.studies.reproductions.auxetic_skin import SYSTEM
from pneumorph.studies.reproductions.soft_wheel import Finding
from pneumorph.units import show

_log = logging.getLogger(__name__)
_STRETCH = next(field for field in FIELDS if field.key == "stretch")
_PANELS = 4  # states of a shape side by side


def write_shapes_report(
    folder: Path,
    study: shapes.ShapesStudy,
    solutions: Mapping[str, Solution],
    found: Sequence[Finding],
    command: str = "",
) -> Path:
    """Write report.html, comparison.csv and figures/ into the folder of the part; return the path of the page.

    solutions: of the runs that there are, by name; found: `shape_findings` of them. Where pictures cannot be drawn the
    page says why; that is no error. Raises InputError where no run has a state, StorageError.
    """
    known = {name: solution for name, solution in solutions.items() if len(solution.states)}
    if not known:
        raise InputError(f"'{folder}' holds no converged state: there is nothing to report")
    make_folder(folder / "figures")
    write_comparison([item.row for item in found], folder)
    done = [name for name in known if known[name].status is Status.DONE]
    held = sum(item.holds is True for item in found)
    told = sum(item.holds is not None for item in found)
    page = Page(
        title=f"{SYSTEM.title}: programmed shapes",
        version=version("pneumorph"),
        status="done" if len(done) == len(study.runs) else "stopped",
        headline=f"{len(done)} of {len(study.runs)} runs reached the reported pressure. {held} of {len(found)} "
        f"statements of the study hold here, {told - held} do not, {len(found) - told} were not computed.",
        message=" ".join(f"{name} stopped: {s.message}." for name, s in known.items() if s.message),
        tiles=[(f"{held} of {len(found)}", "statements hold"), (str(len(done)), "runs at their pressure")],
        results=_results(study, known),
        mesh=None,
        checks=_checks(known),
        versions=versions_table(
            next(iter(known.values())), {name: version(name) for name in ("matplotlib", "pyvista")}
        ),
        source=SYSTEM.source,
        command=command,
        notes=list(shapes.NOTES),
        comparison=findings_table(found),
        shapes_head=("Shapes and maps", "Shapes and maps"),
        beside="Run folders of the shapes (study, states, history), comparison.csv and figures",
    )
    _add_pictures(page, folder, study, known)
    for shape in study.runs:
        content = lattice_figure(shapes.tube_of(shape).tube.lattice)
        _write(folder / "figures" / f"map-{shape.name}.svg", content)
        page.shapes.append(Item(f"{shape.title}: planar map.", data_uri(content, "svg")))
    _write(folder / "report.html", page.html().encode())
    return folder / "report.html"


def shape_picture(solution: Solution) -> bytes:
    """Return the picture of a shape at rest and at three pressures up to its last, as PNG. Raises EngineError."""
    return encode(shapes_picture(Drawing(_shown(solution)), _STRETCH, _shown(solution)))


def _shown(solution: Solution) -> list:
    """Return the first state, the last one, and those between that are nearest to equal parts of its pressure."""
    pressure = solution.history.values("pressure:cavity")
    wanted = [pressure[-1] * i / (_PANELS - 1) for i in range(_PANELS)]
    places = sorted({int(abs(pressure - value).argmin()) for value in wanted})
    return [solution.states[place] for place in places]


def _add_pictures(page: Page, folder: Path, study: shapes.ShapesStudy, known: Mapping[str, Solution]) -> None:
    try:
        check()
        for shape in study.runs:
            if shape.name in known:
                content = shape_picture(known[shape.name])
                _write(folder / "figures" / f"{shape.name}.png", content)
                page.shapes.append(Item(f"{shape.title}.", data_uri(content, "png")))
    except EngineError as error:
        _log.warning("%s", error)
        page.missing.append(str(error))


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda temporary: temporary.write_bytes(content))


def _results(study: shapes.ShapesStudy, known: Mapping[str, Solution]) -> Table:
    head = ("Shape", "Pressure", "Tip rotation", "Chord angle", "Largest diameter",
            *(f"Largest principal stress, {domain}" for domain in shapes.STRESSES))  # fmt: skip
    keys = ("pressure:cavity", "tip_rotation", "chord_angle", "largest_diameter",
            *(f"peak_principal_stress:{domain}" for domain in shapes.STRESSES))  # fmt: skip
    rows: list[tuple[Cell | str, ...]] = []
    for shape in study.shapes:
        solution = known.get(study.run_of(shape).name)
        if solution is None:
            rows.append((shape.title, *(Cell("–", number=True) for _ in keys)))
            continue
        history = solution.history
        cells = [Cell(show(float(history.values(k)[-1]), history.column(k).kind, 3), number=True) for k in keys]
        rows.append((shape.title, *cells))
    ranges = ", ".join(f"{low:g} to {high:g} MPa in the {domain}" for domain, (low, high) in shapes.STRESSES.items())
    return Table("Last states", head, tuple(rows), f"Reported: largest principal stresses of {ranges}.")


def _checks(known: Mapping[str, Solution]) -> Table:
    rows = []
    for name, solution in known.items():
        least = solution.history.smallest("smallest_volume_ratio")
        rows.append(
            (
                name, Cell(solution.status.value, "good" if solution.status is Status.DONE else "fair"),
                Cell(str(len(solution.states)), number=True),
                Cell("–" if least is None else f"{least:.3g}", number=True),
            )
        )  # fmt: skip
    return Table("", ("Run", "Ended", "States", "Smallest det F"), tuple(rows))
