"""Puts drawn pictures together with captions, a colour bar or a legend."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray
from PIL import Image

from pneumorph.report import style
from pneumorph.units import plain

Picture = NDArray[np.uint8]

_DPI = 100
_SIZE = 11.5  # points at _DPI; grows with the picture's width, because a page shows wide ones smaller
_GAP, _CAPTION = 24, 40


@dataclass(frozen=True)
class Bar:
    """A colour bar: title with unit, ends in printed units, largest value of the field, colour map."""

    title: str
    low: float
    high: float
    largest: float
    colour_map: str


def compose(
    panels: Sequence[tuple[str, Picture]],
    *,
    bar: Bar | None = None,
    legend: Mapping[str, style.Colour] | None = None,
    columns: int | None = None,
) -> Picture:
    """Return one picture of captioned panels in a grid, with a colour bar on the right or a legend below."""
    columns = columns or len(panels)
    width = max(picture.shape[1] for _, picture in panels)
    heights = [max(p.shape[0] for _, p in panels[i : i + columns]) + _CAPTION for i in range(0, len(panels), columns)]
    keys = list(legend or {})
    across = columns * width + (columns + 1) * _GAP
    per_row = max(1, across // 230)
    below = _GAP // 2 + 30 * math.ceil(len(keys) / per_row) if keys else 0
    total = (across + (150 + across // 20 if bar else 0), sum(heights) + _GAP + below)
    size = _SIZE * max(1.0, total[0] / 1700)
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(total[0] / _DPI, total[1] / _DPI), dpi=_DPI)
        canvas = FigureCanvasAgg(figure)
        corners = place_panels([picture for _, picture in panels], columns)
        for number, ((caption, picture), (left, top)) in enumerate(zip(panels, corners, strict=True)):
            figure.figimage(picture, left, total[1] - top - picture.shape[0], origin="upper")
            figure.text(
                (_GAP + number % columns * (width + _GAP)) / total[0], 1.0 - (top - 0.5 * _CAPTION) / total[1], caption,
                fontsize=min(size, _fitting(caption, width + _GAP)), va="center", fontweight="bold",
            )  # fmt: skip
        if bar:
            _draw_bar(figure, bar, total, across, size)
        if keys and legend:
            handles = [Patch(facecolor=legend[key], edgecolor=style.MUTED, label=key) for key in keys]
            figure.legend(
                handles=handles, loc="lower left", ncols=min(per_row, len(keys)), fontsize=size,
                bbox_to_anchor=(_GAP / 2 / total[0], 2 / total[1]), handlelength=1.2, handleheight=1.0, borderpad=0.2,
            )  # fmt: skip
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _fitting(caption: str, width: int) -> float:
    """Return the font size, points, at which a bold caption stays within some pixels."""
    return width / (0.68 * _DPI / 72.0 * max(len(caption), 1))


def place_panels(pictures: Sequence[Picture], columns: int | None = None) -> list[tuple[int, int]]:
    """Return the left and upper edge, in pixels, of each panel in the grid that `compose` makes."""
    columns = columns or len(pictures)
    width = max(picture.shape[1] for picture in pictures)
    corners, top = [], 0
    for first in range(0, len(pictures), columns):
        row = pictures[first : first + columns]
        for column, picture in enumerate(row):
            corners.append((_GAP + column * (width + _GAP) + (width - picture.shape[1]) // 2, top + _CAPTION))
        top += max(picture.shape[0] for picture in row) + _CAPTION
    return corners


def _draw_bar(figure: Figure, bar: Bar, total: tuple[int, int], left: int, size: float) -> None:
    tall = min(0.62 * total[1], 420.0)
    axes = figure.add_axes((left / total[0] + 0.012, 0.5 - 0.5 * tall / total[1], 20 / total[0], tall / total[1]))
    capped = bar.largest > bar.high * 1.005
    mappable = ScalarMappable(Normalize(bar.low, bar.high), style.colour_map_of(bar.colour_map))
    drawn = figure.colorbar(mappable, cax=axes, extend="max" if capped else "neither", extendfrac=0.04)
    drawn.outline.set_linewidth(0.6)
    axes.tick_params(labelsize=size - 1)
    axes.set_ylabel(bar.title, fontsize=size, labelpad=8)
    if capped:
        axes.set_title(f"max {plain(bar.largest, 3)}", fontsize=size - 1.5, loc="left", fontweight="normal", pad=22)


def encode(picture: Picture, form: str = "png") -> bytes:
    """Return a picture as a file: 'png' without loss, 'webp' small."""
    buffer = io.BytesIO()
    options = {"quality": 90, "method": 4} if form == "webp" else {"optimize": False, "compress_level": 6}
    Image.fromarray(picture).save(buffer, form.upper(), **options)
    return buffer.getvalue()
