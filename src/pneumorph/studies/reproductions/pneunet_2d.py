"""System 2 in plane strain: three segments of round channels undulate over ground with friction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pneumorph.closed_form.pneunet import pneunet_curvature
from pneumorph.errors import InputError, NotConvergedError
from pneumorph.gaits import Foot, Locomotion, locomotion
from pneumorph.geometry import PlaneCrawler
from pneumorph.measures import CentreOfMass
from pneumorph.mechanics import Programme, march
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison, ReportedCurve
from pneumorph.studies.reproductions.pneunet_segment import segment_curvatures
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import show

SOURCE = "A combined analytical and numerical study of locomotion of pneumatic-network soft robots"
CAVITIES = ("PN1", "PN2", "PN3")
PRESSURE = 0.013  # MPa
FEET = {"rear": "rear_foot", "front": "front_foot"}
FORWARD = (1.0, 0.0)
CLOSED_FORM = (0.002, 0.005, 0.008, 0.01, 0.013)  # MPa
# step of the study -> phase of the run
STEPS = {"i": "gravity", "ii": "+PN1", "iii": "+PN2", "iv": "+PN3", "v": "-PN1", "vi": "-PN2", "vii": "-PN3"}
# N, read off the study's figure: step -> rear, front
REPORTED = {"i": (5e-3, 5e-3), "ii": (2.5e-3, 7.5e-3)}
_REACH = 0.12  # mm: a thousandth of the beam
# s for a step: in 1 s the ends move at 80 mm/s, and how far depends on the inertia that large increments damp
_SECONDS = 10.0
_CREEP = 0.05 / _SECONDS  # mm/s: at rest the beam creeps 0.05 mm a step at most


def study(quick: bool) -> Study:
    """Return the study: the undulation once with large increments, or twice with smaller ones."""
    increment = 0.1 if quick else 0.05
    ramp = {
        "duration": show(_SECONDS, "time"),
        "inertia": "quasi-static",
        "first_increment": increment,
        "largest_increment": increment,
    }
    targets = {"gravity": {"gravity": "9.81 m/s2"}}
    targets |= {f"+{name}": {name: show(PRESSURE, "pressure")} for name in CAVITIES}
    targets |= {f"-{name}": {name: "0 kPa"} for name in CAVITIES}
    table = {
        "title": "PneuNet crawler in plane strain, undulation at 13 kPa",
        "measures": ["centre_of_mass_x", "centre_of_mass_y"],
        "actuator": {"template": "crawler-2d"},
        "mesh": {"size": "1.7 mm"},
        "gravity": {"direction": "-y"},
        "body": {"ground": {"shape": "half-space", "point": ["0 mm", show(-_REACH, "length")], "normal": "y"}},
        "contact": [
            {
                "name": "ground",
                "faces": list(FEET.values()),
                "body": "ground",
                "friction": 0.7,
                "reach": show(_REACH, "length"),
                "creep": show(_CREEP, "speed"),
            },
            {"name": "walls", "faces": ["outer", *FEET.values()]},
        ],
        "phase": [{"name": name, "targets": values, **ramp} for name, values in targets.items()],
        "cycle": {"phases": [name for name in targets if name != "gravity"], "repeat": 1 if quick else 2},
    }
    return study_from(table, "pneunet-2d")


def motion(solution: Solution, study: Study) -> Locomotion:
    """Return the motion of a run of the study."""
    return locomotion(solution.states, study.cycle_ends, [Foot(face) for face in FEET.values()], FORWARD)


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return forces of the ends, motion of the centre of mass and bending of a segment against what was reported."""
    found = motion(solution, study)
    return (
        *_forces(found), *_motion(found), *_step_size(solution, study, found), *apart(solution), *_bending(study)
    )  # fmt: skip


def curves(study: Study) -> tuple[ReportedCurve, ...]:
    """Return the reported forces of the two ends over the clock, at the ends of the phases."""
    clock = study.programme.clock
    times = np.array([clock(1.0 + list(STEPS).index(step)) for step in REPORTED])
    return tuple(
        ReportedCurve(
            f"reported, {end} end", "clock", f"contact_force_y:ground:{face}", times,
            np.array([forces[number] for forces in REPORTED.values()]), marks=True,
        )
        for number, (end, face) in enumerate(FEET.items())
    )  # fmt: skip


def _forces(found: Locomotion) -> list[Comparison]:
    rows = []
    up = {end: found.force[face][:, 1] for end, face in FEET.items()}
    for step, reported in REPORTED.items():
        at = _at(found, step)
        for (end, force), value in zip(up.items(), reported, strict=True):
            computed = None if at is None else 1e3 * float(force[at])
            rows.append(
                Comparison(
                    f"contact force of the {end} end", _condition(step), 1e3 * value, computed, "mN",
                    "1 mm thick; the half of the underside on that side of the middle bears it",
                )
            )  # fmt: skip
    notes = {"iv": "reported: equal again", "v": "reported: rear larger, over 1"}
    for step, note in notes.items():
        at = _at(found, step)
        ratio = None if at is None else float(up["rear"][at] / up["front"][at])
        rows.append(Comparison("force of the rear over the front end", _condition(step), 1.0, ratio, "", note))
    for step in ("i", "vii"):
        at = _at(found, step)
        share = None if at is None else float((up["rear"][at] + up["front"][at]) / found.weight)
        rows.append(Comparison("ground force over weight at rest", _condition(step), 1.0, share, "", "from statics"))
    return rows


def _motion(found: Locomotion) -> list[Comparison]:
    rows = []
    for number in range(len(found.ends) - 1):
        done = number < len(found.displacements)
        way = float(found.displacements[number, 0]) if done else None
        rows.append(
            Comparison(
                "displacement of the centre of mass", f"cycle {number + 1}", 0.0, way, "mm", "reported: forward, over 0"
            )
        )
    before, after = _at(found, "iii"), _at(found, "iv")
    ways = found.slip[FEET["front"]][:, 0]
    slid = None if before is None or after is None else float(ways[before + 1 : after + 1].sum())
    rows.append(
        Comparison("way of the front end", "in step iv, +PN3", 0.0, slid, "mm", "reported: it slides back, under 0")
    )
    rest = _at(found, "i")
    notes = {"iv": "reported: up, over 1", "vii": "reported: down again"}
    for step, note in notes.items():
        at = _at(found, step)
        height = None if rest is None or at is None else float(found.centre[at, 1] / found.centre[rest, 1])
        rows.append(
            Comparison("height of the centre of mass over that at rest", _condition(step), 1.0, height, "", note)
        )
    return rows


def _step_size(solution: Solution, study: Study, found: Locomotion) -> list[Comparison]:
    """Return how far the first cycle goes in increments twice as large, over how far it went; in a full run only."""
    first, last = study.cycle_ends[:2]
    before, after = found.at(first), found.at(last)
    if len(study.cycle_ends) < 3 or before is None or after is None:
        return []
    phases = study.programme.phases[:last]
    wider = [replace(phase, first=2.0 * phase.first, largest=2.0 * phase.largest) for phase in phases]
    way = float(found.centre[after, 0] - found.centre[before, 0])
    start = solution.states[before]
    share = None
    try:
        *_, end = march(start.model, Programme(tuple(wider)), study.settings, [start])
        centre = CentreOfMass("x")
        share = (centre(end) - centre(start)) / way
    except NotConvergedError:
        pass  # the row says that there is no such state
    note = "from theory: it should not depend on the increments; in half as many a step"
    return [Comparison("displacement in larger increments over that of the run", "cycle 1", 1.0, share, "", note)]


def apart(solution: Solution) -> list[Comparison]:
    """Return the smallest distance of surfaces in a run as a row."""
    least = solution.history.smallest("contact_distance:")
    return [Comparison("smallest distance of surfaces", "all states", 0.0, least, "mm", "over 0: nothing intersects")]


def _bending(study: Study) -> list[Comparison]:
    crawler = study.actuator
    if not isinstance(crawler, PlaneCrawler):
        raise InputError(f"expected a study of a plane crawler, received a {type(crawler).__name__}")
    shear = study.materials["body"].shear_modulus
    computed = segment_curvatures(crawler, study.materials, CLOSED_FORM)
    note = "reported: the study's closed form, tubes that touch in one line on a layer that does not stretch"
    return [
        Comparison(
            "curvature of one segment without weight", show(pressure, "pressure"),
            pneunet_curvature(shear, crawler.inner_radius, crawler.outer_radius, pressure), value, "1/mm", note,
        )
        for pressure, value in zip(CLOSED_FORM, computed, strict=True)
    ]  # fmt: skip


def _at(found: Locomotion, step: str) -> int | None:
    """Return the number of the state at the end of a step in the first cycle."""
    return found.at(1.0 + list(STEPS).index(step))


def _condition(step: str) -> str:
    return f"after step {step}, {STEPS[step]}"


register(
    Reproduction(
        name="pneunet-2d",
        title="PneuNet crawler in plane strain, undulation (system 2)",
        source=SOURCE,
        study=study,
        compare=compare,
        curves=curves,
        notes=(
            "Given by the study: three segments, R1 = 3 mm, R2 = 5 mm, shear moduli, friction 0.7, 13 kPa, the order "
            "of the steps. Assumed: five channels a segment, a layer of 0.2 mm, densities of 1070 and 965 kg/m³. With "
            "them the beam weighs 9.3 mN; the reported forces of its ends add up to 10 mN.",
            "Plane strain: the body is 1 mm thick, and forces are those of this slice.",
            "The channels are tubes that hold together along flat sides 2 mm high (corners rounded by 4 mm). A solid "
            "block, of the same weight with four channels, bends a third as much at 13 kPa and crawls backwards.",
            "Assumed: each step takes 10 s, with quasi-static damping; steps of 40 s change the way by 0.2 % (without "
            "self-contact, 5 increments a step). Friction holds below 0.005 mm/s.",
            "In step iv both ends bear the same, so that little decides which of them slides. One cycle takes the beam "
            "11.4, 12.2, 11.8 and 11.7 mm forward with 5, 10, 20 and 40 increments a step. In steps of 1 s inertia "
            "matters, and with it damping by larger increments: without self-contact 12.8, 15.3 and 17.5 mm with 5, 20 "
            "and 80.",
        ),
    )
)
