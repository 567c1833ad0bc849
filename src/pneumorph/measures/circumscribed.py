"""Circumscribed diameter: the bore that a whole body just passes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneumorph.errors import InputError
from pneumorph.measures.diameter import enclosing_diameter
from pneumorph.measures.mirrors import completed, planes
from pneumorph.mechanics import State


@dataclass(frozen=True)
class CircumscribedDiameter:
    """Diameter of the smallest cylinder along `axis` around all nodes of some faces, images in symmetry included, mm.

    Of a straight body along `axis` it is the bore of the narrowest pipe that it passes. Only in three dimensions.
    Raises NameNotFoundError for a face, InputError for no face, an axis without length or a model in the plane.
    """

    faces: tuple[str, ...] = ("outer",)
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    name: str = "circumscribed_diameter"
    kind: str = "length"

    def __post_init__(self) -> None:
        if not self.faces:
            raise InputError(f"{self.name}: no faces, expected at least one")
        if len(self.axis) != 3 or not np.isfinite(self.axis).all() or not any(self.axis):
            raise InputError(f"{self.name}: axis = {self.axis}, expected 3 finite numbers, not all zero")

    def __call__(self, state: State) -> float:
        """Return the diameter, mm."""
        mesh = state.model.mesh
        if mesh.dimension != 3:
            raise InputError(f"{self.name}: expected a model in three dimensions, this one is {mesh.space}")
        axis = np.asarray(self.axis, dtype=float)
        nodes = np.unique(np.concatenate([mesh.face_nodes(face) for face in self.faces]))
        places = completed(state.positions[nodes], planes(state, axis))
        across = np.linalg.svd(axis[None, :])[2][1:]
        return enclosing_diameter(places @ across.T)
