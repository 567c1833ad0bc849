"""From a record to the points that a law is fitted to: branch, rupture, zero, signs, number of points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.materials.fitting.legs import OVERSHOOT, legs, loading_of, unloading_after
from pneumorph.materials.fitting.offset import without_offset
from pneumorph.materials.fitting.specimen import SpecimenTest
from pneumorph.units import show

BRANCHES = ("last-loading", "first-loading", "mean", "all")

# parts of the largest stress: a fall while the strain grows; the most that is left after rupture, and its median; a
# stress of the wrong sign
_FALL, _TORN, _TORN_MEDIAN, _WRONG_SIGN = 0.1, 0.5, 0.1, 0.05
_MOST_POINTS, _BINS = 400, 200


def prepare(test: SpecimenTest, branch: str = "last-loading", keep_offset: bool = False) -> SpecimenTest:
    """Return the points of a test to fit to, ordered by stretch; `notes` of the result say what was done.

    branch: of a record with cycles, the loading of the "last-loading" or "first-loading" cycle to the largest strain,
        the "mean" of the last loading and the unloading after it, or "all" points. The last loading is the response of
        the material in service, after the softening of the first cycles.
    keep_offset: leave the zero of strain where it was recorded.

    Points after rupture are left out. Over 400 points are averaged in 200 equal steps of stretch, so that neither noise
    nor slow parts of a test weigh more. Raises InputError, with the line, for a stretch or stress that goes back and
    forth otherwise than in cycles, for stresses of the wrong sign, and for compression of sheets.
    """
    if branch not in BRANCHES:
        raise NameNotFoundError(unknown_name("branch", branch, BRANCHES))
    if not np.any(test.stress) or np.ptp(test.stretch) == 0.0:
        what = "stress is 0" if not np.any(test.stress) else f"stretch is {test.stretch[0]:.4g}"
        raise InputError(f"{test.where(0)}: the {what} in every row, allowed: a test that was loaded")
    cycles = len(legs(test)) > 1
    chosen = _mean(test) if branch == "mean" else test.take(loading_of(test, branch.partition("-")[0]))
    if cycles and branch != "all":
        said = "mean of the last loading and unloading" if branch == "mean" else f"{branch.replace('-', ' ')} branch"
        chosen = replace(chosen, notes=(*chosen.notes, said))
    if branch != "all":
        chosen = _until_rupture(chosen)
    if not keep_offset:
        chosen = without_offset(chosen)
    _check_signs(chosen)
    return _averaged(chosen.take(np.argsort(chosen.stretch, kind="stable")))


def _mean(test: SpecimenTest) -> SpecimenTest:
    """Return the last loading with the mean of its stresses and those of the unloading after it."""
    places = loading_of(test, "last")
    back = unloading_after(test, int(places[-1]))
    if back is None:
        raise InputError(f"{test.source}: branch 'mean' needs an unloading after the last loading, there is none")
    down = test.take(np.arange(back[0], back[1] + 1))
    order = np.argsort(down.stretch, kind="stable")
    up = test.take(places)
    low, high = down.stretch.min(), down.stretch.max()
    up = up.take(np.flatnonzero((up.stretch >= low) & (up.stretch <= high)))
    return replace(up, stress=0.5 * (up.stress + np.interp(up.stretch, down.stretch[order], down.stress[order])))


def _until_rupture(test: SpecimenTest) -> SpecimenTest:
    """Return the test without what came after the specimen tore; refuse other falls of the stress."""
    keep = np.ones(len(test.stretch), dtype=bool)
    note = ""
    for side in (-1.0, 1.0):
        on = np.flatnonzero((test.stretch - 1.0) * side > 0.0)
        order = on[np.argsort(test.stretch[on] * side, kind="stable")]
        if len(order) < 2 or np.abs(test.stretch[order] - 1.0).max() <= OVERSHOOT * test.reach:
            continue
        stress = test.stress[order] * side
        largest = stress.max()
        peaks = np.maximum.accumulate(stress)
        fallen = np.flatnonzero(peaks - stress > _FALL * max(largest, 0.0))
        if not len(fallen) or largest <= 0.0:
            continue
        peak = int(np.argmax(stress))
        torn = stress[peak:][np.cumsum(stress[peak:] < _TORN * largest) > 0]
        stays_torn = len(torn) and torn.max() < _TORN * largest and np.median(torn) < _TORN_MEDIAN * largest
        if fallen[0] > peak and stays_torn:
            keep[order[peak + 1 :]] = False
            note = f"{len(order) - peak - 1} points after rupture at stretch {test.stretch[order[peak]]:.4g} left out"
            continue
        worst = int(fallen[0])
        before = int(np.argmax(stress[: worst + 1]))
        raise InputError(
            f"{test.where(order[before])} to {test.where(order[worst])}: the stress falls from "
            f"{show(float(stress[before]) * side, 'stress')} to {show(float(stress[worst]) * side, 'stress')} while "
            f"the stretch goes from {test.stretch[order[before]]:.4g} to {test.stretch[order[worst]]:.4g}; allowed: "
            f"falls of up to {_FALL:.0%} of the largest stress, or one rupture at the end"
        )
    return test.take(np.flatnonzero(keep), note) if note else test


def _check_signs(test: SpecimenTest) -> None:
    strain, largest = test.stretch - 1.0, np.abs(test.stress).max()
    wrong = np.flatnonzero((strain * test.stress < 0.0) & (np.abs(test.stress) > _WRONG_SIGN * largest))
    if len(wrong):
        first = wrong[0]
        pulled = strain[first] > 0.0
        raise InputError(
            f"{test.where(first)}: stress = {show(float(test.stress[first]), 'stress')} at stretch "
            f"{test.stretch[first]:.4g}, allowed: {'tension (+) over' if pulled else 'compression (-) under'} stretch 1"
        )
    if test.mode != "uniaxial" and strain.min() < -_WRONG_SIGN * test.reach:
        first = int(np.argmin(strain))
        raise InputError(
            f"{test.where(first)}: stretch = {test.stretch[first]:.4g} in {_article(test.mode)} test, allowed: 1 and "
            "more (a sheet buckles under compression)"
        )


def _article(mode: str) -> str:
    return f"an {mode}" if mode[0] in "aeiou" else f"a {mode}"


def _averaged(test: SpecimenTest) -> SpecimenTest:
    """Return at most 200 points of a test with over 400: means over equal steps of stretch."""
    count = len(test.stretch)
    if count <= _MOST_POINTS:
        return test
    step = np.ptp(test.stretch) / _BINS
    bins = np.minimum(((test.stretch - test.stretch.min()) / step).astype(np.int64), _BINS - 1)
    found, places = np.unique(bins, return_inverse=True)
    number = np.bincount(places)
    means: dict[str, Any] = {name: np.bincount(places, getattr(test, name)) / number for name in ("stretch", "stress")}
    firsts = test.lines[np.searchsorted(bins, found)]
    return replace(test, lines=firsts, notes=(*test.notes, f"{count} points averaged to {len(found)}"), **means)
