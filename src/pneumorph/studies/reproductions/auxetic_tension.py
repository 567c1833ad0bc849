"""Flat sheets of the skin's cells in tension along the tube and across: stiffness, lateral strain, and the trends."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from pneumorph.geometry.lattice import Cell
from pneumorph.homogenisation.tension import Sheet, periodic_test
from pneumorph.materials import NeoHookean
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions.soft_wheel import Finding

STRAIN = 0.05
MUCH = 2.0 / 3.0  # ratio of stiffnesses under which one sheet counts as much softer than the other
LENGTH, CG = 104.3, 0.2  # mm; of the study, Table 1
TUBE_MU, BULK = 0.037, 50.0  # MPa; times mu
KINDS = ("re-entrant", "honeycomb")
WAYS = ("along", "around")


@dataclass(frozen=True)
class Tension:
    """stiffness: secant modulus of the sheet, holes included, MPa; lateral: strain across the pull."""

    stiffness: float
    lateral: float


@cache
def tension(kind: str, way: str, along: int = 7, ratio: float = 50.0) -> Tension:
    """Return what a large sheet of equal cells does at a strain of 5 %: one cell of it, periodic.

    kind: of the cells; way: it is pulled, 'along' the tube or 'around' it; along: cells along the tube; ratio: of the
    modulus to the tube's. Raises NotConvergedError.
    """
    sheet = Sheet(Cell(kind, CG), height=LENGTH / along)
    mu = ratio * TUBE_MU
    test = periodic_test(sheet, way, STRAIN, material=NeoHookean(mu, bulk=BULK * mu), size=sheet.height / 4.0, steps=1)
    return Tension(float(test.force[-1]) / sheet.depth / STRAIN, float(test.lateral[-1]))


def tension_findings() -> tuple[Finding, ...]:
    """Return what the study reports of its flat sheets, a row each, against periodic cells."""
    rows: list[Finding] = []
    for way in WAYS:
        soft, stiff = (tension(kind, way) for kind in KINDS)
        ratio = soft.stiffness / stiff.stiffness
        row = Comparison(
            "stiffness, re-entrant / honeycomb", f"pulled {way}", 1.0, ratio, "", "reported: re-entrant much softer"
        )
        rows.append(Finding(row, f"under {MUCH:.2g}, much softer", ratio < MUCH))
        for kind, found, sign, said in (("re-entrant", soft, +1, "widens"), ("honeycomb", stiff, -1, "narrows")):
            row = Comparison(
                f"lateral strain, {kind}", f"pulled {way} by {STRAIN:.0%}", 0.0, found.lateral, "", f"reported: {said}"
            )
            rows.append(Finding(row, f"{'over' if sign > 0 else 'under'} 0, {said}", sign * found.lateral > 0.0))
    for kind in KINDS:
        for way, sign, said in (("along", -1, "softer"), ("around", +1, "stiffer")):
            values = [tension(kind, way, along=n).stiffness for n in (5, 7, 9)]
            steps = [sign * (b - a) for a, b in pairwise(values)]
            row = Comparison(
                f"stiffness of {kind} cells, 9 / 5 along", f"pulled {way}", 1.0, values[-1] / values[0], "",
                f"reported: {said} at every step",
            )  # fmt: skip
            rows.append(Finding(row, f"{'over' if sign > 0 else 'under'} 1, {said}", min(steps) > 0.0))
    for kind in KINDS:
        first, last = (tension(kind, "along", ratio=ratio) for ratio in (20.0, 80.0))
        quotient = last.stiffness / first.stiffness
        row = Comparison(
            f"stiffness of {kind} cells, ratio of the moduli 80 / 20", "pulled along", 4.0, quotient, "",
            "reported: stiffness in proportion to the modulus",
        )  # fmt: skip
        rows.append(Finding(row, "4, in proportion", abs(quotient / 4.0 - 1.0) < 0.01))
        difference = abs(last.lateral - first.lateral) / abs(first.lateral)
        row = Comparison(
            f"lateral strain of {kind} cells, change from ratio 20 to 80", "pulled along", 0.0, difference, "",
            "reported: unchanged",
        )  # fmt: skip
        rows.append(Finding(row, "0, unchanged", difference < 0.01))
    return tuple(rows)
