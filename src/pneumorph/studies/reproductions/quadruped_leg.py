"""System 2, one leg of the quadruped in the air: how far it curls with pressure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from pneumorph.geometry import Quadruped
from pneumorph.materials import Material
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, Symmetry, march
from pneumorph.mesh import generate

LEG = "PN1"


def leg_angles(
    robot: Quadruped, materials: Mapping[str, Material], pressures: Sequence[float], size: float | None = None
) -> list[float]:
    """Return the angle, rad, by which the tip of a leg turns down at rising pressures, MPa, without weight and ground.

    The undersides of the centre are held. size: of the mesh, mm; left out, that of the robot. Raises
    NotConvergedError where there is no such state.
    """
    half = replace(robot, half=True)
    mesh = generate(half, size)
    model = Model(
        mesh, dict(materials), (Clamp("belly_rear"), Clamp("belly_front"), Symmetry("symmetry_y")),
        cavities=(Cavity(LEG, (LEG,)),),
    )  # fmt: skip
    share = [pressure / pressures[-1] for pressure in pressures]
    phase = Phase("curl", {LEG: pressures[-1]}, marks=tuple(share[:-1]), largest=0.15)
    foot = mesh.face_nodes(f"foot_{LEG}")
    height = mesh.points[foot, 2]
    top = foot[height > half.height * (1.0 - 1e-6)]  # nodes of the tip's upper edge
    place = mesh.points[top, :2]
    below = foot[height < 1e-6 * half.height]
    low = [below[np.argmin(np.linalg.norm(mesh.points[below, :2] - p, axis=1))] for p in place]
    found = []
    for state in march(model, Programme((phase,))):
        if any(abs(state.time - mark) < 1e-9 for mark in share):
            up = (state.positions[top] - state.positions[low]).mean(axis=0)
            found.append(float(np.arctan2(np.hypot(up[0], up[1]), up[2])))
    return found
