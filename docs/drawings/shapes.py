"""Draws docs/figures/shape-*.png, the programmed shapes, from a folder of
`pneumorph reproduce auxetic-skin --part shapes`: python docs/drawings/shapes.py FOLDER [NAME ...].
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

from PIL import Image

from pneumorph.report.shapes import shape_picture
from pneumorph.solution import Solution
from pneumorph.studies.reproductions.auxetic_shapes import ShapesStudy

FIGURES = Path(__file__).parents[1] / "figures"
WIDTH, COLOURS, LARGEST = 1100, 64, 150_000


def main(folder: Path, names: list[str]) -> None:
    """Draw the named shapes, or all that were computed; small for a page of many."""
    for shape in ShapesStudy().runs:
        if (folder / shape.name / "run.json").exists() and (not names or shape.name in names):
            picture = Image.open(io.BytesIO(shape_picture(Solution.open(folder / shape.name)))).convert("RGB")
            picture.thumbnail((WIDTH, WIDTH), Image.Resampling.LANCZOS)
            path = FIGURES / f"shape-{shape.name}.png"
            picture.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
            assert path.stat().st_size < LARGEST, path


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
