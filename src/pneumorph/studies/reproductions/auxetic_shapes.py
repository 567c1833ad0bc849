"""Part `shapes` of system 4: the seven programmed shapes of Pu et al. 2024 at their pressures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from pneumorph.geometry import BendingSkin
from pneumorph.measures import Diameter, centre_line
from pneumorph.measures.faces import best_rotation, sample
from pneumorph.mechanics import State
from pneumorph.solution import Solution, Status
from pneumorph.studies.comparison import Comparison
from pneumorph.studies.reproductions.soft_wheel import Finding
from pneumorph.studies.section import write
from pneumorph.studies.study import Study, study_from

Array = NDArray[np.float64]

PART = "shapes"
STRESSES = {"tube": (0.4, 0.6), "skin": (4.0, 6.0)}  # MPa, largest principal stress as reported
LEAST_BEAM = 1.1  # mm, assumed; below the oblique beams that cg = 0.2 makes by itself, 1.17 mm at 9 cells along
AROUND = 12
_SOFT, _STIFF = "re-entrant", "honeycomb"
_SECTIONS = 40
_STRAIGHT = 0.25  # of the turning of the middle segment, under which the outer ones count as straight
_EQUAL = 2.0  # ratio of the turnings of two segments under which they count as equal
_BENT = 5.0  # deg of the whole, over which a shape counts as bent
_ACROSS = (60.0, 120.0)  # deg between the planes in which two segments bend, that counts as out of plane


@dataclass(frozen=True)
class ShapeSegment:
    """Rows of cells that are alike: runs of columns around, and their gap."""

    rows: int
    columns: tuple[tuple[int, str], ...] = ((6, _SOFT), (6, _STIFF))
    cg: float = 0.2


@dataclass(frozen=True)
class Shape:
    """A programmed shape.

    title: for reports. pressure: reported, MPa. segments: from the clamp. half: whether the map has a mirror plane.
    least_beam: assumed width of the oblique beams, mm, 0 for holes as published. told: what the study shows.
    """

    name: str
    title: str
    pressure: float
    segments: tuple[ShapeSegment, ...]
    told: str
    half: bool = True
    least_beam: float = 0.0

    @property
    def rows(self) -> int:
        """Cells along."""
        return sum(item.rows for item in self.segments)

    @property
    def borders(self) -> Array:
        """Ends of the segments (segments + 1,), as shares of the length."""
        return np.concatenate([[0.0], np.cumsum([item.rows for item in self.segments])]) / self.rows

    @cached_property
    def study(self) -> Study:
        """The study, as in the examples; the number of rows is not given by the source: assumed."""
        actuator: dict[str, Any] = {
            "template": "skinned-tube", "cells_along": self.rows, "cells_around": AROUND, "half": self.half,
            "segment": [
                {"rows": s.rows, "cg": s.cg, "columns": [list(run) for run in s.columns]} for s in self.segments
            ],
        }  # fmt: skip
        if self.least_beam:
            actuator["least_beam"] = write(self.least_beam, "length")
        table = {
            "title": self.title,
            "measures": [
                "tip_rotation", "chord_angle", "largest_diameter",
                *(f"peak_principal_stress:{domain}" for domain in STRESSES),
            ],
            "actuator": actuator,
            "material": {
                "tube": {"name": "ecoflex-00-30-tube", "bulk": "1.85 MPa"},
                "skin": {"name": "hei-cast-8400-skin", "bulk": "92.5 MPa"},
            },
            "mesh": {"size": "coarse"},
            "phase": [
                {
                    "name": "inflate", "targets": {"cavity": write(self.pressure, "pressure")},
                    "states_at": {"cavity": ["10 kPa", "20 kPa"]}, "first_increment": 0.05, "largest_increment": 0.1,
                }
            ],
        }  # fmt: skip
        return study_from(table, self.name)


_SWAPPED = ((6, _STIFF), (6, _SOFT))
_TWO = (ShapeSegment(4), ShapeSegment(4, _SWAPPED))
SHAPES: Mapping[str, Shape] = {
    shape.name: shape
    for shape in (
        Shape("finger", "Finger, three segments", 0.028, tuple(ShapeSegment(3, cg=cg) for cg in (0.2, 0.4, 0.5)),
              "each segment bends less than the one before", least_beam=LEAST_BEAM),
        Shape("trunk", "Trunk in a plane, two segments", 0.028, _TWO, "two segments bend to opposite sides"),
        Shape("trunk-out-of-plane", "Trunk out of the plane, two segments", 0.028,
              (ShapeSegment(4), ShapeSegment(4, ((3, _STIFF), (6, _SOFT), (3, _STIFF)))),
              "two segments bend in planes across each other", half=False),
        Shape("s", "Letter S, two segments", 0.028, _TWO, "two segments bend to opposite sides"),
        Shape("c", "Letter C, two segments", 0.028, (ShapeSegment(4), ShapeSegment(4)),
              "two segments bend alike to one side"),
        Shape("u", "Letter U, three segments", 0.030, tuple(ShapeSegment(3, cg=cg) for cg in (0.5, 0.2, 0.5)),
              "the middle segment bends, the outer ones hardly", least_beam=LEAST_BEAM),
        Shape("tentacle", "Tentacle, five segments", 0.025,
              (ShapeSegment(2, ((12, _SOFT),)),
               *(ShapeSegment(2, ((n, _SOFT), (12 - 2 * n, _STIFF), (n, _SOFT))) for n in (4, 3, 2)),
               ShapeSegment(2, ((12, _STIFF),))),
              "a bent cone, thinner towards the tip"),
    )
}  # fmt: skip
QUICK = ("c", "s", "u", "tentacle")


@dataclass(frozen=True)
class ShapesStudy:
    """Which shapes are computed: all seven, or quickly four, the letters and the tentacle; all on coarse meshes.

    Trunk in the plane and S have one map and one pressure, so that they are computed once.
    """

    quick: bool = False

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes that are told of."""
        return tuple(SHAPES[name] for name in (QUICK if self.quick else SHAPES))

    @property
    def runs(self) -> tuple[Shape, ...]:
        """The shapes that are computed."""
        found: dict[tuple[object, ...], Shape] = {}
        for shape in self.shapes:
            found.setdefault(_what(shape), shape)
        return tuple(found.values())

    def run_of(self, shape: Shape) -> Shape:
        """Return the run that a shape is told from."""
        return next(run for run in self.runs if _what(run) == _what(shape))


def _what(shape: Shape) -> tuple[object, ...]:
    return shape.segments, shape.pressure, shape.half, shape.least_beam


def turns(state: State, shape: Shape) -> Array:
    """Return how much each segment turns (segments, 3): rotation vectors between the sections at its ends, rad.

    In the axes of the section at its lower end; the section at a border is that between the nearest two.
    """
    line, face = centre_line(state, "clamp", "tip", _SECTIONS), sample(state, "tip")
    tip = best_rotation(face.reference, face.deformed, face.area)
    station = np.concatenate([[0.0], line.station, [1.0]])
    rotations = np.concatenate([np.eye(3)[None], line.rotations, tip[None]])
    at = Slerp(station, Rotation.from_matrix(rotations))(shape.borders)
    return np.asarray((at[:-1].inv() * at[1:]).as_rotvec())


def widths(state: State, shape: Shape) -> Array:
    """Return the diameter of the tube in each segment (segments,), mm: in the row of holes below its middle."""
    middles = (shape.borders[:-1] + shape.borders[1:]) / 2.0 - 0.25 / shape.rows
    return np.array([Diameter(float(middle))(state) for middle in middles])


def _away(turn: Array) -> Array:
    """Return the turning of segments in the plane of symmetry (segments,), deg, away from x positive."""
    return -np.degrees(turn[:, 1])


def _finger(turn: Array, width: Array) -> bool:
    bend = _away(turn)
    return bool((np.diff(bend) < 0.0).all() and bend[0] > 0.0)


def _opposite(turn: Array, width: Array) -> bool:
    first, second = _away(turn)
    return bool(first > 0.0 > second)


def _alike(turn: Array, width: Array) -> bool:
    first, second = _away(turn)
    return bool(first > 0.0 and second > 0.0 and max(first, second) < _EQUAL * min(first, second))


def _across(turn: Array, width: Array) -> bool:
    a, b = turn[0, :2], turn[1, :2]
    cosine = float(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)))
    return _ACROSS[0] < np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))) < _ACROSS[1]


def _middle(turn: Array, width: Array) -> bool:
    bend = np.abs(_away(turn))
    return bool(bend[[0, 2]].max() < _STRAIGHT * bend[1])


def _cone(turn: Array, width: Array) -> bool:
    # the clamp holds the first segment, so it is compared with the last one only
    return bool((np.diff(width[1:]) < 0.0).all() and width[0] > width[-1] and _away(turn).sum() > _BENT)


_HOLDS: Mapping[str, Callable[[Array, Array], bool]] = {
    "finger": _finger, "trunk": _opposite, "s": _opposite, "c": _alike, "trunk-out-of-plane": _across, "u": _middle,
    "tentacle": _cone,
}  # fmt: skip


def shape_findings(study: ShapesStudy, solutions: Mapping[str, Solution]) -> tuple[Finding, ...]:
    """Return for each shape whether it is the one that the study shows, and its largest principal stresses.

    solutions: name of a run -> its solution; what is missing or stopped before its pressure has no value.
    """
    rows: list[Finding] = []
    for shape in study.shapes:
        solution = solutions.get(study.run_of(shape).name)
        done = solution is not None and solution.status is Status.DONE
        rows.append(_form(shape, solution if done else None))
        for domain, (low, high) in STRESSES.items():
            value = float(solution.history.values(f"peak_principal_stress:{domain}")[-1]) if done and solution else None
            said = f"{low:g} to {high:g} MPa"
            row = Comparison(
                f"largest principal stress, {domain}", _condition(shape), (low + high) / 2.0, value, "MPa",
                f"reported for all shapes: {said}; middle of it taken",
            )  # fmt: skip
            rows.append(Finding(row, said, None if value is None else low <= value <= high))
    return tuple(rows)


def _form(shape: Shape, solution: Solution | None) -> Finding:
    bend, holds, note = None, None, f"reported: {shape.told}"
    if solution is not None:
        state = solution.states[-1]
        turn, width = turns(state, shape), widths(state, shape)
        holds = _HOLDS[shape.name](turn, width)
        bend = float(np.degrees(np.linalg.norm(turn[:, :2], axis=1).max()))
        note += "; " + described(shape, turn, width)
    row = Comparison("shape: largest turning of a segment", _condition(shape), None, bend, "deg", note)
    return Finding(row, shape.told, holds)


def _condition(shape: Shape) -> str:
    assumed = f", beams of at least {shape.least_beam:g} mm" if shape.least_beam else ""
    return f"{shape.title}, {write(shape.pressure, 'pressure')}{assumed}"


def described(shape: Shape, turn: Array, width: Array) -> str:
    """Return 'segments turn by 12.1, -11.8 deg, are 40.1, 40.3 mm thick' of a deformed shape."""
    if shape.half:
        angles = ", ".join(f"{angle:.1f}" for angle in _away(turn))
    else:
        angles = ", ".join(f"{np.degrees(np.linalg.norm(t[:2])):.1f}" for t in turn)
        a, b = (np.degrees(np.arctan2(-t[0], t[1])) for t in turn[:2])
        angles += f" (towards {a:.0f} and {b:.0f} deg around)"
    return f"segments turn by {angles} deg, are {', '.join(f'{w:.1f}' for w in width)} mm thick in their middles"


def tube_of(shape: Shape) -> BendingSkin:
    """Return the tube of a shape."""
    tube = shape.study.actuator
    assert isinstance(tube, BendingSkin)
    return tube


NOTES = (
    "Given by the study: kinds and number of segments, cg of finger and U, pressures, materials, tube and cells in "
    "cross-section. The number of rows of a segment is not given: assumed three or four, in the tentacle two.",
    f"Assumed: beams between rows of holes of at least {LEAST_BEAM:g} mm in finger and U. The holes as published touch "
    "at cg = 0.5 and leave loose bars, with which the tube bulges below 9 kPa; at cg = 0.4 the re-entrant cells "
    "have beams of 0.4 mm. Cells of cg = 0.2 are as published.",
    "Coarse mesh of quadratic hexahedra and wedges, half the tube where the map is its own mirror image; largest "
    "values at the integration points of a domain, the cap's rim included.",
    "Bending away from the middle of the first run counts positive; a segment turns by what the sections at its ends "
    "have turned against each other.",
)
