"""The fields that deformed shapes are coloured by, as values at the nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.measures import contact_pressure
from pneumorph.mechanics import State
from pneumorph.mechanics import fields as mechanics_fields
from pneumorph.mechanics.fields import BlockFields
from pneumorph.report import style
from pneumorph.units import printed_unit, to_printed

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Field:
    """A scalar field: `values(state)` are (nodes,) in inside units; `start` is its value at rest.

    share: of the nodes above the start that have a colour of their own; what is higher has that of the scale's end.
    """

    key: str
    label: str
    kind: str
    values: Callable[[State], Array]
    start: float = 0.0
    share: float = 0.998

    @property
    def colour_map(self) -> str:
        """Name of the colour map."""
        return style.COLOUR_MAPS.get(self.kind, "viridis")

    @property
    def title(self) -> str:
        """Label with the printed unit."""
        unit = printed_unit(self.kind)
        return f"{self.label} [{unit}]" if unit else self.label

    def limits(self, values: Sequence[Array]) -> tuple[float, float, float]:
        """Return the ends of the colour scale and the largest value for nodal values of states, in inside units.

        The scale ends where `share` of the nodes lie, mostly all but the highest 0.2 %: at the edge of a clamp a stress
        is singular, and a scale up to it would show nothing else.
        """
        above = [v[v > self.start] for v in values]
        high = max((float(np.quantile(v, self.share)) for v in above if len(v)), default=self.start)
        return self.start, max(high, self.start + 1e-12), max(float(v.max()) for v in values)

    def printed(self, value: float) -> float:
        """Return a value in the printed unit."""
        return to_printed(value, self.kind)


def displacement(state: State) -> Array:
    """Return the size of the displacement (nodes,), mm."""
    size = np.asarray(np.linalg.norm(state.displacement, axis=1))
    size[state.model.mesh.solid :] = 0.0  # the colours are those of the soft body, not of a rigid one that falls
    return size


def von_mises(state: State) -> Array:
    """Return the von Mises stress of the Cauchy stress (nodes,), MPa."""
    return _to_nodes(state, lambda part: mechanics_fields.von_mises(part.stress))


def largest_stretch(state: State) -> Array:
    """Return the largest principal stretch (nodes,)."""
    return _to_nodes(state, lambda part: mechanics_fields.principal_stretches(part.gradient)[..., 0])


def _to_nodes(state: State, of: Callable[[BlockFields], Array]) -> Array:
    """Return a field continued to the nodes, but not below its smallest value at the quadrature points."""
    parts = mechanics_fields.fields(state)
    least = min(float(of(part).min()) for part in parts)
    return np.maximum(mechanics_fields.to_nodes(state.model.mesh, parts, of), least)


FIELDS = (
    Field("displacement", "Displacement", "length", displacement),
    Field("von_mises", "Von Mises stress (Cauchy)", "stress", von_mises),
    Field("stretch", "Largest principal stretch", "number", largest_stretch, start=1.0),
)
# edges press with many times what faces do
CONTACT_PRESSURE = Field("contact_pressure", "Contact pressure", "pressure", contact_pressure, share=0.98)
