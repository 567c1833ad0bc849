"""What keeps the frames of free bodies rigid: a stiff energy of the Green strain E = (F'F - 1) / 2 of the frame,
    Psi = 1/2 k V E : E,   S = k E,
with V the volume of the frame and k (MPa) far above the moduli of what touches it. As in stiff parts of the soft body,
tangents take a stress that is carried along the steps of Newton's method to first order (see `kernels`): the iterations
of a body that turns are then those of one whose S is an unknown, whatever k is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.contact.free_body import Frame
from pneumorph.mechanics.contact.part import Entries, upper

Array = NDArray[np.float64]

STIFFER = 1e5  # k over the largest shear modulus of the model; with 1e7 light bodies lose digits in the linear solver


class Rigidity:
    """The stiff energy of some frames; stress arrays (frames, d, d), MPa, hold their S."""

    def __init__(self, frames: Sequence[Frame], stiffness: float):
        self.frames, self.stiffness = tuple(frames), stiffness

    def energy(self, position: Array) -> float:
        """Return the energy at positions (nodes, d), mJ."""
        return sum(0.5 * self.stiffness * f.volume * float(np.sum(strain(f, position) ** 2)) for f in self.frames)

    def stresses(self, position: Array) -> Array:
        """Return S."""
        return self.stiffness * np.array([strain(frame, position) for frame in self.frames])

    def carried(self, position: Array, step: Array) -> Array:
        """Return S after a step (nodes, d), to first order in it."""
        change = []
        for frame in self.frames:
            product = frame.gradient(position).T @ frame.gradient(step)
            change.append(0.5 * (product + product.T))
        return self.stresses(position) + self.stiffness * np.array(change)

    def add_force(self, position: Array, force: Array) -> None:
        """Add the forces with which the frames resist to nodal ones (nodes * d,)."""
        d = position.shape[1]
        for frame, stress in zip(self.frames, self.stresses(position), strict=True):
            own = frame.volume * frame.slopes @ stress @ frame.gradient(position).T
            force.reshape(-1, d)[frame.nodes] += own

    def tangent(self, position: Array, stresses: Array) -> Entries:
        """Return the derivative of the forces (upper triangle), its geometric part by the stresses that are given."""
        found = []
        for frame, stress in zip(self.frames, stresses, strict=True):
            f, g, d = frame.gradient(position), frame.slopes, position.shape[1]
            # dE = 1/2 (F' dF + dF' F),  dF = sum_a du_a g_a'
            along = np.einsum("ik,aj->aikj", f, g)
            bend = 0.5 * (along + along.swapaxes(2, 3))
            matrix = self.stiffness * np.einsum("aikj,blkj->aibl", bend, bend)
            matrix += np.einsum("ak,kj,bj,il->aibl", g, stress, g, np.eye(d))
            unknowns = (d * frame.nodes[:, None] + np.arange(d)).ravel()
            rows, columns = np.meshgrid(unknowns, unknowns, indexing="ij")
            found.append(upper(rows.ravel(), columns.ravel(), frame.volume * matrix.ravel()))
        rows, columns, values = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return rows, columns, values


def strain(frame: Frame, position: Array) -> Array:
    """Return the Green strain (d, d) of a frame at positions (nodes, d)."""
    f = frame.gradient(position)
    result: Array = 0.5 * (f.T @ f - np.eye(f.shape[1]))
    return result
