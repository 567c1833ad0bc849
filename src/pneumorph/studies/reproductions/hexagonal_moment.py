"""System 1, part moment: two neighbouring cavities with both ends held, and the moment that the ends then bear."""

from __future__ import annotations

import numpy as np

from pneumorph.closed_form.hexagonal_prism import REPORTED_BENDING, measured_moment
from pneumorph.measures import ReactionMoment
from pneumorph.mechanics import State
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, Series
from pneumorph.studies.reproductions.hexagonal_expansion import ASSUMED, SHORT, SOURCE, WALLS
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show

NAME = "hexagonal-prism-moment"
# of the half that is modelled; its image in the cut is the neighbour that makes it two
DRIVEN = "cavity_2"
COMPARED = tuple(pressure for pressure, _ in REPORTED_BENDING)  # MPa, where the study tabulates
END = 0.12
LONGER = {"chambers": 5, "length": "52 mm"}
# mm N in a unit in which the printed moment may be
UNITS = {"N mm": 1.0, "N cm": 10.0, "N m": 1000.0}


def study(quick: bool) -> Study:
    """Return the study: half a prism of five chambers a row, quickly three, both ends clamped, to 120 kPa."""
    stops = [show(p, "pressure") for p in COMPARED if p < END]
    table = {
        "title": "Hexagonal-prism actuator, moment with both ends held",
        "measures": ["reaction_moment", "reaction_force"],
        "actuator": {"template": "pipe-robot", "modules": 1, "half": True, **(SHORT if quick else LONGER)},
        "mesh": {"size": "coarse"},
        "support": [
            {"type": "clamp", "face": "clamp"},
            {"type": "clamp", "face": "tip"},
            {"type": "symmetry", "face": "symmetry_x"},
        ],
        "contact": [WALLS],
        "phase": [
            {
                "name": "press",
                "targets": {DRIVEN: show(END, "pressure")},
                "states_at": {DRIVEN: stops},
                "first_increment": 0.004 / END,
                "largest_increment": 0.010 / END,
            }
        ],
    }
    return study_from(table, NAME)


def output_moment(state: State) -> float:
    """Return the moment about x that the held end gives to the whole prism, N mm: twice that of the half."""
    return 2.0 * abs(float(ReactionMoment("clamp", component="x").vector(state)[0]))


def moments(solution: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return pressure (n,), MPa, and output moment (n,), N mm, of all states."""
    found = [(state.pressure[DRIVEN], output_moment(state)) for state in solution.states]
    pressure, moment = np.array(found).T
    return pressure, moment


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return the moment against the printed polynomial, read in N mm; the notes say which unit comes nearest."""
    pressure, moment = moments(solution)
    unit = nearest_unit(float(pressure[-1]), float(moment[-1]))
    end = show(float(pressure[-1]), "pressure")
    note = f"printed without a unit, read as N mm; of {', '.join(UNITS)} the nearest at {end} is {unit}"
    rows = []
    for wanted in COMPARED:
        reached = pressure[-1] >= wanted * (1.0 - 1e-9)
        rows.append(
            Comparison(
                "output moment", show(wanted, "pressure"), float(measured_moment(wanted)),
                float(np.interp(wanted, pressure, moment)) if reached else None, "N mm",
                note if reached else f"the run ends at {end}; {note}",
            )
        )  # fmt: skip
    return tuple(rows)


def nearest_unit(pressure: float, moment: float) -> str:
    """Return the unit in which the printed number at a pressure, MPa, is nearest to a moment, N mm, as a ratio."""
    reported = float(measured_moment(pressure))
    return min(UNITS, key=lambda unit: abs(np.log(moment / (reported * UNITS[unit]))))


def profiles(solution: Solution, study: Study) -> tuple[Profile, ...]:
    """Return the moment over the pressure, computed and printed."""
    pressure, moment = moments(solution)
    over = np.linspace(0.0, COMPARED[-1], 57)
    curves = (
        Series("finite elements, both ends held", 1e3 * pressure, moment),
        Series("eq. 13, polynomial through the experiment, read in N mm", 1e3 * over, measured_moment(over)),
    )
    return (
        Profile(
            "output-moment", "Output moment of two neighbouring cavities", "pressure (kPa)", "moment (N mm)", curves
        ),
    )


register(
    Reproduction(
        name=NAME,
        title="Hexagonal-prism actuator, output moment (system 1)",
        source=SOURCE,
        study=study,
        compare=compare,
        profiles=profiles,
        notes=(
            ASSUMED[0],
            "The prism has five chambers a row (three, if quick) in place of eleven: as both ends are held, the moment "
            "is that of a section, whatever the length.",
            "Half of the prism is solved; the columns of the history are those of this half, the comparison and its "
            "figure those of the whole. Chambers of a row share one pressure without airways and bridges between them.",
            "Both end faces are clamped, so neither turns nor moves away. How the experiment held the actuator is not "
            "said; the study gives no unit of its moment either.",
        ),
    )
)
