"""The virtual tests of the four sands: prints their numbers and draws docs/figures/granular-sands.svg.

python docs/drawings/sands.py        # two to three minutes; needs the extra `granular`
"""

from __future__ import annotations

from math import degrees
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from pneumorph.report import style
from pneumorph.terrain.granular import SANDS
from pneumorph.terrain.granular.virtual_tests import angle_of_slip, confined_compression, restitution

FIGURE = Path(__file__).parents[1] / "figures" / "granular-sands.svg"
SPEEDS = (100.0, 200.0, 500.0, 1000.0, 2000.0)  # mm/s


def main() -> None:
    """Run the tests, print a line for each sand, and draw."""
    with matplotlib.rc_context(style.RC):
        figure = Figure(figsize=(10.4, 3.3), layout="constrained")
        impact, slope, lid = figure.subplots(1, 3)
        print(f"{'sand':22}{'restitution at 0.5 m/s':>24}{'angle of slip':>18}{'modulus 1-5 kPa':>18}")
        for i, (name, sand) in enumerate(SANDS.items()):
            rebound = [restitution(sand, speed) for speed in SPEEDS]
            angle = degrees(angle_of_slip(sand))
            pressed = confined_compression(sand)
            modulus = 1e3 * pressed.modulus()
            print(f"{name:22}{rebound[2]:24.3f}{angle:14.1f} deg{modulus:14.0f} kPa", flush=True)
            impact.plot(1e-3 * np.array(SPEEDS), rebound, "o-", color=style.LINES[i], label=name)
            slope.bar(i, angle, 0.6, color=style.LINES[i])
            lid.plot(100.0 * pressed.strain, 1e3 * pressed.stress, color=style.LINES[i])
        impact.set(xlabel="impact speed [m/s]", ylabel="restitution [-]", ylim=(0.0, 0.6))
        slope.set(ylabel="angle of slip [deg]", xticks=[])
        lid.set(xlabel="strain [%]", ylabel="stress of the lid [kPa]")
        figure.legend(*impact.get_legend_handles_labels(), loc="outside lower center", ncols=4)
        figure.savefig(FIGURE, format="svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
