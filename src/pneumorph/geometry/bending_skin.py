"""Tube under a lattice skin of two halves, re-entrant and honeycomb, that bends (Pu et al. 2024)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from pneumorph.errors import GeometryError
from pneumorph.geometry.actuator import Actuator, millimetres, whole_number
from pneumorph.geometry.lattice import SkinnedTube, skinned_tube
from pneumorph.geometry.lattice.cell_map import Cell, Map, Segment, cell_map, halves
from pneumorph.geometry.lattice.unit_cell import KINDS
from pneumorph.geometry.occ import Shape

Runs = tuple[tuple[int, str], ...]


@dataclass(frozen=True)
class SkinSegment:
    """A segment of the map, [[actuator.segment]]: rows of cells that are alike, one segment after the other.

    rows: cells along.
    columns: runs around, each a number of columns and the kind of their cells; left out, the halves that `reentrant`
        makes.
    cg: gap of a cell over its height; left out, that of the skin.
    turn: columns by which the runs are moved around, anticlockwise as seen from the tip.

    Raises GeometryError for numbers out of range or kinds that there are not.
    """

    rows: int
    columns: Runs | None = field(default=None, metadata={"kind": "runs", "names": tuple(KINDS)})
    cg: float | None = None
    turn: int = 0

    def __post_init__(self) -> None:
        for name in ("rows", "turn"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or (name == "rows" and value < 1):
                least = " of at least 1" if name == "rows" else " of columns"
                raise GeometryError(f"segment: {name} = {value!r}: expected a whole number{least}")
        if self.cg is not None and not _is_number(self.cg):
            raise GeometryError(f"segment: cg = {self.cg!r}: expected a number above 0, at most 0.5")
        if self.columns is not None:
            Segment(self.rows, tuple((count, Cell(kind)) for count, kind in self.columns))

    def cells(self, columns: Runs, cg: float, least_beam: float = 0.0) -> Segment:
        """Return the segment of a map; columns, cg: what holds where the segment has none of its own."""
        chosen, gap = (columns if self.columns is None else self.columns), (cg if self.cg is None else self.cg)
        row = Segment(self.rows, tuple((count, Cell(kind, gap, least_beam)) for count, kind in chosen)).row
        start = -self.turn % len(row)
        return Segment(self.rows, tuple((1, cell) for cell in (*row[start:], *row[:start])))


@dataclass(frozen=True)
class BendingSkin(Actuator):
    """Soft tube with a stiff lattice skin that bends away from its re-entrant half; lengths in mm.

    The tube stands on the face "clamp" (z = 0, end faces of tube and skin) and ends in "tip". Around lie the re-entrant
    cells, their middle at x > 0, then the honeycomb ones. Inside its ends sit stiff discs (domain "cap"; their
    outsides are "clamp_cap" and "tip_cap"). The tube between the beams is "outer", the skin's surface "skin". `half`
    keeps y >= 0 with the cut face "symmetry_y"; its cavity holds half the volume. It is meshed from its flat map
    (see `mesh.skinned`) and has no CAD solid. Other maps: `geometry.lattice`.

    reentrant: share of the columns around that are re-entrant, 0 to 1; a whole number of columns.
    cg: gap of a cell over its height, above 0 to 0.5, where both kinds are the same brick.
    least_beam: width below which the oblique beams, between rows of holes, do not go; 0 leaves the holes as published,
        whose rows touch at cg = 0.5. Not of the study: an assumption where it is given.
    segment: a map by segments from the clamp, `cells_along` rows in all; none: one segment.
    blend: cells along, half of them on either side of a border, over which one segment goes over into the next; an even
        number, 0 for at once.
    half: keep the part with y >= 0 only, cut in the plane of symmetry.

    Source: Pu, Zheng, Hu, Tang, An, Materials & Design 246 (2024) 113334, Table 1. Raises GeometryError.
    """

    cells_along: int = whole_number(7, "nv", "cells along the tube", given=True)
    cells_around: int = whole_number(12, "nh", "columns of cells around the tube", given=True)
    reentrant: float = field(default=0.5, metadata={"help": "share of the columns that are re-entrant, 0 to 1"})
    cg: float = field(default=0.2, metadata={"help": "gap of a cell over its height, at most 0.5"})
    length: float = millimetres(104.3, "L", "whole length", given=True)
    radius: float = millimetres(14.5, "R", "outer radius of the tube", given=True)
    wall: float = millimetres(2.0, "t", "wall of the tube", given=True)
    depth: float = millimetres(2.0, "a", "depth of the beams, radial", given=True)
    beam: float = millimetres(1.57, "b", "width of the straight beams", given=True)
    cap: float = millimetres(2.0, "c", "thickness of the discs in the ends", given=True)
    least_beam: float = millimetres(0.0, "b_min", "least width of the oblique beams, 0 for as published", zero=True)
    segment: tuple[SkinSegment, ...] = ()
    blend: int = 0
    half: bool = field(default=False, metadata={"help": "keep the part with y >= 0 only, cut in the plane of symmetry"})

    def _check_fit(self) -> None:
        self._require(isinstance(self.half, bool), f"half = {self.half!r}: expected True or False")
        for name, allowed in (("cg", "above 0, at most 0.5"), ("reentrant", "from 0 to 1")):
            value = getattr(self, name)
            self._require(_is_number(value), f"{name} = {value!r}: expected a number {allowed}")
        columns = self.reentrant * self.cells_around
        self._require(
            0.0 <= self.reentrant <= 1.0 and abs(columns - round(columns)) < 1e-6,
            f"reentrant = {self.reentrant:g} of cells_around = {self.cells_around} makes {columns:g} columns: expected "
            "a whole number of them, none to all",
        )
        for number, item in enumerate(self.segment, 1):
            around = sum(count for count, _ in item.columns) if item.columns is not None else self.cells_around
            self._require(
                around == self.cells_around,
                f"segment {number} has {around} columns: expected cells_around = {self.cells_around}",
            )
        self._require(bool(self.segment) or self.blend == 0, f"blend = {self.blend}: expected segments to blend, or 0")
        rows = sum(item.rows for item in self.segment)
        self._require(
            not self.segment or rows == self.cells_along,
            f"the segments have {rows} rows: expected cells_along = {self.cells_along}",
        )
        mirror = self.tube.lattice.mirror
        self._require(
            not self.half or mirror is not None,
            "half = True: the map of cells is not its own mirror image, expected one that is, or half = False",
        )

    @cached_property
    def tube(self) -> SkinnedTube:
        """The tube with the flat sheet of its skin."""
        return skinned_tube(
            self.cells, length=self.length, radius=self.radius, beam=self.beam, depth=self.depth, wall=self.wall,
            cap=self.cap,
        )  # fmt: skip

    @property
    def cells(self) -> Map:
        """The map of cells, from the clamp."""
        count = round(self.reentrant * self.cells_around)
        if not self.segment:
            return halves(self.cells_along, self.cells_around, self.cg, reentrant=count, least_beam=self.least_beam)
        runs = ((count, "re-entrant"), (self.cells_around - count, "honeycomb"))
        usual = tuple(run for run in runs if run[0])
        return cell_map([item.cells(usual, self.cg, self.least_beam) for item in self.segment], blend=self.blend)

    @property
    def outer_edge(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Ends of the tube's outer line over the middle of the first run, on the outside of the bend (2, 3), mm."""
        return (self.radius, 0.0, 0.0), (self.radius, 0.0, self.length)

    @property
    def cavities(self) -> tuple[str, ...]:
        """The one cavity."""
        return ("cavity",)

    @property
    def face_names(self) -> tuple[str, ...]:
        """clamp, tip, their caps, cavity, outer, skin and the symmetry plane of a half."""
        names = ("clamp", "tip", "clamp_cap", "tip_cap", "cavity", "outer", "skin")
        return (*names, "symmetry_y") if self.half else names

    @property
    def domains(self) -> tuple[str, ...]:
        """tube, skin and cap."""
        return ("tube", "skin", "cap")

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """The wall of the tube."""
        return {"wall": self.wall}

    @property
    def default_size(self) -> float:
        """A quarter of the height of a cell."""
        return self.tube.lattice.height / 4.0

    @property
    def cavity_volume(self) -> float:
        """Volume between the caps, of the half if it is one, mm³."""
        return self.tube.cavity_volume / (2.0 if self.half else 1.0)

    def shape(self) -> Shape:
        """Raise GeometryError: there is no CAD solid."""
        raise GeometryError("BendingSkin: it is meshed from its flat map and has no CAD solid: export its mesh instead")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
