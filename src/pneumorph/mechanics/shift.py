"""Pseudo-transient continuation: what Newton's method adds to a tangent that has unstable modes.

Where beams or walls buckle within an increment, steps of the tangent alone lead along its unstable modes anywhere, or
to a saddle. With a multiple c of the mass matrix added, raised until no mode is unstable, each iteration is one
implicit step of the motion
    c M du/dt = -r(u)
that leads downhill to the next stable state (Kelley, Keyes, SIAM J. Numer. Anal. 35 (1998) 508); c falls to zero on the
way, so that the end of the iteration, and the equilibrium, are those of the tangent alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_PATIENCE = 3  # unstable tangents in a row before one is shifted: many are only unstable on the way
_FALL = 0.3
_CLOSE = 1.6  # what was enough over what was not: no need to look closer
_NEAR = 1e-3  # error from which the tangent alone is tried again
_MOST = 1e9  # of the first coefficient: no higher one is of use


class Shift:
    """The multiple of the mass matrix in one increment; it is zero until it is first raised.

    mass (unknowns,): per unit density, mm3; first: coefficient, MPa / mm2, at first, 0 for no shift ever.
    used: whether there was any; iterations: how many do not count against the limit.
    """

    def __init__(self, mass: Array, first: float):
        self._mass, self._first = mass, first
        self._coefficient, self._short, self._enough = 0.0, 0.0, 0.0
        self._unstable, self._raised, self._patience = 0, False, _PATIENCE
        self.iterations = 0
        self.used = False

    def __bool__(self) -> bool:
        return self._coefficient > 0.0

    def relaxed(self, error: float) -> Array:
        """Return the diagonal (unknowns,) for the next tangent, lower than the last.

        The least that makes it stable is best: along an unstable mode of eigenvalue -l an iteration grows by
        1 / (1 - l / c). Where the last was raised, look between what was not enough and what was.
        """
        if self._raised:
            close = self._enough <= _CLOSE * self._short
            self._coefficient = self._enough if close else self._between()
        else:
            self._short = 0.0
            self._coefficient *= _FALL if error > _NEAR else 0.0
        self._raised = False
        self.iterations += self._coefficient > 0.0
        return self._coefficient * self._mass

    def wanted(self, unstable: int | None) -> bool:
        """Return whether a tangent with unstable modes is to be shifted (further)."""
        if not self._first or not unstable or self._coefficient > _MOST * self._first:
            self._unstable, self._enough = 0, self._coefficient or self._enough
            return False
        self._unstable += 1
        return self.used or self._unstable >= self._patience

    def raised(self) -> Array:
        """Raise the coefficient and return what this adds to the diagonal (unknowns,)."""
        before = self._short = self._coefficient
        self._coefficient = self._between() if _CLOSE * before < self._enough else max(2.0 * before, self._first)
        self.iterations += before == 0.0
        self._raised = self.used = True
        return (self._coefficient - before) * self._mass

    def again(self, iterations: int) -> bool:
        """Return whether to start once more after iterations that led to a saddle, now shifting without patience."""
        if not self._first or self.used or self._patience == 1:
            return False
        self._patience = 1
        self.iterations = iterations
        return True

    def _between(self) -> float:
        """Return a coefficient between one that was not enough, or nothing, and one that was."""
        return float(np.sqrt(max(self._short, 0.01 * self._enough) * self._enough))
