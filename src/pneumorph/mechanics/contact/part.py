"""What one contact adds to a system: energy, forces, tangent; and what is reported of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Entries = tuple[Integers, Integers, Array]

NO_ENTRIES: Entries = (np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64), np.empty(0))


@dataclass(frozen=True, eq=False)
class Part:
    """One potential at one place.

    energy: mJ; gradient (unknowns,): the force with which it resists, N, to be added to the internal forces.
    entries: rows, columns (rows <= columns) and values of its Hessian, upper triangle, duplicates allowed.
    push (d,): derivative by the place of the obstacle, N; coupling (unknowns,): that of the gradient by the way
    of the obstacle along its direction.
    """

    energy: float
    gradient: Array
    entries: Entries
    push: Array
    coupling: Array


@dataclass(frozen=True, eq=False)
class Place:
    """Where everything is: position (nodes, d) of the mesh, and way (mm) of the obstacle along its direction."""

    position: Array
    way: float = 0.0


@dataclass(frozen=True)
class Touch:
    """What is reported of a contact in a state.

    force: on the named faces (`against` gets the opposite), N; friction: the tangential part of it in it.
    by_face: the force on each face, and on each free body, `against` included. area: of the named faces within reach,
    mm2; pressure: largest at a node, MPa; both as the body is deformed.
    distance: the smallest, mm; infinite where nothing is within reach.
    """

    force: tuple[float, ...]
    friction: tuple[float, ...]
    by_face: dict[str, tuple[float, ...]]
    area: float
    pressure: float
    distance: float


NO_TOUCH = Touch((), (), {}, 0.0, 0.0, np.inf)


class Interaction(Protocol):
    """Two surfaces, or one and itself or an obstacle."""

    def normal(self, place: Place, *, hessian: bool, exact: bool = True) -> Part:
        """Return the barrier; `exact` Hessian, or projected to be positive semi-definite."""

    def lag(self, place: Place) -> object:
        """Return normal forces and tangential planes, for `tangential`."""

    def tangential(self, lag: object, start: Place, place: Place, transition: float, *, hessian: bool) -> Part:
        """Return the potential of friction on the way from `start`, with a slip (mm) up to which it holds."""

    def limit(self, start: Place, end: Place) -> float:
        """Return the share, 0 to 1, of a straight way that keeps all distances above a part of the present ones."""

    def distance(self, place: Place) -> float:
        """Return the smallest distance, mm: infinite beyond reach, not positive where surfaces intersect."""

    def intersection(self, place: Place) -> Array | None:
        """Return a point (d,) where the surfaces intersect; None where they are apart."""

    def near(self, place: Place) -> Integers:
        """Return pairs of nodes (k, 2) that may soon be coupled."""


def upper(rows: Integers, columns: Integers, values: Array) -> Entries:
    """Return the entries of a full symmetric matrix in its upper triangle."""
    kept = rows <= columns
    return rows[kept], columns[kept], values[kept]
