"""Loading and unloading: a record is split where its stretch turns around."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.materials.fitting.specimen import SpecimenTest

Array = NDArray[np.float64]
Leg = tuple[int, int]

# a reversal under this part of the range of stretches is noise
NOISE = 0.02
# strains under this part of the largest one, but of the other sign, are the overshoot of unloading, or noise
OVERSHOOT = 2.0 * NOISE
_FEWEST = 4
# unloading must return to under this part of the strain that it starts from, but for the last, which may stop anywhere
_RETURN = 0.5
# peaks over this part of the largest one reach it
_SAME_PEAK = 0.95


def turning_points(values: Array, tolerance: float) -> list[int]:
    """Return the places of the first value, of each reversal by more than `tolerance`, and of the last value (n,)."""
    points, direction, low, high = [0], 0, 0, 0
    for place, value in enumerate(values.tolist()):
        if value > values[high]:
            high = place
        if value < values[low]:
            low = place
        if direction >= 0 and values[high] - value > tolerance:
            if direction > 0 or high > 0:
                points.append(high)
            direction, low, high = -1, place, place
        elif direction <= 0 and value - values[low] > tolerance:
            if direction < 0 or low > 0:
                points.append(low)
            direction, low, high = 1, place, place
    if points[-1] != len(values) - 1:
        points.append(len(values) - 1)
    return points


def legs(test: SpecimenTest) -> list[Leg]:
    """Return first and last place of each loading or unloading; a single one for a record that goes one way.

    A leg through the undeformed state, from compression to tension, is cut there. Raises InputError, with the lines,
    for a stretch that goes back and forth otherwise than by loading and unloading.
    """
    stretch = test.stretch
    tolerance = NOISE * float(np.ptp(stretch))
    points = turning_points(stretch, tolerance)
    if len(points) == 2:
        return [(0, len(stretch) - 1)]
    # what an extensometer does before the first and after the last leg is no leg
    if points[1] - points[0] < _FEWEST - 1 and abs(stretch[points[1]] - stretch[points[0]]) < 5.0 * tolerance:
        points = points[1:]
    strains = stretch[points] - 1.0
    for number, (first, last) in enumerate(pairwise(points)):
        middle = number < len(points) - 2
        unloading = abs(strains[number + 1]) < abs(strains[number]) and strains[number + 1] * strains[number] > 0.0
        partial = middle and unloading and abs(strains[number + 1]) > _RETURN * abs(strains[number])
        if last - first < _FEWEST - 1 or partial:
            raise InputError(
                f"{test.where(first)} to {test.where(last)}: the stretch goes from {stretch[first]:.4g} to "
                f"{stretch[last]:.4g} and turns around; allowed: a stretch that grows all the way, or "
                f"whole cycles of loading and unloading, {_FEWEST} points or more each way"
            )
    return [leg for first, last in pairwise(points) for leg in _cut_at_rest(stretch, first, last, tolerance)]


def _cut_at_rest(stretch: Array, first: int, last: int, tolerance: float) -> list[Leg]:
    start, end = stretch[first] - 1.0, stretch[last] - 1.0
    if start * end >= 0.0 or min(abs(start), abs(end)) < tolerance:
        return [(first, last)]
    inside = (stretch[first : last + 1] - 1.0) * np.sign(start) > 0.0
    crossing = first + int(np.flatnonzero(inside)[-1])
    return [(first, crossing), (crossing + 1, last)]


def loading_of(test: SpecimenTest, which: str) -> NDArray[np.int64]:
    """Return the places of the points on the loading legs to the largest strain of each sign.

    which: "first" or "last" of the legs that reach it within 5 %, or "all" legs. A record that goes one way is used
        whole.
    """
    found = legs(test)
    if len(found) == 1 or which == "all":
        return np.arange(len(test.stretch))
    chosen = []
    for side in (-1.0, 1.0):
        loading = [leg for leg in found if _strain(test, leg[1]) * side > max(0.0, _strain(test, leg[0]) * side)]
        if loading:
            peak = max(_strain(test, last) * side for _, last in loading)
            reaching = [leg for leg in loading if _strain(test, leg[1]) * side >= _SAME_PEAK * peak]
            chosen.append(reaching[0 if which == "first" else -1])
    chosen = [leg for leg in chosen if abs(_strain(test, leg[1])) > OVERSHOOT * test.reach]
    return np.concatenate([np.arange(first, last + 1) for first, last in sorted(chosen)])


def unloading_after(test: SpecimenTest, last: int) -> Leg | None:
    """Return the leg that unloads from the place where a loading leg ends, None if there is none."""
    return next((leg for leg in legs(test) if leg[0] == last), None)


def _strain(test: SpecimenTest, place: int) -> float:
    return float(test.stretch[place] - 1.0)
