"""A Matplotlib figure as the bytes of a file."""

from __future__ import annotations

import io

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from pneumorph.errors import InputError

FORMATS = ("svg", "png")


def check_form(form: str) -> None:
    """Raise InputError for a form that is not one of FORMATS."""
    if form not in FORMATS:
        raise InputError(f"form = '{form}', allowed: {', '.join(FORMATS)}")


def figure_file(figure: Figure, form: str = "svg") -> bytes:
    """Return a figure as an SVG or PNG file; SVG without a date, so that the same figure gives the same bytes."""
    buffer = io.BytesIO()
    if form == "svg":
        FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None})
    else:
        figure.set_dpi(160)
        FigureCanvasAgg(figure).print_png(buffer)
    return buffer.getvalue()
