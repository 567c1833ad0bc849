"""System 3, gripper: three fingers close on a cup on a table, lift it, and are loaded until it slips out."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.geometry import Gripper
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, Series
from pneumorph.studies.reproductions.finger import SOURCE
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import EARTH, show

Array = NDArray[np.float64]

SETTLE, CLOSE, LIFT, HOLD, LOAD = "settle", "close", "lift", "hold", "load"
PRESSURE = 0.1  # MPa
RISE = 20.0  # mm that the holder is raised
MASS = 20e-6  # tonne
FRICTION = 0.5
OVERLOAD = 1.5  # N on the cup beside its weight at the end of the programme, more than the fingers bear
STEPS = 20  # in which it grows, at least: the largest weight is found to one of them
SLIPPED = 5.0  # mm behind the holder from which the cup counts as lost

# the cup: distance from its axis and height, mm; from the middle of its underside to that of its bottom inside
CUP = ((0.0, 0.0), (21.0, 0.0), (25.69, 61.0), (28.0, 62.0), (28.0, 65.0), (24.5, 65.0), (19.5, 1.5), (0.0, 1.5))
DEPTH = 115.0  # mm from the holder down to the table

_REACH, _CREEP = 0.1, 0.05  # mm, mm/s: of the contact with the fingers
_ABOVE = _REACH  # between the cup and the table at the start


def study(quick: bool) -> Study:
    """Return the study: the cup stands, the fingers close with 100 kPa, lift it 20 mm, hold, and it is loaded.

    One half of a finger, and a sixth of the cup's mass, that moves up and down only: three planes of symmetry.
    quick: cells from wall to wall and increments twice as large.
    """
    gripper = Gripper(half=True)
    share = _share(gripper)
    fingers = range(1, len(gripper.cavities) + 1)
    skins = [f"{name}_{n}" for name in ("outer", "tip") for n in fingers]
    closed = dict.fromkeys(gripper.cavities, show(PRESSURE, "pressure"))
    support = [
        *({"type": "roller", "face": face, "axis": axis} for face in ("clamp", "cup") for axis in "xy"),
        {"type": "prescribed", "face": "clamp", "axis": "z", "name": "holder"},
        {"type": "symmetry", "face": "symmetry_y"},
    ]
    step = 1.0 if quick else 0.5
    load = f"{OVERLOAD / share:.12g} N"
    table = {
        "title": "Three-finger gripper lifts a cup, half a finger",
        "measures": ["mean_von_mises"],
        "actuator": {"template": "gripper", "half": True},
        "material": {"name": "lsr-finger"},
        "mesh": {"size": "coarse" if quick else "automatic"},
        "gravity": {"direction": "-z"},
        "support": support,
        "load": [{"type": "force", "face": "cup", "direction": "-z", "name": "load"}],
        "body": {
            "cup": {
                "shape": "revolved",
                "profile": [[show(radius, "length"), show(height, "length")] for radius, height in CUP],
                "point": ["0 mm", "0 mm", show(-DEPTH, "length")],
                "mass": f"{MASS * 1e6 / share:.12g} g",
            },
            "table": {
                "shape": "half-space",
                "point": ["0 mm", "0 mm", f"{-DEPTH - _ABOVE:.12g} mm"],
                "normal": "z",
            },
        },
        "contact": [
            {"name": "walls", "faces": [f"outer_{n}" for n in fingers]},
            {
                "name": "grip", "faces": skins, "against": ["cup"], "friction": FRICTION,
                "reach": show(_REACH, "length"), "creep": show(_CREEP, "speed"),
            },
            {"name": "stand", "faces": ["cup"], "body": "table", "friction": FRICTION, "reach": show(_REACH, "length")},
        ],
        "phase": [
            _phase(SETTLE, {"gravity": show(EARTH, "acceleration")}, 0.5, first=0.2, largest=0.5),
            _phase(CLOSE, closed, 1.0, largest=0.1 * step),
            _phase(LIFT, {"holder": show(RISE, "length")}, 1.0, largest=0.2 * step),
            _phase(HOLD, {"holder": show(RISE, "length")}, 1.0, first=0.3, largest=0.5),
            _phase(LOAD, {"load": load}, 1.0, first=1.0 / STEPS, largest=1.0 / STEPS),
        ],
    }  # fmt: skip
    return study_from(table, "finger-gripper")


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return whether the cup was lifted, and what the study does not report: rise, slip, forces, largest weight."""
    share = _share(study.actuator)
    at = f"{MASS * 1e6:g} g, {show(PRESSURE, 'pressure')}"
    raised = f"holder raised {show(RISE, 'length')}"
    rise, behind, stand = (_held(solution, column) for column in ("rise", "behind", "stand"))
    lifted = None if rise is None or stand is None else float(rise > 0.5 * RISE and stand == 0.0)
    radial = None
    closed = np.flatnonzero(solution.history.during(CLOSE))
    if len(closed):
        radial = _radial(solution, study)[closed[-1]]
    largest = _largest(solution, share)
    grams = "" if largest is None else f", a mass of {1e6 * largest / EARTH:.0f} g"
    return (
        Comparison("small cup lifted", at, 1.0, lifted, "", "1: lifted off the table and held; reported: lifted"),
        Comparison("rise of the cup", raised, None, rise, "mm", "from where it stood on the table"),
        Comparison("way of the cup behind the holder", raised, None, behind, "mm", "slip and stretch of the fingers"),
        Comparison("radial force of a finger", show(PRESSURE, "pressure"), None, radial, "N", "cup on the table"),
        Comparison(
            "largest weight held", show(PRESSURE, "pressure"), None, largest, "N",
            f"cup and load together{grams}; found to {OVERLOAD / STEPS:g} N; friction {FRICTION:g} is assumed",
        ),
    )  # fmt: skip


def profiles(solution: Solution, study: Study) -> tuple[Profile, ...]:
    """Return heights of holder and cup over time, and the force that the fingers carry over the weight."""
    clock = solution.history.values("clock")
    if len(clock) < 2:
        return ()
    holder, cup = solution.history.values("value:holder"), _rise(solution)
    ways = (Series("holder", clock, holder), Series("cup", clock, cup))
    result = [Profile("lift", "Holder and cup", "time [s]", "way up [mm]", ways)]
    share, last = _share(study.actuator), solution.history.during(LOAD)
    if last.any():
        asked = MASS * EARTH + share * solution.history.values("value:load")[last]
        carried = -share * solution.history.values("contact_force_z:grip")[last]
        lines = (Series("carried by the fingers", asked, carried), Series("all of it", asked, asked))
        result.append(Profile("carried", "Until the cup slips out", "weight and load [N]", "force [N]", lines))
    return tuple(result)


def _phase(name: str, targets: dict[str, str], seconds: float, **sizes: float) -> dict[str, object]:
    steps = {f"{key}_increment": value for key, value in sizes.items()}
    return {
        "name": name, "targets": targets, "duration": show(seconds, "time"), "inertia": "quasi-static", **steps
    }  # fmt: skip


def _share(actuator: object) -> float:
    """Return how often the model is contained in the whole gripper."""
    if not isinstance(actuator, Gripper):
        raise InputError(f"expected a study of a gripper, received a {type(actuator).__name__}")
    return 2.0 * actuator.fingers if actuator.half else 1.0


def _rise(solution: Solution) -> Array:
    """Return how far the cup is above where it stood after settling, mm, in all states."""
    height, settled = solution.history.values("body_z:cup"), np.flatnonzero(solution.history.during(SETTLE))
    result: Array = height - height[settled[-1] if len(settled) else 0]
    return result


def _behind(solution: Solution) -> Array:
    """Return how far the cup is behind the holder since the fingers closed, mm, in all states."""
    rise, closed = _rise(solution), np.flatnonzero(solution.history.during(CLOSE))
    start = rise[closed[-1]] if len(closed) else 0.0
    result: Array = solution.history.values("value:holder") - (rise - start)
    return result


def _held(solution: Solution, what: str) -> float | None:
    """Return rise, way behind the holder or force of the table at the end of holding, None where it was not reached."""
    rows = np.flatnonzero(solution.history.during(HOLD))
    if not len(rows):
        return None
    if what == "stand":
        return float(solution.history.values("contact_force_z:stand")[rows[-1]])
    return float((_rise(solution) if what == "rise" else _behind(solution))[rows[-1]])


def _radial(solution: Solution, study: Study) -> Array:
    """Return the force with which the cup pushes finger 1 outwards, N, in all states."""
    half = bool(getattr(study.actuator, "half", False))
    faces = (f"contact_force_x:grip:{name}_1" for name in ("outer", "tip"))
    result: Array = np.sum([solution.history.values(face) for face in faces], axis=0) * (2.0 if half else 1.0)
    return result


def _largest(solution: Solution, share: float) -> float | None:
    """Return the largest force, N, that the fingers carried under the load before the cup was lost."""
    rows = solution.history.during(LOAD) & (_behind(solution) <= SLIPPED)
    if not rows.any():
        return None
    carried = -share * solution.history.values("contact_force_z:grip")[rows]
    return float(carried.max())


_TAPER = math.degrees(math.atan2(CUP[2][0] - CUP[1][0], CUP[2][1]))

register(
    Reproduction(
        name="finger-gripper",
        title="Three-finger gripper that lifts a cup (system 3)",
        source=SOURCE,
        study=study,
        compare=compare,
        profiles=profiles,
        notes=(
            "Given by the study: three fingers in a holder lift a small cup. It shows that; it gives no size, weight, "
            "friction or force.",
            f"Assumed: the finger's dimensions as in the other runs; fingers at 120 degrees whose bases are "
            f"{Gripper().palm_radius:g} mm from the axis, hanging straight down; a holder that does not deform.",
            f"Assumed: a rigid cup, {CUP[-4][1]:g} mm high, {2.0 * CUP[1][0]:g} mm wide at its bottom, "
            f"{2.0 * CUP[3][0]:g} mm at its rim, its side {_TAPER:.1f} degrees from upright, of {MASS * 1e6:g} g; "
            f"friction {FRICTION:g} everywhere. Its mass is spread over its wall.",
            "The fingers are filled to 100 kPa in 1 s, the holder is raised in 1 s, held for 1 s, and then a force on "
            f"the cup's centre grows to {OVERLOAD:g} N in 1 s. All phases have inertia with the strongest damping.",
            "Half of one finger and a sixth of the cup are solved: what happens is the same in all six, and the cup "
            "can neither tilt nor turn. Whole grippers are a matter of the study file, and of an hour.",
            "Friction gives way a little before it slips: a cup at rest sinks by up to "
            f"{show(_CREEP, 'speed')} times its weight over the largest weight.",
        ),
    )
)
