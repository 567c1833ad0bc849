"""Gripper -> copies of one finger's grid around its axis."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from pneumorph.geometry.gripper import Gripper
from pneumorph.mesh.finger import mesh_finger
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh


def mesh_gripper(gripper: Gripper, size: float) -> Mesh:
    """Return the fingers in their places, all of one domain; size: largest edge, mm. Raises MeshError if too large."""
    one = mesh_finger(gripper.finger, size, half=gripper.half)
    starts = len(one.points) * np.arange(len(gripper.angles))
    points = np.concatenate([gripper.place(one.points, turn) for turn in gripper.angles])
    blocks = tuple(
        CellBlock(block.kind, block.domain, np.concatenate([block.nodes + start for start in starts]))
        for block in one.blocks
    )
    faces: dict[str, tuple[FaceBlock, ...]] = {}
    for name, sides in one.faces.items():
        for number, start in enumerate(starts, 1):
            own = name if name in gripper.face_names else f"{name}_{number}"
            copies = (FaceBlock(side.kind, side.nodes + start) for side in sides)
            faces[own] = (*faces.get(own, ()), *copies)
    return Mesh(points, blocks, MappingProxyType(faces))
