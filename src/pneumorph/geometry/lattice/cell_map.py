"""Maps of cells: which unit cell lies where, along the sheet and around it."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

from pneumorph.errors import GeometryError
from pneumorph.geometry.lattice.unit_cell import BRICK, Polygon, finite_length, kind_of


@dataclass(frozen=True)
class Cell:
    """One place of a map.

    kind: a name of `KINDS` or a `Polygon`. cg: gap over the height of the cell. least_beam: width below which the beams
    between rows of holes do not go, mm, 0 for none: where cg alone would make them narrower, the holes are lower by
    what lacks, half of it on either side; holds between rows of cells that are alike. A polygon uses neither.
    Raises GeometryError for an unknown kind or a negative width; the gap is checked where the size of the cell is
    known.
    """

    kind: str | Polygon
    cg: float = 0.2
    least_beam: float = 0.0

    def __post_init__(self) -> None:
        kind_of(self.kind)
        if self.least_beam != 0.0:
            finite_length("least_beam", self.least_beam)


@dataclass(frozen=True)
class Segment:
    """Cells that repeat along the sheet: `cells` of them, each with the same runs (columns, cell) around."""

    cells: int
    runs: tuple[tuple[int, Cell], ...]

    def __post_init__(self) -> None:
        for name, count in (("cells", self.cells), *(("columns of a run", count) for count, _ in self.runs)):
            if isinstance(count, bool) or not isinstance(count, int) or count < 1:
                raise GeometryError(f"segment: {name} = {count!r}: expected a whole number of at least 1")
        if not self.runs:
            raise GeometryError("segment: no runs of cells around, expected at least one (columns, cell)")

    @property
    def row(self) -> tuple[Cell, ...]:
        """The cells around, column by column."""
        return tuple(cell for count, cell in self.runs for _ in range(count))


Map = tuple[tuple[Cell, ...], ...]


def cell_map(segments: Sequence[Segment], *, blend: int = 0) -> Map:
    """Return the map, cells along by columns around, of segments from the clamp to the tip.

    blend: number of cells along, the same on either side of a border between segments (so an even number), over which
    one lattice goes over into the next; 0 changes at once. cg changes linearly; between re-entrant and honeycomb cells
    it rises to 0.5, where both are the same brick, and falls again. Raises GeometryError for a blend that does not fit
    into the segments, or of cells that have nothing between them.
    """
    if not segments:
        raise GeometryError("cell_map: the map is empty, expected at least one segment")
    rows = [segment.row for segment in segments for _ in range(segment.cells)]
    if isinstance(blend, bool) or not isinstance(blend, int) or blend < 0 or blend % 2:
        raise GeometryError(f"cell_map: blend = {blend!r}: expected an even number of cells, 0 for none")
    shortest = min(segment.cells for segment in segments)
    if blend > shortest:
        raise GeometryError(
            f"cell_map: blend = {blend}: expected at most {shortest}, the cells of the shortest segment"
        )
    border = 0
    for before, after in itertools.pairwise(segments):
        border += before.cells
        if len(before.row) != len(after.row):
            raise GeometryError(
                f"cell_map: segments of {len(before.row)} and {len(after.row)} columns: expected the same in all"
            )
        for i in range(blend):
            share = (i + 0.5) / blend
            rows[border - blend // 2 + i] = tuple(
                _between(a, b, share) for a, b in zip(before.row, after.row, strict=True)
            )
    return tuple(rows)


def halves(along: int, around: int, cg: float = 0.2, *, reentrant: int | None = None, least_beam: float = 0.0) -> Map:
    """Return the map of a bending skin: `reentrant` columns (default: half), side by side, the others honeycomb."""
    count = around // 2 if reentrant is None else reentrant
    if not 0 <= count <= around:
        raise GeometryError(f"halves: reentrant = {count!r}: expected 0 to {around} columns")
    soft, stiff = Cell("re-entrant", cg, least_beam), Cell("honeycomb", cg, least_beam)
    runs = ((count, soft), (around - count, stiff))
    return cell_map([Segment(along, tuple(run for run in runs if run[0]))])


def _between(first: Cell, last: Cell, share: float) -> Cell:
    if first == last:
        return first
    least = first.least_beam + share * (last.least_beam - first.least_beam)
    if first.kind == last.kind and not isinstance(first.kind, Polygon):
        return replace(first, cg=first.cg + share * (last.cg - first.cg), least_beam=least)
    sides = {"re-entrant": -1.0, "honeycomb": 1.0}
    if first.kind not in sides or last.kind not in sides:
        raise GeometryError(
            f"cell_map: nothing lies between {kind_of(first.kind).name} and {kind_of(last.kind).name} cells; allowed "
            "with blend: cells of one kind, or re-entrant and honeycomb"
        )
    a, b = (sides[str(cell.kind)] * (BRICK - cell.cg) for cell in (first, last))
    distance = a + share * (b - a)
    return Cell("re-entrant" if distance < 0.0 else "honeycomb", BRICK - abs(distance), least)
