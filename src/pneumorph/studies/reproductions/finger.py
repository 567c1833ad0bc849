"""System 3: the finger-like actuator, bent freely and then blocked by a rigid block under its tip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from pneumorph.errors import InputError
from pneumorph.geometry import Finger
from pneumorph.measures import linearised_stress
from pneumorph.mechanics import State
from pneumorph.mechanics.fields import von_mises
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, Series
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show, to_printed

Array = NDArray[np.float64]

SOURCE = (
    "Numerical and experimental methods for the assessment of a human finger-inspired soft pneumatic actuator for "
    "gripping applications (MethodsX)"
)
BEND, PRESS = "bend", "press"
PRESSURES = (0.05, 0.06, 0.07, 0.08, 0.09, 0.1)  # MPa
QUICK_PRESSURES = (0.05, 0.075, 0.1)
BLOCKED = {0.05: 2.0, 0.1: 2.71}  # MPa: N, finite elements of the study
MEASURED = 5.0  # N at 100 kPa
STRESS = (0.1, 0.5)  # MPa, mean equivalent stress over the pressures that the study shows
PEAKS = 6

_PARKED = 150.0  # mm that the block waits below, out of the way of the finger that curls
_STATIONS = 241  # along the length
_PROMINENCE = 0.1  # of the range of the stress: what stands out less is no peak


def study(quick: bool) -> Study:
    """Return the study: free bending to 100 kPa with gravity, and again on a block that is raised under the tip.

    quick: cells from wall to wall and three states in place of cells of 3 mm and six.
    """
    pressures = QUICK_PRESSURES if quick else PRESSURES
    stops = {"cavity": [show(p, "pressure") for p in pressures[:-1]]}
    top = {"cavity": show(pressures[-1], "pressure")}
    finger = Finger()
    wide = show(0.75 * finger.width, "length")
    table = {
        "title": "Finger, bending and blocked force",
        "measures": ["tip_rotation", "chord_angle", "mean_von_mises", "mean_equivalent_strain"],
        "actuator": {"template": "finger"},
        "material": {"name": "lsr-finger"},
        "mesh": {"size": "8 mm" if quick else "3 mm", "hexahedra": True},
        "gravity": {"direction": "-z"},
        "body": {
            "block": {
                "shape": "block",
                "lower": [show(finger.length - finger.block_length, "length"), f"-{wide}", f"{-_PARKED - 20.5:g} mm"],
                "upper": [show(finger.length + 10.0, "length"), wide, f"{-_PARKED - 0.5:g} mm"],
                "direction": "z",
            }
        },
        "contact": [
            {"name": "walls", "faces": ["outer"]},
            {"name": "tip on block", "faces": ["outer", "tip"], "body": "block"},
        ],
        "phase": [
            {"name": BEND, "targets": top, "states_at": stops},
            {"name": "release", "targets": {"cavity": "0 kPa"}},
            {"name": "raise", "targets": {"block": f"{_PARKED:g} mm"}},
            {"name": PRESS, "targets": top, "states_at": stops},
        ],
    }
    return study_from(table, "finger")


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return blocked force, mean stress, linearity of the angle and peaks of stress beside what is reported."""
    rows = []
    for pressure, reported in BLOCKED.items():
        found = _force(solution, pressure)
        note = _note(found, "vertical force on the block; size of the finger and place of the block are assumed")
        name = "blocked force (finite elements of the study)"
        rows.append(Comparison(name, show(pressure, "pressure"), reported, found, "N", note))
    found = _force(solution, 0.1)
    note = _note(found, "repeatability of the measurement 9.58 %")
    rows.append(Comparison("blocked force (measured)", show(0.1, "pressure"), MEASURED, found, "N", note))
    ends = [_force(solution, pressure) for pressure in BLOCKED]
    ratio = ends[1] / ends[0] if ends[0] and ends[1] else None
    rows.append(Comparison("blocked force at 100 kPa / at 50 kPa", "", BLOCKED[0.1] / BLOCKED[0.05], ratio, ""))
    for pressure, stress in zip((0.05, 0.1), STRESS, strict=True):
        mean = _at(solution, BEND, "mean_von_mises", pressure)
        note = _note(mean, "reported: 0.1 to 0.5 MPa up to 100 kPa; taken as the values at 50 and 100 kPa")
        rows.append(Comparison("mean equivalent stress", show(pressure, "pressure"), stress, mean, "MPa", note))
    for name in ("chord_angle", "tip_rotation"):
        note = "reported: the angle grows linearly; computed: correlation coefficient with the pressure"
        straight = _correlation(solution, name)
        rows.append(Comparison(f"linearity of {name}", "50 to 100 kPa", 1.0, straight, "", note))
    state = _bent(solution)
    condition = "free" if state is None else f"free, at {show(state.pressure['cavity'], 'pressure')}"
    peaks_of: list[tuple[Array, Array] | None] = [None, None]
    if state is not None:
        place, *stresses = _along(state, study)
        peaks_of = [_peaks(place, stress) for stress in stresses]
    for peaks, (what, note) in zip(peaks_of, _LINES, strict=True):
        count = None if peaks is None else float(len(peaks[0]))
        at = None if peaks is None else float(_at_passages(peaks[0], study))
        rows.append(Comparison(f"peaks of {what}", condition, PEAKS, count, "", note))
        rows.append(Comparison(f"of them at the passages, {what}", condition, PEAKS, at, "", _NEAR))
    central, first = None, peaks_of[0]
    if first is not None and len(first[1]) == PEAKS:
        central = float(first[1][1:-1].min() / max(first[1][0], first[1][-1]))
    note = f"of {_LINES[0][0]}; reported: the four central ones are highest, so above 1"
    rows.append(Comparison("lowest central peak / highest outer", condition, None, central, "", note))
    return tuple(rows)


def profiles(solution: Solution, study: Study) -> tuple[Profile, ...]:
    """Return angles, blocked force, mean stress and strain over the pressure, and the stress along the length."""
    over = "gauge pressure [kPa]"
    free, pressed = (_curve(solution, phase, "pressure:cavity", "pressure") for phase in (BEND, PRESS))
    result = []
    if len(free):
        angles = [Series(n.replace("_", " "), free, _curve(solution, BEND, n, "angle")) for n in _ANGLES]
        result.append(Profile("angle", "Free bending under gravity", over, "angle [deg]", tuple(angles)))
        for key, kind, label, name in _MEANS:
            line = Series("computed", free, _curve(solution, BEND, key, kind))
            result.append(Profile(name, f"Mean {label}, free bending", over, f"{label}", (line,)))
    if len(pressed):
        force = Series("computed", pressed, -_curve(solution, PRESS, "body_force_z:block", "force"))
        at = np.array([to_printed(p, "pressure") for p in BLOCKED])
        reported = Series("finite elements of the study", at, np.array(list(BLOCKED.values())), True)
        measured = Series("measured", at[1:], np.array([MEASURED]), True)
        result.append(Profile("blocked-force", "Blocked force", over, "force [N]", (force, reported, measured)))
    state = _bent(solution)
    if state is not None:
        title = f"Stress in the floor, free, at {show(state.pressure['cavity'], 'pressure')}"
        place, *stresses = _along(state, study)
        lines = tuple(Series(label, place, stress) for (label, _), stress in zip(_LINES, stresses, strict=True))
        result.append(Profile("stress-along-length", title, "place [mm]", "equivalent stress [MPa]", lines))
    return tuple(result)


_ANGLES = ("chord_angle", "tip_rotation")
_LINES = (
    ("membrane stress through the floor", "equivalent, in the middle of the width; peaks above a tenth of its range"),
    ("membrane and bending stress through the floor", "larger equivalent one of the two sides; above a tenth of it"),
)
_NEAR = "as far as the walls beside a gap"
_MEANS = (
    ("mean_von_mises", "stress", "equivalent stress [MPa]", "mean-stress"),
    ("mean_equivalent_strain", "number", "equivalent strain", "mean-strain"),
)


def _curve(solution: Solution, phase: str, column: str, kind: str) -> Array:
    """Return a column over the states of a phase, in printed units."""
    return np.array(
        [to_printed(value, kind) for value in solution.history.values(column)[solution.history.during(phase)]]
    )


def _at(solution: Solution, phase: str, column: str, pressure: float) -> float | None:
    """Return a column in the state of a phase that has a pressure, None where there is none."""
    here = np.isclose(solution.history.values("pressure:cavity"), pressure, rtol=1e-9, atol=0.0)
    values = solution.history.values(column)[here & solution.history.during(phase)]
    return float(values[-1]) if len(values) else None


def _force(solution: Solution, pressure: float) -> float | None:
    """Return the force, N, that presses the block down."""
    found = _at(solution, PRESS, "body_force_z:block", pressure)
    return None if found is None else -found


def _note(value: float | None, text: str) -> str:
    return text if value is not None else f"not reached; {text}"


def _correlation(solution: Solution, column: str) -> float | None:
    """Return the correlation coefficient of a column with the pressure from 50 kPa on in free bending."""
    late = solution.history.during(BEND) & (solution.history.values("pressure:cavity") >= 0.05 - 1e-9)
    if late.sum() < 3:
        return None
    pressure, values = (solution.history.values(key)[late] for key in ("pressure:cavity", column))
    return float(np.corrcoef(pressure, values)[0, 1])


def _bent(solution: Solution) -> State | None:
    """Return the state of free bending with the highest pressure, None where there is none."""
    rows = np.flatnonzero(solution.history.during(BEND))
    return solution.states[int(rows[-1])] if len(rows) else None


def _along(state: State, study: Study) -> tuple[Array, Array, Array]:
    """Return places (n,), mm, along the finger, and the linearised equivalent stress through its floor, MPa.

    It is that of the membrane part (n,), and the larger one of membrane and bending at both sides (n,).
    """
    finger = _finger(study)
    # the clamped edge is singular, and neither end bends: from the first to the last chamber's air
    place = np.linspace(finger.wall, finger.length - finger.wall, _STATIONS)
    low = np.column_stack([place, np.zeros_like(place), np.full_like(place, 1e-6)])
    linear = linearised_stress(state, low, low + np.array([0.0, 0.0, finger.base - 2e-6]))
    return place, von_mises(linear.membrane), linear.equivalent


def _peaks(place: Array, stress: Array) -> tuple[Array, Array]:
    """Return the places and heights of the peaks of a stress."""
    found, _ = find_peaks(stress, prominence=_PROMINENCE * float(np.ptp(stress)))
    return place[found], stress[found]


def _at_passages(places: Array, study: Study) -> int:
    """Return how many places (n,), mm, lie in a passage: a gap and the walls on either side."""
    finger = _finger(study)
    pitch = finger.block_length + finger.gap
    middles = finger.block_length + 0.5 * finger.gap + pitch * np.arange(finger.chambers - 1)
    off = np.abs(places[:, None] - middles).min(axis=1)
    return int((off <= 0.5 * finger.gap + finger.wall).sum())


def _finger(study: Study) -> Finger:
    if not isinstance(study.actuator, Finger):
        raise InputError(f"expected a study of a finger, received a {type(study.actuator).__name__}")
    return study.actuator


register(
    Reproduction(
        name="finger",
        title="Finger-like actuator, bending and blocked force (system 3)",
        source=SOURCE,
        study=study,
        compare=compare,
        profiles=profiles,
        notes=(
            "Given by the study: seven chambers with six passages, Yeoh's constants, gravity, frictionless contact of "
            "all outer faces, pressures, element size 3 mm. It gives no dimension: all of them are assumed, and with "
            "them the size of every force and angle.",
            "The study meshes with tetrahedra, here it is hexahedra with 27 nodes, one through each wall: on 1,546 "
            "tetrahedra the stress along the length is too rough for its peaks to be counted.",
            "Assumed: the block reaches under the last chamber and beyond the tip, 0.5 mm below the level finger. It "
            "waits 150 mm lower during free bending, and is raised under the deflated finger, whose tip it lifts.",
            "Blocked force is the vertical force on the block; it contains the part of the weight that it bears.",
            "The study's 'linearised equivalent stress' follows no stated line. Here lines go through the floor in the "
            "middle of its width, one beside the other along the length; its membrane part is what the length carries, "
            "the bending part is also that of the floor of each chamber, which bulges.",
        ),
        parts={"bending": "finger", "gripper": "finger-gripper", "massage": "finger-massage"},
    )
)
