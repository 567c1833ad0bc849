"""The reduced limb: rigid links on hinges whose springs and rest angles depend on the pressure."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.units import show

Array = NDArray[np.float64]

_STEPS = 200  # Newton steps that a chain of a few hinges never needs
_LARGEST = 0.5  # rad that a hinge may turn in one of them


@dataclass(frozen=True, eq=False)
class ReducedLimb:
    """A plane chain of n hinges; mm, N, rad, MPa; axes as in `LimbData`.

    hinges:     (n, 2), places in the unloaded shape. load_point, end: (2,), on the last link: where the tip force acts,
                and the end of the limb's line.
    rest:       (n, a), coefficients of the rest angle r(p) = rest[:, 0] p + rest[:, 1] p^2 + ..., rad.
    compliance: (n, b), coefficients of the compliance c(p) = compliance[:, 0] + compliance[:, 1] p + ..., rad/(N mm).
    stop:       (n, d), coefficients of the angle s(p) = stop[:, 0] + stop[:, 1] p + ... below which neighbouring pleats
                touch, rad. stop_stiffness: (n,), of their contact, N mm/rad; 0 for none.
    pressures:  (least, largest) of the data that the law was fitted to, MPa; it is not used beyond them.
    thickness, width, foot, mount: as in `LimbData`.

    A hinge takes the moment M(angle, p) = (angle - r(p)) / c(p) - stop_stiffness max(0, s(p) - angle).

    Raises InputError for arrays that do not fit together a compliance that is not positive at every pressure, or a
    negative stiffness of a stop.
    """

    hinges: Array
    load_point: Array
    end: Array
    rest: Array
    compliance: Array
    stop: Array
    stop_stiffness: Array
    pressures: tuple[float, float]
    thickness: tuple[float, float]
    width: float
    foot: float
    mount: tuple[float, float, float]

    def __post_init__(self) -> None:
        count = len(self.hinges)
        laws = (self.rest, self.compliance, self.stop, self.stop_stiffness)
        if self.hinges.shape != (count, 2) or any(len(values) != count for values in laws):
            raise InputError(
                f"reduced limb: {self.hinges.shape} is the shape of hinges, {', '.join(str(v.shape) for v in laws)} "
                "those of rest, compliance, stop and stop_stiffness, expected (n, 2), (n, a), (n, b), (n, d) and (n,)"
            )
        if self.stop_stiffness.min() < 0.0:
            raise InputError(f"reduced limb: stop_stiffness = {self.stop_stiffness.min():g}, expected at least 0")
        if not self.pressures[0] <= 0.0 < self.pressures[1]:
            raise InputError(
                f"reduced limb: pressures from {show(self.pressures[0], 'pressure')} to "
                f"{show(self.pressures[1], 'pressure')}, expected a range that holds 0 and more"
            )
        least = self._compliance(self._grid).min(axis=0)
        if least.min() <= 0.0:
            raise InputError(
                f"reduced limb: hinge {int(least.argmin()) + 1} has a compliance of {least.min():.3g} rad/(N mm) at a "
                "pressure of its range, expected more than 0: too few or contradictory tip forces"
            )

    @property
    def _grid(self) -> Array:
        return np.linspace(*self.pressures, 101)

    def _compliance(self, pressure: ArrayLike) -> Array:
        return np.asarray(np.asarray(pressure)[..., None] ** np.arange(self.compliance.shape[1]) @ self.compliance.T)

    def check_pressure(self, pressure: ArrayLike) -> None:
        """Raise InputError for a pressure outside the fitted range."""
        low, high = self.pressures
        # a rounding error is no extrapolation
        outside = ~((np.asarray(pressure) >= low - 1e-9) & (np.asarray(pressure) <= high + 1e-9))
        if outside.any():
            first = float(np.asarray(pressure)[outside].flat[0])
            raise InputError(
                f"pressure = {show(first, 'pressure')}: outside the range that the limb was fitted in, "
                f"{show(low, 'pressure')} to {show(high, 'pressure')}"
            )

    def rest_angles(self, pressure: ArrayLike) -> Array:
        """Return the angles (..., n) that the hinges take without load at pressures (...); see `check_pressure`."""
        self.check_pressure(pressure)
        powers = np.asarray(pressure, dtype=float)[..., None] ** np.arange(1, self.rest.shape[1] + 1)
        return np.asarray(powers @ self.rest.T)

    def stiffness(self, pressure: ArrayLike) -> Array:
        """Return the stiffness (..., n) of the hinges, N mm/rad, at pressures (...); see `check_pressure`."""
        self.check_pressure(pressure)
        return 1.0 / self._compliance(pressure)

    def stop_angles(self, pressure: ArrayLike) -> Array:
        """Return the angles (..., n) below which pleats touch at pressures (...); see `check_pressure`."""
        self.check_pressure(pressure)
        return np.asarray(np.asarray(pressure)[..., None] ** np.arange(self.stop.shape[1]) @ self.stop.T)

    def springs(self, pressure: ArrayLike) -> Springs:
        """Return the hinges' laws at pressures (...); raises InputError as `check_pressure`."""
        return Springs(
            self.stiffness(pressure), self.rest_angles(pressure), self.stop_stiffness, self.stop_angles(pressure)
        )

    @cached_property
    def monotone(self) -> bool:
        """Whether every rest angle grows in its own direction over the whole range of pressures."""
        steps = np.diff(self.rest_angles(self._grid), axis=0)
        return bool(((steps >= 0.0).all(axis=0) | (steps <= 0.0).all(axis=0)).all())

    @cached_property
    def links(self) -> Array:
        """(n + 1, 2), from the clamp to the first hinge, from hinge to hinge, and from the last one to the load point,
        in the unloaded shape."""
        return np.diff(np.vstack([np.zeros(2), self.hinges, self.load_point]), axis=0)

    def shape(self, angles: ArrayLike) -> tuple[Array, Array]:
        """Return the places of the hinges (n, 2) and of the load point (2,) for angles (n,) of the hinges."""
        return chain(self.links, np.asarray(angles, dtype=float))

    def equilibrium(self, pressure: float, force: ArrayLike) -> Array:
        """Return the angles (n,) of the hinges under a pressure and a tip force (2,) that keeps its direction.

        Newton's method on the potential energy, whose second derivative (springs, stops and turning levers) is exact.
        Raises InputError for a pressure out of range and for a force under which the chain finds no stable shape.
        """
        load = np.asarray(force, dtype=float)
        springs = self.springs(pressure)
        angles = springs.rest.copy()
        order = np.arange(len(angles))
        outer = np.maximum.outer(order, order)

        def energy(theta: Array) -> float:
            return float(springs.energy(theta).sum() - load @ self.shape(theta)[1])

        for _ in range(_STEPS):
            hinges, tip = self.shape(angles)
            lever = tip - hinges
            excess = springs.moment(angles) - cross(lever, load)
            if np.abs(excess).max() < 1e-10 * springs.stiffness.max():
                return angles
            # d M_i / d angle_j = -(lever of the outer one of both) . force
            own = np.diag(springs.tangent(angles))
            tangent = own + (lever @ load)[outer]
            if np.linalg.eigvalsh(tangent)[0] <= 0.0:
                tangent = own
            step = -np.linalg.solve(tangent, excess)
            step *= min(1.0, _LARGEST / np.abs(step).max())
            before, slope = energy(angles), float(excess @ step)
            # near the end the energy has no digits left: then the full step is right
            while energy(angles + step) > before + 1e-4 * slope + 1e-12 * abs(before) and np.abs(step).max() > 1e-9:
                step, slope = 0.5 * step, 0.5 * slope
            angles = angles + step
        raise InputError(f"tip force = {np.round(load, 4).tolist()} N: the limb finds no stable shape under it")


@dataclass(frozen=True, eq=False)
class Springs:
    """Hinges at given pressures: stiffness, rest angles, stiffness and angles of the stops, each (..., n)."""

    stiffness: Array
    rest: Array
    stop_stiffness: Array
    stop: Array

    def moment(self, angles: Array) -> Array:
        """Return the moments (..., n) that hold the hinges at angles, N mm."""
        return self.stiffness * (angles - self.rest) - self.stop_stiffness * np.maximum(0.0, self.stop - angles)

    def tangent(self, angles: Array) -> Array:
        """Return the derivative of the moments, N mm/rad."""
        return np.asarray(self.stiffness + self.stop_stiffness * (angles < self.stop))

    def energy(self, angles: Array) -> Array:
        """Return the energy (..., n) of the hinges, mJ."""
        closed = np.maximum(0.0, self.stop - angles)
        return np.asarray(0.5 * self.stiffness * (angles - self.rest) ** 2 + 0.5 * self.stop_stiffness * closed**2)

    def angles(self, moments: Array) -> Array:
        """Return the angles (..., n) at which the hinges take moments, rad."""
        free = self.rest + moments / self.stiffness
        stiffness, rest = self.as_lines(free)
        return np.asarray(rest + moments / stiffness)

    def as_lines(self, angles: Array) -> tuple[Array, Array]:
        """Return stiffness and rest angle (..., n) of the straight line of each law on which the angles lie."""
        stiffness = self.tangent(angles)
        touching = stiffness - self.stiffness
        return stiffness, (self.stiffness * self.rest + touching * self.stop) / stiffness


def chain(links: Array, angles: Array) -> tuple[Array, Array]:
    """Return hinges (..., n, 2) and far end (..., 2) of links (n + 1, 2), each turned by angles (..., n) on the last.

    The first link stays.
    """
    turn = np.concatenate([np.zeros((*angles.shape[:-1], 1)), np.cumsum(angles, axis=-1)], axis=-1)
    c, s = np.cos(turn), np.sin(turn)
    x, y = links[:, 0], links[:, 1]
    places = np.cumsum(np.stack([c * x - s * y, s * x + c * y], axis=-1), axis=-2)
    return places[..., :-1, :], places[..., -1, :]


def cross(first: Array, second: Array) -> Array:
    """Return the moment (...,) of plane vectors (..., 2)."""
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])
