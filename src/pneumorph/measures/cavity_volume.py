"""Volume of a cavity."""

from __future__ import annotations

from dataclasses import dataclass

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.mechanics import State


@dataclass(frozen=True)
class CavityVolume:
    """Volume that a cavity encloses, mm3; `added` takes that of the reference off. Of the modelled part where the model
    has symmetry planes. Raises NameNotFoundError for a cavity."""

    cavity: str
    added: bool = False
    name: str = "cavity_volume"
    kind: str = "volume"

    def __call__(self, state: State) -> float:
        """Return the volume, mm3."""
        if self.cavity not in state.volume:
            raise NameNotFoundError(f"{self.name}: " + unknown_name("cavity", self.cavity, state.volume))
        start = state.model.surfaces[self.cavity].reference_volume if self.added else 0.0
        return float(state.volume[self.cavity] - start)
