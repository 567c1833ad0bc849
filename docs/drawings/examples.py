"""Solves the examples and draws each where it moved furthest: python docs/drawings/examples.py [NAME ...]."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from pneumorph.report.drawing import Drawing
from pneumorph.report.fields import FIELDS
from pneumorph.report.pictures import field_picture
from pneumorph.solution import Solution
from pneumorph.studies import load_study, run_study

EXAMPLES = Path(__file__).parents[2] / "examples"
WIDTH, COLOURS, LARGEST = 640, 256, 100_000


def draw(solution: Solution, path: Path) -> None:
    """Draw the state of the largest displacement, coloured by stretch, whole and cut; small for a page of many."""
    soft = solution.model.mesh.solid
    state = max(solution.states, key=lambda state: float(np.abs(state.displacement[:soft]).max()))
    field = next(field for field in FIELDS if field.key == "stretch")
    picture = Image.fromarray(field_picture(Drawing([solution.states[0], state]), field, state))
    picture.thumbnail((WIDTH, WIDTH), Image.Resampling.LANCZOS)
    picture.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
    assert path.stat().st_size < LARGEST, path


def main(names: list[str]) -> None:
    """Draw the named examples, or all."""
    (EXAMPLES / "pictures").mkdir(exist_ok=True)
    for study in sorted(EXAMPLES.glob("*.toml")):
        if not names or study.stem in names:
            draw(run_study(load_study(study)), EXAMPLES / "pictures" / f"{study.stem}.png")
            print(study.stem)


if __name__ == "__main__":
    main(sys.argv[1:])
