"""The animation of a run: an MP4 film of the deforming body with its pressure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib import font_manager
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from pneumorph.errors import EngineError
from pneumorph.mechanics import State
from pneumorph.report import style
from pneumorph.report.compose import Picture, compose, encode, place_panels
from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import Field
from pneumorph.report.page import data_uri
from pneumorph.report.pictures import bar, caption, height_of
from pneumorph.report.render import Scene

Array = NDArray[np.float64]

_RATE = 12  # frames a second
_FRAMES = 30  # of the motion; the last one is then held
_HOLD = 10
_AREA = 220_000  # pixels of a panel


def write_animation(drawing: Drawing, field: Field, states: Sequence[State], path: Path) -> str:
    """Write the film of the states in turn, coloured by a field (H.264, MP4); return its last picture as a data URI.

    Between converged states positions and colours are interpolated linearly, the text names the last state passed.
    Raises EngineError where pictures cannot be drawn or the film cannot be encoded.
    """
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise EngineError("the animation cannot be written: imageio-ffmpeg is not installed") from error
    pictures = frames(drawing, field, states)
    first = next(pictures)
    height, width = first.shape[:2]
    try:
        writer = imageio_ffmpeg.write_frames(
            str(path), (width, height), fps=_RATE, codec="libx264", pix_fmt_in="rgb24", pix_fmt_out="yuv420p",
            macro_block_size=2, ffmpeg_log_level="error",
            output_params=["-crf", "24", "-preset", "medium", "-movflags", "+faststart"],
        )  # fmt: skip
        writer.send(None)
        last = first
        writer.send(np.ascontiguousarray(first))
        for last in pictures:
            writer.send(np.ascontiguousarray(last))
        writer.close()
    except (OSError, RuntimeError) as error:
        path.unlink(missing_ok=True)
        reason = str(error).strip().splitlines()[-1] if str(error).strip() else type(error).__name__
        raise EngineError(f"the animation cannot be written: {reason}") from error
    return data_uri(encode(last, "webp"), "webp")


def frames(drawing: Drawing, field: Field, states: Sequence[State]) -> Iterator[Picture]:
    """Yield the pictures of the film, all of one even size."""
    low, high, largest = drawing.limits(field, states)
    values = [drawing.values(field, state) for state in states]
    height = height_of(drawing.view, _AREA)
    moments = _moments(len(states))
    panels = [(drawing.view, drawing.body)]
    if not drawing.flat:
        panels.append((drawing.cut_view, drawing.cut_body))
    columns: list[list[Picture]] = []
    for view, layers in panels:
        with Scene(view, height, fine=False) as scene:
            columns.append([])
            for moment in moments:
                place = _between([state.positions for state in states], moment)
                colour = _between(values, moment)
                bodies = drawing.bodies.layers(_driven(states, moment), place)
                columns[-1].append(scene.draw([*layers(place, colour, (low, high), field), *bodies]))
    shown = None
    for number, moment in enumerate(moments):
        row = [("", column[number]) for column in columns]
        if shown is None:
            ground = _even(compose(row, bar=bar(field, low, high, largest)))
            corners = place_panels([picture for _, picture in row])
        picture = ground.copy()
        for (left, top), (_, panel) in zip(corners, row, strict=True):
            picture[top : top + panel.shape[0], left : left + panel.shape[1]] = panel
        shown = _labelled(picture, caption(states[int(moment + 1e-9)]), moment / max(len(states) - 1, 1))
        yield shown
    for _ in range(_HOLD if shown is not None else 0):
        assert shown is not None
        yield shown


def _between(items: Sequence[Array], moment: float) -> Array:
    """Return the linear interpolation of a sequence at a place between its items."""
    one = int(moment + 1e-9)
    two = min(one + 1, len(items) - 1)
    return (1.0 - (moment - one)) * items[one] + (moment - one) * items[two]


def _driven(states: Sequence[State], moment: float) -> dict[str, float]:
    """Return the linear interpolation of what the programme drives."""
    names = list(dict.fromkeys(name for state in states for name in state.values))
    values = [np.array([state.values.get(name, 0.0) for name in names]) for state in states]
    return dict(zip(names, _between(values, moment).tolist(), strict=True))


def _moments(states: int) -> Array:
    """Return the places between the states that are shown: every state, with as many steps between as make the film."""
    steps = max(1, round(_FRAMES / max(states - 1, 1)))
    moments = np.arange((states - 1) * steps + 1) / steps
    most = 3 * _FRAMES
    return moments if len(moments) <= most else np.linspace(0.0, states - 1.0, most).round()


def _even(picture: Picture) -> Picture:
    """Return the picture without an odd last row or column: H.264 with half the colour resolution needs even sizes."""
    height, width = (n - n % 2 for n in picture.shape[:2])
    return picture[:height, :width]


def _labelled(picture: Picture, text: str, done: float) -> Picture:
    """Return the picture with a caption and a line that shows how far the run is."""
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = ImageFont.truetype(
        font_manager.findfont(font_manager.FontProperties(family="DejaVu Sans", weight="bold")), 17
    )
    draw.text((24, 10), text, fill=style.INK, font=font)
    draw.rectangle((0, picture.shape[0] - 5, picture.shape[1] * min(done, 1.0), picture.shape[0]), fill=style.LINES[0])
    return np.asarray(image)
