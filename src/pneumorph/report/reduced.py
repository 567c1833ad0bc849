"""The report of the reduced soft wheel: hinge laws with their error bounds, static tests, heights and a roll."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from pneumorph.report import reduced_figures as figures
from pneumorph.report.comparison import comparison_table, write_comparison
from pneumorph.report.page import Item, Page, data_uri
from pneumorph.report.tables import Cell, Table
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.solution.versions import versions
from pneumorph.studies.reduced_wheel import ALLOWED, SMALL, ReducedWheel, StaticTest, comparison, worst
from pneumorph.terrain.limb_data import LimbData
from pneumorph.terrain.limb_fit import LimbErrors
from pneumorph.units import show, to_printed

NOTES = (
    "The limb is a chain of rigid links on hinges, one a pleat. The moment at a hinge is (angle - r(p)) / c(p) with "
    "polynomials r and c of the pressure, fitted to finite-element shapes under pressure and tip forces; links do not "
    "stretch. It is not used outside the pressures and, as for its error bounds, not beyond the forces of the data.",
    "The finite-element limb: half of it, clamped at the hub, no gravity, contact between the pleats without friction, "
    "a dead force spread over the sole of the foot.",
    "Given by the study: four limbs, 500 g and 1.25 N a wheel, heights 230 mm and 280 mm, speed 2 pi rad/s, friction. "
    "Assumed: 50 g a wheel, 80 % of them in the limbs; damping of a hinge 3 ms times its stiffness, its own inertia "
    "(1 ms)^2 times that; pressures that follow within 0.1 s; limbs of a wheel do not touch each other.",
)


def write_reduced_report(folder: Path, data: LimbData, result: ReducedWheel, source: str, command: str) -> Path:
    """Write hinges.csv, static.csv, roll.csv, comparison.csv, figures/ and report.html; return the page's path.

    Raises StorageError where something cannot be written.
    """
    make_folder(folder / "figures")
    rows = comparison(result, data)
    write_comparison(rows, folder)
    _write(folder / "hinges.csv", hinges_csv(result))
    _write(folder / "static.csv", static_csv(result.tests))
    _write(folder / "roll.csv", roll_csv(result))
    bounds, held = result.fit.fitted.bounds, worst(result.tests, True)
    fitted = worst(result.tests, False)
    page = Page(
        title="Soft wheel: the reduced limb in MuJoCo",
        version=versions()["pneumorph"],
        status="done",
        headline=f"{len(result.fit.limb.hinges)} hinges fitted to {len(result.fit.fitted.data.pressures)} "
        "finite-element shapes.",
        message=_verdict(fitted, held),
        tiles=[
            (show(bounds["angle_error"], "angle", 2), "largest error of a hinge's angle"),
            (show(bounds["moment_error"], "moment", 2), "largest error of a hinge's moment"),
            *([(f"{100.0 * held.difference:+.1f} %", "largest difference, held-out forces")] if held else []),
            (f"{result.heights[0]:.0f} to {result.heights[-1]:.0f} mm", "height of the wheel"),
        ],
        results=_laws(result),
        mesh=None,
        checks=_errors(result),
        versions=Table("", ("", ""), tuple(versions().items())),
        source=source,
        command=command,
        notes=[*NOTES, f"Limb data from: {data.provenance.get('command') or 'an unnamed run'}; SHA-256 of its inputs "
               f"{data.provenance.get('sha256', 'unknown')}."],
        comparison=comparison_table(rows),
        asked=[_stands(result)],
        shapes_head=("Figures", "Figures"),
        beside="Limb data, tables and figures",
    )  # fmt: skip
    for name, caption, draw in (
        ("laws", "Moment over the angle of each hinge: law (lines), finite elements (points).", figures.laws_figure),
        ("shapes", "Reduced limb (lines), finite elements (points), in the limb's axes.", figures.shapes_figure),
        ("static", "Deflection of the tip by a force, at all pressures.", figures.static_figure),
        ("heights", "Height of the wheel over the pressure.", figures.heights_figure),
        ("roll", "A robot rolls over level ground while all pressures go up and down.", figures.roll_figure),
    ):
        content = draw(result)
        write_atomically(folder / "figures" / f"{name}.svg", lambda path, c=content: path.write_bytes(c))  # type: ignore[misc]
        page.shapes.append(Item(caption, data_uri(content, "svg")))
    _write(folder / "report.html", page.html())
    return folder / "report.html"


def hinges_csv(result: ReducedWheel) -> str:
    """Return the law of each hinge at the pressures of the heights: rest angle and stiffness."""
    limb = result.fit.limb
    head = ["pressure [kPa]"]
    head += [f"rest angle {n + 1} [deg]" for n in range(len(limb.hinges))]
    head += [f"stiffness {n + 1} [N mm/rad]" for n in range(len(limb.hinges))]
    return _csv(head, [[1e3 * p, *np.degrees(limb.rest_angles(p)), *limb.stiffness(p)] for p in result.pressures])


def static_csv(tests: Sequence[StaticTest]) -> str:
    """Return all static tests."""
    head = (
        "pressure [kPa]", "force x [N]", "force y [N]", "held out", "finite elements x [mm]", "finite elements y [mm]",
        "MuJoCo x [mm]", "MuJoCo y [mm]", "difference of sizes [-]", "size of the difference [-]",
    )  # fmt: skip
    return _csv(
        head,
        [
            [1e3 * t.pressure, *t.force, "yes" if t.held_out else "no", *t.finite_elements, *t.multibody, t.difference,
             t.apart] for t in tests
        ],
    )  # fmt: skip


def roll_csv(result: ReducedWheel) -> str:
    """Return the roll at its moments."""
    roll = result.roll
    columns = (roll.time, 1e3 * roll.pressure, *roll.centre.T, roll.height, np.degrees(roll.bending))
    head = ("time [s]", "pressure [kPa]", "x [mm]", "y [mm]", "z [mm]", "height over the ground [mm]", "bending [deg]")
    return _csv(head, list(zip(*columns, strict=True)))


def _csv(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([f"{v:.6g}" if isinstance(v, float) else v for v in row] for row in rows)
    return buffer.getvalue()


def _write(path: Path, text: str) -> None:
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def _verdict(fitted: StaticTest | None, held: StaticTest | None) -> str:
    parts = []
    for test, name in ((fitted, "fitted"), (held, "held-out")):
        if test is not None:
            within = "within" if abs(test.difference) <= ALLOWED else "beyond"
            parts.append(
                f"tip deflections under {name} forces differ by at most {abs(test.difference):.1%} ({within} "
                f"{ALLOWED:.0%}; {show(test.pressure, 'pressure')}, {np.linalg.norm(test.force):.3g} N)"
            )
    text = "; ".join(parts)
    return (
        f"MuJoCo against finite elements: {text}; deflections under {SMALL:g} mm are left out."
        if text
        else "No static test: the data has no tip forces."
    )


def _laws(result: ReducedWheel) -> Table:
    limb = result.fit.limb
    low, high = (float(result.pressures[index]) for index in (0, -1))
    body: list[tuple[Cell | str, ...]] = []
    for n in range(len(limb.hinges)):
        rest = to_printed(float(limb.rest_angles(high)[n]), "angle")
        values = (rest, limb.stiffness(low)[n], limb.stiffness(high)[n])
        body.append((str(n + 1), *(Cell(f"{v:.4g}", number=True) for v in values)))
    ends = show(low, "pressure"), show(high, "pressure")
    head = ("Hinge", f"Rest angle at {ends[1]} [deg]", *(f"Stiffness at {end} [N mm/rad]" for end in ends))
    note = "Rest angles count from the unloaded shape." + ("" if limb.monotone else " Not all grow with the pressure.")
    return Table("Law of the hinges", head, tuple(body), note)


def _errors(result: ReducedWheel) -> Table:
    kinds = (
        ("Angle of a hinge under the moments of the data", "angle_error", "angle"),
        ("Moment of a hinge at the angles of the data", "moment_error", "moment"),
        ("Place of the tip", "tip_error", "length"),
        ("Turn of the tip", "rotation_error", "angle"),
        ("Place of the tip, from links that do not stretch alone", "link_error", "length"),
    )

    def text(errors: LimbErrors | None, name: str, kind: str) -> str:
        return "–" if errors is None else show(errors.bounds[name], kind, 3)

    parts = (result.fit.fitted, result.fit.held_out)
    body = tuple((label, *(text(part, name, kind) for part in parts)) for label, name, kind in kinds)
    return Table("", ("Largest error", "Fitted cases", "Held-out cases"), body, "Reduced limb against finite elements.")


def _stands(result: ReducedWheel) -> Table:
    body = tuple(
        (
            *(Cell(f"{v:.4g}", number=True) for v in (1e3 * p, height, stand.sink, stand.overlap, stand.force)),
            "foot" if stand.on_foot else "limb",
        )
        for p, height, stand in zip(result.pressures, result.heights, result.stands, strict=True)
    )
    head = (
        "Pressure [kPa]",
        "Height [mm]",
        "Sinking [mm]",
        "Overlap with the ground [mm]",
        "Force [N]",
        "Touches with",
    )
    return Table("Wheel pressed on level ground, one limb down", head, body, "Contact without friction; MuJoCo.")
