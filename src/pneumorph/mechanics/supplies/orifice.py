"""The flow of gas through a valve, orifice or short tube by ISO 6358, in both directions.

With absolute pressures p1 upstream and p2 downstream, r = p2/p1 and the upstream temperature T1,
    m' = C rho0 p1 sqrt(T0/T1) phi(r),   phi = 1 where r <= b (choked),   sqrt(1 - ((r - b)/(1 - b))^2) above,
rho0 and T0 being those of the standard reference atmosphere. This phi has an infinite slope at r = 1; real flow is
laminar there, with a flow in proportion to the pressure difference. From r = 0.999 on phi is therefore a cubic in
1 - r that goes through zero and continues value and slope.
Sources: ISO 6358-1 as given with rho0 and the range of laminar flow (0.995 to 0.999) in the MathWorks documentation,
'Constant Area Pneumatic Orifice (ISO 6358)', after Sanville (1971).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from pneumorph.errors import InputError
from pneumorph.units import show

REFERENCE_DENSITY = 1.185e-12  # t/mm3
REFERENCE_TEMPERATURE = 293.15  # K
LAMINAR = 1e-3  # relative pressure difference up to which flow is laminar


@dataclass(frozen=True)
class Orifice:
    """conductance: C, mm3/(s MPa), more than 0; critical_ratio: b, above 0 and below 1."""

    conductance: float
    critical_ratio: float

    def __post_init__(self) -> None:
        if not 0.0 < self.conductance < float("inf"):
            raise InputError(f"conductance = {show(self.conductance, 'conductance')}, allowed: more than 0")
        if not 0.0 < self.critical_ratio < 1.0 - LAMINAR:
            raise InputError(f"critical_ratio = {self.critical_ratio:g}, allowed: above 0 and below {1.0 - LAMINAR:g}")

    def flow(
        self, first: float, second: float, first_temperature: float, second_temperature: float
    ) -> tuple[float, float, float, float, float]:
        """Return the mass flow from the first to the second side, t/s, and its four derivatives.

        first, second: absolute pressures, MPa; temperatures in K. The derivatives are by the arguments, in their order.
        """
        if second > first:
            m, by_second, by_first, by_t = self._down(second, first, second_temperature)
            return -m, -by_first, -by_second, 0.0, -by_t
        m, by_first, by_second, by_t = self._down(first, second, first_temperature)
        return m, by_first, by_second, by_t, 0.0

    def _down(self, upstream: float, downstream: float, temperature: float) -> tuple[float, float, float, float]:
        """Return the flow down a pressure difference, and its slopes by both pressures and the temperature."""
        factor = self.conductance * REFERENCE_DENSITY * sqrt(REFERENCE_TEMPERATURE / temperature)
        ratio = downstream / upstream
        share, slope = self._share(ratio)
        m = factor * upstream * share
        return m, factor * (share - slope * ratio), factor * slope, -0.5 * m / temperature

    def _share(self, ratio: float) -> tuple[float, float]:
        """Return phi and its slope."""
        if ratio <= self.critical_ratio:
            return 1.0, 0.0
        if ratio <= 1.0 - LAMINAR:
            return self._ellipse(ratio)
        value, slope = self._ellipse(1.0 - LAMINAR)
        cubic = -(slope + value / LAMINAR) / (2.0 * LAMINAR**2)
        linear = value / LAMINAR - cubic * LAMINAR**2
        x = 1.0 - ratio
        return x * (linear + cubic * x * x), -(linear + 3.0 * cubic * x * x)

    def _ellipse(self, ratio: float) -> tuple[float, float]:
        x = (ratio - self.critical_ratio) / (1.0 - self.critical_ratio)
        share = sqrt(1.0 - x * x)
        return share, -x / (share * (1.0 - self.critical_ratio))
