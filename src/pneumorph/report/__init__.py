"""The report of a run: one self-contained page, its figures and the comparison with reported values."""

from pneumorph.report.comparison import read_at, read_comparison, write_comparison
from pneumorph.report.figures import Curve
from pneumorph.report.tables import Cell, Table
from pneumorph.report.write import write_report

__all__ = ["Cell", "Curve", "Table", "read_at", "read_comparison", "write_comparison", "write_report"]
