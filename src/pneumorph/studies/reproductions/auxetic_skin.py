"""System 4: the tube under a lattice skin of Pu et al. 2024: a sweep of designs, and the trends that were reported."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions.reproduction import SystemBySweep, register_sweep
from pneumorph.studies.reproductions.soft_wheel import Finding
from pneumorph.studies.section import write
from pneumorph.studies.sweeps import Sweep, SweepTable
from pneumorph.studies.sweeps.schema import SweepFile

Array = NDArray[np.float64]

NAME = "auxetic-skin"
TUBE_MU = 0.037  # MPa
BULK = 50.0  # times mu, of the authors' model files
END, QUICK_END = 75.0, 30.0  # mL in the whole tube
PRESSURE, QUICK_PRESSURE = 0.025, 0.015  # MPa, at which shares of re-entrant columns are compared
FIRST, LARGEST = 0.05, 0.1  # increments, of 75 mL
REST = 29.0  # mm, diameter at rest
STRAIGHT = 1.0  # deg, tip rotation under which a skin does not bend
# cells along, cells around -> curvature in 1/mm and diameter in mm, at 75 mL
CORNERS = {(5, 20): (0.0077, 44.0), (9, 12): (0.0097, 38.4)}

ALONG, AROUND, RATIOS, GAPS = (5, 7, 9), (12, 16, 20), (20.0, 50.0, 80.0), (0.2, 0.4, 0.5)
SHARES, QUICK_SHARES = (0, 2, 4, 6, 8, 10, 12), (0, 4, 6, 8, 12)  # re-entrant columns of 12


@dataclass(frozen=True)
class Skin:
    """A design: cells along and around, cg, ratio of the moduli, re-entrant columns; the study's first one."""

    along: int = 7
    around: int = 12
    cg: float = 0.2
    ratio: float = 50.0
    reentrant: float = 0.5

    @property
    def name(self) -> str:
        """Short text for a figure or table."""
        return (
            f"{self.along} x {self.around}, cg {self.cg:g}, ratio {self.ratio:g}, "
            f"{round(self.reentrant * self.around)} re-entrant"
        )


@dataclass(frozen=True)
class SkinStudy:
    """What is computed: 19 designs to 75 mL, or quickly 14, of which all but three stop at 30 mL.

    Both on the coarse mesh of half the tube.
    """

    quick: bool = False

    @property
    def volume(self) -> float:
        """Added volume at which designs are compared, mL in the whole tube."""
        return QUICK_END if self.quick else END

    @property
    def pressure(self) -> float:
        """Pressure at which shares of re-entrant columns are compared, MPa."""
        return QUICK_PRESSURE if self.quick else PRESSURE

    @property
    def shares(self) -> tuple[int, ...]:
        """Numbers of re-entrant columns."""
        return QUICK_SHARES if self.quick else SHARES

    @property
    def skins(self) -> dict[Skin, float]:
        """Design -> added volume to which it is inflated, mL; those that take longest come first."""
        if self.quick:
            grid = [(5, 20), (9, 12), (7, 12), (7, 20), (7, 16), (5, 12)]
        else:
            grid = sorted(itertools.product(ALONG, AROUND), key=lambda pair: -pair[0] * pair[1])
        skins = [Skin(*pair) for pair in grid]
        skins += [Skin(ratio=ratio) for ratio in RATIOS] + [Skin(cg=cg) for cg in GAPS]
        skins += [Skin(reentrant=count / 12) for count in self.shares]
        whole = {Skin(*pair) for pair in (*CORNERS, (7, 12))}
        return {skin: self.volume if self.quick and skin not in whole else END for skin in dict.fromkeys(skins)}

    @property
    def sweep(self) -> Sweep:
        """The sweep of all designs; volumes in it are those of half the tube."""
        skins = self.skins
        parameters: dict[str, list[Any]] = {
            "actuator.cells_along": [s.along for s in skins], "actuator.cells_around": [s.around for s in skins],
            "actuator.cg": [s.cg for s in skins], "actuator.reentrant": [s.reentrant for s in skins],
            "material.skin.mu": [write(s.ratio * TUBE_MU, "stress") for s in skins],
            "material.skin.bulk": [write(s.ratio * TUBE_MU * BULK, "stress") for s in skins],
            "phase.inflate.targets.cavity": [f"{volume / 2.0:g} mL" for volume in skins.values()],
            # equal steps of volume, whatever the target
            "phase.inflate.first_increment": [FIRST * END / volume for volume in skins.values()],
            "phase.inflate.largest_increment": [LARGEST * END / volume for volume in skins.values()],
        }  # fmt: skip
        results: dict[str, Any] = {}
        for name, column, place in (
            ("", "added_volume:cavity", f"{self.volume / 2.0:g} mL"),
            (" at 75 mL", "added_volume:cavity", f"{END / 2.0:g} mL"),
            (" at pressure", "pressure:cavity", write(self.pressure, "pressure")),
        ):  # fmt: skip
            for key in ("curvature", "edge_curvature", "diameter", "tip_rotation", "pressure:cavity"):
                results[f"{key.removesuffix(':cavity')}{name}"] = {"column": key, "at": {column: place}}
        table = {
            "title": SYSTEM.title, "study": "skinned-tube.toml", "parameters": parameters, "results": results,
            "sampling": {"method": "list"},
        }  # fmt: skip
        file = SweepFile.model_validate(table, context={"quantities": "text", "folder": Path()})
        return Sweep(NAME, file, self._study())

    def _study(self) -> dict[str, Any]:
        return {
            "title": "Half of a tube under a lattice skin",
            "measures": ["curvature", "edge_curvature", "diameter", "tip_rotation", "chord_angle"],
            "actuator": {"template": "skinned-tube", "half": True},
            "material": {
                "tube": {"law": "neo-hookean", "mu": write(TUBE_MU, "stress"), "bulk": write(BULK * TUBE_MU, "stress")},
                "skin": {"law": "neo-hookean", "mu": "1.85 MPa"},
                "cap": {"name": "auxetic-end-cap"},
            },
            "mesh": {"size": "coarse"},
            "cavity": [{"name": "cavity", "supply": "volume"}],
            "phase": [
                {
                    "name": "inflate",
                    "targets": {"cavity": "37.5 mL"},
                    "first_increment": FIRST,
                    "largest_increment": LARGEST,
                }
            ],
        }


class Measured:
    """Results of a sweep by design."""

    def __init__(self, study: SkinStudy, table: SweepTable):
        self.study = study
        self._rows = dict(zip(study.skins, table.rows.rows, strict=True))

    def value(self, skin: Skin, name: str) -> float:
        """Return a result in inside units; nan where the design is not there or did not get so far."""
        row = self._rows.get(skin)
        return math.nan if row is None else float(row[name])

    def values(self, skins: Sequence[Skin], name: str) -> Array:
        """Return a result of several designs (n,)."""
        return np.array([self.value(skin, name) for skin in skins])


def findings(study: SkinStudy, table: SweepTable) -> tuple[Finding, ...]:
    """Return what the study reports, a row each, against the table; what was not computed has no value."""
    known = Measured(study, table)
    at = f"{study.volume:g} mL"
    along, around = [Skin(along=n) for n in ALONG], [Skin(around=n) for n in AROUND]
    ratios, gaps = [Skin(ratio=r) for r in RATIOS], [Skin(cg=c) for c in GAPS]
    rows = [
        _trend(known, "edge_curvature", along, +1, f"5, 7, 9 cells along, {at}"),
        _trend(known, "diameter", along, -1, f"5, 7, 9 cells along, {at}"),
        _trend(known, "pressure", along, +1, f"5, 7, 9 cells along, {at}"),
        _trend(known, "edge_curvature", around, -1, f"12, 16, 20 cells around, {at}"),
        _trend(known, "diameter", around, +1, f"12, 16, 20 cells around, {at}"),
        _trend(known, "pressure", around, +1, f"12, 16, 20 cells around, {at}"),
    ]
    growth = known.values(around, "diameter") - REST
    rows.append(
        _order(
            "growth of the diameter / fall of the curvature, relative", f"12 to 20 cells around, {at}",
            abs(growth[-1] / growth[0] - 1.0), _change(known, "edge_curvature", around),
            "diameter markedly, curvature slightly",
        )
    )  # fmt: skip
    rows.append(_trend(known, "pressure", ratios, +1, f"modulus ratio 20, 50, 80, {at}"))
    for name in ("edge_curvature", "diameter"):
        rows.append(
            _order(
                f"change of the pressure / of the {_words(name)}, relative", f"modulus ratio 20 to 80, {at}",
                _change(known, "pressure", ratios), _change(known, name, ratios),
                f"pressure strongly, {_words(name)} hardly",
            )
        )  # fmt: skip
    rows.append(_trend(known, "edge_curvature", gaps[:2], -1, f"cg 0.2, 0.4, {at}"))
    rows.append(_straight(math.degrees(known.value(gaps[2], "tip_rotation")), f"cg 0.5, {at}"))
    rows += _shares(known)
    for (nv, nh), (kappa, diameter) in CORNERS.items():
        rows += [
            _number(known, "edge_curvature", Skin(nv, nh), kappa, "1/mm"),
            _number(known, "diameter", Skin(nv, nh), diameter, "mm"),
        ]
    return tuple(rows)


def _shares(known: Measured) -> list[Finding]:
    """Diameter rises with every further re-entrant column; curvature rises to one half and falls."""
    study = known.study
    counts = np.array(study.shares)
    skins = [Skin(reentrant=count / 12) for count in counts]
    columns = ", ".join(map(str, counts))
    at = f"of 12 columns re-entrant, {write(study.pressure, 'pressure')}"
    bend = known.values(skins, "tip_rotation at pressure")
    half = int(np.flatnonzero(counts == 6)[0])
    rows = [_trend(known, "diameter at pressure", skins, +1, f"{columns} {at}")]
    for part, sign, said in ((slice(0, half + 1), +1, "rises up to"), (slice(half, None), -1, "falls beyond")):
        least = _least_step(bend[part], sign)
        text = f"tip rotation: least step on, in its direction ({said} one half)"
        row = Comparison(text, f"{', '.join(map(str, counts[part]))} {at}", 0.0, _or_none(math.degrees(least)), "deg",
                         f"reported: curvature {said} one half")  # fmt: skip
        rows.append(Finding(row, "over 0", None if math.isnan(least) else least > 0.0))
    return rows


def _trend(known: Measured, name: str, skins: Sequence[Skin], sign: int, condition: str) -> Finding:
    """Return whether a result rises (sign 1) or falls (-1) from each design to the next, with last over first."""
    values = known.values(skins, name)
    ratio = values[-1] / values[0]
    holds = None if np.isnan(values).any() else bool(_least_step(values, sign) > 0.0)
    said = "over 1, rises" if sign > 0 else "under 1, falls"
    shown = _words(name.removesuffix(" at pressure"))
    row = Comparison(f"{shown}, last / first", condition, 1.0, _or_none(ratio), "", f"reported: {said} at every step")
    return Finding(row, said, holds)


def _order(what: str, condition: str, large: float, small: float, said: str) -> Finding:
    """Return whether one change is larger than another, as the quotient of both."""
    ratio = float(large / small) if small else math.nan
    row = Comparison(what, condition, 1.0, _or_none(ratio), "", f"reported: {said}")
    return Finding(row, f"over 1: {said}", None if math.isnan(ratio) else ratio > 1.0)


def _straight(angle: float, condition: str) -> Finding:
    row = Comparison("tip rotation, size", condition, 0.0, _or_none(abs(angle)), "deg", "reported: does not bend")
    return Finding(row, f"under {STRAIGHT:g} deg", None if math.isnan(angle) else abs(angle) < STRAIGHT)


def _number(known: Measured, name: str, skin: Skin, reported: float, unit: str) -> Finding:
    value = known.value(skin, f"{name} at 75 mL")
    note = _LINE[name]
    if name == "edge_curvature":
        note += (
            f"; through the centre line, which swelling does not bend, {known.value(skin, 'curvature at 75 mL'):.3g}"
        )
    row = Comparison(_words(name), f"{skin.along} x {skin.around} cells, 75 mL", reported, _or_none(value), unit, note)
    difference = row.relative_difference
    return Finding(row, f"{reported:g} {unit}", None if difference is None else abs(difference) <= WITHIN)


WITHIN = 0.15  # relative difference up to which a reported number counts as met
_LINE = {
    "edge_curvature": "circle through the tube's outer edge line, as in the study",
    "diameter": "smallest circle around the section at mid-length",
}


def _change(known: Measured, name: str, skins: Sequence[Skin]) -> float:
    """Return the relative change of a result from the first design to the last, without sign."""
    values = known.values(skins, name)
    return float(abs(values[-1] / values[0] - 1.0))


def _least_step(values: Array, sign: int) -> float:
    return float(np.min(sign * np.diff(values)))


def _words(name: str) -> str:
    return name.replace("_", " ")


def _or_none(value: float) -> float | None:
    return None if math.isnan(value) else float(value)


@dataclass(frozen=True)
class Trend:
    """A curve of the figures: what is varied, its values (n,), the designs, and where their results are taken."""

    x: str
    over: tuple[float, ...]
    skins: tuple[Skin, ...]
    place: str = ""


def trends(study: SkinStudy) -> tuple[Trend, ...]:
    """Return the curves of the figures; designs that were not computed have no value."""
    at = tuple(Skin(reentrant=count / 12) for count in study.shares)
    return (
        Trend("cells along", tuple(map(float, ALONG)), tuple(Skin(along=n) for n in ALONG)),
        Trend("cells around", tuple(map(float, AROUND)), tuple(Skin(around=n) for n in AROUND)),
        Trend("ratio of the moduli", RATIOS, tuple(Skin(ratio=r) for r in RATIOS)),
        Trend("cg", GAPS, tuple(Skin(cg=c) for c in GAPS)),
        Trend("re-entrant columns of 12", tuple(map(float, study.shares)), at, " at pressure"),
    )


SYSTEM = register_sweep(
    SystemBySweep(
        name=NAME,
        title="Tube with an auxetic-metamaterial skin (system 4)",
        source="Pu, Zheng, Hu, Tang, An, Materials & Design 246 (2024) 113334, doi 10.1016/j.matdes.2024.113334",
        parts={"shapes": "the seven programmed shapes at their pressures (finite elements)"},
    )
)

NOTES = (
    "Given by the study (Table 1 and its model files): dimensions, neo-Hookean tube of mu 0.037 MPa and skin of 1.85 "
    "MPa, bulk moduli of 50 times mu, end caps of 2 mm with C10 1.0 MPa and D1 0.02 /MPa.",
    "Half of the tube, cut in its plane of symmetry, on the coarse mesh of quadratic hexahedra and wedges (half a cell "
    "along and around), clamped at the end faces of tube and skin, inflated by volume; between states linearly.",
    "The coarse mesh has one cell across an oblique beam and is not converged: a periodic re-entrant cell pulled along "
    "is a third stiffer than at an eighth of its height, a honeycomb one a tenth, so that it bends too little.",
    "A trend holds where it holds at every step, not only from the first design to the last. Numbers count as met "
    f"within {WITHIN:.0%}.",
)
