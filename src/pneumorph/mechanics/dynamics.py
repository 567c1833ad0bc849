"""Inertia by the implicit generalised-alpha method, with the damping of the time integration chosen by name.

At the end of a step of h seconds the body obeys (Chung and Hulbert, J. Appl. Mech. 60 (1993) 371)
    (1 - af) R + af R_n + M [(1 - am) a + am a_n] = 0,       R: internal minus applied forces,
    u = u_n + h v_n + h^2 [(1/2 - b) a_n + b a],             v = v_n + h [(1 - g) a_n + g a].
Divided by 1 - af this is the static equation with one force more, linear in u: what `Inertia` gives to Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.mass import Mass
from pneumorph.mechanics.state import State

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scheme:
    """Coefficients of a time integration.

    radius: spectral radius at high frequencies, 0 (they vanish in one step) to 1 (nothing is damped).
    accuracy: largest error of a step, as a share of the displacement; None where steps follow convergence alone.
    euler: backward Euler in place of generalised-alpha: it damps all motion, also that of low frequency.
    """

    radius: float
    accuracy: float | None
    euler: bool = False

    @property
    def alpha_m(self) -> float:
        """Weight of the old acceleration."""
        return 0.0 if self.euler else (2.0 * self.radius - 1.0) / (self.radius + 1.0)

    @property
    def alpha_f(self) -> float:
        """Weight of the old forces."""
        return 0.0 if self.euler else self.radius / (self.radius + 1.0)

    @property
    def beta(self) -> float:
        """Weight of the new acceleration in the displacement."""
        return 1.0 if self.euler else 0.25 * (1.0 - self.alpha_m + self.alpha_f) ** 2

    @property
    def past(self) -> float:
        """Weight of the old acceleration in the displacement."""
        return 0.0 if self.euler else 0.5 - self.beta

    @property
    def gamma(self) -> float:
        """Weight of the new acceleration in the velocity."""
        return 1.0 if self.euler else 0.5 - self.alpha_m + self.alpha_f


# transient: waves and swings are wanted; moderate: the motion, but not its high frequencies; quasi-static: its rest
SCHEMES = {
    "transient": Scheme(0.9, 1e-4),
    "moderate": Scheme(0.5, 1e-3),
    "quasi-static": Scheme(0.0, None, euler=True),
}


class Inertia:
    """The forces of inertia in one step (a `Drag`), and the motion at its end.

    start: the state before; seconds: size of the step.
    """

    def __init__(self, mass: Mass, scheme: Scheme, start: State, seconds: float):
        self.mass, self.scheme, self.start, self.seconds = mass, scheme, start, seconds
        zero = np.zeros_like(start.displacement)
        self._velocity = zero if start.velocity is None else start.velocity
        self._acceleration = zero if start.acceleration is None else start.acceleration
        self._imbalance = zero.ravel() if start.imbalance is None else start.imbalance
        s, h = scheme, seconds
        self._origin = start.displacement + h * self._velocity + h * h * s.past * self._acceleration
        self._factor = (1.0 - s.alpha_m) / ((1.0 - s.alpha_f) * s.beta * h * h)
        old = s.alpha_f * self._imbalance + s.alpha_m * mass.times(self._acceleration).ravel()
        self._old = old / (1.0 - s.alpha_f)

    def force(self, displacement: Array) -> Array:
        """Return the force (unknowns,), N, that stands beside R at a displacement (nodes, d)."""
        return self._factor * self.mass.times(displacement - self._origin).ravel() + self._old

    def add_tangent(self, values: Array) -> None:
        """Add the derivative of the force to the tangent."""
        self.mass.add(self._factor, values)

    def motion(self, displacement: Array) -> tuple[Array, Array]:
        """Return velocity and acceleration (nodes, d) at the end, mm/s and mm/s2."""
        s, h = self.scheme, self.seconds
        acceleration = (displacement - self._origin) / (s.beta * h * h)
        velocity = self._velocity + h * ((1.0 - s.gamma) * self._acceleration + s.gamma * acceleration)
        return velocity, acceleration

    def error(self, displacement: Array) -> float:
        """Return the error of the step over what the scheme allows: 1 is just allowed, 0 if there is no limit.

        The error is that of the displacement against its Taylor series, h^2 (b - 1/6) (a - a_n) (Zienkiewicz and Xie,
        Earthq. Eng. Struct. Dyn. 20 (1991) 871), over the largest displacement, the way of ten steps at the present
        velocity, or a thousandth of the body, whichever is largest.
        """
        if self.scheme.accuracy is None:
            return 0.0
        velocity, acceleration = self.motion(displacement)
        share = abs(self.scheme.beta - 1.0 / 6.0) * self.seconds**2
        missed = share * float(np.abs(acceleration - self._acceleration).max())
        way = 10.0 * self.seconds * float(np.abs(velocity).max())
        scale = max(float(np.abs(displacement).max()), way, 1e-3 * self.start.model.mesh.size)
        return missed / (self.scheme.accuracy * scale) if missed else 0.0

    def lost(self, displacement: Array, imbalance: Array) -> float:
        """Return the energy that the integration damped away in the step, mJ.

        It is the work of the unbalanced forces (supports included, by the trapezoidal rule) not found as motion.
        """
        velocity, acceleration = self.motion(displacement)
        moved = (displacement - self.start.displacement).ravel()
        held = self.start.model.held
        forces = self._imbalance + imbalance
        # at the supports the reaction, imbalance + M a, works as well
        forces[held] -= (self._imbalance + imbalance + self.mass.times(self._acceleration + acceleration).ravel())[held]
        gained = kinetic(self.mass, velocity) - kinetic(self.mass, self._velocity)
        return -0.5 * float(forces @ moved) - gained


def kinetic(mass: Mass, velocity: Array) -> float:
    """Return the kinetic energy of nodal velocities (nodes, d), mJ."""
    return 0.5 * float(np.sum(velocity * mass.times(velocity)))
