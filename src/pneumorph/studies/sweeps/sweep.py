"""A sweep: the checked contents of a sweep file, with the study of every design."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from pneumorph.errors import InputError, StudyError
from pneumorph.studies.importing import ImportedSection
from pneumorph.studies.running import STUDY_FILE
from pneumorph.studies.section import refusal
from pneumorph.studies.study import Study, study_from
from pneumorph.studies.sweeps.designs import Design, designs_of
from pneumorph.studies.sweeps.parameters import Parameter, parameter_of
from pneumorph.studies.sweeps.paths import replaced
from pneumorph.studies.sweeps.results import Result, results_of
from pneumorph.studies.sweeps.sampling import combinations
from pneumorph.studies.sweeps.schema import TAGS, SweepFile
from pneumorph.studies.toml_file import read_toml
from pneumorph.studies.writing import to_toml, toml_key, toml_value


@dataclass(frozen=True)
class Sweep:
    """A checked sweep: every design's study is made, and what is wrong refused, when the sweep is; no mesh is.

    name: short name, that of the file. file: its sections. table: contents of the study file.
    Raises InputError, one of its kinds, with the section and key that is wrong.
    """

    name: str
    file: SweepFile
    table: Mapping[str, Any]

    def __post_init__(self) -> None:
        _ = self.study, self.designs, self.results

    @property
    def title(self) -> str:
        """The title, or that of the study."""
        return self.file.title or self.study.title

    @cached_property
    def study(self) -> Study:
        """The study as its own file says, before any parameter is varied."""
        return study_from(self.table, Path(self.file.study).stem, Path(self.file.study).parent)

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """What is varied."""
        if not self.file.parameters:
            raise StudyError("parameters: expected at least one, such as \"actuator.length\" = ['90 mm', '100 mm']")
        return tuple(parameter_of(path, given) for path, given in self.file.parameters.items())

    @cached_property
    def designs(self) -> tuple[Design, ...]:
        """Every design, in order."""
        values = combinations(self.parameters, self.file.sampling)
        path = Path(self.file.study)
        return designs_of(self.table, path.stem, path.parent, self.parameters, values)

    @cached_property
    def results(self) -> tuple[Result, ...]:
        """What goes into the table."""
        return results_of(self.file.results, (d.study for d in self.designs if d.study is not None))

    def text(self) -> str:
        """Return a sweep file that makes an equal sweep beside `study.toml`, which holds `study_text`."""
        data = self.file.model_dump(exclude_none=True) | {"title": self.title, "study": STUDY_FILE}
        # in the order given, which is that of the designs: lists and ranges on one line each
        lines = [f"{toml_key(path)} = {toml_value(item)}" for path, item in data.pop("parameters").items()]
        return to_toml(data) + "\n[parameters]\n" + "\n".join(lines) + "\n"

    def study_text(self) -> str:
        """Return the study file as it stands, not resolved, as the parameters lead into it; files by whole paths.

        Its title is in it, so that under any name it makes equal designs.
        """
        table, file = {**self.table, "title": self.study.title}, self.study.file
        sections = {"actuator.file": file.actuator}
        sections |= {f"part.{name}.actuator.file": part.actuator for name, part in file.part.items()}
        for path, section in sections.items():
            if isinstance(section, ImportedSection):
                table = replaced(table, path, section.file)
        return to_toml(table)


def load_sweep(path: Path | str) -> Sweep:
    """Return the sweep in a TOML file.

    Raises StudyError for a file that is missing, not readable or not TOML, and for unknown keys, missing entries and
    wrong types, in it or in its study; other InputErrors for values that are refused.
    """
    path = Path(path)
    table = read_toml(path, "sweep file")
    try:
        return sweep_from(table, path.stem, path.parent)
    except InputError as error:
        raise type(error)(f"{path}: {error}") from error


def sweep_from(table: Mapping[str, Any], name: str, folder: Path | None = None) -> Sweep:
    """Return the sweep with the contents of a sweep file as plain data; folder: where its study is sought."""
    try:
        file = SweepFile.model_validate(table, context={"quantities": "text", "folder": folder or Path()})
    except ValidationError as error:
        raise refusal(error, TAGS) from None
    return Sweep(name, file, read_toml(Path(file.study), "study file"))
