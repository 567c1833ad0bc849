"""How far a body is moved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.mechanics import State


@dataclass(frozen=True)
class LargestDisplacement:
    """Largest size of the displacement of a node, mm.

    domain: the material domains that count; None: all. Raises NameNotFoundError for one that is not there.
    """

    domain: tuple[str, ...] | None = None
    name: str = "largest_displacement"
    kind: str = "length"

    def __call__(self, state: State) -> float:
        """Return the displacement, mm."""
        mesh = state.model.mesh
        chosen = mesh.domains if self.domain is None else self.domain
        for name in chosen:
            if name not in mesh.domains:
                raise NameNotFoundError(unknown_name("domain", name, mesh.domains))
        nodes = np.concatenate([block.nodes.ravel() for block in mesh.blocks if block.domain in chosen])
        return float(np.linalg.norm(state.displacement[nodes], axis=1).max())
