"""The schema of a sweep file: which study, which parameters, how they are sampled, what goes into the table."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Strict, Tag, ValidationInfo

from pneumorph.errors import StudyError
from pneumorph.studies.section import Section

METHODS = ("grid", "list", "latin-hypercube", "sobol")
SAMPLED = ("latin-hypercube", "sobol")

Texts = Annotated[tuple[str, ...], Strict(False)]


class RangeSection(Section):
    """The values from one bound to another: steps of a grid, or the bounds of samples.

    low: first value, a quantity with its unit or a number; whole numbers stay whole.
    high: last value.
    steps: how many values from low to high, both among them; not for samples.
    spacing: "linear" for equal differences, "log" for equal ratios.
    """

    low: int | float | str
    high: int | float | str
    steps: int | None = None
    spacing: Literal["linear", "log"] = "linear"


class SamplingSection(Section):
    """How designs are made from the parameters.

    method: "grid" for every combination; "list" takes the first value of each parameter, then the second, and so on;
        "latin-hypercube" and "sobol" spread samples between bounds.
    samples: how many designs; for samples only.
    seed: of the random numbers of samples; the same seed gives the same designs.
    """

    method: Literal["grid", "list", "latin-hypercube", "sobol"] = "grid"
    samples: int | None = None
    seed: int = 0


class ResultSection(Section):
    """A column of the table, taken from a column of each design's history. A text alone is the column at the end.

    column: key of the history's column, such as "tip_rotation" or "pressure:cavity".
    at: "end" of the run, "maximum" or "minimum" over it; or a table with one entry, such as
        { phase = "inflate" } for the end of a phase, or { "pressure:cavity" = "60 kPa" } for where another column
        first has a value, between states linearly.
    """

    column: str
    at: Literal["end", "maximum", "minimum"] | dict[str, str] = "end"


class SlurmSection(Section):
    """Jobs of a SLURM cluster that do the work.

    jobs: how many jobs are submitted.
    workers: designs that one job computes at a time, each on one core.
    memory: memory of a job, such as "8 GB".
    walltime: time after which SLURM ends a job, such as "02:00:00".
    queue: partition that the jobs go to.
    account: account that they are charged to.
    prologue: lines of shell before a job's workers start, such as "module load python".
    directives: further #SBATCH options, such as "--exclusive".
    """

    jobs: int = 1
    workers: int = 1
    memory: str
    walltime: str
    queue: str | None = None
    account: str | None = None
    prologue: Texts = ()
    directives: Texts = ()


def _located(value: object, info: ValidationInfo) -> object:
    """Return the path of the study as seen from everywhere: it is relative to the sweep file."""
    if not isinstance(value, str) or not value.strip():
        raise StudyError(f"study = {value!r}: expected the name of a study file, as text")
    return str((Path((info.context or {}).get("folder") or ".") / value).resolve())


def _flattened(table: object) -> object:
    """Return dotted path -> list or range; TOML reads `actuator.wall = [...]` as a table in a table."""
    if not isinstance(table, Mapping):
        return table
    found: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping) and not value.keys() & RangeSection.model_fields.keys():
            if not value:
                raise StudyError(f"{key} = {{}}: expected a list of values, or a table with low and high")
            inner = _flattened(value)
            assert isinstance(inner, dict)
            new = {f"{key}.{rest}": item for rest, item in inner.items()}
        else:
            new = {str(key): value}
        for path, item in new.items():
            if path in found:
                raise StudyError(f"'{path}' is given twice")
            found[path] = item
    return found


def _alone(value: object) -> object:
    """A text alone is a column at the end."""
    return {"column": value} if isinstance(value, str) else value


def _form(value: object) -> str:
    return RANGE if isinstance(value, Mapping | RangeSection) else LIST


LIST, RANGE = "values", "range"
TAGS = (LIST, RANGE)  # names of union members that pydantic adds to the path of an error
Values: Any = Annotated[
    Annotated[list[Any], Tag(LIST)] | Annotated[RangeSection, Tag(RANGE)],
    Discriminator(_form),
]


class SweepFile(Section):
    """A sweep: one study with many values of its parameters.

    study: study file whose parameters are varied, seen from the sweep file.
    title: title of the report; left out, that of the study.
    parameters: dotted path into the study file, such as "actuator.length" or "phase[1].targets.cavity" -> list of
        values, or a range.
    sampling: how designs are made from the parameters.
    results: name -> column of the table; left out, all measures, pressures and added volumes at the end of each phase.
    keep_runs: keep every design's whole run folder, not only its history.
    slurm: jobs of a SLURM cluster that do the work, in place of this machine.
    """

    study: Annotated[str, BeforeValidator(_located)]
    title: str = ""
    keep_runs: bool = False
    parameters: Annotated[dict[str, Values], BeforeValidator(_flattened)]
    sampling: SamplingSection = Field(default_factory=SamplingSection)
    results: dict[str, Annotated[ResultSection, BeforeValidator(_alone)]] = Field(default_factory=dict)
    slurm: SlurmSection | None = None
