"""What the gaits of the pipe robot share: bore and phases in a study file, the motion, and rows on its cycles."""

from __future__ import annotations

import math
from typing import Any

from pneumorph.gaits import Foot, Gait, Locomotion, locomotion
from pneumorph.mechanics import Phase
from pneumorph.solution import Solution
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.study import Study
from pneumorph.units import show

PIPE = "pipe"
FEET = ("rear", "front")
FRICTION = 0.7  # assumed
FORWARD = (0.0, 0.0, 1.0)
_KINDS = {"gravity": "acceleration"}


def in_pipe(diameter: float, reach: str, creep: str, height: float = 0.0) -> dict[str, Any]:
    """Return the sections of a pipe along z and of its contact with both prisms; mm, height: y of the pipe's axis."""
    point = ["0 mm", show(height, "length"), "0 mm"]
    bore = {"shape": "pipe", "point": point, "radius": show(diameter / 2.0, "length"), "axis": "z"}
    contact = {"name": PIPE, "faces": list(FEET), "body": PIPE, "friction": FRICTION, "reach": reach, "creep": creep}
    return {"body": {PIPE: bore}, "contact": [contact]}


def phases_and_cycle(gait: Gait) -> dict[str, Any]:
    """Return the sections of a gait."""
    return {
        "phase": [_phase(phase) for phase in (*gait.settle, *gait.phases)],
        "cycle": {"phases": [phase.name for phase in gait.phases], "repeat": gait.cycles},
    }


def _phase(phase: Phase) -> dict[str, Any]:
    """Return a phase as the section of a study file."""
    targets = {name: show(value, _KINDS.get(name, "pressure")) for name, value in phase.targets.items()}
    return {
        "name": phase.name,
        "targets": targets,
        "first_increment": phase.first,
        "largest_increment": phase.largest,
        "duration": show(phase.duration or 0.0, "time"),
        "inertia": phase.inertia,
    }


def motion(solution: Solution, study: Study) -> Locomotion:
    """Return the motion of a run of a study with both prisms as feet."""
    return locomotion(solution.states, study.cycle_ends, [Foot(face, PIPE) for face in FEET], FORWARD)


def cycle_rows(found: Locomotion, solution: Solution) -> tuple[Comparison, ...]:
    """Return way, slip of the ends and cost of each cycle, and the smallest distance to the pipe."""
    rows = []
    for number in range(len(found.ends) - 1):
        done = number < len(found.displacements)
        cycle = f"cycle {number + 1}"
        way = float(found.displacements[number, 2]) if done else None
        rows.append(Comparison("displacement of the centre of mass", cycle, 0.0, way, "mm", "reported: over 0"))
        for end in FEET:
            slid = float(found.backward_slip[end][number]) if done else None
            rows.append(Comparison(f"way that the {end} end slid back", cycle, 0.0, slid, "mm", "the less the better"))
        cost = float(found.cost_of_transport[number]) if done else None
        cost = cost if cost is None or math.isfinite(cost) else None
        rows.append(Comparison("cost of transport", cycle, 0.0, cost, "", "work delivered over weight and way"))
    least = solution.history.smallest("contact_distance:")
    rows.append(Comparison("smallest distance to the pipe", "all states", 0.0, least, "mm", "over 0: none intersect"))
    return tuple(rows)
