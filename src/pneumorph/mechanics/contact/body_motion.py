"""Where a free body is and how it moves, from the nodes of its frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pneumorph.mechanics.contact.free_body import Frame
from pneumorph.mechanics.contact.rigidity import strain

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """Place and motion of a free body.

    centre (d,): of mass, mm; velocity (d,): of it, mm/s, zero in states without inertia.
    rotation: since the start, as axis times angle, rad, up to half a turn: (3,), in the plane (1,) about z;
    spin: angular velocity in the same form, rad/s.
    strain: largest principal Green strain of its frame, 0 for a perfectly rigid one.
    """

    centre: Array
    velocity: Array
    rotation: Array
    spin: Array
    strain: float


def motion_of(frame: Frame, position: Array, velocity: Array | None) -> BodyMotion:
    """Return the motion of a frame at positions and velocities (nodes, d) of all nodes; None where nothing moves."""
    moving = np.zeros_like(position) if velocity is None else velocity
    gradient = frame.gradient(position)
    left, _, right = np.linalg.svd(gradient)
    turned = left @ right  # of the polar decomposition
    rate = frame.gradient(moving) @ turned.T
    rate = 0.5 * (rate - rate.T)
    if len(turned) == 2:
        rotation, spin = np.array([np.arctan2(turned[1, 0], turned[0, 0])]), np.array([rate[1, 0]])
    else:
        rotation = Rotation.from_matrix(turned).as_rotvec()
        spin = np.array([rate[2, 1], rate[0, 2], rate[1, 0]])
    largest = float(np.abs(np.linalg.eigvalsh(strain(frame, position))).max())
    return BodyMotion(position[frame.nodes].mean(axis=0), moving[frame.nodes].mean(axis=0), rotation, spin, largest)
