"""The look that all figures and pictures share: colours that colour-blind readers can tell apart, fonts, sizes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, LinearSegmentedColormap
from numpy.typing import NDArray

Colour = tuple[float, float, float]


def rgb(text: str) -> Colour:
    """Return red, green, blue from 0 to 1 of '#rrggbb'."""
    return int(text[1:3], 16) / 255, int(text[3:5], 16) / 255, int(text[5:7], 16) / 255


# Okabe and Ito 2008, darkened a little where it must be read as a line on white
LINES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#3d8fc6", "#4d4d4d", "#7b3294")
INK, MUTED, GRID = "#1f2933", "#6b7785", "#e3e7ec"
BODY = rgb("#d9cfc3")
SECTION = rgb("#b5a48f")
DOMAINS = (BODY, rgb("#a9b7c0"), rgb("#c9b1c4"), rgb("#b7c4a3"))
GHOST = rgb("#8d99a6")
EDGE = rgb("#2b333b")
OBSTACLE = rgb("#7d8a97")

# faces by name: roles first, then cavities in order
_ROLES = {"clamp": "#44546a", "tip": "#f0c808", "outer": "#d9cfc3", "core": "#a9b7c0", "unnamed": "#eeeeee"}
_OTHERS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#a6761d", "#7b3294", "#e69f00", "#66a182", "#b2182b")

COLOUR_MAPS = {"length": "BuPu", "stress": "YlOrRd", "pressure": "YlOrRd", "number": "YlGnBu"}

RC: Any = {
    "font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 10.5, "axes.titleweight": "bold",
    "axes.titlelocation": "left", "axes.labelcolor": INK, "axes.edgecolor": MUTED, "axes.linewidth": 0.8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.8,
    "axes.axisbelow": True, "text.color": INK, "xtick.color": MUTED, "ytick.color": MUTED, "xtick.labelcolor": INK,
    "ytick.labelcolor": INK, "lines.linewidth": 1.9, "lines.markersize": 4.5, "legend.frameon": False,
    "legend.fontsize": 9, "figure.facecolor": "white", "savefig.facecolor": "white", "svg.fonttype": "path",
    "svg.hashsalt": "pneumorph", "mathtext.default": "regular",
}  # fmt: skip


def face_colours(names: Sequence[str]) -> dict[str, Colour]:
    """Return a colour for each name of a face or domain."""
    rest = [name for name in names if name not in _ROLES]
    colours = {name: rgb(_ROLES[name]) for name in names if name in _ROLES}
    return colours | {name: rgb(_OTHERS[i % len(_OTHERS)]) for i, name in enumerate(rest)}


@cache
def colour_map_of(name: str) -> Colormap:
    """Return a colour map without its lightest tenth, so that no body is white on white."""
    return LinearSegmentedColormap.from_list(name, colormaps[name](np.linspace(0.1, 1.0, 256)))


def coloured(values: NDArray[np.float64], limits: tuple[float, float], colour_map: str) -> NDArray[np.float64]:
    """Return the colours (n, 3) of values on a scale; values beyond its ends take the colour of the end."""
    low, high = limits
    share = np.clip((values - low) / max(high - low, 1e-300), 0.0, 1.0)
    return np.asarray(colour_map_of(colour_map)(share))[:, :3]
