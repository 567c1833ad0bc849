"""The inverse of a curve on the branch that starts at rest."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from pneumorph.errors import InputError

SAMPLES = 1000


def first_crossing(
    curve: Callable[[NDArray], NDArray], target: float, start: float, end: float, name: str, what: str
) -> float:
    """Return the first place on the way from `start` to `end` where `curve` takes the value `target`.

    `curve` maps an array to an array; it may rise and fall again, as pressure does in a balloon. `name` and `what` are
    the target's name and unit for the message of the InputError that says how far the curve goes.
    """
    places = np.linspace(start, end, SAMPLES + 1)
    values = np.asarray(curve(places), dtype=float)
    if not np.isfinite(target):
        raise InputError(f"{name} = {target!r}, allowed: finite")
    gap = values - target
    hits = np.flatnonzero((gap[:-1] == 0.0) | (np.sign(gap[:-1]) * np.sign(gap[1:]) < 0.0) | (gap[1:] == 0.0))
    if len(hits) == 0:
        raise InputError(f"{name} = {target:.6g} {what}, allowed: {values.min():.6g} to {values.max():.6g} {what}")
    first = hits[0]
    if gap[first] == 0.0 or gap[first + 1] == 0.0:
        return float(places[first] if gap[first] == 0.0 else places[first + 1])
    # machine precision, so that the inverse may be tested against the curve itself
    return float(
        brentq(lambda x: float(curve(np.asarray(x))) - target, places[first], places[first + 1], xtol=1e-15, rtol=1e-14)
    )
