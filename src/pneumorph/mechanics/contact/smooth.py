"""Contact of a surface with a smooth rigid obstacle, by gaps at its force points (see `facets`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.mechanics.contact.barrier import barrier, friction
from pneumorph.mechanics.contact.facets import Points
from pneumorph.mechanics.contact.obstacles import Smooth
from pneumorph.mechanics.contact.part import NO_ENTRIES, Entries, Part, Place, upper

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

KEPT = 0.3  # share of a distance that a step leaves


@dataclass(frozen=True, eq=False)
class SmoothLag:
    """Normal force (m,), N, and tangential projection (m, d, d) at the force points of each group."""

    force: list[Array]
    plane: list[Array]


class SmoothContact:
    """A surface's force points against a half-space or in a pipe (an `Interaction`).

    along (d,): direction in which the obstacle moves; reach: mm; stiffness: MPa; coefficient: of friction.
    """

    def __init__(
        self, points: list[Points], obstacle: Smooth, along: Array, reach: float, stiffness: float, coefficient: float
    ):
        self.points, self.obstacle, self.along = points, obstacle, along
        self.reach, self.stiffness, self.coefficient = reach, stiffness, coefficient

    def _gaps(self, group: Points, place: Place) -> tuple[Array, Array, Array]:
        at = np.einsum("mk,mki->mi", group.share, place.position[group.nodes])
        return self.obstacle.gap(at - place.way * self.along)

    def normal(self, place: Place, *, hessian: bool, exact: bool = True) -> Part:
        """Return the barrier; its Hessian is positive semi-definite by itself, as no obstacle is convex."""
        total = _Sum(place.position, self.along)
        for group in self.points:
            gap, normal, bend = self._gaps(group, place)
            near = gap < self.reach
            value, first, second = (group.weight[near] * v for v in barrier(gap[near], self.reach, self.stiffness))
            n = normal[near]
            blocks = None
            if hessian:
                blocks = second[:, None, None] * n[:, :, None] * n[:, None, :] + first[:, None, None] * bend[near]
            total.add(group, near, float(value.sum()), first[:, None] * n, blocks)
        return total.part()

    def lag(self, place: Place) -> SmoothLag:
        """Return normal forces and tangential planes."""
        force, plane = [], []
        for group in self.points:
            gap, normal, _ = self._gaps(group, place)
            _, first, _ = barrier(gap, self.reach, self.stiffness)
            force.append(-group.weight * first)
            plane.append(np.eye(normal.shape[1]) - normal[:, :, None] * normal[:, None, :])
        return SmoothLag(force, plane)

    def tangential(self, lag: object, start: Place, place: Place, transition: float, *, hessian: bool) -> Part:
        """Return the potential of friction on the way from `start`, with a slip (mm) up to which it holds."""
        assert isinstance(lag, SmoothLag)
        total = _Sum(place.position, self.along)
        moved = place.position - start.position
        way = (place.way - start.way) * self.along
        for group, force, plane in zip(self.points, lag.force, lag.plane, strict=True):
            near = force > 0.0
            limit, plane = self.coefficient * force[near], plane[near]
            relative = np.einsum("mk,mki->mi", group.share[near], moved[group.nodes[near]]) - way
            slip = np.einsum("mij,mj->mi", plane, relative)
            size = np.linalg.norm(slip, axis=1)
            integral, over, slope = friction(size, transition)
            blocks = None
            if hessian:
                unit = slip / np.maximum(size, 1e-300)[:, None]
                blocks = over[:, None, None] * plane
                blocks = blocks + (slope - over)[:, None, None] * unit[:, :, None] * unit[:, None, :]
                blocks = limit[:, None, None] * blocks
            total.add(group, near, float(limit @ integral), (limit * over)[:, None] * slip, blocks)
        return total.part()

    def limit(self, start: Place, end: Place) -> float:
        """Return the share, 0 to 1, of a straight way that keeps all distances above a part of the present ones."""
        share = 1.0
        for _ in range(60):
            place = Place(
                start.position + share * (end.position - start.position), start.way + share * (end.way - start.way)
            )
            worst = 1.0
            for group in self.points:
                before, _, _ = self._gaps(group, start)
                after, _, _ = self._gaps(group, place)
                least = KEPT * np.minimum(before, self.reach)
                short = after < least
                if short.any():  # gaps are concave along a way: the chord's crossing lies on the safe side
                    way = (before - after)[short]
                    worst = min(worst, float(((before - least)[short] / way).min()))
            if worst == 1.0:
                return share
            share *= 0.999 * worst
        return 0.0

    def distance(self, place: Place) -> float:
        """Return the smallest distance, mm: infinite beyond reach, not positive where surfaces intersect."""
        least = min(float(self._gaps(group, place)[0].min()) for group in self.points)
        return least if least < self.reach else np.inf

    def pressing(self, place: Place) -> list[Array]:
        """Return the normal force at the force points of each group, N."""
        gaps = [self._gaps(group, place)[0] for group in self.points]
        pairs = zip(self.points, gaps, strict=True)
        return [-group.weight * barrier(gap, self.reach, self.stiffness)[1] for group, gap in pairs]

    def bearing(self, place: Place, deformed: list[Points]) -> tuple[float, float]:
        """Return the area within reach, mm2, and the largest pressure, MPa; deformed: force points as they are."""
        area, largest = 0.0, 0.0
        for group, now in zip(self.points, deformed, strict=False):  # those of free bodies come last
            gap, _, _ = self._gaps(group, place)
            area += float(now.weight[gap < self.reach].sum())
            force = -group.weight * barrier(gap, self.reach, self.stiffness)[1]
            largest = max(largest, float((force / now.weight).max()))
        return area, largest

    def worst(self, place: Place) -> tuple[float, Array]:
        """Return the smallest gap, within reach or not, and where it is (d,)."""
        found = []
        for group in self.points:
            gap, _, _ = self._gaps(group, place)
            i = int(np.argmin(gap))
            found.append((float(gap[i]), group.share[i] @ place.position[group.nodes[i]]))
        return min(found, key=lambda item: item[0])

    def intersection(self, place: Place) -> Array | None:
        """Return the deepest point (d,) in the obstacle; None where all are outside."""
        gap, where = self.worst(place)
        return where if gap <= 0.0 else None

    def near(self, place: Place) -> Integers:
        """Return no pairs: the nodes of a face are coupled by their cell."""
        return np.empty((0, 2), dtype=np.int64)


class _Sum:
    """Adds forces (m, d) and blocks (m, d, d) at force points up to a `Part`."""

    def __init__(self, position: Array, along: Array):
        self.shape, self.along = position.shape, along
        self.energy, self.gradient, self.push = 0.0, np.zeros(position.shape), np.zeros(position.shape[1])
        self.entries: list[Entries] = []
        self.coupling = np.zeros(position.shape)

    def add(self, group: Points, near: NDArray[np.bool_], energy: float, force: Array, blocks: Array | None) -> None:
        nodes, share, d = group.nodes[near], group.share[near], self.shape[1]
        self.energy += energy
        np.add.at(self.gradient, nodes, share[:, :, None] * force[:, None, :])
        self.push -= force.sum(axis=0)
        if blocks is None or not len(nodes):
            return
        pulled = -np.einsum("mij,j->mi", blocks, self.along)
        np.add.at(self.coupling, nodes, share[:, :, None] * pulled[:, None, :])
        unknowns = nodes[:, :, None] * d + np.arange(d)
        full = np.einsum("ma,mb,mij->maibj", share, share, blocks)
        rows = np.broadcast_to(unknowns[:, :, :, None, None], full.shape)
        columns = np.broadcast_to(unknowns[:, None, None, :, :], full.shape)
        self.entries.append(upper(rows.ravel(), columns.ravel(), full.ravel()))

    def part(self) -> Part:
        entries = tuple(np.concatenate(e) for e in zip(*self.entries, strict=True)) if self.entries else NO_ENTRIES
        return Part(self.energy, self.gradient.ravel(), entries, self.push, self.coupling.ravel())  # type: ignore[arg-type]
