"""System 1, part anchoring: the prism expanded in the 84 mm pipe, and the least pressure that holds its weight."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pneumorph.measures.centre_of_mass import nodal_mass
from pneumorph.mechanics import Model, Symmetry
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, Series
from pneumorph.studies.reproductions.hexagonal_expansion import (
    ASSUMED,
    COLUMN,
    DIAMETER,
    DRIVEN,
    END,
    QUICK_END,
    SOURCE,
    WALLS,
    crossing,
    printed,
    prism_table,
)
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import EARTH, show

NAME = "hexagonal-prism-anchoring"
PIPE = "pipe"
NORMAL = f"normal_force:{PIPE}"
FRICTION = 0.7  # assumed
# reported: tilt, degrees -> least pressure that holds, MPa
REPORTED = {0.0: 0.160, 30.0: 0.175, 60.0: 0.195, 90.0: 0.225}
_STEPS = {tilt: held - REPORTED[0.0] for tilt, held in REPORTED.items()}
_REACH = "0.1 mm"


def study(quick: bool) -> Study:
    """Return the study: to 100 kPa in the pipe, quickly to 150 kPa of a shorter prism; outer walls may touch."""
    bore = {"shape": "pipe", "point": ["0 mm"] * 3, "radius": show(DIAMETER / 2.0, "length"), "axis": "z"}
    table = prism_table(
        "Hexagonal-prism actuator anchored in the 84 mm pipe",
        QUICK_END if quick else END,
        quick,
        [COLUMN, NORMAL],
        body={PIPE: bore},
        contact=[{"name": PIPE, "faces": ["outer"], "body": PIPE, "reach": _REACH}, WALLS],
    )
    # where contact begins, a state every 2 kPa
    table["phase"][0]["states_at"] = {DRIVEN[0]: [f"{pressure} kPa" for pressure in range(50, 70, 2)]}
    return study_from(table, NAME)


def weight(model: Model) -> float:
    """Return the weight of the whole prism, N: that of the modelled part and its images."""
    images = 2 ** sum(isinstance(support, Symmetry) for support in model.supports)
    return images * EARTH * float(nodal_mass(model).sum())


def holding_pressure(
    pressure: NDArray[np.float64], normal: NDArray[np.float64], weight: float, tilt: float, friction: float
) -> float | None:
    """Return the least pressure, MPa, at which friction holds the weight in a pipe at a tilt, None if not reached.

    friction N(p) >= weight sin(tilt), the tilt in degrees from the horizontal; level, it is where the normal force
    begins. pressure, normal (n,): gauge pressure and sum of the normal forces, N, of a prism pressed evenly all around.
    """
    if not normal.any():
        return None
    demand = weight * math.sin(math.radians(tilt)) / friction
    return crossing(pressure, normal, max(demand, 1e-9 * float(normal.max())))


def fitted_friction(pressure: NDArray[np.float64], normal: NDArray[np.float64], weight: float) -> float | None:
    """Return the friction that makes the step from the level to the vertical pipe the reported one, 65 kPa.

    The step, as contact begins at another pressure than reported. None where the run does not reach it.
    """
    level = holding_pressure(pressure, normal, weight, 0.0, FRICTION)
    if level is None or level + _STEPS[90.0] > pressure[-1] * (1.0 + 1e-9):
        return None
    return weight / float(np.interp(level + _STEPS[90.0], pressure, normal))


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return holding pressures at the reported tilts with the assumed friction, and their steps with a fitted one."""
    pressure = solution.history.values(f"pressure:{DRIVEN[0]}")
    normal = solution.history.values(NORMAL)
    load = weight(solution.model)
    note = f"weight of the prism {load:.3g} N; level: where the normal force begins"
    rows = []
    for tilt, reported in REPORTED.items():
        held = printed(holding_pressure(pressure, normal, load, tilt, FRICTION))
        quantity = f"least pressure that holds (friction {FRICTION:g}, assumed)"
        rows.append(Comparison(quantity, f"tilt {tilt:g} deg", printed(reported) or 0.0, held, "kPa", note))
    fitted = fitted_friction(pressure, normal, load)
    for tilt, step in list(_STEPS.items())[1:]:
        found = None if fitted is None else _step(pressure, normal, load, tilt, fitted)
        rows.append(
            Comparison(
                "the same over that when level (friction fitted at 90 deg)", f"tilt {tilt:g} deg", 1e3 * step,
                printed(found), "kPa", "90 deg is right by the fit" if tilt == 90.0 else "",
            )
        )  # fmt: skip
    rows.append(
        Comparison(
            "friction that the reported step to 90 deg asks for", "tilt 90 deg", FRICTION, fitted, "",
            "0.7 is the assumed friction, none is reported",
        )
    )  # fmt: skip
    return tuple(rows)


def _step(
    pressure: NDArray[np.float64], normal: NDArray[np.float64], weight: float, tilt: float, friction: float
) -> float | None:
    """Return the pressure by which a tilt asks for more than the level pipe, MPa."""
    level, held = (holding_pressure(pressure, normal, weight, angle, friction) for angle in (0.0, tilt))
    return None if level is None or held is None else held - level


def profiles(solution: Solution, study: Study) -> tuple[Profile, ...]:
    """Return the holding pressure over the tilt, reported and computed."""
    pressure = solution.history.values(f"pressure:{DRIVEN[0]}")
    normal = solution.history.values(NORMAL)
    load = weight(solution.model)
    tilts = np.linspace(0.0, 90.0, 31)

    def line(label: str, friction: float) -> Series:
        held = [printed(holding_pressure(pressure, normal, load, float(tilt), friction)) for tilt in tilts]
        known = np.array([value is not None for value in held])
        return Series(label, tilts[known], np.array([value for value in held if value is not None]))

    curves = [line(f"friction {FRICTION:g}, assumed", FRICTION)]
    fitted = fitted_friction(pressure, normal, load)
    if fitted is not None:
        curves.append(line(f"friction {fitted:.2g}, fitted to the step at 90°", fitted))
    reported = np.array([printed(value) for value in REPORTED.values()], dtype=float)
    curves.append(Series("experiment", np.array(list(REPORTED)), reported, marks=True))
    title = "Least pressure that holds the prism in the 84 mm pipe"
    return (Profile("holding-pressure", title, "tilt (°)", "pressure (kPa)", tuple(curves)),)


register(
    Reproduction(
        name=NAME,
        title="Hexagonal-prism actuator anchored in the 84 mm pipe (system 1)",
        source=SOURCE,
        study=study,
        compare=compare,
        profiles=profiles,
        notes=(
            *ASSUMED,
            "Assumed: friction 0.7 between silicone and pipe; the prism alone bears its own weight (1130 kg/m³). "
            "Friction times the sum of the normal forces all around must reach the weight times the sine of the tilt.",
            "The normal force does not depend on friction here: it is found without, as the prism is pressed evenly.",
            "Contact begins at two fifths of the reported pressures, and a few kPa more press the prism with many "
            "times its weight: with any usual friction it holds as soon as it touches. The friction that makes the "
            "step from the level to the vertical pipe as large as reported is an eightieth of that, and gives more "
            "of the step to the first tilts than is reported: what holds in the experiment is not this friction alone.",
        ),
    )
)
