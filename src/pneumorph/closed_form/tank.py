"""Filling of a rigid tank from a constant source through an ISO 6358 orifice, at constant temperature.

With y = P/Ps the absolute pressure over that of the source, and the rate k = C rho0 R T / V (T = T0 outside),
    dy/dt = k for y <= b (choked),   k sqrt(1 - ((y - b)/(1 - b))^2) above,
so that y rises in proportion to time up to b and then as b + (1 - b) sin(k t/(1 - b)), until it is 1 after a finite
time. Follows from the formula of ISO 6358 by separation of variables.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError


def filling_ratio(start: float, critical_ratio: float, rate: float, time: ArrayLike) -> NDArray[np.float64]:
    """Return absolute pressure in the tank over that of the source at times, of their shape.

    start:          the same ratio at time 0, from 0 to 1.
    critical_ratio: b, above 0 and below 1.
    rate:           k = C rho0 R T / V, 1/s, more than 0.
    time:           s, 0 or more, any shape.
    Raises InputError for values outside these ranges.
    """
    t = np.asarray(time, dtype=float)
    b, k = critical_ratio, rate
    if not 0.0 <= start <= 1.0:
        raise InputError(f"start = {start:g}, allowed: 0 to 1")
    if not 0.0 < b < 1.0:
        raise InputError(f"critical_ratio = {b:g}, allowed: above 0 and below 1")
    if not 0.0 < k < np.inf:
        raise InputError(f"rate = {k:g} 1/s, allowed: more than 0")
    if not (t >= 0.0).all():
        raise InputError("time, allowed: 0 s or more")
    choked = max(b - start, 0.0) / k
    angle = np.arcsin((max(start, b) - b) / (1.0 - b)) + k * np.maximum(t - choked, 0.0) / (1.0 - b)
    subsonic: NDArray[np.float64] = b + (1.0 - b) * np.sin(np.minimum(angle, 0.5 * np.pi))
    return np.where(t < choked, start + k * t, subsonic)
