"""System 5, part `limb`: one pleated limb of the soft wheel, bent, loaded and blocked, against the closed form."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumorph.closed_form import soft_limb as published
from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.exchange.wheel import wheel_height, wheel_surface
from pneumorph.geometry import SoftLimb
from pneumorph.materials import Material, Yeoh, library
from pneumorph.measures import ChamberSpread, LargestStress, ReactionForce, StressQuantile, TipRotation
from pneumorph.mechanics import (
    Cavity,
    Clamp,
    Contact,
    Force,
    Gravity,
    Model,
    Phase,
    Programme,
    State,
    Symmetry,
)
from pneumorph.mechanics.supports import Support
from pneumorph.mesh import Mesh, generate
from pneumorph.solution import Measure, Solution
from pneumorph.studies.comparison import Comparison, ReportedCurve
from pneumorph.units import EARTH

Array = NDArray[np.float64]

CASES = {
    "bending": "0 to 30 kPa, the foot free",
    "load": "0 kPa, 1.25 N on the foot towards the axle",
    "blocked": "0 to 50 kPa, the foot held",
}
CAVITY, PRESSURE = "cavity", "pressure:cavity"
FULL, HIGHEST = 0.030, 0.050  # MPa
FOOT_LOAD = 1.25  # N
UNEVEN = 0.10  # spread of the chambers' growth from which they count as uneven (assumed)
WHEEL_PRESSURES = {"neutral": 0.0, "half": 0.5 * FULL, "full": FULL}

_MATERIALS = {"body": "dragon-skin-30-wheel", "base": "smooth-sil-950"}
_FRICTION = 0.2
_SIZES = {False: 4.5, True: 6.0}  # mm
_GRID = 31  # pressures over which closed form and finite elements are compared


@dataclass(frozen=True)
class FootForce:
    """Force, N, of the whole limb on what holds its foot, in the plane of bending.

    towards: (x, z) of a direction for the component along it; None takes the magnitude. The model is one half.
    """

    towards: tuple[float, float] | None = None
    name: str = "blocked_force"
    kind: str = "force"

    def __call__(self, state: State) -> float:
        """Return the force, N."""
        x, _, z = -2.0 * ReactionForce("foot").vector(state)
        return math.hypot(x, z) if self.towards is None else x * self.towards[0] + z * self.towards[1]


@dataclass(frozen=True, eq=False)
class LimbCase:
    """What `solve` takes for one of the cases."""

    name: str
    title: str
    model: Model
    programme: Programme
    measures: tuple[Measure, ...]


@dataclass(frozen=True)
class LimbStudy:
    """Part `limb`: three cases of one half limb. quick: a coarser mesh. limb: its dimensions, a half."""

    quick: bool = False
    limb: SoftLimb = field(default_factory=lambda: SoftLimb(half=True))

    def __post_init__(self) -> None:
        if not self.limb.half:
            raise InputError("limb.half = False: expected True, the forces are those of one half")

    @property
    def materials(self) -> dict[str, Material]:
        """Domain -> material."""
        return {domain: library.material(name) for domain, name in _MATERIALS.items()}

    @property
    def down(self) -> tuple[float, float, float]:
        """Unit vector from the axle to the foot at rest: down, for a limb that stands on its foot."""
        (x, _, z), (ax, _, az) = self.limb.foot_point, self.limb.axle
        size = math.hypot(x - ax, z - az)
        return ((x - ax) / size, 0.0, (z - az) / size)

    def mesh(self) -> Mesh:
        """Return the mesh of the half limb."""
        return generate(self.limb, _SIZES[self.quick], detail=0.2)

    def case(self, name: str, mesh: Mesh) -> LimbCase:
        """Return a case on a mesh; raises NameNotFoundError."""
        if name not in CASES:
            raise NameNotFoundError(unknown_name("case", name, CASES))
        held: tuple[Support, ...] = (Clamp("clamp"), Symmetry("symmetry_y"))
        loads: tuple[Gravity | Force, ...] = ()
        measures = self._measures()
        settle = Phase("gravity", {"gravity": EARTH}, first=0.5, largest=1.0)
        if name == "bending":
            marks = tuple(n / 12.0 for n in range(1, 12))
            phases: tuple[Phase, ...] = (Phase("inflate", {CAVITY: FULL}, marks, first=0.04, largest=0.1),)
        elif name == "load":
            up = (-self.down[0], 0.0, -self.down[2])
            loads = (Gravity(self.down), Force("foot", up, "foot_load"))
            phases = (settle, Phase("load", {"foot_load": 0.5 * FOOT_LOAD}, first=0.1, largest=0.25))
        else:
            held = (*held, Clamp("foot"))
            loads = (Gravity(self.down),)
            marks = tuple(n / 20.0 for n in range(1, 20))
            phases = (settle, Phase("press", {CAVITY: HIGHEST}, marks, first=0.03, largest=0.05))
            towards = (self.down[0], self.down[2])
            measures = (*measures, FootForce(), FootForce(towards, "force_from_axle"))
        model = Model(
            mesh, self.materials, held, loads, (Cavity(CAVITY, (CAVITY,), mirrors=("symmetry_y",)),),
            contacts=(Contact("walls", ("pleats",), friction=_FRICTION),),
        )  # fmt: skip
        return LimbCase(name, f"Soft limb, {name}: {CASES[name]}", model, Programme(phases), measures)

    def _measures(self) -> tuple[Measure, ...]:
        return (
            TipRotation(axis=(0.0, -1.0, 0.0)),
            LargestStress(name="peak_stress"),
            StressQuantile(name="stress_99"),
            LargestStress("largest_stretch", name="peak_stretch"),
            StressQuantile("largest_stretch", name="stretch_99"),
            ChamberSpread(CAVITY, self.limb.centre, self.limb.cuts),
        )

    def settings(self, command: str) -> dict[str, object]:
        """Return what a folder is reported and resumed by."""
        return {"part": "limb", "quick": self.quick, "limb": asdict(self.limb), "command": command}


def closed_form_angles(study: LimbStudy, pressures: Array) -> Array:
    """Return the closed form's angle, rad, at gauge pressures (n,), MPa."""
    material = study.materials["body"]
    assert isinstance(material, Yeoh)
    section = published.limb_section(study.limb)
    return np.array([published.limb_angle(section, material, float(p)) for p in pressures])


def closed_form_difference(study: LimbStudy, solution: Solution) -> float | None:
    """Return the mean absolute difference, rad, of closed form and finite elements over 31 pressures from 0 to 30 kPa.

    Between its states the run is interpolated linearly. None where it did not come to 30 kPa.
    """
    reached = solution.history.values(PRESSURE)
    if len(reached) == 0 or reached[-1] < FULL * (1.0 - 1e-9):
        return None
    grid = np.linspace(0.0, FULL, _GRID)
    computed = np.interp(grid, reached, solution.history.values("tip_rotation"))
    return float(np.abs(closed_form_angles(study, grid) - computed).mean())


def uniform_until(solution: Solution) -> float | None:
    """Return the highest pressure, MPa, up to which the chambers have grown evenly; None where nothing was computed."""
    spread, pressure = (solution.history.values(key) for key in ("chamber_spread", PRESSURE))
    if len(spread) == 0:
        return None
    beyond = np.flatnonzero(spread > UNEVEN)
    return float(pressure[beyond[0] - 1] if len(beyond) and beyond[0] > 0 else pressure[-1])


def first_touch(solution: Solution) -> float | None:
    """Return the pressure, MPa, of the first state with contact between the walls; None without any."""
    touching = np.flatnonzero(solution.history.values("contact_area:walls") > 0.0)
    return float(solution.history.values(PRESSURE)[touching[0]]) if len(touching) else None


def compare(study: LimbStudy, solutions: Mapping[str, Solution]) -> tuple[Comparison, ...]:
    """Return reported and computed numbers; solutions: those of the cases that were run, by name."""
    bending, load, blocked = (solutions.get(name) for name in CASES)
    rows = [
        Comparison(
            "mean absolute difference of closed form and finite elements", "0 to 30 kPa", 2.51,
            _degrees(closed_form_difference(study, bending) if bending else None), "deg",
            "chamber width x taken as the mean width of the air; E at the strain k h / 2",
        )
    ]  # fmt: skip
    rows += _stresses(bending, "30 kPa", PRESSURE, FULL, 449.0, 0.69)
    turned = _at(load, "tip_rotation", "value:foot_load", 0.5 * FOOT_LOAD)
    before = _at(load, "tip_rotation", "time", 1.0)
    note = "reported: hardly changes; change of the tip's angle by the foot load, after gravity"
    change = None if turned is None or before is None else math.degrees(turned - before)
    rows.append(Comparison("change of angle", "0 kPa, 1.25 N", 0.0, change, "deg", note))
    rows += _stresses(load, "0 kPa, 1.25 N", "value:foot_load", 0.5 * FOOT_LOAD, 848.0, 0.37)
    for pressure, reported, note in ((0.035, 1.98, ""), (HIGHEST, 3.0, "reported: just above 3 N; ")):
        condition = f"{1e3 * pressure:.0f} kPa, foot held"
        for key, what in (("blocked_force", "magnitude"), ("force_from_axle", "component from the axle to the foot")):
            rows.append(
                Comparison(
                    f"blocked force, {what}", condition, reported, _at(blocked, key, PRESSURE, pressure), "N",
                    f"{note}force on what holds the foot, weight of the limb included; walls and depth were chosen by "
                    "its size",
                )
            )  # fmt: skip
    rows += _stresses(blocked, "35 kPa, foot held", PRESSURE, 0.035, 878.0, 1.23)
    limit = uniform_until(blocked) if blocked else None
    rule = f"assumed: uniform while the chambers' growth differs by {UNEVEN:.0%} of its mean or less"
    if blocked and limit == blocked.history.values(PRESSURE)[-1]:
        rule += "; it stays so to the end of the run"
    rows.append(
        Comparison(
            "last pressure with uniform chambers", "foot held", 35.0, None if limit is None else 1e3 * limit, "kPa",
            rule,
        )
    )  # fmt: skip
    for name, reported in (("neutral", 230.0), ("full", 280.0)):
        height = _height(study, bending, WHEEL_PRESSURES[name])
        note = "twice the largest distance from the axle; the assumed length, radius and hub were chosen by this height"
        rows.append(Comparison("height of the wheel", name, reported, height, "mm", note))
    return tuple(rows)


def reported_curves(study: LimbStudy) -> tuple[ReportedCurve, ...]:
    """Return the closed form over the pressure, and the two reported blocked forces."""
    pressure = np.linspace(0.0, FULL, 61)
    return (
        ReportedCurve("closed form, eqs. 2-5", PRESSURE, "tip_rotation", pressure, closed_form_angles(study, pressure)),
        ReportedCurve(
            "reported", PRESSURE, "blocked_force", np.array([0.035, HIGHEST]), np.array([1.98, 3.0]), marks=True
        ),
    )


def _stresses(
    solution: Solution | None, condition: str, along: str, place: float, stress: float, strain: float
) -> list[Comparison]:
    """Return rows of largest stress, kPa, and strain, with what 99 % of the volume stays under in the notes."""
    peak, most = (_at(solution, key, along, place) for key in ("peak_stress", "stress_99"))
    stretch, usual = (_at(solution, key, along, place) for key in ("peak_stretch", "stretch_99"))
    sharp = "grows with refinement at sharp corners and bonds"
    return [
        Comparison(
            "largest stress", condition, stress, None if peak is None else 1e3 * peak, "kPa",
            f"von Mises; {sharp}" + ("" if most is None else f"; 99 % of the volume stays under {1e3 * most:.0f} kPa"),
        ),
        Comparison(
            "largest strain", condition, strain, None if stretch is None else stretch - 1.0, "",
            f"principal stretch less 1; {sharp}"
            + ("" if usual is None else f"; 99 % of the volume stays under {usual - 1.0:.2f}"),
        ),
    ]  # fmt: skip


def _at(solution: Solution | None, key: str, along: str, place: float) -> float | None:
    """Return a column in the last state in which another has a value; None where there is none."""
    if solution is None:
        return None
    found = np.isclose(solution.history.values(along), place, rtol=1e-9, atol=1e-12)
    return float(solution.history.values(key)[found][-1]) if found.any() else None


def _degrees(value: float | None) -> float | None:
    return None if value is None else math.degrees(value)


def _height(study: LimbStudy, bending: Solution | None, pressure: float) -> float | None:
    if bending is None or len(bending.states) == 0 or bending.history.values(PRESSURE).max() < pressure * (1 - 1e-9):
        return None
    points, _ = wheel_surface(bending, pressure, limb=study.limb)
    return wheel_height(points)


NOTES = (
    "Given by the study: Dragon Skin 30 as a Yeoh solid, C1 = 114.88 kPa, C2 = 1.262 kPa; trapezoidal chambers, "
    "neutral at most curvature; friction 0.2 between chamber walls; gravity; heights of the wheel 230 and 280 mm.",
    "Assumed: every dimension of the limb (see docs/soft-wheel.md): length, radius and hub chosen so that four limbs "
    "make a wheel of about the two heights, walls, depth and base so that the blocked force has about the reported "
    "size. Those rows are a calibration, no independent check. The base is Smooth-Sil 950, the study names no "
    "strain-limiting material; density 1.08 g/cm3.",
    "Half a limb is modelled, mirrored in the middle plane, with quadratic tetrahedra; the study has linear elements "
    "of 3 mm. Bending is computed without gravity, as of a limb on its side; with the foot loaded or held, gravity "
    "acts from the axle to the foot.",
    "The foot is held over its whole sole, so it cannot turn; the study says 'contact point fixed'.",
    "Pleats touch themselves and each other (incremental potential contact); cavity walls do not.",
)
