"""System 1, part earthworm: the robot of two prisms and a bellows climbs through the 84 mm pipe."""

from __future__ import annotations

from typing import Any

from pneumorph.gaits import Gait, earthworm
from pneumorph.mechanics import Phase
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions.hexagonal_expansion import DIAMETER, SOURCE, mirrors
from pneumorph.studies.reproductions.pipe_gaits import FEET, PIPE, cycle_rows, in_pipe, motion, phases_and_cycle
from pneumorph.studies.reproductions.reproduction import Reproduction, register
from pneumorph.studies.study import Study, study_from
from pneumorph.units import EARTH

NAME = "hexagonal-prism-earthworm"
# MPa: what presses an end against the pipe, and what lengthens the bellows
GRIP, STRETCH = 0.100, 0.006


def study(quick: bool) -> Study:
    """Return the study: a quarter of a short robot climbs twice, or quickly once on a coarser mesh in larger steps."""
    step = 0.25 if quick else 0.1
    ramp: dict[str, Any] = {"duration": 10.0, "inertia": "quasi-static", "first": step, "largest": step}
    settle = (Phase("gravity", {"gravity": EARTH}, **ramp),)
    rear, front = (tuple(f"{end}_{number}" for number in (1, 2)) for end in FEET)
    gait = earthworm(rear, "middle", front, GRIP, STRETCH, settle=settle, cycles=1 if quick else 2, **ramp)
    return study_from(_table(gait, quick), NAME)


def _table(gait: Gait, quick: bool) -> dict[str, Any]:
    """Return the study of the gait as plain data."""
    return {
        "title": "Pipe robot, earthworm gait up the 84 mm pipe",
        "measures": ["centre_of_mass_z", f"normal_force:{PIPE}"],
        "actuator": {"template": "pipe-robot", "quarter": True, "chambers": 1, "length": "12 mm"},
        "mesh": {"size": "coarse" if quick else "automatic"},
        "gravity": {"direction": "-z"},
        "support": mirrors("xy"),
        # an end that meets the pipe in one increment may jump to and fro: then a smaller one is quicker
        "solver": {"contact_iterations": 25},
        **in_pipe(DIAMETER, reach="0.1 mm", creep="0.05 mm/s"),
        **phases_and_cycle(gait),
    }


def compare(solution: Solution, study: Study) -> tuple[Comparison, ...]:
    """Return the way of each cycle, slip of the ends and cost; the study reports that the robot moves forward."""
    return cycle_rows(motion(solution, study), solution)


register(
    Reproduction(
        name=NAME,
        title="Pipe robot, earthworm gait in the 84 mm pipe (system 1)",
        source=SOURCE,
        study=study,
        compare=compare,
        notes=(
            "Given by the study: section of the prisms, order of the parts, bore of 84 mm. Assumed: the elongation "
            "actuator (a bellows of five rings, 28 mm in radius, walls 3 mm), friction 0.7, 100 kPa in the ends and "
            "6 kPa in the bellows.",
            "The robot is short: one ring of six chambers a prism in place of eleven, 12 mm long, so that a cycle "
            "takes minutes. A ring alone has no neighbours to push it out; it meets the pipe at 77 kPa.",
            "A quarter is solved, with two planes of symmetry, so gravity can only act along the pipe: the robot "
            "climbs a vertical one, the hardest case. Forces in the history are those of the quarter, but for "
            "normal_force.",
            "Each phase takes 10 s with quasi-static damping; friction holds below 0.05 mm/s.",
        ),
    )
)
