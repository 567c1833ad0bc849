"""Tube with a bonded lattice skin and stiff end caps: its dimensions and closed-form volumes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pneumorph.errors import GeometryError
from pneumorph.geometry.lattice.cell_map import Map, halves
from pneumorph.geometry.lattice.sheet import Lattice
from pneumorph.geometry.lattice.unit_cell import finite_length

_CLOSED = 1e-6


@dataclass(frozen=True)
class SkinnedTube:
    """Tube about the z axis from the clamp (z = 0), with a rolled lattice outside and a disc inside each end; mm.

    lattice: the flat sheet; as wide as the skin is around at the middle of its depth, as long as the tube.
    radius: outer of the tube, R. wall: of the tube, t. depth: of the skin, radial, a. cap: thickness of the discs.
    tip_radius: R at the tip of a cone; None for a cylinder. Wall and depth, radial, stay; the cells narrow with it.

    Raises GeometryError for lengths out of range and for cells that do not close around the circumference.
    """

    lattice: Lattice
    radius: float = 14.5
    wall: float = 2.0
    depth: float = 2.0
    cap: float = 2.0
    tip_radius: float | None = None

    def __post_init__(self) -> None:
        for name in ("radius", "wall", "depth", "cap", *(("tip_radius",) if self.tip_radius is not None else ())):
            finite_length(name, getattr(self, name))
        smallest = min(self.radius, self.end_radius)
        if self.wall >= smallest:
            raise GeometryError(f"lattice: wall = {self.wall:g} mm: expected less than the radius, {smallest:g} mm")
        if 2.0 * self.cap >= self.lattice.length:
            raise GeometryError(
                f"lattice: cap = {self.cap:g} mm: expected less than half the length, {self.lattice.length / 2.0:g} mm"
            )
        around = circumference(self.radius, self.depth)
        if abs(self.lattice.around - around) > _CLOSED * around:
            raise GeometryError(
                f"lattice: the cells do not close around the circumference: {self.lattice.columns} of width = "
                f"{self.lattice.width:.6g} mm make {self.lattice.around:.6g} mm, expected 2 pi (radius + depth / 2) = "
                f"{around:.6g} mm"
            )

    @property
    def end_radius(self) -> float:
        """Outer radius of the tube at the tip, mm."""
        return self.radius if self.tip_radius is None else self.tip_radius

    def outer_radius(self, z: float) -> float:
        """Return the outer radius of the tube at z, mm."""
        return self.radius + (self.end_radius - self.radius) * z / self.lattice.length

    @property
    def tube_volume(self) -> float:
        """Volume of the tube's wall, mm³."""
        mean = (self.radius + self.end_radius) / 2.0 - self.wall / 2.0
        return 2.0 * math.pi * mean * self.wall * self.lattice.length

    @property
    def cavity_volume(self) -> float:
        """Volume between the caps, mm³."""
        low, high = self.cap, self.lattice.length - self.cap
        a, b = self.outer_radius(low) - self.wall, self.outer_radius(high) - self.wall
        return math.pi * (high - low) * (a * a + a * b + b * b) / 3.0


def circumference(radius: float, depth: float) -> float:
    """Return the width of the sheet that, rolled on a radius, closes at the middle of its depth, mm."""
    return 2.0 * math.pi * (radius + depth / 2.0)


def skinned_tube(
    cells: Map | None = None, *, length: float = 104.3, radius: float = 14.5, beam: float = 1.57, depth: float = 2.0,
    wall: float = 2.0, cap: float = 2.0,
) -> SkinnedTube:  # fmt: skip
    """Return the cylinder whose cells are as wide and high as they must be to fill it with a map of cells.

    Default: the study's 7 cells along and 12 around, half of them re-entrant, cg = 0.2.
    """
    chosen = halves(7, 12) if cells is None else cells
    if not chosen or not chosen[0]:
        raise GeometryError("lattice: the map of cells is empty, expected at least one row of at least one cell")
    for name, value in (("length", length), ("radius", radius), ("depth", depth)):
        finite_length(name, value)
    sheet = Lattice(circumference(radius, depth) / len(chosen[0]), length / len(chosen), beam, chosen)
    return SkinnedTube(sheet, radius, wall, depth, cap)
