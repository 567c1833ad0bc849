"""System 1, part expansion: the prism with all six cavities at one pressure, free: its circumscribed diameter."""

from __future__ import annotations

from typing import Any

import numpy as np

from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, ReportedCurve
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show, to_printed

NAME = "hexagonal-prism-expansion"
SOURCE = "Wang, Zhang, Zhang, Zhao, Peng, Actuators 2022, 11, 125, doi 10.3390/act11050125"
DIAMETER, PRESSURE = 84.0, 0.150  # mm, MPa: reported, and the bore of the test pipe
# from 110 kPa on a row of eleven chambers, which push each other apart, buckles; three do not
END, QUICK_END = 0.100, PRESSURE
COLUMN = "circumscribed_diameter"
# the cavities that an eighth of the prism has, which stand for all six
DRIVEN = ("cavity_1", "cavity_2")
SHORT = {"chambers": 3, "length": "32 mm"}
WALLS = {"name": "walls", "faces": ["outer"], "reach": "0.2 mm"}

ASSUMED = (
    "Given by the study (Table 1): side, length, core radius, chambers and their inner dimensions, expansion wall "
    "2 mm. Assumed: gap 2 mm, top and side walls 3 mm.",
    "An eighth of the prism is solved, with three planes of symmetry; chambers of a row share one pressure without "
    "airways and bridges between them.",
)


def prism_table(title: str, end: float, quick: bool, measures: list[str], **sections: Any) -> dict[str, Any]:
    """Return a study of an eighth of the prism with all cavities driven to a pressure, MPa, as plain data.

    quick: three chambers a row in place of eleven, on the coarse mesh.
    """
    steps = {"first_increment": min(1.0, 0.004 / end), "largest_increment": min(1.0, 0.010 / end)}
    return {
        "title": title,
        "measures": measures,
        "actuator": {"template": "pipe-robot", "modules": 1, "eighth": True, **(SHORT if quick else {})},
        "mesh": {"size": "coarse" if quick else "automatic"},
        "support": mirrors("xyz"),
        "phase": [{"name": "expand", "targets": dict.fromkeys(DRIVEN, show(end, "pressure")), **steps}],
        **sections,
    }


def mirrors(axes: str) -> list[dict[str, str]]:
    """Return symmetry in the cut faces as the only supports: left out, the face "clamp" would be held, too."""
    return [{"type": "symmetry", "face": f"symmetry_{axis}"} for axis in axes]


def study(quick: bool) -> Study:
    """Return the study: to 100 kPa, quickly to 150 kPa of a shorter prism; all outer walls may touch."""
    title = "Hexagonal-prism actuator, radial expansion by all six cavities"
    table = prism_table(title, QUICK_END if quick else END, quick, [COLUMN], contact=[WALLS])
    return study_from(table, NAME)


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return the diameter at the reported pressure, the pressure at the reported diameter, and where walls touch."""
    pressure = solution.history.values(f"pressure:{DRIVEN[0]}")
    diameter = solution.history.values(COLUMN)
    reached = pressure[-1] >= PRESSURE * (1.0 - 1e-9)
    touching = pressure[solution.history.values("contact_area:walls") > 0.0]
    return (
        Comparison(
            "circumscribed diameter", show(PRESSURE, "pressure"), DIAMETER,
            float(np.interp(PRESSURE, pressure, diameter)) if reached else None, "mm",
            "reported for the experiment" if reached else f"the run ends at {show(float(pressure[-1]), 'pressure')}",
        ),
        Comparison(
            "pressure at which the diameter is reached", show(DIAMETER, "length"), to_printed(PRESSURE, "pressure"),
            printed(crossing(pressure, diameter, DIAMETER)), "kPa", "reported for the experiment",
        ),
        Comparison(
            "pressure at which walls touch", "", 200.0,
            printed(float(touching[0])) if len(touching) else None, "kPa",
            "first state with walls within reach, 0.2 mm; reported for bending",
        ),
    )  # fmt: skip


def curves(study: Study) -> tuple[ReportedCurve, ...]:
    """Return the reported point of the diameter over the pressure."""
    column = (f"pressure:{DRIVEN[0]}", COLUMN)
    return (ReportedCurve("experiment", *column, np.array([PRESSURE]), np.array([DIAMETER]), marks=True),)


def crossing(pressure: np.ndarray, values: np.ndarray, wanted: float) -> float | None:
    """Return the first pressure at which values reach the wanted one, between states on a line; None if they do not."""
    reached = np.flatnonzero(values >= wanted)
    if not len(reached):
        return None
    i = int(reached[0])
    if i == 0:
        return float(pressure[0])
    share = (wanted - values[i - 1]) / (values[i] - values[i - 1])
    return float(pressure[i - 1] + share * (pressure[i] - pressure[i - 1]))


def printed(pressure: float | None) -> float | None:
    """Return a pressure in kPa."""
    return None if pressure is None else float(to_printed(pressure, "pressure"))


register(
    Reproduction(
        name=NAME,
        title="Hexagonal-prism actuator, radial expansion (system 1)",
        source=SOURCE,
        study=study,
        compare=compare,
        curves=curves,
        notes=(
            *ASSUMED,
            "The full run, eleven chambers a row, ends at 100 kPa: from about 110 kPa on the rows buckle, and "
            "increments grow tiny. The quick one has three chambers a row, whose ends fan out, and reaches 150 kPa.",
            "The diameter is that of the smallest cylinder around all of it; 81.1 mm at rest.",
            "Neighbouring chamber walls touch early, as in bending, and push each other apart: the prism grows longer "
            "and wider than the experiment says. Walls or gaps of the real one are stiffer than those assumed.",
        ),
    )
)
