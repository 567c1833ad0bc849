"""Draws docs/figures/lattice-map.svg, the planar map of a published skin: python docs/drawings/lattice.py."""

from pathlib import Path

from pneumorph.geometry.lattice import skinned_tube
from pneumorph.report.lattice_figure import lattice_figure

if __name__ == "__main__":
    figure = Path(__file__).parents[1] / "figures" / "lattice-map.svg"
    figure.write_bytes(lattice_figure(skinned_tube().lattice))
