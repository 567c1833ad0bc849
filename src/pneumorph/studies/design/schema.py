"""The schema of a target file: which curve is wanted, of which tube, and what may be varied to get it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, Strict

from pneumorph.studies.schema import MeshSection
from pneumorph.studies.section import Section, quantity

Numbers = Annotated[tuple[float, ...], Strict(False)]
Counts = Annotated[tuple[int, ...], Strict(False)]


class TargetSection(Section):
    """The centre line that is wanted.

    curve: its name, with length and angle; or
    file: CSV file of points from the clamp to the tip, seen from the target file; columns such as 'x [mm]'.
    length: of a named curve.
    angle: by which each of its arcs turns.
    twist: of a helix, over its whole length.
    """

    curve: str | None = None
    file: str | None = None
    length: quantity("length") | None = None  # type: ignore[valid-type]
    angle: quantity("angle") | None = None  # type: ignore[valid-type]
    twist: quantity("angle") = 0.0  # type: ignore[valid-type]


class SearchSection(Section):
    """What may be varied, and how it is searched.

    segments: of the map.
    cells_along: numbers of cells along to choose from.
    cells_around: numbers of columns to choose from.
    reentrant: shares of re-entrant columns to choose from, from 0 to 1.
    cg: gaps at which uniform tubes are computed; between the first and the last a segment has any.
    pressure: the lowest and the highest.
    model: of the uniform tubes: "full", by finite elements of every beam, or "homogenised", with a closed skin that
        stands for them: faster and less exact, pressures are off by 15 %.
    trials: designs that are tried on the surrogate, in all.
    starts: independent searches among which they are shared.
    sampler: "cma-es", evolution of a covariance, or "tpe", a tree of Parzen estimators, which is better at choices;
        left out, "tpe" where there is more than one choice of cells or shares, or the curve is not plane.
    seed: of its random numbers.
    """

    segments: int = 2
    cells_along: Counts = (8,)
    cells_around: Counts = (12,)
    reentrant: Numbers = (0.5,)
    cg: Numbers = (0.2, 0.3)
    pressure: Annotated[tuple[quantity("pressure"), ...], Strict(False)] = (0.005, 0.02)  # type: ignore[valid-type]
    model: Literal["full", "homogenised"] = "full"
    trials: int = 1200
    starts: int = 4
    sampler: Literal["tpe", "cma-es"] | None = None
    seed: int = 0


class StepsSection(Section):
    """Increments of the runs by finite elements, as in a phase of a study.

    first_increment: first increment as a fraction of the way to the pressure.
    largest_increment: largest increment as a fraction of it.
    """

    first_increment: float = 0.05
    largest_increment: float = 0.1


class DesignFile(Section):
    """An inverse search.

    title: title of the report; left out, the name of the file.
    target: the centre line that is wanted.
    actuator: keys of the template "skinned-tube" that are not searched, such as length and wall.
    material: as in a study; left out, that of the published actuator.
    mesh: how fine the mesh of every run by finite elements is.
    search: what may be varied.
    steps: increments of the runs.
    """

    title: str = ""
    target: TargetSection
    actuator: dict[str, Any] = Field(default_factory=dict)
    material: dict[str, Any] = Field(default_factory=dict)
    mesh: MeshSection = Field(default_factory=lambda: MeshSection(size="coarse"))
    search: SearchSection = Field(default_factory=SearchSection)
    steps: StepsSection = Field(default_factory=StepsSection)
