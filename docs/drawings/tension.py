"""Draws docs/figures/sheet-tension.svg, tension tests of endless sheets: python docs/drawings/tension.py."""

from pathlib import Path

from pneumorph.geometry.lattice import Cell
from pneumorph.homogenisation import Sheet, periodic_test
from pneumorph.report.tension_figure import tension_figure

if __name__ == "__main__":
    tests = {}
    for kind in ("re-entrant", "honeycomb"):
        for direction in ("along", "around"):
            test = periodic_test(Sheet(Cell(kind)), direction, 0.3, steps=6, size=104.3 / 7 / 4)
            tests[f"{kind}, {direction}"] = test
    figure = Path(__file__).parents[1] / "figures" / "sheet-tension.svg"
    figure.write_bytes(tension_figure(tests))
