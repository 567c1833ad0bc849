"""Where the centre of mass is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.mechanics import Model, State
from pneumorph.mechanics.loads import density_of, lumped_mass

Array = NDArray[np.float64]


@lru_cache(maxsize=4)
def nodal_mass(model: Model, domains: tuple[str, ...] | None = None) -> Array:
    """Return mass by node (nodes,), tonne, work-equivalent; raises InputError for a material without a density.

    domains: those that have mass here; by default all.
    """
    density = {
        name: density_of(item, name, "the centre of mass") if domains is None or name in domains else 0.0
        for name, item in model.materials.items()
    }
    return lumped_mass(model.mesh, density, False)


@dataclass(frozen=True)
class CentreOfMass:
    """One coordinate of the centre of mass, mm; axis: 'x', 'y' or 'z'. Raises InputError for another axis.

    domain: the material domains that are weighed; None: all.
    """

    axis: str
    kind: str = "length"
    domain: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if self.axis not in ("x", "y", "z"):
            raise InputError(f"centre_of_mass: axis = {self.axis!r}, allowed: x, y, z")

    @property
    def name(self) -> str:
        """Name of its column."""
        return f"centre_of_mass_{self.axis}"

    def vector(self, state: State) -> Array:
        """Return the centre of mass (d,), mm."""
        mass = nodal_mass(state.model, self.domain)
        return np.asarray(mass @ state.positions / mass.sum())

    def __call__(self, state: State) -> float:
        """Return the coordinate; raises InputError for an axis that the mesh does not have, or without densities."""
        number = "xyz".index(self.axis)
        if number >= state.model.mesh.dimension:
            raise InputError(f"{self.name}: a plane model has no axis {self.axis}, allowed: x, y")
        return float(self.vector(state)[number])
