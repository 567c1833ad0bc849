"""The centre line of a slender body: sections across the line from clamp to tip, and their rigid motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.measures.faces import best_rotation, sample
from pneumorph.measures.mirrors import completed, planes
from pneumorph.mechanics import State

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CentreLine:
    """Sections in order. station (n,): 0 at the clamp, 1 at the tip; points (n, d): deformed points of the straight
    reference line between the centres of clamp and tip, mm; rotations (n, d, d)."""

    station: Array
    points: Array
    rotations: Array


def axis_of(state: State, clamp: str, tip: str) -> tuple[Array, Array]:
    """Return the reference centre of the clamp and the vector from there to the centre of the tip (d,), mm.

    Of a body that is cut in planes of symmetry along this axis they are those of the whole.

    Raises InputError where both centres coincide.
    """
    start = sample(state, clamp).centre
    chord = sample(state, tip).centre - start
    if np.linalg.norm(chord) < 1e-9 * state.model.mesh.size:
        raise InputError(f"faces '{clamp}' and '{tip}' have the same centre: no axis lies between them")
    for axis, place in planes(state, chord):
        start[axis], chord[axis] = place, 0.0
    return start, chord


def centre_line(state: State, clamp: str, tip: str, sections: int) -> CentreLine:
    """Return the centre line through `sections` slices of equal thickness.

    The nodes of each slice, weighted by their volume and completed by their images in planes of symmetry, give its best
    rigid motion; it carries the axis point at their mean height. A wall that swells alike on all sides does not move
    it. In a slice that turns by a within itself the point lies inwards by a^2 / 24 of the radius: 1 % at half a radian.
    Slices with too few nodes are left out.
    Raises InputError where fewer than three remain.
    """
    start, chord = axis_of(state, clamp, tip)
    mirrors = planes(state, chord)
    points, positions = completed(state.model.mesh.points, mirrors), completed(state.positions, mirrors)
    weight = np.tile(state.model.unit_mass, 2 ** len(mirrors))
    along = (points - start) @ chord / (chord @ chord)
    number = np.floor(along * sections).astype(int)
    number[np.isclose(along, 1.0)] = sections - 1
    stations, places, rotations = [], [], []
    for index in range(sections):
        nodes = np.flatnonzero(number == index)
        spread = points[nodes] - points[nodes].mean(axis=0) if len(nodes) > 2 else np.zeros((3, len(start)))
        values = np.linalg.svd(spread, compute_uv=False)
        if len(nodes) < 3 or values[len(start) - 2] < 1e-6 * state.model.mesh.size:
            continue
        station = float(np.average(along[nodes], weights=weight[nodes]))
        rotation = best_rotation(points[nodes], positions[nodes], weight[nodes])
        centre = np.average(points[nodes], axis=0, weights=weight[nodes])
        moved = np.average(positions[nodes], axis=0, weights=weight[nodes])
        stations.append(station)
        places.append(moved + rotation @ (start + station * chord - centre))
        rotations.append(rotation)
    if len(stations) < 3:
        raise InputError(
            f"centre line from '{clamp}' to '{tip}': {len(stations)} sections with nodes, expected 3 or more"
        )
    return CentreLine(np.array(stations), np.array(places), np.array(rotations))
