"""System 1: the hexagonal-prism actuator of Wang et al. 2022, bent by two neighbouring cavities at one pressure."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pneumorph.closed_form import hexagonal_prism as published
from pneumorph.errors import InputError
from pneumorph.geometry import HexagonalPrism
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, ReportedCurve
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show, to_printed

_CAVITIES = ("cavity_1", "cavity_2", "cavity_6")  # of the half
DRIVEN = ("cavity_2",)  # of the half; cavity_3, its mirror image, has the same pressure
COMPARED = tuple(pressure for pressure, _ in published.REPORTED_BENDING)  # MPa
QUICK_END, END = COMPARED[1], COMPARED[-1]
TOUCH = 0.2  # MPa at which neighbouring chamber walls touch in the experiment
WALLS, INSIDES = "walls", "insides"
_PLATE = 4.0  # mm, the plate at the free end
_REACH = 0.2  # mm, a tenth of the gaps: a softer contact takes fewer iterations
_STIFFNESS = 1.0  # MPa, as blocks on the inside of the bend press on each other with more than that
_FRICTION = 0.7  # of silicone on itself: without it blocks slip past each other, and branches are many
_CREEP = 0.01  # mm a kPa of pressure
# no silicone snaps in no time: its overstress leads from one state to the next where blocks buckle
_PACE = 5000.0  # s / MPa
_VISCOSITY = {"g": [0.9], "tau": ["0.3 s"]}  # assumed; a slow ramp lags by 9 x 0.3 s, 0.5 kPa
IMAGE = "image"
# walls meet those of the other half in the plane of the cut; it has to lie behind it by the reach, because rows touch
# it at rest in the edge of the hexagon
_BEHIND = 1.05 * _REACH
ANGLES = ("chord_angle", "tip_rotation")

_TABLE = "Table 2, finite elements"
_MEASURED = "eq. 13, polynomial through the experiment"
_CLOSED_FORM = "eqs. 1-12, closed form as printed"
_MEANING = {"chord_angle": "line from the clamped to the free end", "tip_rotation": "normal of the free end face"}
_AGREES = {
    "chord_angle": "the angle that Table 2 is nearest to",
    "tip_rotation": "about twice the chord angle, so not what Table 2 lists",
}
_CAUTION = "as printed, the formula gives a pressure that grows like the angle squared: it is no check of the run"


def study(quick: bool) -> Study:
    """Return the study: two neighbouring cavities to 280 kPa, or quickly to 80 kPa; all outer walls may touch.

    One half, cut between the two cavities, in hexahedra from wall to wall.
    """
    end = QUICK_END if quick else END
    stops = [show(p, "pressure") for p in COMPARED if p < end]
    barrier = {"reach": show(_REACH, "length"), "stiffness": show(_STIFFNESS, "stress")}
    creep = f"{1e3 * _CREEP / _PACE:g} mm/s"
    table = {
        "title": "Hexagonal-prism actuator, bending by two neighbouring cavities",
        "actuator": {
            "template": "hexagonal-prism",
            "half": True,
            "end_wall": show(_end_wall(), "length"),
            "end_plate": show(_PLATE, "length"),
        },
        "material": {
            "body": {"name": "shore-a45-platinum", "prony": _VISCOSITY},
            # next to silicone of 0.22 MPa as good as rigid
            "plate": {"law": "neo-hookean", "mu": "10 MPa", "bulk": "500 MPa"},
        },
        "mesh": {"hexahedra": True},
        "cavity": [{"name": name} for name in DRIVEN],
        "body": {IMAGE: {"shape": "half-space", "point": [show(-_BEHIND, "length"), "0 mm", "0 mm"], "normal": "x"}},
        "contact": [
            {"name": WALLS, "faces": ["outer", "core"], "friction": _FRICTION, "creep": creep} | barrier,
            {"name": INSIDES, "faces": list(_CAVITIES), "friction": _FRICTION, "creep": creep} | barrier,
            {"name": IMAGE, "faces": ["outer"], "body": IMAGE} | barrier,
        ],
        "phase": [
            {
                "name": "bend",
                "targets": dict.fromkeys(DRIVEN, show(end, "pressure")),
                "states_at": {DRIVEN[0]: stops},
                # contact is sought step by step: larger ones do not converge where rows of walls meet at once,
                # and one that fails is cut to half of it before it slides viscously
                "first_increment": 0.005 / end,
                "largest_increment": 0.01 / end,
                "duration": show(_PACE * end, "time"),
            }
        ],
        "solver": {"tolerance": 1e-3},  # looser ones leave the free end centimetres from where it belongs
    }
    return study_from(table, "hexagonal-prism")


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return reported and computed angles at all pressures of Table 2, against each of the study's three sources.

    And the pressure at which walls begin to touch.
    """
    rows = []
    for name in ANGLES:
        for source, reported, note in _sources(study):
            for pressure in COMPARED:
                computed = _at(solution, name, pressure)
                missing = [] if computed is not None else [f"not reached: the run ended at {_reached(solution)}"]
                agrees = [_AGREES[name]] if source == _TABLE else []
                rows.append(
                    Comparison(
                        quantity=f"{name} ({source})",
                        condition=show(pressure, "pressure"),
                        reported=math.degrees(reported(pressure)),
                        computed=None if computed is None else math.degrees(computed),
                        unit="deg",
                        note="; ".join([*missing, _MEANING[name], *agrees, *note]),
                    )
                )
    touching = solution.history.values(f"pressure:{DRIVEN[0]}")[solution.history.values(f"contact_area:{WALLS}") > 0.0]
    first = to_printed(float(touching[0]), "pressure") if len(touching) else None
    rows.append(
        Comparison(
            "pressure at which walls touch", "", to_printed(TOUCH, "pressure"), first, "kPa",
            f"first state with walls within reach, {_REACH:g} mm; reported for the experiment",
        )
    )  # fmt: skip
    return tuple(rows)


def curves(study: Study) -> tuple[ReportedCurve, ...]:
    """Return the study's table, its polynomial and its closed form as chord angle over pressure."""
    column = (f"pressure:{DRIVEN[0]}", "chord_angle")
    table = np.array(published.REPORTED_BENDING)
    pressure = np.linspace(0.0, COMPARED[-1], 81)
    angle = np.linspace(0.0, published.prism_bending_angle(_actuator(study), study.materials["body"], 0.10), 41)
    printed = published.prism_pressure(_actuator(study), study.materials["body"], angle)
    shown = table[:, 0] <= pressure[-1] + 1e-9
    return (
        ReportedCurve(_TABLE, *column, table[shown, 0], table[shown, 1], marks=True),
        ReportedCurve(_MEASURED, *column, pressure, published.measured_bending_angle(pressure)),
        ReportedCurve(_CLOSED_FORM, *column, printed, angle),
    )


def _end_wall() -> float:
    """Return the end walls, mm, of rows as long as the column: by the study's rule only expansion walls are thin."""
    row = HexagonalPrism()
    return row.end_wall + 0.5 * (row.length - row.assembly_length)


def _actuator(study: Study) -> HexagonalPrism:
    if not isinstance(study.actuator, HexagonalPrism):
        raise InputError(f"expected a study of a hexagonal prism, received a {type(study.actuator).__name__}")
    return study.actuator


def _sources(study: Study) -> list[tuple[str, Callable[[float], float], list[str]]]:
    """Return (source, angle in rad over pressure in MPa, notes) for the three kinds of reported data."""
    table = {round(p, 9): angle for p, angle in published.REPORTED_BENDING}
    actuator, material = _actuator(study), study.materials["body"]
    return [
        (_TABLE, lambda p: table[round(p, 9)], []),
        (_MEASURED, lambda p: float(published.measured_bending_angle(p)), ["the fit gives 1.2 deg at no pressure"]),
        (_CLOSED_FORM, lambda p: published.prism_bending_angle(actuator, material, p), [_CAUTION]),
    ]


def _at(solution: Solution, column: str, pressure: float) -> float | None:
    """Return a column where the pressure is the given one, None where the run has no such state."""
    found = np.isclose(solution.history.values(f"pressure:{DRIVEN[0]}"), pressure, rtol=1e-9, atol=0.0)
    return float(solution.history.values(column)[found][-1]) if found.any() else None


def _reached(solution: Solution) -> str:
    return show(float(solution.history.values(f"pressure:{DRIVEN[0]}").max()), "pressure")


register(
    Reproduction(
        name="hexagonal-prism",
        title="Hexagonal-prism bending actuator (system 1)",
        source="Wang, Zhang, Zhang, Zhao, Peng, Actuators 2022, 11, 125, doi 10.3390/act11050125",
        study=study,
        compare=compare,
        curves=curves,
        notes=(
            "Given by the study (Table 1): side, length, core radius, chambers and their inner dimensions, expansion "
            "wall 2 mm. Assumed: gap 2 mm, top and side walls 3 mm, airway 3 x 3 mm with a roof and sides of 1.5 mm, "
            "and a stiff plate of 4 mm in the free end, as modules of the robot are joined by: without it the last "
            "chambers roll the end of the open core in from 140 kPa on.",
            "One half is modelled, cut between the two driven cavities, in hexahedra with one cell through each wall. "
            "Walls of the two rows on either side of the cut meet in its plane, to 0.2 mm.",
            "All walls may touch, outside and inside, with friction 0.7 (assumed). Here neighbouring chamber walls, "
            "2 mm apart at rest (assumed; the given length leaves 2.4 mm at most), touch below 20 kPa: walls of "
            "14 x 19 x 2 mm bulge by a millimetre then. The study sees contact, which resists bending, from 200 kPa. "
            "Walls that touch push each other apart, and the body bends further; without contact it is near Table 2 at "
            "40 and 80 kPa.",
            "Pressure rises by 1 kPa in 5 s, and the silicone's overstress relaxes in 0.3 s (both assumed), so that "
            "blocks which buckle move to their next place within a few increments. A slow ramp lags by 0.5 kPa.",
            "The study's 'bending angle' is not defined in its text. Its Table 2 is nearest to the chord angle (line "
            "from the clamped to the free end); the rotation of the free end face is about twice as large.",
            "The closed form is evaluated as printed and does not follow the study's own near-linear curve.",
        ),
        parts={
            "bending": "hexagonal-prism",
            "expansion": "hexagonal-prism-expansion",
            "anchoring": "hexagonal-prism-anchoring",
            "moment": "hexagonal-prism-moment",
            "earthworm": "hexagonal-prism-earthworm",
            "inchworm": "hexagonal-prism-inchworm",
        },
    )
)
