"""A height field: the height of rigid ground on a regular grid, and its way in and out as a grey-scale image."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from pneumorph.errors import InputError, StorageError
from pneumorph.units import show

Array = NDArray[np.float64]

# what Pillow calls images of one channel without a palette: 8 bits, and the ways it names 16 bits
_GREY = ("L", "I;16", "I;16B", "I;16L", "I")
_WHITE = 65535


@dataclass(frozen=True, eq=False)
class HeightField:
    """Ground of `length` (x) by `width` (y), both mm, centred on the origin.

    heights: (rows, columns), mm; rows run along +y and columns along +x, the first of each lies on the edge.
    Raises InputError for fewer than 2 x 2 heights, a height that is no number, or an extent that is not positive.
    """

    heights: Array
    length: float
    width: float

    def __post_init__(self) -> None:
        heights = np.asarray(self.heights, dtype=float)
        if heights.ndim != 2 or min(heights.shape) < 2:
            raise InputError(f"height field of shape {heights.shape}: expected at least 2 rows and 2 columns")
        if not np.isfinite(heights).all():
            raise InputError("height field: every height must be a finite number")
        for name in ("length", "width"):
            value = getattr(self, name)
            if not 0.0 < value < np.inf:
                raise InputError(f"height field: {name} = {show(value, 'length')}, expected more than 0")
        object.__setattr__(self, "heights", heights)

    @property
    def x(self) -> Array:
        """Places of the columns, mm."""
        return np.linspace(-0.5 * self.length, 0.5 * self.length, self.heights.shape[1])

    @property
    def y(self) -> Array:
        """Places of the rows, mm."""
        return np.linspace(-0.5 * self.width, 0.5 * self.width, self.heights.shape[0])

    @property
    def relief(self) -> float:
        """Highest less lowest place, mm."""
        return float(np.ptp(self.heights))

    def highest(self, x: tuple[float, float], y: tuple[float, float]) -> float:
        """Return the largest height, mm, of the grid's places in a rectangle and of those next to it.

        Raises InputError for a rectangle that is not wholly on the field.
        """
        if x[0] < self.x[0] or x[1] > self.x[-1] or y[0] < self.y[0] or y[1] > self.y[-1]:
            raise InputError(
                f"place {_span(x)} by {_span(y)}: off the terrain, which covers "
                f"{_span((self.x[0], self.x[-1]))} by {_span((self.y[0], self.y[-1]))}"
            )
        columns, rows = (_around(*ends) for ends in ((self.x, x), (self.y, y)))
        return float(self.heights[rows, columns].max())

    def at(self, x: float, y: float) -> float:
        """Return the height, mm, at a place, bilinear between the grid's; beyond the edges that of the edge."""
        column, u = _cell(self.x, x)
        row, v = _cell(self.y, y)
        corners = self.heights[row : row + 2, column : column + 2]
        return float(np.array([1.0 - v, v]) @ corners @ np.array([1.0 - u, u]))


def _cell(places: Array, place: float) -> tuple[int, float]:
    """Return the number of the cell that holds a place, and how far into it the place lies, 0 to 1."""
    share = np.clip((place - places[0]) / (places[-1] - places[0]), 0.0, 1.0) * (len(places) - 1)
    number = min(int(share), len(places) - 2)
    return number, float(share - number)


def _around(places: Array, ends: tuple[float, float]) -> slice:
    first = int(np.searchsorted(places, ends[0], side="right")) - 1
    return slice(max(first, 0), int(np.searchsorted(places, ends[1], side="left")) + 1)


def _span(ends: tuple[float, float]) -> str:
    return f"{ends[0] / 1000.0:.3g} to {ends[1] / 1000.0:.3g} m"


def from_image(path: Path | str, *, length: float, width: float, relief: float) -> HeightField:
    """Return the height field of a grey-scale image file: black lies at 0, white at `relief`; all in mm.

    Raises StorageError for a file that cannot be read, InputError as `from_image_bytes`.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise StorageError(f"terrain image '{path}' cannot be read: {error.strerror or error}") from error
    return from_image_bytes(content, str(path), length=length, width=width, relief=relief)


def from_image_bytes(content: bytes, name: str, *, length: float, width: float, relief: float) -> HeightField:
    """Return the height field of the content of a grey-scale image file; `name` is what a message calls it.

    The image is seen from above, with x to the right and y upwards. 8 and 16 bits are read. The greys are not
    stretched: what is neither black nor white lies between 0 and `relief`.

    Raises InputError for a file that is no image, one that is not grey-scale, one of a single grey, and for a relief
    that is not positive.
    """
    if not 0.0 < relief < np.inf:
        raise InputError(f"terrain image '{name}': relief = {show(relief, 'length')}, expected more than 0")
    try:
        with Image.open(io.BytesIO(content)) as image:
            mode = image.mode
            pixels = np.asarray(image) if mode in _GREY else None
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise InputError(
            f"terrain image '{name}': expected a grey-scale image, such as PNG; it cannot be read"
        ) from error
    if pixels is None:
        raise InputError(f"terrain image '{name}': its pixels are {mode}, expected grey-scale of 8 or 16 bits")
    if np.ptp(pixels) == 0:
        raise InputError(
            f"terrain image '{name}': every pixel has the grey {pixels.flat[0]}, so it has no relief; "
            "expected at least two greys (flat ground needs no image)"
        )
    white = 255.0 if mode == "L" else float(_WHITE)
    return HeightField(relief * pixels[::-1].astype(float) / white, length, width)


def to_image(field: HeightField) -> Image.Image:
    """Return the height field as a 16-bit grey-scale image, lowest place black, highest white, y upwards."""
    low, relief = field.heights.min(), field.relief
    grey = (field.heights - low) * (_WHITE / relief) if relief > 0.0 else np.zeros_like(field.heights)
    return Image.fromarray(np.round(grey[::-1]).astype(np.uint16))
