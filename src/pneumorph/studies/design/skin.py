"""A design: the map of a skin by segments and a pressure, its study section, and the rod that it is predicted to be."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.geometry import BendingSkin
from pneumorph.geometry.bending_skin import SkinSegment
from pneumorph.studies.design.law import Lattice, SegmentLaw
from pneumorph.studies.design.rod import Piece, rod_line

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """A segment of a design.

    rows: cells along. cg: gap over height. reentrant: columns that are re-entrant. middle: twice the column border at
    which their middle lies, so an odd number for the middle of a column.
    """

    rows: int
    cg: float
    reentrant: int
    middle: int

    def segment(self, around: int) -> SkinSegment:
        """Return the segment of the template."""
        runs = ((self.reentrant, "re-entrant"), (around - self.reentrant, "honeycomb"))
        turn = (self.middle - self.reentrant) // 2 % around
        return SkinSegment(self.rows, tuple(run for run in runs if run[0]), self.cg, turn)


@dataclass(frozen=True)
class SkinDesign:
    """Segments from the clamp on, cells around, pressure in MPa."""

    parts: tuple[Part, ...]
    around: int
    pressure: float

    @property
    def along(self) -> int:
        """Cells along the whole tube."""
        return sum(part.rows for part in self.parts)

    def section(self, base: Mapping[str, Any], *, half: bool) -> dict[str, Any]:
        """Return the [actuator] section of a study; base: its other keys."""
        segments = []
        for part in self.parts:
            plain = asdict(part.segment(self.around))
            segments.append(plain | {"columns": [list(run) for run in plain["columns"]]})
        return dict(base) | {
            "template": "skinned-tube", "cells_along": self.along, "cells_around": self.around, "half": half,
            "segment": segments,
        }  # fmt: skip

    def line(self, law: SegmentLaw, length: float, fractions: ArrayLike) -> Array:
        """Return points (n, 3) of the predicted centre line at fractions of its length, mm.

        length: of the tube at rest, mm. The seam of the map looks along x, see `seam_angle`.
        """
        return rod_line(self.pieces(law, length), fractions)

    def pieces(self, law: SegmentLaw, length: float) -> list[Piece]:
        """Return the pieces of the rod; both ends keep straight over `law.end`."""
        pieces: list[Piece] = []
        height = length / self.along
        for part in self.parts:
            bend = law.bend(Lattice(self.along, self.around, part.reentrant), part.cg, self.pressure)
            angle = 2.0 * math.pi * (part.middle / 2.0) / self.around
            # away from the re-entrant middle: about the axis that lies a quarter turn behind it
            turn = bend.turn * np.array([math.sin(angle), -math.cos(angle), 0.0])
            pieces.append(Piece(part.rows * height, bend.stretch, turn))
        return _with_straight_ends(pieces, law.end)


def seam_angle(tube: BendingSkin) -> float:
    """Return by how much the mesh of a design is turned from where the seam of its map looks along x, rad.

    The mesh of a map with a mirror line has that line at y = 0, x > 0.
    """
    lattice = tube.tube.lattice
    return 0.0 if lattice.mirror is None else 2.0 * math.pi * lattice.mirror / lattice.around


def _with_straight_ends(pieces: list[Piece], end: float) -> list[Piece]:
    first, last = pieces[0], pieces[-1]
    end = min(end, 0.5 * first.length, 0.5 * last.length)
    if end <= 0.0:
        return pieces
    still = np.zeros(3)
    middle = list(pieces)
    middle[0] = Piece(middle[0].length - end, first.stretch, first.turn)
    middle[-1] = Piece(middle[-1].length - end, last.stretch, last.turn)
    return [Piece(end, first.stretch, still), *middle, Piece(end, last.stretch, still)]
