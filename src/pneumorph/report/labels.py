"""Names written beside a drawn picture, each with a line to a place where its colour is seen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import ndimage

from pneumorph.report import style
from pneumorph.report.compose import Picture

_DPI = 100
_MARGIN, _CAPTION, _LINE = 190, 44, 34  # pixels: beside the picture for names, above it, least distance of two names
_DEEP = 2.0  # pixels: thinner traces are mixed colours of borders

Anchors = dict[str, tuple[float, float]]


def key_colours(names: Sequence[str]) -> dict[str, style.Colour]:
    """Return a flat colour for each name that `anchors` can tell apart from all others."""
    return {name: ((i % 6 + 1) / 6.0, (i // 6 % 6 + 1) / 6.0, (i // 36 % 6 + 1) / 6.0) for i, name in enumerate(names)}


def anchors(key: Picture, colours: Mapping[str, style.Colour]) -> Anchors:
    """Return name -> (x, y) in pixels: the place deepest inside what shows in the name's colour; names unseen are out.

    key: the picture drawn unlit in the colours of `key_colours`.
    """
    found: Anchors = {}
    for name, colour in colours.items():
        seen = (np.abs(key.astype(int) - np.rint(255.0 * np.array(colour)).astype(int)) <= 2).all(axis=2)
        depth = ndimage.distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1]
        if depth.max() < _DEEP:
            continue
        y, x = np.unravel_index(int(np.argmax(depth)), depth.shape)
        found[name] = (float(x), float(y))
    return found


def labelled(
    panels: Sequence[tuple[str, Picture, Anchors]], colours: Mapping[str, style.Colour], words: Mapping[str, str]
) -> Picture:
    """Return panels (caption, picture, anchors) one below the other, with the names in margins on both sides.

    colours: of the names; words: name -> what is written, if it is more than the name.
    """
    width = max(picture.shape[1] for _, picture, _ in panels) + 2 * _MARGIN
    heights = [max(picture.shape[0], _LINE * (len(places) // 2 + 1)) + _CAPTION for _, picture, places in panels]
    total = (width, sum(heights) + _CAPTION // 2)
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(total[0] / _DPI, total[1] / _DPI), dpi=_DPI)
        canvas = FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_axis_off()
        axes.set_xlim(0, total[0])
        axes.set_ylim(total[1], 0)
        top = 0
        for (caption, picture, places), height in zip(panels, heights, strict=True):
            left = (width - picture.shape[1]) // 2
            axes.imshow(
                picture, extent=(left, left + picture.shape[1], top + _CAPTION + picture.shape[0], top + _CAPTION),
                interpolation="none", zorder=0,
            )  # fmt: skip
            axes.text(16, top + 0.5 * _CAPTION, caption, fontsize=12.5, fontweight="bold", va="center")
            shifted = {name: (x + left, y + top + _CAPTION) for name, (x, y) in places.items()}
            for name, (place, target) in _arranged(shifted, width, top + _CAPTION, top + height).items():
                axes.annotate(
                    words.get(name, name), xy=target, xytext=place, fontsize=11.5, va="center",
                    ha="left" if place[0] < width / 2 else "right", zorder=3,
                    bbox={"boxstyle": "round,pad=0.3", "facecolor": "white", "edgecolor": colours[name], "lw": 2},
                    arrowprops={"arrowstyle": "-", "color": style.INK, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0},
                )  # fmt: skip
                axes.plot(*target, "o", markersize=4.5, color=style.INK, markeredgecolor="white", zorder=4)
            top += height
        axes.set_xlim(0, total[0])
        axes.set_ylim(total[1], 0)
        axes.set_aspect("auto")
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _arranged(
    places: Anchors, width: float, top: float, bottom: float
) -> dict[str, tuple[tuple[float, float], tuple[float, float]]]:
    """Return name -> (place of the text, anchor): on the nearer side unless that is full, by height, apart."""
    across = sorted(places, key=lambda name: places[name][0])
    room = max(int((bottom - top) // _LINE), 1)
    left = sum(places[name][0] < width / 2 for name in across)
    left = min(max(left, len(across) - room), room)
    result = {}
    for names, x in ((across[:left], 14.0), (across[left:], width - 14.0)):
        names = sorted(names, key=lambda name: places[name][1])
        for name, y in zip(names, _apart([places[name][1] for name in names], top, bottom), strict=True):
            result[name] = ((x, y), places[name])
    return result


def _apart(wanted: Sequence[float], top: float, bottom: float) -> NDArray[np.float64]:
    """Return sorted heights moved apart to the distance of two lines, inside the limits where that is possible."""
    heights = np.clip(np.array(wanted, dtype=float), top + _LINE / 2, bottom - _LINE / 2)
    for i in range(1, len(heights)):
        heights[i] = max(heights[i], heights[i - 1] + _LINE)
    for i in range(len(heights) - 1, -1, -1):
        heights[i] = min(heights[i], bottom - _LINE / 2 - (len(heights) - 1 - i) * _LINE)
    return heights
