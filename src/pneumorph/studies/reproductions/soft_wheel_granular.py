"""System 5, part `granular`: three shapes of the soft wheel on four sands."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from pneumorph.errors import InputError
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.granular import GranularRun, Means
from pneumorph.studies.reproductions.soft_wheel import NAME, Finding
from pneumorph.terrain.granular import SANDS, Bed, Friction, Vehicle, WheelSurface, from_stl, limbed
from pneumorph.terrain.rover import Drive

# height over two tips, mm: neutral and full given by the study, the one between is their mean
HEIGHTS = {"neutral": 230.0, "half": 255.0, "full": 280.0}
REPORTED_DISTANCE = {"neutral": 2.9, "half": 2.6, "full": 3.4}  # m, mean over the four sands
REPORTED_RIDE = {"neutral": 72.0, "half": 55.0, "full": 70.0}  # mm
REPORTED_BEST_RIDE = {
    "sticky-compressible": ("neutral", 74.0), "dry": ("neutral", 71.0),
    "dry-compressible": ("full", None), "sticky": ("full", None),
}  # fmt: skip
_QUICK_NOTE = "; a quick run of 2.5 s on a rig: not comparable"
QUICK_BED = {"grains": 3_000, "length": 2_400.0, "width": 500.0}


@dataclass(frozen=True)
class GranularStudy:
    """What part `granular` runs: 12 runs of the rover, or quick ones of one wheel on 3,000 grains.

    beds: how many beds of each sand, with different seeds. wheels: a folder with neutral.stl, half.stl and full.stl,
    surfaces in mm around the axis y; without it parametric outlines of the study's heights are taken.
    """

    quick: bool = False
    beds: int = 1
    wheels: Path | None = None

    def __post_init__(self) -> None:
        if self.beds < 1:
            raise InputError(f"beds = {self.beds}: expected at least 1")

    @property
    def drive(self) -> Drive:
        """How the hinges are driven."""
        return Drive(duration=2.5 if self.quick else 5.0, step=2e-4)

    def surfaces(self) -> tuple[WheelSurface, ...]:
        """Return the three wheels; raises StorageError or GeometryError for files that are missing or not closed."""
        if self.wheels is None:
            return tuple(limbed(name, height) for name, height in HEIGHTS.items())
        return tuple(from_stl(self.wheels / f"{name}.stl", name) for name in HEIGHTS)

    def runs(self, surfaces: Sequence[WheelSurface] | None = None) -> tuple[GranularRun, ...]:
        """Return all runs, sand by sand; raises InputError where wheels and robot do not fit."""
        size = QUICK_BED if self.quick else {}
        result = []
        for sand in SANDS.values():
            for number in range(1, self.beds + 1):
                bed = Bed(sand, seed=number, **size)  # type: ignore[arg-type]
                for surface in surfaces or self.surfaces():
                    vehicle = Vehicle(surface, single=self.quick)
                    result.append(GranularRun(vehicle, bed, self.drive, Friction(), number if self.beds > 1 else 0))
        return tuple(result)

    def settings(self, runs: Sequence[GranularRun]) -> dict[str, object]:
        """Return what the sweep is resumed and reported by."""
        first = runs[0]
        surfaces = {run.vehicle.surface.name: run.vehicle.surface for run in runs}
        vehicle = {key: value for key, value in vars(first.vehicle).items() if key != "surface"}
        bed = {key: value for key, value in asdict(first.bed).items() if key not in ("sand", "seed")}
        return {
            "reproduction": NAME,
            "part": "granular",
            "quick": self.quick,
            "beds": self.beds,
            "outlines": "parametric" if self.wheels is None else "files",
            "wheels": {name: hashlib.sha256(s.stl()).hexdigest() for name, s in surfaces.items()},
            "drive": asdict(self.drive),
            "friction": asdict(first.friction),
            "vehicle": vehicle,
            "bed": bed,
            "sands": {name: asdict(sand) for name, sand in SANDS.items()},
        }


def findings(table: Mapping[str, Mapping[str, Means]], quick: bool) -> tuple[Finding, ...]:
    """Return the study's findings against a table of means (wheel -> sand -> means).

    Means over the four sands of distance and ride height; full travels farthest on each sand; which shape rides
    highest on which sand. A quick table has no reported numbers to stand beside: its runs are shorter.
    """
    rows: list[Finding] = []
    for key, unit, reported in (("distance", "m", REPORTED_DISTANCE), ("ride height", "mm", REPORTED_RIDE)):
        for wheel, value in reported.items():
            cells = table.get(wheel, {})
            known = [v for v in (_value(cells.get(sand), key) for sand in SANDS) if v is not None]
            mean = float(np.mean(known)) if len(known) == len(SANDS) else None
            note = f"mean over {len(known)} sands{_spread(cells.values(), key, unit)}"
            note += _QUICK_NOTE if quick else ""
            rows.append(Finding(Comparison(f"{key}, {wheel}", "mean of the sands", value, mean, unit, note), "", None))
    for sand, (wheel, height) in REPORTED_BEST_RIDE.items():
        if height is not None:
            mean = _value(table.get(wheel, {}).get(sand), "ride height")
            note = f"one sand{_QUICK_NOTE if quick else ''}"
            rows.append(Finding(Comparison(f"ride height, {wheel}", sand, height, mean, "mm", note), "", None))
    for sand in SANDS:
        rows.append(_best(table, sand, "full", "distance", "goes farthest"))
    for sand, (wheel, _) in REPORTED_BEST_RIDE.items():
        rows.append(_best(table, sand, wheel, "ride height", "rides highest"))
    return tuple(rows)


def _best(table: Mapping[str, Mapping[str, Means]], sand: str, wheel: str, key: str, words: str) -> Finding:
    """Return whether a wheel has the most of a quantity on a sand: its value less that of the best other one."""
    unit = "m" if key == "distance" else "mm"
    own = _value(table.get(wheel, {}).get(sand), key)
    others = [v for v in (_value(table.get(w, {}).get(sand), key) for w in HEIGHTS if w != wheel) if v is not None]
    ahead = own - max(others) if own is not None and len(others) == len(HEIGHTS) - 1 else None
    beds = max((len(cells.get(sand, Means()).distances) for cells in table.values()), default=0)
    note = f"reported: more than 0, {wheel} {words}" + ("; one bed, so its chance is not known" if beds == 1 else "")
    row = Comparison(f"{key}, {wheel} less the best other wheel", sand, 0.0, ahead, unit, note)
    return Finding(row, f"{wheel} {words}", None if ahead is None else ahead > 0.0)


def _value(cell: Means | None, key: str) -> float | None:
    if cell is None:
        return None
    return cell.distance if key == "distance" else cell.ride_height


def _spread(cells: object, key: str, unit: str) -> str:
    values = [c.distances if key == "distance" else c.ride_heights for c in cells]  # type: ignore[attr-defined]
    many = [max(v) - min(v) for v in values if len(v) > 1]
    return f"; beds of one sand differ by up to {max(many):.3g} {unit}" if many else ""


def notes(outlines: str) -> tuple[str, ...]:
    """Return what was given and what was assumed; outlines: 'parametric' or 'files'."""
    if outlines == "parametric":
        wheels = (
            "Assumed: the wheels' outlines: four curved limbs of fixed length with seven trapezoidal pleats, 42 mm "
            "wide, whose arcs open so that the height over two tips is 230, 255 and 280 mm (the first and last given). "
            "Deformed finite-element shapes take their place with --wheels FOLDER."
        )
    else:
        wheels = "The wheels' surfaces were read from STL files; they are rigid while they roll."
    return (
        "Given by the study: bed of 3 m by 4 m by 0.8 m, 30,000 to 35,000 grains settled first, four sands, "
        "restitution 0.48 to 0.36, friction 0.55 and rolling 0.37 between wheel and grain, wheel speed 2 pi rad/s for "
        "5 s, 500 g on four wheels.",
        wheels,
        "Assumed: grains of 20 mm +- 10 % in radius, 1500 kg/m3, friction and rolling between grains as at the wheel; "
        "modulus 5 MPa, and 0.5 MPa where the sand is called compressible (a stated simplification: elastic grains "
        "that yield more, not ones that crush); sticky grains attract each other with 5 J/m2, about a grain's weight, "
        "but do not stick to the wheel.",
        "Assumed: wheelbase 300 mm, track 320 mm, body 300 x 200 x 40 mm, 50 g a wheel; gain 10 N m/rad and damping "
        "0.2 N m s/rad as on rigid terrain; wanted speed grows in 1 s.",
        "Ride height is taken as the mean height of the axles over the bed's settled surface from 1.5 s on; the "
        "study's own definition is not given. Sinkage is the wheel's largest radius less the ride height.",
        "LAMMPS and MuJoCo exchange poses and forces in every step, 0.2 ms. A grain of 4 cm weighs 50 g, a tenth of "
        "the robot: the size of the grains rules the sinkage, and beds of other seeds (--beds) show what is chance.",
    )
