"""The scalar laws of contact: a barrier that grows without bound as a gap closes, and Coulomb's friction made smooth.

Both are those of incremental potential contact (Li et al., ACM Trans. Graph. 39 (2020) 49, eqs. 6 and 13-15), the
barrier with a pressure as its stiffness: per area, with s = gap / reach,
    phi = -stiffness * reach * (s^2 - 1)^2 ln s^2   for s < 1,   0 beyond,   pressure = -d phi / d gap.
A pressure equal to the stiffness leaves a gap of 0.78 reach, four times as much 0.52, ten times 0.24.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def barrier(gap: Array, reach: float, stiffness: float) -> tuple[Array, Array, Array]:
    """Return energy per area (mJ/mm2) and its first and second derivatives by the gap; zero where gap >= reach.

    gap (n,) mm, more than 0; reach: mm; stiffness: MPa.
    """
    s = np.minimum(gap / reach, 1.0)
    y, log = s * s, 2.0 * np.log(s)
    value = -((y - 1.0) ** 2) * log
    by_y = -2.0 * (y - 1.0) * log - (y - 1.0) ** 2 / y
    by_yy = -2.0 * log - 4.0 * (y - 1.0) / y + (y - 1.0) ** 2 / y**2
    first = 2.0 * s * by_y
    second = 2.0 * by_y + 4.0 * y * by_yy
    return stiffness * reach * value, stiffness * first, stiffness / reach * second


def friction(slip: Array, transition: float) -> tuple[Array, Array, Array]:
    """Return the integral of the friction force per unit limit, force / slip, and d force / d slip.

    slip (n,): size of the tangential displacement, mm; the force rises as 2 y - y^2, y = slip / transition, up to the
    limit of sliding at the transition (mm).
    """
    y = np.minimum(slip / transition, 1.0)
    beyond = slip >= transition
    integral = np.where(beyond, slip, transition * (y * y - y**3 / 3.0 + 1.0 / 3.0))
    over = np.where(beyond, 1.0 / np.maximum(slip, transition), (2.0 - y) / transition)
    slope = np.where(beyond, 0.0, 2.0 * (1.0 - y) / transition)
    return integral, over, slope
