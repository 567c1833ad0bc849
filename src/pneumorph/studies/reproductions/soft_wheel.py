"""System 5: the adaptive soft wheel of Pans, Chen and Jovanova. Part `rigid`: nine rigid wheels on rigid terrain."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions.reproduction import SystemInParts, register_parts
from pneumorph.studies.rolling import Cell, Ground, RollingRun
from pneumorph.terrain import COURSES, Drive, Rover, all_wheels
from pneumorph.terrain.wheels import Wheel

NAME = "soft-wheel"
DROPPED = ("smooth", "terraced")  # terrains on which the robot is dropped at random places
DROPS = 3
SEED = 5
# where drops may lie, m: as far from the edges of the 50 m as a run may take the robot
_DROP_X, _DROP_Y = (-20.0, 10.0), (-15.0, 15.0)

FAR, NEAR = 8.0, 5.0  # m: what three and more paddles pass, what a single one stays under
CURVED_BETTER = ("flat", "ramp")


@dataclass(frozen=True)
class RigidStudy:
    """What part `rigid` runs: 81 runs, or 18 quick ones (flat, and one drop on smooth ground).

    radius: of all wheels, mm. image: a further terrain from a grey-scale image.
    """

    quick: bool = False
    radius: float = 140.0
    image: Ground | None = None
    drive: Drive = field(default_factory=Drive)

    @property
    def runs(self) -> tuple[RollingRun, ...]:
        """All runs, terrain by terrain; every wheel is dropped at the same places.

        Raises InputError where the wheels are too large for the robot.
        """
        rovers = [Rover(Wheel(w.paddles, w.curved, self.radius)) for w in all_wheels()]
        grounds = [Ground(name) for name in (("flat", "smooth") if self.quick else COURSES)]
        if self.image is not None:
            grounds.append(self.image)
        result = []
        for ground in grounds:
            for drop, place in self._places(ground):
                result += [RollingRun(rover, self.drive, ground, drop, place) for rover in rovers]
        return tuple(result)

    def _places(self, ground: Ground) -> list[tuple[int, tuple[float, float]]]:
        if ground.name not in DROPPED and not ground.image:
            return [(0, (0.0, 0.0))]
        # a seed for each terrain, so that leaving one out does not move the drops on the others
        random = np.random.default_rng([SEED, *ground.name.encode()])
        drops = [(random.uniform(*_DROP_X), random.uniform(*_DROP_Y)) for _ in range(DROPS)]
        places = [(n, (round(1000.0 * x), round(1000.0 * y))) for n, (x, y) in enumerate(drops, start=1)]
        return [(n, (float(x), float(y))) for n, (x, y) in places[: 1 if self.quick else DROPS]]

    def settings(self) -> dict[str, object]:
        """Return what the sweep is resumed and reported by."""
        image = None
        if self.image is not None:
            digest = hashlib.sha256(self.image.image).hexdigest()
            image = {"name": self.image.name, "relief": self.image.relief, "sha256": digest}
        rover = {key: value for key, value in asdict(Rover(Wheel(0, radius=self.radius))).items() if key != "wheel"}
        return {
            "reproduction": NAME,
            "part": "rigid",
            "quick": self.quick,
            "radius": self.radius,
            "image": image,
            "drive": asdict(self.drive),
            "rover": rover,
            "starts": {run.name: run.place for run in self.runs},
        }


@dataclass(frozen=True)
class Finding:
    """A statement of the study against what was computed: the row for comparison.csv, and whether it holds."""

    row: Comparison
    statement: str
    holds: bool | None


def findings(table: Mapping[str, Mapping[str, Cell]]) -> tuple[Finding, ...]:
    """Return the study's findings against a table of distances (wheel -> terrain -> distances), terrain by terrain.

    Over 8 m with three and more paddles, under 5 m with one, the shortest of the former over the longest of the
    latter, and curved against straight paddles. What was not computed has no value.
    """
    rows: list[Finding] = []
    terrains = [name for name in COURSES if any(name in cells for cells in table.values())]
    for terrain in terrains:
        for wheel in table:
            paddles = _paddles(wheel)
            if paddles >= 3:
                rows.append(_distance(table, wheel, terrain, FAR, over=True))
            if paddles == 1:
                rows.append(_distance(table, wheel, terrain, NEAR, over=False))
    for terrain in terrains:
        many, single = (_means(table, terrain, chosen) for chosen in ((3, 4), (1,)))
        ratio = min(many) / max(single) if many and single and max(single) > 0.0 else None
        row = Comparison(
            "shortest distance of three and more paddles / longest of one", terrain, FAR / NEAR, ratio, "",
            "reported: over 8 m against under 5 m; more than 1: three and more paddles beat one",
        )  # fmt: skip
        rows.append(Finding(row, "over 1", None if ratio is None else ratio > 1.0))
    for terrain in terrains:
        curved, straight = (_means(table, terrain, (1, 2, 3, 4), kind) for kind in ("curved", "straight"))
        ratio = sum(curved) / sum(straight) if len(curved) == len(straight) == 4 and sum(straight) > 0.0 else None
        better = terrain in CURVED_BETTER
        side = "over 1" if better else "under 1"
        row = Comparison(
            "distance with curved / straight paddles, sums over one to four", terrain, 1.0, ratio, "",
            f"reported: {side}, {'curved' if better else 'straight'} paddles go farther",
        )  # fmt: skip
        rows.append(Finding(row, side, None if ratio is None else (ratio > 1.0) is better))
    return tuple(rows)


def _distance(table: Mapping[str, Mapping[str, Cell]], wheel: str, terrain: str, limit: float, over: bool) -> Finding:
    cell = table[wheel].get(terrain, Cell(()))
    statement = f"{'over' if over else 'under'} {limit:g} m"
    notes = [f"reported: {statement}"]
    count = len(cell.values) + cell.failed
    if count > 1:
        notes.append(f"mean of {len(cell.values)} drops, spread {cell.spread:.2f} m")
    if cell.failed:
        notes.append(f"{cell.failed} of {count} runs failed")
    if cell.overturned:
        notes.append(f"overturned in {cell.overturned} of {count} runs")
    row = Comparison(f"distance, {wheel}", terrain, limit, cell.mean, "m", "; ".join(notes))
    return Finding(row, statement, None if cell.mean is None else (cell.mean > limit) is over)


def _paddles(wheel: str) -> int:
    return 0 if wheel == "plain" else int(wheel.rpartition("-")[2])


def _means(
    table: Mapping[str, Mapping[str, Cell]], terrain: str, paddles: Sequence[int], kind: str = ""
) -> list[float]:
    chosen = [table[w].get(terrain, Cell(())).mean for w in table if _paddles(w) in paddles and w.startswith(kind)]
    return [mean for mean in chosen if mean is not None]


SYSTEM = register_parts(
    SystemInParts(
        name=NAME,
        title="Adaptive soft wheel for deformable terrain (system 5)",
        source=(
            "Pans, Chen, Jovanova, Soft and Steady Wins the Race: Model-based design for an adaptive soft "
            "meta-mechanism for locomotion on deformable terrain"
        ),
        parts={
            "limb": "one pleated limb bent, loaded and blocked, against the closed form (finite elements)",
            "rigid": "nine rigid wheels, one to four paddles and a plain one, on five rigid terrains (MuJoCo)",
            "reduced": "the limb as a chain of sprung hinges, and robots on such wheels (finite elements, MuJoCo)",
            "granular": "three shapes of the soft wheel on four sands (LAMMPS with MuJoCo)",
        },
    )
)

RIGID_NOTES = (
    "Given by the study: robot of 500 g on four hinges, nine wheels of equal radius, wanted speed growing to "
    "2 pi rad/s in 1 s, damping 0.2 N m s/rad, 10.5 s, step 2 ms, friction 0.6 / 0.005 / 0.2, contact dimension 3, "
    "height fields of 50 m by 50 m, three random drops on undulating ground.",
    "With contact dimension 3 only the sliding friction acts in MuJoCo; the torsional and rolling coefficients are "
    "written into the model but have no effect.",
    "Assumed: wheels of radius 140 mm, half of the 280 mm of the inflated soft wheel: rolling on 115 mm, half of the "
    "neutral height, would end at 7.2 m, short of the 8 m that the study reports. Width 40 mm, paddles 8 mm thick, "
    "curved ones quarter circles that trail. All four wheels start with a paddle pointing down.",
    "Assumed: body 600 x 300 x 60 mm, wheelbase 600 mm, track 400 mm, 50 g a wheel; gain 10 N m/rad of the "
    "controller; MuJoCo's default contact stiffness, implicitfast integrator.",
    "Assumed: steps of 40 mm every 0.6 m, ramp of 10 degrees over 12 m, Perlin noise of 2.5 m and 1.25 m wavelength "
    "scaled to a relief of 400 mm, terraces of 40 mm; heights every 50 mm.",
    "Distance is the forward displacement of the body's centre. The robot is not steered: light robots on paddles "
    "hop, yaw and at times overturn, so single runs depend strongly on small changes. runs.csv has the straight-line "
    "distance and the least uprightness of each.",
)
