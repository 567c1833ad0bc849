"""An inverse search: the checked contents of a target file, and the sweep of uniform tubes that it needs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from pneumorph.errors import InputError, StudyError
from pneumorph.geometry import BendingSkin
from pneumorph.solution import History
from pneumorph.studies.design.law import LENGTH, PRESSURE, TURN, Lattice, TableLaw, law_of
from pneumorph.studies.design.schema import DesignFile
from pneumorph.studies.design.skin import Part, SkinDesign
from pneumorph.studies.design.target import Target, named_curve, read_curve
from pneumorph.studies.section import refusal, write
from pneumorph.studies.study import Study, study_from
from pneumorph.studies.sweeps import Sweep, SweepFolder
from pneumorph.studies.sweeps.schema import SweepFile
from pneumorph.studies.toml_file import read_toml
from pneumorph.studies.writing import to_toml

MEASURES = ("tip_rotation", TURN, LENGTH)
POINTS = "target.csv"  # beside a written target file
_SEARCHED = ("template", "cells_along", "cells_around", "reentrant", "cg", "segment", "blend", "half")
_BEYOND = 2.0  # stretch that no tube of the table has: what is longer is refused before it is computed


@dataclass(frozen=True)
class DesignTask:
    """A checked inverse search; every study that it may need is made, and refused if wrong, when it is.

    name: short name, that of the file. file: its sections. target: the curve.
    Raises InputError, one of its kinds, with the section and key that is wrong.
    """

    name: str
    file: DesignFile
    target: Target

    def __post_init__(self) -> None:
        self._check_search()
        for key in self.file.actuator:
            if key in _SEARCHED:
                raise StudyError(f"actuator: '{key}' is what is searched, or fixed by it: leave it out")
        _ = self.table
        self.verification(self._first)
        rest = self.tube.length
        if self.target.length > _BEYOND * rest:
            raise InputError(
                f"target: the curve is {self.target.length:.4g} mm long, the actuator {rest:g} mm at rest: expected at "
                f"most {_BEYOND:g} times that"
            )

    @property
    def title(self) -> str:
        """The title, or the name of the search."""
        return self.file.title or self.name

    @property
    def tube(self) -> BendingSkin:
        """The template as the file says, with the first lattice that it allows."""
        actuator = self.table.study.actuator
        assert isinstance(actuator, BendingSkin)
        return actuator

    @cached_property
    def lattices(self) -> tuple[Lattice, ...]:
        """All lattices that a segment may have."""
        s = self.file.search
        return tuple(
            Lattice(along, around, round(share * around))
            for along in s.cells_along
            for around in s.cells_around
            for share in s.reentrant
        )

    @cached_property
    def table(self) -> Sweep:
        """The sweep of uniform tubes, one for each lattice and cg."""
        s = self.file.search
        first = s.cells_along[0], s.cells_around[0], s.reentrant[0]
        actuator = dict(self.file.actuator) | {"template": "skinned-tube", "half": True, "cg": s.cg[0]}
        actuator |= dict(zip(("cells_along", "cells_around", "reentrant"), first, strict=True))
        study = self._study(actuator, s.pressure[-1]) | {"title": "Uniform tubes"}
        if s.model == "homogenised":
            study["mesh"] = {"homogenised": True}
        table = {
            "study": f"{self.name}-tube.toml",
            "parameters": {
                "actuator.cells_along": list(s.cells_along), "actuator.cells_around": list(s.cells_around),
                "actuator.reentrant": list(s.reentrant), "actuator.cg": list(s.cg),
            },
            "results": {key: key for key in (*MEASURES, PRESSURE)},
        }  # fmt: skip
        try:
            file = SweepFile.model_validate(table, context={"quantities": "text", "folder": Path()})
        except ValidationError as error:
            raise refusal(error, ()) from None
        sweep = Sweep("table", file, study)
        for design in sweep.designs:
            if design.study is None:
                raise InputError(f"search: {design.reason}")
        return sweep

    @property
    def sampler(self) -> str:
        """Name of the sampler."""
        s = self.file.search
        choices = max(map(len, (s.cells_along, s.cells_around, s.reentrant))) > 1 or not self.target.planar
        return s.sampler or ("tpe" if choices else "cma-es")

    def runs(self, folder: Path) -> dict[tuple[Lattice, float], History]:
        """Return (lattice, cg) -> history of the table that `run_sweep` computed into a folder.

        Raises InputError for a run that has not ended.
        """
        place = SweepFolder(folder)
        found = {}
        for design in self.table.designs:
            record = place.record(design)
            if record is None:
                raise InputError(f"'{folder}' misses design {design.number} of the table: compute it first")
            along, around, share, cg = design.values
            found[Lattice(along, around, round(share * around)), float(cg)] = record.history
        return found

    def law(self, runs: Mapping[tuple[Lattice, float], History]) -> TableLaw:
        """Return the law of the runs of the table.

        Raises InputError for a run that reached no pressure, or a target that is longer or shorter than the actuator
        can be.
        """
        law = law_of(runs, self.tube.length, self.file.search.pressure[-1])
        if law.pressure[-1] < self.file.search.pressure[0]:
            raise InputError(
                f"search: pressure from {write(self.file.search.pressure[0], 'pressure')}: the runs of the table "
                f"reached {write(float(law.pressure[-1]), 'pressure')} only"
            )
        shortest, longest = law.lengths(self.tube.length)
        if not shortest <= self.target.length <= longest:
            raise InputError(
                f"target: the curve is {self.target.length:.4g} mm long, the actuator {shortest:.4g} to {longest:.4g} "
                "mm under these pressures: expected a curve that it can reach"
            )
        return law

    def verification(self, design: SkinDesign) -> Study:
        """Return the study of a design by the full model: half of the tube where the map is its own mirror image."""
        whole = self._study(design.section(self.file.actuator, half=False), design.pressure)
        made = study_from(whole, f"{self.name}-found")
        assert isinstance(made.actuator, BendingSkin)
        half = made.actuator.tube.lattice.mirror is not None
        table = self._study(design.section(self.file.actuator, half=half), design.pressure)
        return study_from(table | {"title": f"{self.title}: the design found"}, f"{self.name}-found")

    def text(self) -> str:
        """Return the target file with all defaults; one with points of its own names `POINTS`, see `points_text`."""
        data = self.file.model_dump(exclude_none=True) | {"title": self.title}
        if self.file.target.file is not None:
            data["target"] = {**data["target"], "file": POINTS}
        return to_toml(data)

    def points_text(self) -> str | None:
        """Return the points of a target from a file, as it is placed, as such a file; None of a named curve."""
        if self.file.target.file is None:
            return None
        lines = ["x [mm],y [mm],z [mm]", *(",".join(f"{x:.12g}" for x in point) for point in self.target.points)]
        return "\n".join(lines) + "\n"

    def _study(self, actuator: Mapping[str, Any], pressure: float) -> dict[str, Any]:
        mesh = self.file.mesh.model_dump(exclude_none=True)
        steps = self.file.steps.model_dump()
        table: dict[str, Any] = {"measures": list(MEASURES), "actuator": dict(actuator), "mesh": mesh}
        if self.file.material:
            table["material"] = dict(self.file.material)
        targets = {"cavity": write(pressure, "pressure")}
        return table | {"phase": [{"name": "inflate", "targets": targets, **steps}]}

    @property
    def _first(self) -> SkinDesign:
        """A design of as many segments as any, to see that it makes a study."""
        s = self.file.search
        along, around = s.cells_along[0], s.cells_around[0]
        rows = [1] * (s.segments - 1) + [along - s.segments + 1]
        columns = round(s.reentrant[0] * around)
        return SkinDesign(tuple(Part(n, s.cg[0], columns, 0) for n in rows), around, s.pressure[-1])

    def _check_search(self) -> None:
        s = self.file.search
        for key, least in (("segments", 1), ("trials", 1), ("starts", 1), ("seed", 0)):
            if getattr(s, key) < least:
                what = ": the map would be empty" if key == "segments" else ""
                raise StudyError(f"search.{key} = {getattr(s, key)}: expected at least {least}{what}")
        for key in ("cells_along", "cells_around", "reentrant", "cg"):
            values = getattr(s, key)
            if not values or len(set(values)) < len(values) or not all(map(math.isfinite, values)):
                raise StudyError(f"search.{key} = {list(values)}: expected one or more different numbers")
        if list(s.cg) != sorted(s.cg):
            raise StudyError(f"search.cg = {list(s.cg)}: expected rising numbers")
        if len(s.pressure) != 2 or not 0.0 < s.pressure[0] < s.pressure[1]:
            shown = [write(p, "pressure") for p in s.pressure]
            raise StudyError(f"search.pressure = {shown}: expected the lowest, above 0, and the highest")
        if min(s.cells_along) < s.segments:
            raise StudyError(
                f"search.cells_along = {list(s.cells_along)}: expected at least {s.segments}, one row for each segment"
            )
        if self.target.planar:
            for around in s.cells_around:
                if around % 2 or any(round(share * around) % 2 for share in s.reentrant):
                    raise StudyError(
                        f"search: {around} columns, {[round(share * around) for share in s.reentrant]} of them "
                        "re-entrant: expected even numbers for a plane curve, so that the map is its own mirror image"
                    )


def load_design(path: Path | str) -> DesignTask:
    """Return the inverse search in a TOML file.

    Raises StudyError for a file that is missing, not readable or not TOML, and for unknown keys, missing entries and
    wrong types; NameNotFoundError for an unknown curve, UnitError for points without a unit, other InputErrors.
    """
    path = Path(path)
    table = read_toml(path, "target file")
    try:
        return design_from(table, path.stem, path.parent)
    except InputError as error:
        raise type(error)(f"{path}: {error}") from error


def design_from(table: Mapping[str, Any], name: str, folder: Path | None = None) -> DesignTask:
    """Return the search with the contents of a target file as plain data; folder: where its CSV file is sought."""
    try:
        file = DesignFile.model_validate(table, context={"quantities": "text"})
    except ValidationError as error:
        raise refusal(error, ()) from None
    return DesignTask(name, file, _target(file, folder or Path()))


def _target(file: DesignFile, folder: Path) -> Target:
    asked = file.target
    if (asked.curve is None) == (asked.file is None):
        raise StudyError("target: expected either curve, the name of one, or file, a CSV file of points")
    if asked.file is not None:
        for key in ("length", "angle"):
            if getattr(asked, key) is not None:
                raise StudyError(f"target.{key}: only for a named curve, the file has its own")
        return read_curve(folder / asked.file)
    if asked.length is None or (asked.angle is None and asked.curve != "line"):
        missing = "length" if asked.length is None else "angle"
        raise StudyError(f"target.{missing}: missing for the curve '{asked.curve}'")
    return named_curve(str(asked.curve), asked.length, asked.angle or 0.0, asked.twist)
