"""What contact adds to one iteration of Newton's method: friction, room in the pattern, tangent, softer steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.contact.contacts import Rubbing
from pneumorph.mechanics.contact.part import NO_ENTRIES, Entries
from pneumorph.mechanics.contact.widened import WidenedPattern
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.state import State

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Tangent:
    """Contact in a tangent: matrix entries (upper triangle), and columns (unknowns, contacts) for obstacles' ways."""

    entries: Entries
    coupling: Array

    def bend(self, left: Array, du: Array, dw: Array) -> float:
        """Return left . (H du + C dw) for vectors (unknowns,) and moves (contacts,) of the obstacles."""
        rows, columns, values = self.entries
        mirrored = np.where(rows == columns, 0.0, left[columns] * du[rows])
        return float(values @ (left[rows] * du[columns] + mirrored)) + float(left @ (self.coupling @ dw))


@dataclass(frozen=True, eq=False)
class Forces:
    """Unbalanced forces before a step (unknowns,), those of contact in them, and the friction that these are by."""

    residual: Array
    pushed: Array
    rubbing: Rubbing | None


class Touching:
    """The contacts of a model in its Newton iterations; `wide` is the pattern of the tangent with them."""

    def __init__(self, model: Model):
        self.contact = model.contact
        self.wide = WidenedPattern(model.body.pattern)
        self._unknowns = model.body.unknowns
        self._held = model.held

    def __bool__(self) -> bool:
        return bool(self.contact)

    def make_room(self, start: State) -> None:
        """Give the pattern room for the pairs that are near at the start of an increment, and for them alone.

        So it does not depend on what was near earlier, and a run that is resumed rounds the same way.
        """
        if not self.contact:
            return
        wide = WidenedPattern(self.wide.base)
        wide.include(self.contact.near(start.positions, self.contact.ways(start.values)))
        if not np.array_equal(wide.pattern.keys, self.wide.pattern.keys):
            self.wide = wide

    def rubbing(self, start: State, seconds: float, at: tuple[Array, Array] | None = None) -> Rubbing | None:
        """Return the friction since a state, by the normal forces in it or at other positions and ways; or None."""
        if not self.contact.friction:
            return None
        return self.contact.rubbing(start.positions, self.contact.ways(start.values), seconds, at)

    def tangent(
        self, values: Array, position: Array, ways: Array, rubbing: Rubbing | None, exact: bool
    ) -> tuple[Array, Tangent]:
        """Return the values of a tangent with contact, in the wide pattern, and the part of contact in it.

        exact: Hessian of the barrier, or one projected to be positive semi-definite: for far from the solution.
        """
        if not self.contact:
            return values, Tangent(NO_ENTRIES, np.zeros((self._unknowns, 0)))
        total = self.contact.evaluate(position, ways, rubbing, hessian=True, exact=exact)
        missing = self.wide.missing(total.entries)
        if len(missing):
            self.wide.include(np.concatenate([missing, self.contact.near(position, ways)]))
        wide = self.wide.widen(values)
        self.wide.add(total.entries, wide)
        return wide, Tangent(total.entries, total.coupling)

    def softened(
        self, place: tuple[Array, Array], step: tuple[Array, Array], forces: Forces, tangent: Tangent, most: float
    ) -> float:
        """Return the share of a step, at most `most`, at which the forces along it nearly vanish, if it went too far.

        place, step: positions (nodes, d) and ways (contacts,), and their full change. Contact and friction stiffen and
        slacken within one step, so full steps may jump to and fro for ever. Along the step only their forces are
        evaluated; those of the body are taken to change linearly, as its large bulk modulus makes them mislead.
        """
        (position, ways), (du, dw) = place, step
        free = du.ravel().copy()
        free[self._held] = 0.0
        before, contact = float(free @ forces.residual), float(free @ forces.pushed)
        slope = -before - tangent.bend(free, du.ravel(), dw)

        def left(share: float) -> float:
            at = position + share * du, ways + share * dw
            pushed = self.contact.evaluate(*at, forces.rubbing, hessian=False).gradient
            return before + share * slope + float(free @ pushed) - contact

        low, high, at_high = 0.0, most, left(most)
        if before >= 0.0 or at_high <= 0.5 * abs(before):
            return most
        at_low, share = before, most
        for _ in range(8):
            share = low + (high - low) * min(max(at_low / (at_low - at_high), 0.1), 0.9)
            here = left(share)
            if abs(here) <= 0.2 * abs(before):
                break
            if here > 0.0:
                high, at_high = share, here
            else:
                low, at_low = share, here
        return share
