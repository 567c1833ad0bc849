"""The table as a Parquet file; no other module imports pyarrow."""

from __future__ import annotations

from pathlib import Path

import pyarrow
import pyarrow.parquet

from pneumorph.solution.files import write_atomically
from pneumorph.solution.history import TEXT
from pneumorph.studies.sweeps.table import SweepTable
from pneumorph.units import to_printed


def write_parquet(path: Path, table: SweepTable) -> None:
    """Write a table with the columns and units of its CSV file: float64, null where there is no number, and text.

    Raises StorageError.
    """
    arrays = {}
    for column in table.rows.columns:
        values = table.values(column.key)
        if column.kind == TEXT:
            arrays[column.header] = pyarrow.array([str(value) for value in values], pyarrow.string())
        else:
            printed = [to_printed(float(value), column.kind) for value in values]
            arrays[column.header] = pyarrow.array(printed, pyarrow.float64(), from_pandas=True)
    made = pyarrow.table(arrays)
    write_atomically(path, lambda temporary: pyarrow.parquet.write_table(made, temporary))
