"""The hexagonal-prism actuator's published closed form (eqs. 1-12) and reported data.

The study takes the column and both driven assemblies to share one plane deformation, stretches (l, 1/l, 1), with
l = Phi / sin Phi at the bending angle Phi in radians, and equates the pressure's work on the air with the stored
energy. Evaluated as printed, the pressure grows like Phi², not nearly linearly as the study describes: the formula
stands here for comparison, uncorrected.
Source: Wang, Zhang, Zhang, Zhao, Peng, Actuators 2022, 11, 125, doi 10.3390/act11050125.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.closed_form.roots import first_crossing
from pneumorph.errors import InputError
from pneumorph.materials import Material

if TYPE_CHECKING:  # the dimensions alone are read, so Netgen need not be loaded
    from pneumorph.geometry.hexagonal_prism import HexagonalPrism

# finite-element results of the study, Table 2: gauge pressure, MPa -> bending angle, rad
REPORTED_BENDING: tuple[tuple[float, float], ...] = tuple(
    (1e-3 * pressure, math.radians(angle))
    for pressure, angle in ((40, 5.5), (80, 13.7), (120, 22.6), (160, 32.5), (200, 41.5), (240, 47.4), (280, 50.5))
)

# polynomials fitted to the study's experiment, eq. 13, pressure in kPa, highest power first
_MEASURED_ANGLE = (1.1097e-8, -9.4894e-6, 0.0024, 0.0146, 1.2143)
_MEASURED_MOMENT = (-1.4254e-7, 1.8295e-5, 0.0163, -0.9734, 107.200)
# the range of the experiment, MPa; a quartic means nothing beyond it
MEASURED_RANGE = (0.0, 0.280)


class PrismVolumes(NamedTuple):
    """Volumes of the closed form, mm³, eqs. 3-7, by the study's symbols.

    assembly:       V_a, silicone of one cavity assembly.
    column:         V_b, silicone of the hexagonal column.
    envelope:       V_0, outer volume of one assembly with its airway.
    deformed:       V_R = 2 V_a + V_b, silicone that stores energy when two assemblies are driven.
    """

    assembly: float
    column: float
    envelope: float
    deformed: float


def prism_volumes(actuator: HexagonalPrism) -> PrismVolumes:
    """Return the volumes of the closed form from the dimensions of an actuator.

    V_a = N (La Wa Ha - l2 w2 h2) + l3 h3 Wa (N - 1), V_b = (3 sqrt(3)/2 a² - pi r²) l,
    V_0 = N La Wa Ha + l3 h3 w3 (N - 1), with La, Wa, Ha the outer dimensions of one chamber.
    """
    block = actuator.block_length * actuator.block_width * actuator.block_height
    air = actuator.chamber_length * actuator.chamber_width * actuator.chamber_height
    count = actuator.chambers
    bridge = actuator.gap * actuator.airway_height * (count - 1)
    assembly = count * (block - air) + bridge * actuator.block_width
    column = (1.5 * math.sqrt(3.0) * actuator.side**2 - math.pi * actuator.core_radius**2) * actuator.length
    envelope = count * block + bridge * actuator.airway_width
    return PrismVolumes(assembly, column, envelope, 2.0 * assembly + column)


def prism_pressure(actuator: HexagonalPrism, material: Material, bending_angle: ArrayLike) -> NDArray[np.float64]:
    """Return the gauge pressure, MPa, at bending angles Phi, rad, from 0 to less than pi, any shape.

    Eq. 12, P = (sin Phi)² V_R / (2 V_0 (sin Phi - Phi cos Phi)) dW/dPhi. The fraction holds the inverse of
    dl/dPhi = (sin Phi - Phi cos Phi)/(sin Phi)², so P = V_R / (2 V_0) dW/dl at l = Phi / sin Phi, and dW/dl is the
    nominal stress of planar tension: this form has no 0/0 at Phi = 0.
    Raises InputError for an angle outside the range.
    """
    angle = np.asarray(bending_angle, dtype=float)
    if not ((angle >= 0.0) & (angle < math.pi)).all():
        raise InputError(f"bending_angle = {bending_angle!r} rad, allowed: 0 to less than pi")
    volumes = prism_volumes(actuator)
    stretch = 1.0 / np.sinc(angle / math.pi)
    return np.asarray(volumes.deformed / (2.0 * volumes.envelope) * material.planar_tension(stretch))


def prism_bending_angle(actuator: HexagonalPrism, material: Material, pressure: float) -> float:
    """Return the bending angle Phi, rad, at a gauge pressure, MPa: the inverse of `prism_pressure` up to 0.9 pi.

    Raises InputError for a pressure outside what the formula gives there.
    """
    return first_crossing(
        lambda angle: prism_pressure(actuator, material, angle), pressure, 0.0, 0.9 * math.pi, "pressure", "MPa"
    )


def measured_bending_angle(pressure: ArrayLike) -> NDArray[np.float64]:
    """Return the measured bending angle, rad, at gauge pressures, MPa, from the study's polynomial (eq. 13).

    The fit does not pass through zero: 1.2 degrees at no pressure. Raises InputError beyond the measured 280 kPa.
    """
    return np.radians(np.polyval(_MEASURED_ANGLE, _measured(pressure)))


def measured_moment(pressure: ArrayLike) -> NDArray[np.float64]:
    """Return the measured driving moment at gauge pressures, MPa, from the study's polynomial (eq. 13).

    The study gives no unit of the moment beside the table, so neither do we: the numbers are as printed, 107.2 at no
    pressure. Raises InputError beyond the measured 280 kPa.
    """
    return np.asarray(np.polyval(_MEASURED_MOMENT, _measured(pressure)))


def _measured(pressure: ArrayLike) -> NDArray[np.float64]:
    """Return gauge pressures of the experiment in kPa."""
    values = np.asarray(pressure, dtype=float)
    low, high = MEASURED_RANGE
    # 280 kPa read from text may come out a rounding error above 0.28 MPa
    if not ((values >= low) & (values <= high * (1.0 + 1e-12))).all():
        raise InputError(f"pressure = {pressure!r} MPa, allowed: {low:g} to {high:g} MPa, the range of the experiment")
    return 1e3 * values
