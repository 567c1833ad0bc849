"""A skinned tube inflated with its lattice and with the homogenised skin: shape, pressure and time of both.

    python benchmarks/homogenised_skin.py [cells along] [cells around] [cg] [volume in mL]

Both have the same materials (the study's files: bulk moduli of 50 times mu) and the same size of mesh for the lattice,
half the height of a cell: in the tube and in the unit cell. Times are those of this process on one core each, and the
laws of the cells, found once for all tubes with these cells, are a line of their own.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from time import process_time

import numpy as np

from pneumorph.geometry.bending_skin import BendingSkin
from pneumorph.homogenisation import homogenised_model, skin_laws
from pneumorph.materials import NeoHookean
from pneumorph.measures import Curvature, Diameter, TipRotation
from pneumorph.mechanics import Cavity, Clamp, Model, Phase, Programme, State, Symmetry, VolumeSupply, march
from pneumorph.mesh import generate

TUBE, SKIN = NeoHookean(0.037, bulk=50 * 0.037), NeoHookean(1.85, bulk=50 * 1.85)
CAP = NeoHookean(2.0, bulk=100.0)


def shape(state: State) -> dict[str, float]:
    """Return curvature (1/mm), diameter (mm), tip rotation (degrees) and pressure (kPa) of a half tube."""
    return {
        "curvature": Curvature()(state),
        "diameter": Diameter()(state),
        "tip_rotation": float(np.degrees(TipRotation()(state))),
        "pressure": 1e3 * state.pressure["cavity"],
    }


def inflated(
    model: Model, volume: float, marks: Sequence[float], largest: float
) -> tuple[list[dict[str, float]], float]:
    """Return the shapes at the marks (shares of the added volume of the whole tube, mm³) and its end, and seconds."""
    start = process_time()
    programme = Programme((Phase("inflate", {"cavity": volume / 2.0}, tuple(marks), first=0.05, largest=largest),))
    wanted = [*marks, 1.0]
    states = [s for s in march(model, programme) if any(abs(s.time - mark) < 1e-9 for mark in wanted)]
    seconds = process_time() - start
    return [shape(state) for state in states], seconds


def compare(
    along: int = 7, around: int = 12, cg: float = 0.2, volume: float = 75e3, marks: Sequence[float] = (0.05, 0.25, 0.5)
) -> dict[str, object]:
    """Return the shapes of both models and the seconds they took: 'full', 'homogenised', 'laws'."""
    actuator = BendingSkin(cells_along=along, cells_around=around, cg=cg, half=True)
    start = process_time()
    laws = skin_laws(actuator.tube, TUBE, SKIN)
    found = process_time() - start
    smooth = homogenised_model(actuator.tube, laws, tube_material=TUBE, cap_material=CAP, half=True)
    quick, quick_seconds = inflated(smooth, volume, marks, 0.2)
    cavity = Cavity("cavity", ("cavity",), VolumeSupply(), ("symmetry_y",))
    full = Model(
        generate(actuator, coarse=True), {"tube": TUBE, "skin": SKIN, "cap": CAP},
        (Clamp("clamp"), Symmetry("symmetry_y")), cavities=(cavity,),
    )  # fmt: skip
    slow, slow_seconds = inflated(full, volume, marks, 0.1)
    return {
        "volumes": [volume * mark for mark in (*marks, 1.0)], "full": slow, "homogenised": quick,
        "seconds": {"full": slow_seconds, "homogenised": quick_seconds, "laws": found},
        "unknowns": {"full": full.mesh.points.size, "homogenised": smooth.mesh.points.size},
    }  # fmt: skip


def main() -> None:
    """Print the comparison as a table."""
    kinds = (int, int, float, lambda text: 1e3 * float(text))
    result = compare(*(kind(text) for kind, text in zip(kinds, sys.argv[1:], strict=False)))  # type: ignore[operator]
    for name in ("seconds", "unknowns"):
        print(name, result[name])
    for volume, full, quick in zip(result["volumes"], result["full"], result["homogenised"], strict=True):  # type: ignore[call-overload]
        print(f"{volume / 1e3:.4g} mL")
        for key, value in full.items():
            print(f"  {key:14s} {value:10.4g} {quick[key]:10.4g} {100.0 * (quick[key] / value - 1.0):+6.1f} %")


if __name__ == "__main__":
    main()
