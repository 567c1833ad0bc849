"""The flat sheet of a lattice: holes at their places, closed-form area, beams, and the lines that separate its rows."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import GeometryError
from pneumorph.geometry.lattice.beams import distance
from pneumorph.geometry.lattice.cell_map import Cell, Map
from pneumorph.geometry.lattice.unit_cell import finite_length, halved, kind_of

Array = NDArray[np.float64]

# of a length of the sheet: places closer than this are one
TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class Hole:
    """A hole: row from the clamp, place around, upper and lower chain (k, 2) of corners in the sheet, mm."""

    row: int
    place: int
    upper: Array
    lower: Array

    @property
    def corners(self) -> Array:
        """Corners (n, 2), anticlockwise; a pointed end, or the side of a brick, has its corners once."""
        loop = np.vstack([self.lower, self.upper[::-1]])
        return loop[np.abs(loop - np.roll(loop, 1, axis=0)).max(axis=1) > 0.0]

    @property
    def area(self) -> float:
        """Area, mm²."""
        x, y = self.corners.T
        return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


@dataclass(frozen=True)
class Lattice:
    """A sheet of unit cells: x around (periodic), y along from the clamp.

    width, height: of a unit cell, w and h, mm. beam: width b of the straight beams along y, mm.
    cells: map, cells along by columns around, see `cell_map`.

    A cell holds two rows of holes, h / 2 apart: one hole in the middle of its column, and half a hole at each border to
    the next column. A hole on a border takes each half from its own column, and the mean of their heights in between.

    Raises GeometryError for an empty or ragged map, lengths out of range, beams wider than the cell, a gap beyond the
    cell, holes that overlap or leave the sheet. Holes of neighbouring rows may touch: see `narrowest_beam`.
    """

    width: float
    height: float
    beam: float
    cells: Map

    def __post_init__(self) -> None:
        if not self.cells or not all(self.cells):
            raise GeometryError("lattice: the map of cells is empty, expected at least one row of at least one cell")
        for number, row in enumerate(self.cells):
            if len(row) != self.columns:
                raise GeometryError(
                    f"lattice: row {number} of the map has {len(row)} columns: expected {self.columns} as in row 0"
                )
            if not all(isinstance(cell, Cell) for cell in row):
                raise GeometryError(f"lattice: row {number} of the map: expected objects of the class Cell")
        for name in ("width", "height", "beam"):
            finite_length(name, getattr(self, name))
        if self.beam >= self.width:
            raise GeometryError(
                f"lattice: beam = {self.beam:g} mm: expected less than the width of the cell, {self.width:g} mm"
            )
        self._check_ribs()
        self._check_rows()

    @property
    def columns(self) -> int:
        """Cells around."""
        return len(self.cells[0])

    @property
    def rows(self) -> int:
        """Rows of holes, two a cell along."""
        return 2 * len(self.cells)

    @property
    def length(self) -> float:
        """Of the sheet along y, mm."""
        return len(self.cells) * self.height

    @property
    def around(self) -> float:
        """Width of the flat sheet along x, mm."""
        return self.columns * self.width

    @cached_property
    def holes(self) -> tuple[Hole, ...]:
        """All holes, row by row; those of odd rows lie on the borders between columns, the first at x = 0."""
        return tuple(self._hole(row, place) for row in range(self.rows) for place in range(self.columns))

    def _hole(self, row: int, place: int) -> Hole:
        line = self.cells[row // 2]
        left, right = (line[place], line[place]) if row % 2 == 0 else (line[place - 1], line[place])
        centre = np.array([(place + (0.5 if row % 2 == 0 else 0.0)) * self.width, (row + 0.5) * self.height / 2.0])
        chains = []
        for number in range(2):
            left_chain, right_chain = (
                kind_of(cell.kind).outline(self.width, self.height, self.beam, cell.cg, cell.least_beam)[number]
                for cell in (left, right)
            )
            first, last = halved(left_chain)[0], halved(right_chain)[1]
            middle = (first[-1:] + last[:1]) / 2.0
            chains.append(np.vstack([first[:-1], middle, last[1:]]) + centre)
        return Hole(row, place, *chains)

    def in_row(self, row: int) -> tuple[Hole, ...]:
        """Return the holes of a row, from left to right."""
        return self.holes[row * self.columns : (row + 1) * self.columns]

    @property
    def area(self) -> float:
        """Area of the sheet without its holes, mm²; the volume of flat or rolled skin is this times its depth."""
        return self.around * self.length - sum(hole.area for hole in self.holes)

    def levels(self, x: Array) -> Array:
        """Return the heights (2 * rows, n) of the lower and upper edge of each row of holes at x (n,), mm.

        Between two holes of a row the edges go on as straight lines from corner to corner.
        """
        result = []
        for row in range(self.rows):
            for name in ("lower", "upper"):
                chain: Array = np.vstack([getattr(hole, name) for hole in self.in_row(row)])
                result.append(np.interp(x, chain[:, 0], chain[:, 1], period=self.around))
        return np.array(result)

    @cached_property
    def lines(self) -> Array:
        """x (n,) in [0, around) of all corners of holes, of the middles and borders of columns; sorted, mm."""
        found = np.concatenate([h.upper[:, 0] for h in self.holes] + [h.lower[:, 0] for h in self.holes])
        found = np.concatenate([found % self.around, np.arange(2 * self.columns) * self.width / 2.0])
        found = np.sort(np.where(self.around - found < TOLERANCE * self.around, 0.0, found))
        return found[np.diff(found, prepend=-1.0) > TOLERANCE * self.around]

    @cached_property
    def narrowest_beam(self) -> float:
        """Least distance between two holes, mm; 0 where they touch and the skin falls apart without its tube."""
        best = np.inf
        for row in range(self.rows):
            mine = self.in_row(row)
            for i, hole in enumerate(mine):
                for other in (mine[(i + 1) % self.columns], *self._above(row, i)):
                    if other is not hole:
                        best = min(best, self._distance(hole, other))
        return float(best)

    def _above(self, row: int, place: int) -> list[Hole]:
        if row + 1 == self.rows:
            return []
        above = self.in_row(row + 1)
        step = 1 if row % 2 == 0 else -1
        return [above[place], above[(place + step) % self.columns]]

    def _distance(self, first: Hole, second: Hole) -> float:
        shift = self.around * round((first.upper[0, 0] - second.upper[0, 0]) / self.around)
        return distance(first.corners, second.corners + np.array([shift, 0.0]))

    @cached_property
    def mirror(self) -> float | None:
        """x of a line about which the sheet is its own mirror image, mm; another lies half-way around. None: none."""
        if not all(kind_of(cell.kind).symmetric for row in self.cells for cell in row):
            return None
        n = self.columns
        for twice in range(n):  # a border (even) or the middle of a column (odd)
            if all(row[(twice - 1 - j) % n] == row[j] for row in self.cells for j in range(n)):
                return twice * self.width / 2.0
        return None

    def _check_ribs(self) -> None:
        for row in range(self.rows):
            holes = self.in_row(row)
            for hole, after in zip(holes, (*holes[1:], holes[0]), strict=True):
                right = max(hole.upper[-1, 0], hole.lower[-1, 0])
                left = min(after.upper[0, 0], after.lower[0, 0]) + (self.around if after is holes[0] else 0.0)
                if left - right < TOLERANCE * self.around:
                    raise GeometryError(
                        f"lattice: the holes {hole.place} and {after.place} of row {row} are {left - right:.4g} mm "
                        "apart around: expected more than 0"
                    )

    def _check_rows(self) -> None:
        gaps = np.diff(self.levels(self.lines), axis=0)[1::2]
        if len(gaps) and gaps.min() < -TOLERANCE * self.length:
            row, column = np.unravel_index(int(np.argmin(gaps)), gaps.shape)
            raise GeometryError(
                f"lattice: rows {row} and {row + 1} of holes overlap by {-gaps.min():.4g} mm at x = "
                f"{self.lines[column]:.4g} mm: expected holes that leave a beam between rows, or touch"
            )
        ends = self.levels(self.lines)[[0, -1]]
        if ends[0].min() < -TOLERANCE * self.length or ends[1].max() > (1.0 + TOLERANCE) * self.length:
            raise GeometryError(
                f"lattice: holes reach beyond the ends of the sheet, y = {ends[0].min():.4g} to "
                f"{ends[1].max():.4g} mm: expected 0 to {self.length:g} mm"
            )
