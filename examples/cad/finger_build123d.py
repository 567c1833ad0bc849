"""Draws a small finger with build123d, another CAD kernel run than ours, and writes it as STEP, IGES and STL.

Three chambers joined by passages, along x; clamped at x = 0. `finger_closed` has a closed cavity; `finger_inlet` has
a round inlet through the face x = 0. Their volumes follow from the dimensions (`cavity_volume`), so that a program
which reads the files can be checked. Needs `pip install pneumorph[cad]`. Run: python finger_build123d.py FOLDER
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

# mm
LENGTH, WIDTH, HEIGHT = 44.0, 12.0, 12.0
WALL, FLOOR = 2.0, 3.0
CHAMBERS, CHAMBER, BETWEEN = 3, 12.0, 2.0
PASSAGE = 4.0  # side of the square passages, on the chambers' floor
INLET_RADIUS, INLET_HEIGHT = 1.5, 6.0  # above the underside


def cavity_volume(inlet: bool) -> float:
    """Return the volume of air, mm3: chambers, passages and, if any, the inlet up to the face x = 0."""
    chambers = CHAMBERS * CHAMBER * (WIDTH - 2.0 * WALL) * (HEIGHT - FLOOR - WALL)
    passages = (CHAMBERS - 1) * BETWEEN * PASSAGE**2
    return chambers + passages + (math.pi * INLET_RADIUS**2 * WALL if inlet else 0.0)


def finger(inlet: bool):
    """Return the finger as a build123d solid."""
    from build123d import Align, Box, Cylinder, Pos, Rot

    low = (Align.MIN, Align.CENTER, Align.MIN)
    body = Box(LENGTH, WIDTH, HEIGHT, align=low)
    for number in range(CHAMBERS):
        start = WALL + number * (CHAMBER + BETWEEN)
        chamber = Box(CHAMBER, WIDTH - 2.0 * WALL, HEIGHT - FLOOR - WALL, align=low)
        body -= Pos(start, 0.0, FLOOR) * chamber
        if number + 1 < CHAMBERS:
            body -= Pos(start + CHAMBER, 0.0, FLOOR) * Box(BETWEEN, PASSAGE, PASSAGE, align=low)
    if inlet:
        upright = Cylinder(INLET_RADIUS, WALL, align=(Align.CENTER, Align.CENTER, Align.MIN))
        body -= Pos(0.0, 0.0, INLET_HEIGHT) * Rot(0.0, 90.0, 0.0) * upright
    return body


def main(folder: Path) -> None:
    """Write all files."""
    from build123d import export_step, export_stl
    from OCP.IGESControl import IGESControl_Writer

    folder.mkdir(parents=True, exist_ok=True)
    for name, inlet in (("finger_closed", False), ("finger_inlet", True)):
        body = finger(inlet)
        export_step(body, folder / f"{name}.step", timestamp="2026-01-01T00:00:00")
        export_stl(body, folder / f"{name}.stl", tolerance=0.02)
        print(f"{name}: body {body.volume:.6f} mm3, cavity {cavity_volume(inlet):.6f} mm3")
    writer = IGESControl_Writer("MM", 1)  # 1: solids, not loose surfaces
    writer.AddShape(finger(False).wrapped)
    writer.ComputeModel()
    writer.Write(str(folder / "finger_closed.iges"))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
