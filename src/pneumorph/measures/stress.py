"""Stress and stretch: largest, volume-averaged, at points and along paths.

Quantities (Cauchy stresses in MPa; axes x, y, z; z is across the plane in plane strain, the hoop direction with axial
symmetry): von_mises, largest_principal_stress, smallest_principal_stress, mean_stress (a third of the trace),
stress_xx .. stress_zx, largest_stretch, middle_stretch, smallest_stretch, equivalent_strain (von Mises's of the
logarithmic strain).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.measures.locate import locate
from pneumorph.mechanics import State
from pneumorph.mechanics.fields import BlockFields, fields, principal, to_nodes, von_mises

Array = NDArray[np.float64]
Quantity = Callable[[Array, Array], Array]
Domains = str | tuple[str, ...] | None


def _component(i: int, j: int) -> Quantity:
    return lambda stress, _: stress[..., i, j]


def _principal_stress(number: int) -> Quantity:
    return lambda stress, _: principal(stress)[..., number]


def _stretch(number: int) -> Quantity:
    return lambda _, right: np.sqrt(np.maximum(principal(right)[..., number], 0.0))


def _equivalent_strain(_: Array, right: Array) -> Array:
    """Return sqrt(2/3 e:e) with the deviator e of Hencky's logarithmic strain: in uniaxial tension ln(stretch)."""
    strain = 0.5 * np.log(np.maximum(principal(right), 1e-300))
    deviator = strain - strain.mean(axis=-1, keepdims=True)
    return np.asarray(np.sqrt(2.0 / 3.0 * (deviator**2).sum(axis=-1)))


# name -> (kind of unit, function of the Cauchy stress and C, both (..., 3, 3))
QUANTITIES: dict[str, tuple[str, Quantity]] = {
    "von_mises": ("stress", lambda stress, _: von_mises(stress)),
    "largest_principal_stress": ("stress", _principal_stress(0)),
    "smallest_principal_stress": ("stress", _principal_stress(2)),
    "mean_stress": ("stress", lambda stress, _: np.trace(stress, axis1=-2, axis2=-1) / 3.0),
    "stress_xx": ("stress", _component(0, 0)),
    "stress_yy": ("stress", _component(1, 1)),
    "stress_zz": ("stress", _component(2, 2)),
    "stress_xy": ("stress", _component(0, 1)),
    "stress_yz": ("stress", _component(1, 2)),
    "stress_zx": ("stress", _component(2, 0)),
    "largest_stretch": ("number", _stretch(0)),
    "middle_stretch": ("number", _stretch(1)),
    "smallest_stretch": ("number", _stretch(2)),
    "equivalent_strain": ("number", _equivalent_strain),
}


def quantity(name: str) -> tuple[str, Quantity]:
    """Return unit kind and function of a quantity; raises NameNotFoundError with the nearest name."""
    if name not in QUANTITIES:
        raise NameNotFoundError(unknown_name("quantity", name, QUANTITIES))
    return QUANTITIES[name]


def _parts(state: State, domain: Domains) -> list[BlockFields]:
    """Return the fields of one domain, of several, or of all; raises NameNotFoundError."""
    known = state.model.mesh.domains
    chosen = known if domain is None else (domain,) if isinstance(domain, str) else domain
    for name in chosen:
        if name not in known:
            raise NameNotFoundError(unknown_name("domain", name, known))
    return [part for part in fields(state) if part.block.domain in chosen]


@dataclass(frozen=True)
class _StressMeasure:
    quantity: str = "von_mises"
    domain: Domains = None
    name: str = ""

    def __post_init__(self) -> None:
        quantity(self.quantity)
        if not self.name:
            of = ",".join(self.domain) if isinstance(self.domain, tuple) else self.domain
            object.__setattr__(self, "name", f"{self._prefix}_{self.quantity}" + (f":{of}" if of else ""))

    @property
    def _prefix(self) -> str:
        raise NotImplementedError

    @property
    def kind(self) -> str:
        """Kind of unit."""
        return quantity(self.quantity)[0]


@dataclass(frozen=True)
class LargestStress(_StressMeasure):
    """Largest value of a quantity at the quadrature points of a domain, or of several (None: of all).

    At a re-entrant corner or clamp edge the exact value is infinite: it then grows as the mesh is refined.
    Raises NameNotFoundError for a quantity or domain.
    """

    @property
    def _prefix(self) -> str:
        return "peak"

    def place(self, state: State) -> tuple[float, Array]:
        """Return the value and where it is in the reference (d,), mm."""
        best, where = -np.inf, np.zeros(state.model.mesh.dimension)
        for part in _parts(state, self.domain):
            values = quantity(self.quantity)[1](part.stress, part.right_cauchy_green)
            index = np.unravel_index(int(np.argmax(values)), values.shape)
            if values[index] > best:
                best, where = float(values[index]), part.place[index]
        return best, where

    def __call__(self, state: State) -> float:
        """Return the value, MPa or a stretch."""
        return self.place(state)[0]


@dataclass(frozen=True)
class MeanStress(_StressMeasure):
    """Average of a quantity over the reference volume of a domain, or of several (None: of all).

    Raises NameNotFoundError for a quantity or domain.
    """

    @property
    def _prefix(self) -> str:
        return "average"

    def __call__(self, state: State) -> float:
        """Return the value, MPa or a stretch."""
        total, volume = 0.0, 0.0
        for part in _parts(state, self.domain):
            values = quantity(self.quantity)[1](part.stress, part.right_cauchy_green)
            total += float((part.volume * values).sum())
            volume += float(part.volume.sum())
        return total / volume


@dataclass(frozen=True)
class StressQuantile(_StressMeasure):
    """The value of a quantity that a share of the volume of a domain, or of several (None: of all), does not exceed.

    share: 0 to 1. Unlike the largest value it settles as the mesh is refined, also where corners are sharp.
    Raises InputError for the share, NameNotFoundError for a quantity or domain.
    """

    share: float = 0.99

    def __post_init__(self) -> None:
        if not 0.0 < self.share < 1.0:
            raise InputError(f"stress quantile: share = {self.share!r}, allowed: between 0 and 1")
        super().__post_init__()

    @property
    def _prefix(self) -> str:
        return f"{100.0 * self.share:g}_percent"

    def __call__(self, state: State) -> float:
        """Return the value, MPa or a stretch."""
        parts = _parts(state, self.domain)
        function = quantity(self.quantity)[1]
        values = np.concatenate([function(part.stress, part.right_cauchy_green).ravel() for part in parts])
        volume = np.concatenate([part.volume.ravel() for part in parts])
        order = np.argsort(values)
        below = np.cumsum(volume[order])
        return float(values[order][np.searchsorted(below, self.share * below[-1])])


@dataclass(frozen=True)
class StressAt:
    """A quantity at a material point, given by its place in the reference, mm.

    Raises NameNotFoundError for a quantity, InputError for a point outside the body.
    """

    point: tuple[float, ...]
    quantity: str = "von_mises"
    name: str = ""

    def __post_init__(self) -> None:
        quantity(self.quantity)
        if not self.name:
            place = ",".join(f"{x:g}" for x in self.point)
            object.__setattr__(self, "name", f"{self.quantity}@({place})")

    @property
    def kind(self) -> str:
        """Kind of unit."""
        return quantity(self.quantity)[0]

    def __call__(self, state: State) -> float:
        """Return the value, MPa or a stretch."""
        return float(at_points(state, np.array([self.point]), self.quantity)[0])


def tensors_at(state: State, points: Array) -> tuple[Array, Array]:
    """Return Cauchy stress and C (n, 3, 3) at reference points (n, d), mm; raises InputError for one outside the body.

    Both are averaged to the nodes of the domain that the point lies in, then interpolated in its cell.
    """
    mesh = state.model.mesh
    places = locate(mesh, points)
    stress, right = np.empty((len(places.block), 3, 3)), np.empty((len(places.block), 3, 3))
    domains = np.array([mesh.blocks[number].domain for number in places.block])
    for domain in dict.fromkeys(domains.tolist()):
        parts = _parts(state, domain)
        here = domains == domain
        stress[here] = places.interpolate(to_nodes(mesh, parts, lambda part: part.stress), here)
        right[here] = places.interpolate(to_nodes(mesh, parts, lambda part: part.right_cauchy_green), here)
    return stress, right


def at_points(state: State, points: Array, name: str) -> Array:
    """Return a quantity (n,) at reference points (n, d), mm; raises as `tensors_at`, NameNotFoundError for its name."""
    function = quantity(name)[1]
    return function(*tensors_at(state, points))


@dataclass(frozen=True, eq=False)
class PathValues:
    """Values along a path: distance (n,) from its start in the reference, mm; place (n, d), mm; values by quantity."""

    distance: Array
    place: Array
    values: dict[str, Array]


def along_path(
    state: State, corners: ArrayLike, quantities: Sequence[str] = ("von_mises",), samples: int = 50
) -> PathValues:
    """Return quantities at evenly spaced points of a polyline of material points.

    corners: (m, d), m >= 2, its corners in the reference, mm. Raises InputError for fewer than two corners or samples,
    corners that coincide, or a path that leaves the body; NameNotFoundError for a quantity.
    """
    line = np.asarray(corners, dtype=float)
    if line.ndim != 2 or len(line) < 2 or samples < 2:
        raise InputError(
            f"path of shape {line.shape} with {samples} samples: expected at least two corners and samples"
        )
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    if not (lengths > 0.0).all():
        raise InputError("path: corners coincide, expected different ones")
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    distance = np.linspace(0.0, ends[-1], samples)
    place = np.column_stack([np.interp(distance, ends, column) for column in line.T])
    functions = {name: quantity(name)[1] for name in quantities}
    stress, right = tensors_at(state, place)
    return PathValues(distance, place, {name: function(stress, right) for name, function in functions.items()})
