"""System 1, part inchworm: the robot lies in the 115 mm pipe and bends its prisms until they are wedged in it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from pneumorph.gaits import Gait, inchworm
from pneumorph.geometry import PipeRobot
from pneumorph.measures.normal_force import contact_number, normal_forces
from pneumorph.mechanics import Phase, State
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions.hexagonal_expansion import SOURCE, mirrors, printed
from pneumorph.studies.reproductions.pipe_gaits import FEET, PIPE, cycle_rows, in_pipe, motion, phases_and_cycle
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import EARTH, show

NAME = "hexagonal-prism-inchworm"
DIAMETER = 115.0  # mm, bore of the second test pipe
DRIVE = 80.0  # kPa, reported for the bending mode
# MPa: what bends a prism until it is wedged, and what lengthens the bellows
BEND, STRETCH = 0.128, 0.008
# the row below, which with its image in the cut lifts the end of a prism
REAR, FRONT = (f"{end}_6" for end in FEET)
REACH = 0.8  # mm
ROBOT = PipeRobot(half=True, chambers=2, chamber_length=30.0, gap=38.0, rings=3)


def study(quick: bool) -> Study:
    """Return the study: half a robot of two long chambers a row goes through one cycle, quickly in larger steps."""
    step = 0.125 if quick else 0.0625
    slow: dict[str, Any] = {"duration": 10.0, "inertia": "quasi-static"}
    settle = (Phase("gravity", {"gravity": EARTH}, first=0.5, largest=0.5, **slow),)
    gait = inchworm((REAR,), "middle", (FRONT,), BEND, STRETCH, settle=settle, first=step, largest=step, **slow)
    return study_from(_table(_hastened(gait, 2.0 * step)), NAME)


def _hastened(gait: Gait, step: float) -> Gait:
    """Return the gait with larger increments where the bellows alone moves: no wall balloons then."""
    alone = [set(phase.targets) == {"middle"} for phase in gait.phases]
    phases = (
        replace(phase, first=step, largest=step) if on else phase for phase, on in zip(gait.phases, alone, strict=True)
    )
    return replace(gait, phases=tuple(phases))


def _table(gait: Gait) -> dict[str, Any]:
    """Return the study of the gait as plain data."""
    return {
        "title": "Pipe robot, inchworm gait in the 115 mm pipe",
        "measures": ["centre_of_mass_z", "centre_of_mass_y", f"normal_force:{PIPE}"],
        "actuator": {
            "template": "pipe-robot",
            "half": True,
            "chambers": ROBOT.chambers,
            "chamber_length": show(ROBOT.chamber_length, "length"),
            "gap": show(ROBOT.gap, "length"),
            "rings": ROBOT.rings,
        },
        "mesh": {"size": "coarse"},
        "gravity": {"direction": "-y"},
        "support": mirrors("x"),
        # an increment in which a wall balloons or an end meets the pipe is quicker in two
        "solver": {"contact_iterations": 15, "tolerance": 1e-6, "cut": 0.5},
        **in_pipe(DIAMETER, reach=show(REACH, "length"), creep="0.1 mm/s", height=lying_height()),
        **phases_and_cycle(gait),
    }


def lying_height() -> float:
    """Return the height of the pipe's axis over that of the robot, mm, when its lowest edges are a reach off the pipe.

    The lowest edges are those of the row that looks 60 degrees down from x.
    """
    outward, along = np.array([0.5, -math.sqrt(0.75)]), np.array([math.sqrt(0.75), 0.5])
    middle = (ROBOT.apothem + ROBOT.block_height) * outward
    edges = [middle + side * ROBOT.block_width / 2.0 * along for side in (-1.0, 1.0)]
    return min(float(y) + math.sqrt((DIAMETER / 2.0 - REACH) ** 2 - float(x) ** 2) for x, y in edges)


def wedging_pressure(solution: Solution) -> float | None:
    """Return the pressure, MPa, of the first state in which the rear prism is pressed from above as well."""
    for state in solution.states:
        if state.touches and pressed_from_above(state, "rear"):
            return state.pressure[REAR]
    return None


def pressed_from_above(state: State, end: str) -> bool:
    """Return whether the pipe pushes a node of an end rather down than aside."""
    number = contact_number(state.model, PIPE, NAME)
    push = normal_forces(state, number)[state.model.mesh.face_nodes(end)]
    return bool((push[:, 1] < -np.abs(push[:, 0])).any())


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return the pressure at which a prism is wedged, then way, slip of the ends and cost of each cycle."""
    held = printed(wedging_pressure(solution))
    note = "first state; reported is the drive pressure of the bending mode"
    wedged = Comparison("pressure at which the rear prism is wedged", "", DRIVE, held, "kPa", note)
    return (wedged, *cycle_rows(motion(solution, study), solution))


register(
    Reproduction(
        name=NAME,
        title="Pipe robot, inchworm gait in the 115 mm pipe (system 1)",
        source=SOURCE,
        study=study,
        compare=compare,
        notes=(
            "Given by the study: section of the prisms and their length, order of the parts, bore of 115 mm, that ends "
            "bend to anchor. Assumed: the elongation actuator (a bellows of three rings, 28 mm in radius, walls "
            f"3 mm), friction 0.7, {show(BEND, 'pressure')} in a row and {show(STRETCH, 'pressure')} in the bellows.",
            "Two chambers of 30 mm a row stand for eleven of 4 mm: a quarter of the unknowns. They hold more air "
            "(60 mm of the length in place of 44 mm), have no neighbours to push, and bend more.",
            "Half of the robot is solved, with one plane of symmetry. It lies in a level pipe; the rows below (5 and "
            "6) lift the far end of a prism until the pipe holds it from below and above. Forces in the history are "
            "those of the half, but for normal_force.",
            "Only the prisms may touch the pipe, and no walls each other: above 90 kPa the side walls of a filled row "
            "reach into its neighbours', by up to 4 mm. Real ones would push each other, which is left out.",
            "Pushes of the pipe begin 0.8 mm away from it. Each phase takes 10 s with quasi-static damping; friction "
            "holds below 0.1 mm/s.",
        ),
    )
)
