"""The stress-stretch curves of materials in the three tests, side by side for comparison."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Literal, get_args

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.materials.entry import LibraryEntry
from pneumorph.materials.tension import MODES, principal_stretches
from pneumorph.report import style
from pneumorph.units import printed_unit, to_printed

Format = Literal["png", "svg", "pdf"]
FORMATS: tuple[Format, ...] = get_args(Format)

_TITLES = {"uniaxial": "Uniaxial tension", "equibiaxial": "Equibiaxial tension", "planar": "Planar tension"}
# drawn as far as this where nothing says how far the constants hold
_TOP = 3.0
# how far curves go on, dotted, beyond the strain that the constants hold for
_BEYOND = 1.5
# moduli further apart than this share no linear axis
_APART = 30.0
_POINTS = 300


def material_figure(entries: Sequence[LibraryEntry], form: Format = "svg") -> bytes:
    """Return the nominal stress over the stretch in uniaxial, equibiaxial and planar tension, one colour a material.

    A curve is dotted where the specimen is strained further than the constants were fitted to. Stresses stand on a
    logarithmic axis where the moduli differ by more than 30 times. Raises InputError for no material or another format.
    """
    if not entries:
        raise InputError("figure of materials: no material to draw")
    if form not in FORMATS:
        raise InputError(f"format = {form!r}, allowed: {', '.join(FORMATS)}")
    moduli = [entry.material.shear_modulus for entry in entries]
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(10.5, 3.6 + 0.16 * len(entries)), layout="constrained")
        all_axes = figure.subplots(1, len(MODES))
        for axes, mode in zip(all_axes, MODES, strict=True):
            for number, entry in enumerate(entries):
                _draw(axes, mode, entry, style.LINES[number % len(style.LINES)])
            if max(moduli) > _APART * min(moduli):
                axes.set_yscale("log")
            axes.set_title(_TITLES[mode])
            axes.set_xlabel("stretch")
        all_axes[0].set_ylabel(f"nominal stress [{printed_unit('stress')}]")
        lines, labels = all_axes[0].get_legend_handles_labels()
        if any(entry.valid_to is not None for entry in entries):
            lines.append(Line2D([], [], linestyle=":", color=style.MUTED))
            labels.append("beyond the strain that the constants were fitted to")
        figure.legend(lines, labels, loc="outside lower center", ncols=min(3, len(labels)))
        stream = io.BytesIO()
        # no date in the file: the same materials give the same bytes
        metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(form, {})
        figure.savefig(stream, format=form, dpi=150, metadata=metadata)
    return stream.getvalue()


def held_to(entry: LibraryEntry, mode: str, stretch: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return where a test strains no further, by I1, than the uniaxial stretch that the constants were fitted to."""
    if entry.valid_to is None:
        return np.ones(stretch.shape, dtype=bool)
    most = (principal_stretches("uniaxial", entry.valid_to) ** 2).sum()
    strained = (principal_stretches(mode, stretch) ** 2).sum(axis=-1)
    return np.asarray(strained <= most * (1.0 + 1e-12))


def _draw(axes: Axes, mode: str, entry: LibraryEntry, colour: str) -> None:
    top = _TOP if entry.valid_to is None else 1.0 + _BEYOND * (entry.valid_to - 1.0)
    if entry.elongation is not None:
        top = min(top, 1.0 + entry.elongation)
    stretch = np.linspace(1.0, top, _POINTS)[1:]
    stress = to_printed(1.0, "stress") * getattr(entry.material, f"{mode}_tension")(stretch)
    held = held_to(entry, mode, stretch)
    axes.plot(stretch[held], stress[held], color=colour, label=entry.name)
    axes.plot(stretch[~held], stress[~held], ":", color=colour)
