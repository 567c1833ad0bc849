"""System 2 in space: the quadruped of five cavities undulates and crawls over ground with friction."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from pneumorph.errors import InputError
from pneumorph.gaits import Foot, Locomotion, locomotion
from pneumorph.geometry import Quadruped
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, Profile, Series
from pneumorph.studies.reproductions.pneunet_2d import SOURCE, apart
from pneumorph.studies.reproductions.quadruped_leg import leg_angles
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show

PRESSURE = 0.02  # MPa
FORWARD = (1.0, 0.0, 0.0)
PAIRS = {
    "rear": ("foot_PN1", "foot_PN2", "belly_rear"),
    "front": ("foot_PN3", "foot_PN4", "belly_front"),
}
# phase -> cavities that it fills and cavities that it empties
UNDULATION = {
    "+rear": (("PN1", "PN2"), ()),
    "+centre": (("PN5",), ()),
    "+front": (("PN3", "PN4"), ()),
    "-rear": ((), ("PN1", "PN2")),
    "-centre": ((), ("PN5",)),
    "-front": ((), ("PN3", "PN4")),
}
CRAWLING = {
    "+PN5": (("PN5",), ()),
    "+PN1": (("PN1",), ()),
    "+PN3 -PN1": (("PN3",), ("PN1",)),
    "+PN2 -PN3": (("PN2",), ("PN3",)),
    "+PN4 -PN2": (("PN4",), ("PN2",)),
    "+PN1 -PN4": (("PN1",), ("PN4",)),
}
_CYCLE = tuple(CRAWLING)[2:]
# step of the study's crawling -> phase
STEPS = dict(zip(("i", "ii", "iii", "iv", "v", "vi", "vii"), ("gravity", *CRAWLING), strict=True))
PUSHES = ("iv", "vi")
REPORTED_FORCE = 0.12  # N, of the rear pair and of the front pair under gravity
LEG_PRESSURES = (0.005, 0.01, 0.015, PRESSURE)  # MPa
_REACH = 0.15  # mm: a thousandth of the robot
# MPa: ten times the pressure under the robot at rest, a tenth of that under the edge of a tip, so that neither rests
# on the outermost nor the innermost part of the reach, where small ways make large forces come and go
_STIFFNESS = 5e-4
_DURATION = 10.0  # s: so slow that inertia does not carry it along


def study(quick: bool) -> Study:
    """Return the study: crawling alone with large increments, or undulation and then crawling."""
    phases = {"gravity": {"gravity": "9.81 m/s2"}}
    for name, (filled, emptied) in (({} if quick else UNDULATION) | CRAWLING).items():
        phases[name] = dict.fromkeys(filled, show(PRESSURE, "pressure")) | dict.fromkeys(emptied, "0 kPa")
    step = 0.2 if quick else 0.1
    ramp = {
        "duration": show(_DURATION, "time"), "inertia": "quasi-static", "first_increment": step,
        "largest_increment": step,
    }  # fmt: skip
    settling = {"first_increment": 0.5, "largest_increment": 0.5}
    table = {
        "title": "PneuNet quadruped, crawling at 20 kPa" if quick else "PneuNet quadruped, two gaits at 20 kPa",
        "measures": ["centre_of_mass_x", "centre_of_mass_y", "centre_of_mass_z"],
        "actuator": {"template": "quadruped"},
        "mesh": {"size": "coarse" if quick else "automatic"},
        "gravity": {"direction": "-z"},
        "body": {"ground": {"shape": "half-space", "point": ["0 mm", "0 mm", show(-_REACH, "length")], "normal": "z"}},
        "contact": [
            {
                "name": "ground",
                "faces": [face for pair in PAIRS.values() for face in pair],
                "body": "ground",
                "friction": 0.7,
                "reach": show(_REACH, "length"),
                "stiffness": show(_STIFFNESS, "stress"),
                "creep": "0.004 mm/s",
            }
        ],
        "phase": [
            {"name": name, "targets": targets, **ramp} | (settling if name == "gravity" else {})
            for name, targets in phases.items()
        ],
        "cycle": {"phases": list(_CYCLE), "repeat": 1},
    }
    return study_from(table, "pneunet-quadruped")


def motion(solution: Solution, study: Study) -> Locomotion:
    """Return the motion of a run of the study."""
    return locomotion(
        solution.states, study.cycle_ends, [Foot(face) for pair in PAIRS.values() for face in pair], FORWARD
    )


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return forces under gravity, the way of both gaits and of the crawling's phases against what was reported."""
    found = motion(solution, study)
    return (*_forces(found), *_undulation(found, study), *_crawling(found, study), *apart(solution))


def profiles(solution: Solution, study: Study) -> tuple[Profile, ...]:
    """Return forces of legs, centre of mass and curl of a leg as figures."""
    curl = _curl(study)
    found = motion(solution, study)
    ends = [at for number in range(1, len(study.programme.phases) + 1) if (at := found.at(float(number))) is not None]
    legs = [
        Series(face, found.time, 1e3 * force[:, 2]) for face, force in found.force.items() if face.startswith("foot_")
    ]
    path, marks = found.centre[:, [0, 2]].T, found.centre[ends][:, [0, 2]].T
    return (
        Profile(
            "legs", "Vertical force of each leg", "time of the programme [phases, as in the schedule]",
            "force [mN]", tuple(legs),
        ),
        Profile(
            "centre", "Way of the centre of mass", "x [mm]", "z [mm]",
            (Series("path", path[0], path[1]), Series("ends of the phases", marks[0], marks[1], marks=True)),
        ),
        curl,
    )  # fmt: skip


def _curl(study: Study) -> Profile:
    robot = _robot(study)
    angles = leg_angles(robot, study.materials, LEG_PRESSURES)
    series = Series("finite elements", 1e3 * np.array([0.0, *LEG_PRESSURES]), np.degrees([0.0, *angles]))
    return Profile(
        "leg", "Turn of the tip of a leg in the air, without weight", "pressure [kPa]", "angle [deg]", (series,)
    )


def _robot(study: Study) -> Quadruped:
    if not isinstance(study.actuator, Quadruped):
        raise InputError(f"expected a study of a quadruped, received a {type(study.actuator).__name__}")
    return study.actuator


def _end(found: Locomotion, study: Study, phase: str) -> int | None:
    """Return the number of the state at the end of a phase, None where the run has none."""
    names = [item.name for item in study.programme.phases]
    return found.at(names.index(phase) + 1.0) if phase in names else None


def _way(found: Locomotion, before: int | None, after: int | None) -> float | None:
    """Return how far forward the centre of mass went between two states, mm."""
    if before is None or after is None:
        return None
    return float((found.centre[after] - found.centre[before]) @ found.forward)


def _forces(found: Locomotion) -> list[Comparison]:
    at = found.at(1.0)
    when, note = "after step i, gravity", "two legs and half of the centre"
    up = {} if at is None else {p: sum(float(found.force[face][at, 2]) for face in PAIRS[p]) for p in PAIRS}
    rows = [
        Comparison(f"normal force of the {pair} pair", when, REPORTED_FORCE, up.get(pair), "N", note) for pair in PAIRS
    ]
    total = sum(up.values()) / found.weight if up else None
    return [*rows, Comparison("ground force over weight at rest", when, 1.0, total, "", "from statics")]


def _undulation(found: Locomotion, study: Study) -> list[Comparison]:
    if next(iter(UNDULATION)) not in [item.name for item in study.programme.phases]:
        return []
    way = _way(found, found.at(1.0), _end(found, study, list(UNDULATION)[-1]))
    note = "the study gives no number; forward is over 0"
    return [Comparison("way of the centre of mass", "one cycle of undulation", 0.0, way, "mm", note)]


def _crawling(found: Locomotion, study: Study) -> list[Comparison]:
    rows, marks = [], {step: _end(found, study, phase) for step, phase in STEPS.items()}
    for before, step in pairwise(list(STEPS)[2:]):
        note = "reported: markedly forward, over 0" if step in PUSHES else ""
        way = _way(found, marks[before], marks[step])
        rows.append(Comparison("way of the centre of mass", f"in step {step}, {STEPS[step]}", 0.0, way, "mm", note))
    way, note = _way(found, marks["iii"], marks["vii"]), "reported: forward, over 0"
    rows.append(Comparison("way of the centre of mass", "one cycle of crawling, iii to vii", 0.0, way, "mm", note))
    first, last = marks["iii"], marks["vii"]
    ratio = None if first is None or last is None else float(found.centre[last, 2] / found.centre[first, 2])
    note = "reported: the same state again, further on"
    return [*rows, Comparison("height of the centre of mass, vii over iii", "crawling", 1.0, ratio, "", note)]


register(
    Reproduction(
        name="pneunet-quadruped",
        title="PneuNet quadruped, undulation and crawling (system 2)",
        source=SOURCE,
        study=study,
        compare=compare,
        profiles=profiles,
        notes=(
            "Given by the study: 135.7 x 58.5 x 6.3 mm, five cavities, Ecoflex 5.3 mm on PDMS 1 mm, channels 4 mm high "
            "and 1.5 mm wide along the leg with 2 mm between, shear moduli, friction 0.7, 20 kPa, the order of the "
            "steps. Assumed: legs 15 mm wide along the diagonals of the plan, a centre 27.5 mm wide, side walls of "
            "2 mm, channels that lie on the PDMS, densities of 1070 and 965 kg/m³; with them the robot weighs 0.21 N, "
            "the reported forces add up to 0.24 N. PN1 and PN3 are on the left.",
            "No ducts between the channels of a cavity: one of 2 mm through the middle of the walls lowers the largest "
            "pressure that neo-Hookean Ecoflex bears from 21 to 16 kPa.",
            "Assumed: each step takes 10 s, with quasi-static damping. Friction holds below 0.004 mm/s.",
            "20 kPa lies 4 % below the largest pressure that a leg bears: there its curl depends steeply on pressure "
            "and side walls.",
        ),
    )
)
