"""A table of runs as CSV that grows by a line for each finished run, and of which a killed sweep is resumed."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from pneumorph.errors import StorageError

DONE, FAILED = "done", "failed"


class RunTable:
    """The CSV file of a sweep; its first columns are `run`, `status` ('done' or 'failed') and `reason`.

    A line is written whole and brought to the disk before the next run counts. A last line that a kill cut short is
    dropped; of several lines for one run the last one holds, so that a failed run may be tried again.
    """

    def __init__(self, path: Path, columns: Sequence[str]):
        self.path = path
        self.columns = ("run", "status", "reason", *columns)

    def rows(self) -> dict[str, dict[str, str]]:
        """Return the rows by run; raises StorageError for a file with other columns or one that cannot be read."""
        text = self._text()
        if not text:
            return {}
        lines = list(csv.reader(io.StringIO(text)))
        if tuple(lines[0]) != self.columns:
            raise StorageError(f"{self.path} has the columns {', '.join(lines[0])}; expected {', '.join(self.columns)}")
        found = {}
        for number, line in enumerate(lines[1:], start=2):
            if len(line) != len(self.columns) or line[1] not in (DONE, FAILED):
                raise StorageError(f"{self.path} is damaged: line {number} is no row of this table")
            found[line[0]] = dict(zip(self.columns, line, strict=True))
        return found

    def append(self, row: Mapping[str, object]) -> None:
        """Add a row; columns that it does not have stay empty. Raises StorageError where it cannot be written."""
        unknown = set(row) - set(self.columns)
        if unknown:
            raise KeyError(f"no such columns: {', '.join(sorted(unknown))}")
        kept = self._text()
        buffer = io.StringIO()
        writer = csv.writer(buffer, lineterminator="\n")
        if not kept:
            writer.writerow(self.columns)
        values = (row.get(name, "") for name in self.columns)
        writer.writerow([f"{value:.6g}" if isinstance(value, float) else _one_line(value) for value in values])
        try:
            with self.path.open("r+b" if self.path.exists() else "xb") as file:
                file.seek(len(kept.encode()))
                file.truncate()
                file.write(buffer.getvalue().encode())
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise StorageError(f"{self.path} cannot be written: {error}") from error

    def _text(self) -> str:
        """Return the whole lines of the file."""
        try:
            content = self.path.read_bytes() if self.path.exists() else b""
            return content[: content.rfind(b"\n") + 1].decode("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise StorageError(f"{self.path} cannot be read: {error}") from error


def _one_line(value: object) -> str:
    return " ".join(str(value).split())
