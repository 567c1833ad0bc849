"""A study of flat sheets: a file with [sheet] in place of [actuator], which pulls lattices along and around."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field, ValidationError

from pneumorph.errors import InputError, NameNotFoundError, StorageError, StudyError, unknown_name
from pneumorph.geometry.lattice import KINDS, Cell, Lattice
from pneumorph.homogenisation import Sheet, TensionTest, periodic_test, tension_test
from pneumorph.homogenisation.tension import DIRECTIONS
from pneumorph.materials import Material
from pneumorph.mechanics import State
from pneumorph.solution import History
from pneumorph.solution.history import Column, read_csv
from pneumorph.studies.schema import TAGS, LibraryMaterial, MaterialSection, MeshSection, Names
from pneumorph.studies.section import Section, quantity, refusal
from pneumorph.studies.study import material_of
from pneumorph.studies.toml_file import read_toml
from pneumorph.studies.writing import to_toml

SHEET, ENDLESS = "sheet", "endless"
MODELS = {SHEET: "a sheet between two grips", ENDLESS: "an endless sheet, one periodic cell"}
# columns of a curve; all lengths and forces are those of the whole sheet
CURVE = (
    Column("strain", "strain", "number"),
    Column("displacement", "displacement", "length"),
    Column("force", "force", "force"),
    Column("stress", "nominal stress", "stress"),
    Column("gauge_strain", "strain of the inner cells", "number"),
    Column("lateral_strain", "lateral strain of the inner cells", "number"),
    Column("lateral_displacement", "lateral displacement", "length"),
)


class SheetSection(Section):
    """A flat sheet of equal cells; left out, the skin of Pu et al. 2024 laid flat.

    kinds: cells that are pulled, one sheet of each: "re-entrant", "honeycomb", "brick".
    cg: gap of a cell over its height.
    columns: cells across, an even number.
    rows: cells along.
    width: of a cell, across.
    height: of a cell, along.
    beam: width of the straight beams.
    depth: of the sheet.
    least_beam: width below which the beams between rows of holes do not go.
    """

    kinds: Names = ("re-entrant", "honeycomb")
    cg: float = 0.2
    columns: int = 12
    rows: int = 7
    width: quantity("length") = Sheet.width  # type: ignore[valid-type]
    height: quantity("length") = Sheet.height  # type: ignore[valid-type]
    beam: quantity("length") = Sheet.beam  # type: ignore[valid-type]
    depth: quantity("length") = Sheet.depth  # type: ignore[valid-type]
    least_beam: quantity("length") = 0.0  # type: ignore[valid-type]


class PullSection(Section):
    """How the sheets are pulled.

    directions: "along" the tube, "around" it, or both.
    models: "sheet", between grips that slide across the pull, "endless", one periodic cell, or both.
    strain: of the sheet at the end.
    steps: states on the way, equally spaced.
    """

    directions: Names = DIRECTIONS
    models: Names = (SHEET, ENDLESS)
    strain: float = 0.3
    steps: int = 6


class TensionFile(Section):
    """A study of flat sheets in tension.

    title: title of the report; left out, the name of the file.
    sheet: the sheets.
    pull: how they are pulled.
    material: of the beams; left out, that of the published skin.
    mesh: how fine the mesh is: "automatic" a quarter of a cell's height, "coarse" half of it.
    """

    title: str = ""
    sheet: SheetSection
    pull: PullSection = Field(default_factory=PullSection)
    material: MaterialSection = Field(default_factory=lambda: LibraryMaterial(name="hei-cast-8400-skin"))
    mesh: MeshSection = Field(default_factory=MeshSection)


@dataclass(frozen=True)
class Pull:
    """One test: kind of the cells, direction, and model ('sheet' or 'endless')."""

    kind: str
    direction: str
    model: str

    @property
    def name(self) -> str:
        """Name of its files."""
        return f"{self.kind}-{self.direction}-{self.model}"

    @property
    def label(self) -> str:
        """Name in figures and tables."""
        return f"{self.kind}, {self.direction}"


@dataclass(frozen=True)
class TensionStudy:
    """A checked study of sheets; every sheet is made, and refused if wrong, when it is.

    name: short name, that of the file. file: its sections. Raises InputError, one of its kinds.
    """

    name: str
    file: TensionFile

    def __post_init__(self) -> None:
        sheet, pull = self.file.sheet, self.file.pull
        for where, chosen, known in (
            ("sheet.kinds", sheet.kinds, tuple(KINDS)), ("pull.directions", pull.directions, DIRECTIONS),
            ("pull.models", pull.models, tuple(MODELS)),
        ):  # fmt: skip
            if not chosen or len(set(chosen)) < len(chosen):
                raise StudyError(f"{where} = {list(chosen)}: expected one or more of {', '.join(known)}, each once")
            for name in chosen:
                if name not in known:
                    raise NameNotFoundError(f"{where}: {unknown_name('name', name, known)}")
        if not 0.0 < pull.strain < 10.0:
            raise StudyError(f"pull.strain = {pull.strain}: expected more than 0, less than 10")
        if pull.steps < 1:
            raise StudyError(f"pull.steps = {pull.steps}: expected at least 1")
        for name in ("grading", "detail", "wall_size", "homogenised"):
            if getattr(self.file.mesh, name):
                raise StudyError(f"mesh: {name} is given for flat sheets: expected a size only")
        for made in self.sheets.values():
            Lattice(*made.lengths, cells=((made.cell,) * made.columns,) * made.rows)
        _ = self.material, self.size

    @property
    def title(self) -> str:
        """The title, or the name of the study."""
        return self.file.title or self.name

    @cached_property
    def sheets(self) -> dict[str, Sheet]:
        """Kind of cell -> sheet."""
        s = self.file.sheet
        return {
            kind: Sheet(Cell(kind, s.cg, s.least_beam), s.columns, s.rows, s.width, s.height, s.beam, s.depth)
            for kind in s.kinds
        }

    @cached_property
    def material(self) -> Material:
        """Of the beams."""
        return material_of(self.file.material)

    @property
    def size(self) -> float:
        """Largest edge of the mesh, mm."""
        size, height = self.file.mesh.size, self.file.sheet.height
        return size if isinstance(size, float) else height / (2.0 if size == "coarse" else 4.0)

    @property
    def pulls(self) -> tuple[Pull, ...]:
        """All tests, endless sheets first: they take seconds."""
        models = sorted(self.file.pull.models)
        kinds, directions = self.file.sheet.kinds, self.file.pull.directions
        return tuple(Pull(kind, way, model) for model, kind, way in itertools.product(models, kinds, directions))

    def test(self, pull: Pull, progress: Callable[[State], None] | None = None) -> TensionTest:
        """Return the result of a test; progress: called with each state of a sheet. Raises NotConvergedError."""
        sheet, asked = self.sheets[pull.kind], self.file.pull
        if pull.model == ENDLESS:
            return periodic_test(
                sheet, pull.direction, asked.strain, material=self.material, size=self.size, steps=asked.steps
            )
        return tension_test(
            sheet, pull.direction, asked.strain, material=self.material, size=self.size, steps=asked.steps,
            progress=progress,
        )  # fmt: skip

    def curve(self, pull: Pull, test: TensionTest) -> History:
        """Return a test as a table with the columns `CURVE`."""
        sheet = self.sheets[pull.kind]
        extent = {"along": sheet.rows * sheet.height, "around": sheet.columns * sheet.width}
        long = extent[pull.direction]
        wide = next(value for way, value in extent.items() if way != pull.direction)
        rows = [
            dict(
                zip(
                    (column.key for column in CURVE),
                    (e, e * long, f * wide, f / sheet.depth, gauge, lateral, lateral * wide),
                    strict=True,
                )
            )
            for e, f, gauge, lateral in zip(test.strain, test.force, test.gauge, test.lateral, strict=True)
        ]
        return History(list(CURVE), rows)

    def read_curve(self, pull: Pull, path: Path) -> TensionTest:
        """Return the test whose curve was written to a file; raises StorageError for one that is damaged."""
        columns = read_csv(path)
        found = [columns.get(column.header) for column in CURVE]
        if any(not isinstance(values, np.ndarray) or len(values) < 2 for values in found):
            raise StorageError(f"{path} is damaged: expected the columns {', '.join(c.header for c in CURVE)}")
        strain, _, _, stress, gauge, lateral, _ = (np.asarray(values, dtype=float) for values in found)
        return TensionTest(strain, stress * self.sheets[pull.kind].depth, gauge, lateral)

    def resolved_text(self) -> str:
        """Return the text of a file that makes an equal study, with every default written out."""
        return to_toml(self.file.model_dump(exclude_none=True) | {"title": self.title})


def is_tension_table(table: Mapping[str, Any]) -> bool:
    """Return whether the contents of a study file are those of a study of sheets."""
    return "sheet" in table and "actuator" not in table


def load_tension(path: Path | str) -> TensionStudy:
    """Return the study of sheets in a TOML file; raises as `studies.load_study`."""
    path = Path(path)
    table = read_toml(path, "study file")
    try:
        return tension_from(table, path.stem)
    except InputError as error:
        raise type(error)(f"{path}: {error}") from error


def tension_from(table: Mapping[str, Any], name: str) -> TensionStudy:
    """Return the study of sheets with the contents of a study file as plain data."""
    try:
        file = TensionFile.model_validate(table, context={"quantities": "text", "folder": Path()})
    except ValidationError as error:
        raise refusal(error, TAGS) from None
    return TensionStudy(name, file)
