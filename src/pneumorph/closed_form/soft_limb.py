"""The soft wheel's published closed form of a pleated limb's bending (eqs. 2-5).

Each of N chambers is an ellipse of width xi (x before), height h and depth dc; its centre line lies hc from the base,
which keeps its length. With theta = xi / R = x / (R - hc), so k = theta / xi =
(xi - x) / (hc xi), the energy of a chamber,
    Gamma = 1/2 E I k² xi - P pi/4 h xi dc,    I = d h³ / 12,
has its minimum, for a fixed modulus E, at xi = x E I / S with S² = (E I)² - 1/2 pi E I dc h hc² P, so
    N theta = N x (E I - S) / (hc S):
this is the printed formula, which therefore follows from the printed energy. It has no state from the pressure
2 E I / (pi dc h hc²) on, where S vanishes.

The study takes E from the tangent of the Yeoh curve in tension, without saying at which strain; here it is that of the
outermost fibre of the energy's own beam, k h / 2 (assumed). E is put in after the minimisation: the minimum of the
energy with a modulus that depends on xi lies elsewhere (at larger angles, where E falls with strain).
Source: Pans, Chen, Jovanova, 'Soft and Steady Wins the Race', eqs. 2-5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.closed_form.roots import first_crossing
from pneumorph.errors import InputError
from pneumorph.materials import Yeoh

if TYPE_CHECKING:  # the dimensions alone are read, so Netgen need not be loaded
    from pneumorph.geometry.soft_limb import SoftLimb

Array = NDArray[np.float64]
_WIDEST = 4.0  # xi / x up to which the inverse is sought


@dataclass(frozen=True)
class LimbSection:
    """What the closed form knows of a limb, lengths in mm, by the study's symbols.

    chambers: N. width: x, of a chamber before. height: h, of a chamber. arm: hc, from the base to the centre line of
    the ellipse. depth: d, of the limb. chamber_depth: dc. Raises InputError for one that is not more than 0.
    """

    chambers: int
    width: float
    height: float
    arm: float
    depth: float
    chamber_depth: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not 0.0 < value < math.inf:
                raise InputError(f"limb section: {name} = {value!r}, allowed: finite and more than 0")

    @property
    def second_moment(self) -> float:
        """I = d h³ / 12, mm4."""
        return self.depth * self.height**3 / 12.0

    @property
    def drive(self) -> float:
        """pi dc h hc² / 2, mm4: times the pressure over E I it is 1 - (x / xi)²."""
        return 0.5 * math.pi * self.chamber_depth * self.height * self.arm**2


def limb_section(actuator: SoftLimb) -> LimbSection:
    """Return the section of a limb: x is the mean width of an air chamber, hc from the middle of base to its centre."""
    width = 0.5 * (actuator.chamber_foot + actuator.chamber_top)
    arm = 0.5 * (actuator.base + actuator.chamber_height)
    return LimbSection(actuator.chambers, width, actuator.chamber_height, arm, actuator.depth, actuator.chamber_depth)


def yeoh_tangent(material: Yeoh, strain: ArrayLike) -> Array:
    """Return E, MPa: the slope of the nominal stress in uniaxial tension over the strain (stretch - 1), any shape.

    With I1 = l² + 2/l the nominal stress is W' I1'(l), so E = W'' I1'² + W' (2 + 4/l³); 3 mu at no strain.
    Raises InputError for a strain of -1 or less.
    """
    stretch = 1.0 + np.asarray(strain, dtype=float)
    if not (stretch > 0.0).all():
        raise InputError(f"strain = {strain!r}, allowed: more than -1")
    i1 = stretch**2 + 2.0 / stretch
    energy = material.derivatives(i1, i1)
    return np.asarray(energy.w11 * (2.0 * stretch - 2.0 / stretch**2) ** 2 + energy.w1 * (2.0 + 4.0 / stretch**3))


def limb_energy(section: LimbSection, modulus: ArrayLike, width: ArrayLike, pressure: float) -> Array:
    """Return Gamma of one chamber, mJ, at widths xi, mm, for a modulus E and a gauge pressure, MPa (eq. 4)."""
    xi = np.asarray(width, dtype=float)
    curvature = (xi - section.width) / (section.arm * xi)
    volume = 0.25 * math.pi * section.height * xi * section.chamber_depth
    stiffness = np.asarray(modulus) * section.second_moment
    return np.asarray(0.5 * stiffness * curvature**2 * xi - pressure * volume)


def limit_pressure(section: LimbSection, modulus: float) -> float:
    """Return the gauge pressure, MPa, from which the printed formula has no state at a fixed modulus, MPa."""
    return modulus * section.second_moment / section.drive


def printed_angle(section: LimbSection, modulus: float, pressure: ArrayLike) -> Array:
    """Return N theta, rad, at gauge pressures, MPa, any shape, for a fixed modulus, MPa (eq. 5).

    Raises InputError for pressures outside 0 to less than the limit.
    """
    values, limit = np.asarray(pressure, dtype=float), limit_pressure(section, modulus)
    if not ((values >= 0.0) & (values < limit)).all():
        raise InputError(f"pressure = {pressure!r} MPa, allowed: 0 to less than {limit:.4g} MPa")
    stiffness = modulus * section.second_moment
    root = np.sqrt(stiffness**2 - stiffness * section.drive * values)
    return np.asarray(section.chambers * section.width * (stiffness - root) / (section.arm * root))


def fibre_strain(section: LimbSection, ratio: ArrayLike) -> Array:
    """Return k h / 2, the strain of the outermost fibre, at ratios xi / x, any shape."""
    return np.asarray(0.5 * section.height / section.arm * (1.0 - 1.0 / np.asarray(ratio, dtype=float)))


def limb_pressure(section: LimbSection, material: Yeoh, angle: ArrayLike) -> Array:
    """Return the gauge pressure, MPa, at which eq. 5 with E at the strain of the state gives angles N theta, rad."""
    ratio = 1.0 + np.asarray(angle, dtype=float) * section.arm / (section.chambers * section.width)
    if not (ratio >= 1.0).all():
        raise InputError(f"angle = {angle!r} rad, allowed: 0 or more")
    modulus = yeoh_tangent(material, fibre_strain(section, ratio))
    return np.asarray(modulus * section.second_moment * (1.0 - 1.0 / ratio**2) / section.drive)


def limb_angle(section: LimbSection, material: Yeoh, pressure: float) -> float:
    """Return N theta, rad, at a gauge pressure, MPa: the inverse of `limb_pressure`.

    Raises InputError for a pressure outside what the formula gives for chambers up to four times as wide.
    """
    widest = (_WIDEST - 1.0) * section.chambers * section.width / section.arm
    return first_crossing(
        lambda angle: limb_pressure(section, material, angle), pressure, 0.0, widest, "pressure", "MPa"
    )
