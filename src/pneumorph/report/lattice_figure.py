"""The planar map of a lattice: beams coloured by the kind of their cell, holes white."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from pneumorph.geometry.lattice import Lattice, Polygon
from pneumorph.geometry.lattice.cell_map import Cell
from pneumorph.report import style
from pneumorph.report.figure_file import check_form, figure_file

_COLOURS = {"re-entrant": "#0072b2", "honeycomb": "#d55e00", "brick": "#8a6d00", "polygon": "#009e73"}
_ACROSS = 5.2  # inches of the longer side of the sheet


def lattice_figure(lattice: Lattice, form: str = "svg") -> bytes:
    """Return the picture of a flat sheet, clamp below, as an SVG or PNG file.

    Cells of one kind share a colour, paler for a larger cg. form: "svg" or "png"; raises InputError for another one.
    """
    check_form(form)
    scale = _ACROSS / max(lattice.around, lattice.length)
    with matplotlib.rc_context(style.RC):
        width, height = lattice.around * scale, lattice.length * scale
        whole = width + 2.9, max(height + 0.8, 1.8)
        figure = Figure(figsize=whole)
        axes = figure.add_axes((0.7 / whole[0], 0.6 / whole[1], width / whole[0], height / whole[1]))
        axes.grid(False)
        tiles = [
            (j * lattice.width, i * lattice.height, cell)
            for i, row in enumerate(lattice.cells)
            for j, cell in enumerate(row)
        ]
        w, h = lattice.width, lattice.height
        axes.add_collection(
            PolyCollection(
                [[(x, y), (x + w, y), (x + w, y + h), (x, y + h)] for x, y, _ in tiles],
                facecolors=[_colour(cell) for _, _, cell in tiles], edgecolors="none", antialiaseds=False,
            )
        )  # fmt: skip
        holes = [hole.corners for hole in lattice.holes]
        # a hole on the seam shows at both ends of the sheet
        holes += [corners + np.array([lattice.around, 0.0]) for corners in holes if corners[:, 0].min() < 0.0]
        axes.add_collection(PolyCollection(holes, facecolors="white", edgecolors=style.EDGE, linewidths=0.5))
        axes.set_xlim(0.0, lattice.around)
        axes.set_ylim(0.0, lattice.length)
        axes.set_xlabel("around [mm]")
        axes.set_ylabel("along, from the clamp [mm]")
        shown = dict.fromkeys(_label(cell) for row in lattice.cells for cell in row)
        first = {label: next(c for row in lattice.cells for c in row if _label(c) == label) for label in shown}
        patches = [Patch(color=_colour(cell)) for cell in first.values()]
        axes.legend(patches, list(first), loc="upper left", bbox_to_anchor=(1.01, 1.0))
        return figure_file(figure, form)


def _name(cell: Cell) -> str:
    return "polygon" if isinstance(cell.kind, Polygon) else cell.kind


def _label(cell: Cell) -> str:
    return _name(cell) if isinstance(cell.kind, Polygon) else f"{cell.kind}, cg = {cell.cg:.3g}"


def _colour(cell: Cell) -> style.Colour:
    pale = 0.0 if isinstance(cell.kind, Polygon) else min(0.75, 1.5 * cell.cg)
    red, green, blue = (c + pale * (1.0 - c) for c in to_rgb(_COLOURS[_name(cell)]))
    return red, green, blue
