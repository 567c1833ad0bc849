"""The full model of a design that was found, and how far its centre line is from the target."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pneumorph.errors import InputError
from pneumorph.geometry import BendingSkin
from pneumorph.measures import centre_line
from pneumorph.measures.faces import sample
from pneumorph.mechanics import State
from pneumorph.solution import Progress, Solution
from pneumorph.studies.design.search import Deviation
from pneumorph.studies.design.skin import SkinDesign, seam_angle
from pneumorph.studies.design.task import DesignTask
from pneumorph.studies.running import run_study

Array = NDArray[np.float64]

_SECTIONS = 24


@dataclass(frozen=True, eq=False)
class Verified:
    """What the full model says.

    solution: of the run. line (n, 3): its centre line in the last state, mm. deviation: of that from the target.
    nearest: state of the run, by its place in the history, that comes nearest; least: its deviation.
    """

    solution: Solution
    line: Array
    deviation: Deviation
    nearest: int
    least: Deviation


def verify(
    task: DesignTask,
    design: SkinDesign,
    folder: Path | None = None,
    *,
    resume: bool = False,
    progress: Callable[[Progress], None] | None = None,
) -> Verified:
    """Return what the full model makes of a design; arguments as in `solve`.

    A run that stops before its pressure is no error: the last state counts, and `solution.status` says so.
    """
    study = task.verification(design)
    return verified_by(task, design, run_study(study, folder, resume=resume, progress=progress, raise_on_stop=False))


def verified_by(task: DesignTask, design: SkinDesign, solution: Solution) -> Verified:
    """Return what a solution of the full model of a design says; raises InputError for one without a state beyond rest.
    """  # fmt: skip
    tube = task.verification(design).actuator
    assert isinstance(tube, BendingSkin)
    states = [state for state in solution.states if state.displacement.any()]
    lines = [state_line(state, tube) for state in states]
    if not states:
        raise InputError("the full model has no state under pressure: it says nothing of the design")
    deviations = [Deviation.of(line, task.target, fractions_of(line)) for line in lines]
    nearest = int(np.argmin([deviation.rms for deviation in deviations]))
    return Verified(solution, lines[-1], deviations[-1], states[nearest].index, deviations[nearest])


def state_line(state: State, tube: BendingSkin) -> Array:
    """Return the centre line (n, 3) of a state from the middle of the clamp to that of the tip, mm.

    As the surrogate has it: the seam of the map looks along x, so the mesh of a map with a mirror is turned.
    """
    inner = centre_line(state, "clamp", "tip", _SECTIONS).points
    points = np.vstack([np.zeros(3), inner, sample(state, "tip").moved_centre])
    if tube.half:  # faces and sections of a half have their centres beside the plane of symmetry
        points[:, 1] = 0.0
    turned: Array = Rotation.from_rotvec([0.0, 0.0, seam_angle(tube)]).apply(points)
    return turned


def fractions_of(line: Array) -> Array:
    """Return how far along its length each point (n, 3) of a line lies, from 0 to 1."""
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    return np.asarray(arc / arc[-1])
