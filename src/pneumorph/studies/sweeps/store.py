"""The folder of a sweep: sweep.toml, study.toml, table.csv, table.parquet and a folder for each design that ended.

designs/<identity>/ holds study.toml (resolved), history.csv and design.json, which is written last: where it stands,
the design has ended. Each file is replaced in one go, so that a kill at any moment loses no design that ended.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pneumorph.errors import StorageError
from pneumorph.solution.files import make_folder, remove_parts, write_atomically
from pneumorph.solution.storage import HISTORY
from pneumorph.studies.running import STUDY_FILE
from pneumorph.studies.sweeps.compute import Record
from pneumorph.studies.sweeps.designs import Design
from pneumorph.studies.sweeps.parquet import write_parquet
from pneumorph.studies.sweeps.table import SweepTable

FORMAT = 1
SWEEP, DESIGNS, DESIGN, TABLE, PARQUET, RUN = (
    "sweep.toml",
    "designs",
    "design.json",
    "table.csv",
    "table.parquet",
    "run",
)
_SHORT = 16  # characters of an identity in a folder's name: 64 bits, so that no two designs meet


class SweepFolder:
    """Paths of a sweep, and its files in and out; nothing is touched when it is made."""

    def __init__(self, folder: Path | str):
        self.path = Path(folder)
        self.sweep, self.study, self.designs = self.path / SWEEP, self.path / STUDY_FILE, self.path / DESIGNS
        self.table, self.parquet = self.path / TABLE, self.path / PARQUET

    @property
    def holds_sweep(self) -> bool:
        """Whether anything of a sweep lies there."""
        return self.sweep.exists() or self.designs.exists()

    def start(self, sweep: str, study: str) -> None:
        """Write the texts of the sweep file and of the study file, and remove what a kill left half-written."""
        make_folder(self.designs)
        for folder in (self.path, *self.designs.iterdir()):
            if folder.is_dir():
                remove_parts(folder)
        _write_text(self.sweep, sweep)
        _write_text(self.study, study)

    def of(self, design: Design) -> Path:
        """Return the folder of a design."""
        return self.designs / design.identity[:_SHORT]

    def record(self, design: Design) -> Record | None:
        """Return how a design ended, None where it has not; raises StorageError for a damaged file."""
        path = self.of(design) / DESIGN
        if not path.is_file():
            return None
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
            if data["format"] != FORMAT:
                raise StorageError(f"{path} has format {data['format']}, this version reads {FORMAT}")
            return Record.of_plain(data)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise StorageError(f"{path} is damaged: {error}; remove it to compute the design again") from error

    def keep(self, design: Design, record: dict[str, Any]) -> Record:
        """Write how a design ended; return it. Raises StorageError."""
        assert design.study is not None
        folder, made = self.of(design), Record.of_plain(record)
        make_folder(folder)
        _write_text(folder / STUDY_FILE, design.study.resolved_text())
        if made.history.columns:
            made.history.write_csv(folder / HISTORY)
        _write_text(folder / DESIGN, json.dumps({"format": FORMAT, **record}, indent=1, ensure_ascii=False) + "\n")
        return made

    def write_table(self, table: SweepTable) -> None:
        """Write the table in both forms, in place of earlier ones."""
        table.rows.write_csv(self.table)
        write_parquet(self.parquet, table)


def _write_text(path: Path, text: str) -> None:
    write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
