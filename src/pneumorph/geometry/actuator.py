"""What every actuator template shares: described dimensions, their checks, and the names of its faces."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from numbers import Integral, Real
from typing import Any

from pneumorph.errors import GeometryError
from pneumorph.geometry.occ import Shape


@dataclass(frozen=True)
class Dimension:
    """One row of an actuator's table: its field name, symbol, value, kind ("length", "count" or "angle") and source.

    `given` is True if the study states the value, False if it is assumed.
    """

    name: str
    symbol: str
    value: float
    kind: str
    given: bool
    help: str


def millimetres(default: float, symbol: str, help: str, *, given: bool = False, zero: bool = False) -> Any:
    """Declare a length in mm: positive, or not negative with `zero`."""
    metadata = {"symbol": symbol, "given": given, "help": help, "kind": "length", "minimum": 0.0, "open": not zero}
    return field(default=default, metadata=metadata)


def whole_number(default: int, symbol: str, help: str, *, given: bool = False) -> Any:
    """Declare a count: a whole number of at least 1."""
    return field(default=default, metadata={"symbol": symbol, "given": given, "help": help, "kind": "count"})


def angle(default: float, symbol: str, help: str, *, given: bool = False) -> Any:
    """Declare an angle in rad, of either sign."""
    return field(default=default, metadata={"symbol": symbol, "given": given, "help": help, "kind": "angle"})


@dataclass(frozen=True)
class Actuator(ABC):
    """Base of the templates. A template is frozen and checked: one that exists makes a closed solid.

    Raises GeometryError for a dimension that is not a finite number in its range, or dimensions that do not fit.
    """

    def __post_init__(self) -> None:
        for item in fields(self):
            if "kind" in item.metadata:
                _check(type(self).__name__, item.name, getattr(self, item.name), item.metadata)
        self._check_fit()

    @abstractmethod
    def _check_fit(self) -> None:
        """Raise GeometryError if the dimensions do not fit together."""

    @abstractmethod
    def shape(self) -> Shape:
        """Return the solid with named faces and material domains (for `geometry.occ`)."""

    @property
    @abstractmethod
    def cavities(self) -> tuple[str, ...]:
        """Names of the pressurised cavities; each is also the name of all its faces."""

    def cavity_faces(self, cavity: str) -> tuple[str, ...]:
        """Names of the faces that bound a cavity: those that bear its name."""
        return (cavity,)

    @property
    @abstractmethod
    def face_names(self) -> tuple[str, ...]:
        """Names of all faces of the solid; every face has exactly one."""

    @property
    @abstractmethod
    def bending_walls(self) -> Mapping[str, float]:
        """Thickness in mm of each wall that bends or stretches, by name."""

    @property
    @abstractmethod
    def default_size(self) -> float:
        """Largest edge of the automatic mesh, mm."""

    @property
    def face_sizes(self) -> Mapping[str, float]:
        """Largest edge in mm on faces whose curvature asks for more than the mesh's size, by face name."""
        return {}

    @property
    @abstractmethod
    def cavity_volume(self) -> float:
        """Volume of one cavity as drawn, mm³."""

    @property
    def space(self) -> str:
        """'3d', or 'plane_strain' for a template that lies in the plane of x and y."""
        return "3d"

    @property
    def axis(self) -> tuple[float, float, float]:
        """Unit vector from the clamp to the tip."""
        return (0.0, 0.0, 1.0)

    @property
    def domains(self) -> tuple[str, ...]:
        """Names of the material domains."""
        return ("body",)

    def dimensions(self) -> tuple[Dimension, ...]:
        """Return the table of dimensions in the order of the fields."""
        return tuple(
            Dimension(item.name, data["symbol"], getattr(self, item.name), data["kind"], data["given"], data["help"])
            for item in fields(self)
            if "kind" in (data := item.metadata)
        )

    def _require(self, good: bool, message: str) -> None:
        if not good:
            raise GeometryError(f"{type(self).__name__}: {message}")


def _check(owner: str, name: str, value: object, data: Mapping[str, Any]) -> None:
    if data["kind"] == "count":
        if not isinstance(value, Integral) or isinstance(value, bool) or value < 1:
            raise GeometryError(f"{owner}: {name} = {value!r}: expected a whole number of at least 1")
        return
    unit = "rad" if data["kind"] == "angle" else "mm"
    if not isinstance(value, Real) or isinstance(value, bool) or not math.isfinite(value):
        raise GeometryError(f"{owner}: {name} = {value!r}: expected a finite number in {unit}")
    if data["kind"] == "angle":
        return
    if value < 0.0 or (data["open"] and value == 0.0):
        allowed = "greater than 0" if data["open"] else "of at least 0"
        raise GeometryError(f"{owner}: {name} = {value:g} mm: expected a length {allowed}")
