"""Diameter of the cross-section: the smallest circle around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from pneumorph.errors import InputError
from pneumorph.measures.centre_line import axis_of
from pneumorph.measures.faces import best_rotation
from pneumorph.measures.mirrors import completed, planes
from pneumorph.mechanics import State

Array = NDArray[np.float64]

# straight pieces between neighbouring nodes of a face
_PIECES = {
    "triangle6": [(0, 3), (3, 1), (1, 4), (4, 2), (2, 5), (5, 0), (3, 4), (4, 5), (5, 3)],
    "quad9": [(0, 4), (4, 1), (1, 5), (5, 2), (2, 6), (6, 3), (3, 7), (7, 0), (4, 8), (5, 8), (6, 8), (7, 8)],
    "line3": [(0, 2), (2, 1)],
}


@dataclass(frozen=True)
class Diameter:
    """Diameter of the smallest circle around a deformed cross-section of the outer face, mm.

    The section is the material one: the points of `outer` that lay in the plane across the line from clamp to tip at
    `station` in the reference; they are projected on their plane as it has turned. In plane strain the circle becomes
    the extent across the line; with axial symmetry it is twice the largest radius.

    station: 0 (clamp) to 1 (tip); None takes the largest of `stations` sections, evenly spaced.
    outer:   name of the outer face. Raises NameNotFoundError for a face, InputError for a station out of range or one
             at which the outer face has fewer than three points (two in the plane).
    """

    station: float | None = 0.5
    outer: str = "outer"
    clamp: str = "clamp"
    tip: str = "tip"
    stations: int = 31
    name: str = "diameter"
    kind: str = "length"

    def __post_init__(self) -> None:
        if self.station is not None and not 0.0 <= self.station <= 1.0:
            raise InputError(f"{self.name}: station = {self.station!r}, allowed: 0 to 1, or None for the largest")
        if self.stations < 1:
            raise InputError(f"{self.name}: stations = {self.stations}, allowed: 1 or more")

    def __call__(self, state: State) -> float:
        """Return the diameter, mm."""
        mesh = state.model.mesh
        start, chord = axis_of(state, self.clamp, self.tip)
        along = (mesh.points - start) @ chord / (chord @ chord)
        pieces = [block.nodes[:, pair] for block in mesh.face_blocks(self.outer) for pair in _PIECES[block.kind]]
        ends = np.unique(np.sort(np.concatenate(pieces), axis=1), axis=0)
        if self.station is not None:
            found = self._section(state, ends, along, chord, self.station)
            if found is None:
                raise InputError(f"{self.name}: '{self.outer}' has no section at station {self.station:g}")
            return found
        places = (np.arange(self.stations) + 0.5) / self.stations
        sections = [self._section(state, ends, along, chord, place) for place in places]
        sizes = [size for size in sections if size is not None]
        if not sizes:
            raise InputError(f"{self.name}: '{self.outer}' has no section between '{self.clamp}' and '{self.tip}'")
        return max(sizes)

    def _section(
        self, state: State, ends: NDArray[np.int64], along: Array, chord: Array, station: float
    ) -> float | None:
        """Return the diameter at a station, None where the outer face has no section there."""
        points, d = state.model.mesh.points, len(chord)
        low, high = along[ends].min(axis=1) - 1e-9, along[ends].max(axis=1) + 1e-9
        cut = ends[(low <= station) & (station <= high)]
        width = along[cut[:, 1]] - along[cut[:, 0]]
        flat = np.abs(width) < 1e-9  # pieces in the section's own plane give their first end
        share = np.clip(np.where(flat, 0.0, (station - along[cut[:, 0]]) / np.where(flat, 1.0, width)), 0.0, 1.0)[
            :, None
        ]
        reference = points[cut[:, 0]] + share * (points[cut[:, 1]] - points[cut[:, 0]])
        deformed = state.positions[cut[:, 0]] + share * (state.positions[cut[:, 1]] - state.positions[cut[:, 0]])
        revolved = state.model.mesh.space == "axisymmetric"
        if len(cut) < (1 if revolved else d):
            return None
        if revolved:
            return 2.0 * float(deformed[:, 0].max())
        mirrors = planes(state, chord)
        reference, deformed = completed(reference, mirrors), completed(deformed, mirrors)
        rotation = best_rotation(reference, deformed, np.ones(len(reference)))
        across = np.linalg.svd((chord / np.linalg.norm(chord))[None, :])[2][1:] @ rotation.T
        projected = deformed @ across.T
        return float(np.ptp(projected)) if d == 2 else enclosing_diameter(projected)


def enclosing_diameter(points: Array) -> float:
    """Return the diameter of the smallest circle around points (n, 2), mm (Welzl 1991, incremental form)."""
    try:
        points = points[ConvexHull(points).vertices]
    except QhullError:  # all on one line
        direction = np.linalg.svd(points - points.mean(axis=0))[2][0]
        return float(np.ptp(points @ direction))
    points = np.random.default_rng(0).permutation(points)
    centre, radius = points[0], 0.0

    def outside(point: Array) -> bool:
        return bool(np.linalg.norm(point - centre) > radius * (1.0 + 1e-12) + 1e-300)

    for i in range(1, len(points)):
        if not outside(points[i]):
            continue
        centre, radius = points[i], 0.0
        for j in range(i):
            if not outside(points[j]):
                continue
            centre = 0.5 * (points[i] + points[j])
            radius = float(np.linalg.norm(points[i] - centre))
            for k in range(j):
                if outside(points[k]):
                    centre, radius = _through(points[i], points[j], points[k])
    return 2.0 * radius


def _through(a: Array, b: Array, c: Array) -> tuple[Array, float]:
    """Return centre and radius of the circle through three points."""
    sides = np.array([b - a, c - a])
    offset = np.linalg.solve(2.0 * sides, (sides**2).sum(axis=1))
    return a + offset, float(np.linalg.norm(offset))
