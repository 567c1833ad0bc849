"""System 3, massage: the finger presses a deformable forearm that lies under it, both ends of the arm fixed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pneumorph.geometry import Finger, Forearm
from pneumorph.measures import contact_pressure
from pneumorph.mesh.assembly import Turn, name_of
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, Series
from pneumorph.studies.reproductions.finger import SOURCE
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show, to_printed

Array = NDArray[np.float64]

NAME = "finger-massage"
PRESS, CONTACT, ARM = "press", "massage", "arm"
PRESSURE = 0.09  # MPa
THRESHOLD = 180.0  # kPa, pressure at which contact begins to hurt
SAFETY = 2.0

_STOPS = (0.03, 0.06)  # MPa
_GAP = 1.0  # mm between the level finger and the arm under it
_MIDDLE = 45.0  # mm from the clamp to the middle of the arm
# mm and MPa: of the order of the pressures between finger and arm, so that contact comes and goes smoothly
_REACH, _STIFFNESS = 0.3, 0.05


def study(quick: bool) -> Study:
    """Return the study: a finger across the arm, 30 mm from the wrist, sags onto it and is inflated to 90 kPa.

    quick: cells of 9 mm in place of 6 mm on the pressed part of the arm, and of the finger no more than from wall to
    wall.
    """
    turns, shift = _pose(Forearm())
    measures = ["tip_rotation", "chord_angle", f"largest_displacement:{ARM}.body", f"mean_contact_pressure:{CONTACT}"]
    table = {
        "title": "Finger, massage of a forearm",
        "measures": measures,
        "actuator": {"template": "finger"},
        "material": {"name": "lsr-finger"},
        "mesh": {"hexahedra": True} | ({} if quick else {"size": "4 mm"}),
        "part": {
            ARM: {
                "actuator": {"template": "forearm"},
                "material": {"name": "finger-arm"},
                "mesh": {"size": "9 mm" if quick else "6 mm"},
                "turn": turns,
                "shift": shift,
            }
        },
        "gravity": {"direction": "-z"},
        "support": [{"type": "clamp", "face": face} for face in ("clamp", f"{ARM}.wrist", f"{ARM}.elbow")],
        "contact": [
            {
                "name": CONTACT,
                "faces": ["outer", "tip"],
                "against": [f"{ARM}.skin"],
                "reach": show(_REACH, "length"),
                "stiffness": show(_STIFFNESS, "stress"),
            },
            {"name": "walls", "faces": ["outer"]},
        ],
        "phase": [
            {
                "name": PRESS,
                "targets": {"cavity": show(PRESSURE, "pressure")},
                "states_at": {"cavity": [show(p, "pressure") for p in _STOPS]},
                "largest_increment": 0.1,
            },
        ],
    }  # fmt: skip
    return study_from(table, NAME)


def _pose(arm: Forearm) -> tuple[list[dict[str, str]], list[str]]:
    """Return turns and shift that lay the arm across the finger, its wrist to -y and the line on its top level."""
    slope = math.atan2(arm.half_axes(arm.length)[1] - arm.half_axes(0.0)[1], arm.length)
    turns = (Turn((0.0, 0.0, 1.0), 0.5 * math.pi), Turn((1.0, 0.0, 0.0), -slope))
    top = np.array([[arm.pressed, 0.0, arm.half_axes(arm.pressed)[1]]])
    for turn in turns:
        top = turn(top)
    shift = np.array([_MIDDLE, 0.0, -_GAP]) - top[0]
    angles = [show(turn.angle, "angle", 8) for turn in turns]
    return (
        [{"axis": axis, "angle": angle} for axis, angle in zip("zx", angles, strict=True)],
        [show(float(x), "length", 8) for x in shift],
    )


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return contact pressure, its distance from the threshold of discomfort, and the arm's displacement."""
    row = _row(solution)
    at = show(PRESSURE, "pressure")

    def value(column: str, kind: str) -> float | None:
        return None if row is None else to_printed(float(solution.history.values(column)[row]), kind)

    largest, mean = (
        value(f"contact_pressure:{CONTACT}", "pressure"),
        value(f"mean_contact_pressure:{CONTACT}", "pressure"),
    )
    limit = "reported: below the threshold of discomfort, 180 kPa, by the safety factor 2"
    single = "of a node, it depends on both meshes"
    rows = [
        Comparison("largest contact pressure", at, THRESHOLD / SAFETY, largest, "kPa", f"{limit}; {single}"),
        Comparison("the same, of the nodes of the arm", at, THRESHOLD / SAFETY, _on_arm(solution, row), "kPa", single),
        Comparison("mean contact pressure", at, None, mean, "kPa", "normal force over the area that bears it"),
        Comparison("safety factor, threshold over largest pressure", at, SAFETY, _over(largest), "", single),
        Comparison("safety factor, threshold over mean pressure", at, None, _over(mean), ""),
        Comparison("contact area", at, None, value(f"contact_area:{CONTACT}", "area"), "mm²"),
    ]
    force = None
    if row is not None:
        parts = [solution.history.values(f"contact_force_{axis}:{CONTACT}")[row] for axis in "xyz"]
        force = float(np.linalg.norm(parts))
    rows.append(Comparison("contact force", at, None, force, "N", "size of the resultant on the finger"))
    moved = None if row is None else 1e3 * _arm_moved(solution, row)
    note = "since the finger hung still: without the sag of the arm under its own weight"
    rows.append(Comparison("largest displacement of the arm", at, None, moved, "µm", note))
    return tuple(rows)


def profiles(solution: Solution, study: Study) -> tuple[Profile, ...]:
    """Return contact force and contact pressure over the pressure in the finger, beside the threshold."""
    history = solution.history
    here = history.during(PRESS)
    if not here.any():
        return ()

    def curve(column: str, kind: str) -> Array:
        return np.array([to_printed(float(x), kind) for x in history.values(column)[here]])

    inside, over = curve("pressure:cavity", "pressure"), "gauge pressure [kPa]"
    force = np.sqrt(sum(curve(f"contact_force_{axis}:{CONTACT}", "force") ** 2 for axis in "xyz"))
    pressures = (
        Series("largest, at a node", inside, curve(f"contact_pressure:{CONTACT}", "pressure")),
        Series("mean over the area that bears", inside, curve(f"mean_contact_pressure:{CONTACT}", "pressure")),
        Series("threshold of discomfort", inside[[0, -1]], np.full(2, THRESHOLD)),
        Series("threshold over the safety factor 2", inside[[0, -1]], np.full(2, THRESHOLD / SAFETY)),
    )
    return (
        Profile(
            "contact-force", "Force between finger and arm", over, "force [N]", (Series("computed", inside, force),)
        ),
        Profile("contact-pressure", "Contact pressure on the arm", over, "pressure [kPa]", pressures),
    )


def _row(solution: Solution) -> int | None:
    """Return the state at the full pressure, None where the run did not get there."""
    reached = np.isclose(solution.history.values("pressure:cavity"), PRESSURE, rtol=1e-9, atol=0.0)
    return int(np.flatnonzero(reached)[-1]) if reached.any() else None


def _arm_moved(solution: Solution, row: int) -> float:
    """Return the largest displacement of the arm's skin since the end of the phase with gravity, mm."""
    before = np.flatnonzero(~solution.history.during(PRESS))[-1]
    skin = solution.model.mesh.face_nodes(name_of(ARM, "skin"))
    moved = solution.states[row].displacement[skin] - solution.states[int(before)].displacement[skin]
    return float(np.linalg.norm(moved, axis=1).max())


def _on_arm(solution: Solution, row: int | None) -> float | None:
    """Return the largest contact pressure at a node of the arm's skin, kPa."""
    if row is None:
        return None
    skin = solution.model.mesh.face_nodes(name_of(ARM, "skin"))
    return to_printed(float(contact_pressure(solution.states[row], CONTACT)[skin].max()), "pressure")


def _over(pressure: float | None) -> float | None:
    return THRESHOLD / pressure if pressure else None


register(
    Reproduction(
        name=NAME,
        title="Finger-like actuator, massage of a forearm (system 3)",
        source=SOURCE,
        study=study,
        compare=compare,
        profiles=profiles,
        notes=(
            "Given by the study: 90 kPa, about 30 mm from the wrist, both ends of the arm fixed, E = 270 MPa and "
            "nu = 0.47 of the arm, frictionless contact, threshold of discomfort 180 kPa, safety factor 2.",
            "E = 270 MPa is more than a thousand times the finger's stiffness, and a hundred and more that of skin and "
            "muscle: the arm hardly yields, and the pressure on it is near that on a rigid one. A softer arm is one "
            'line, such as [part.arm.material] law = "neo-hookean", mu = "20 kPa".',
            "Assumed: size and shape of the arm, a tapered elliptic cylinder, and of the finger, "
            f"{Finger().length:g} mm long; the finger is level, across the arm, clamped {_MIDDLE:g} mm beside the "
            f"arm's middle and {_GAP:g} mm above it; the arm is tilted so that the line on its top is level, too.",
            "Contact pressure is the normal force of a node over the area that it bears. The largest one depends on "
            "the meshes: on a round arm of flat facets edges bear more than flats; the mean hardly does.",
        ),
    )
)
