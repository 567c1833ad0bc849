"""Solving and keeping: `solve`, its solution, history and run folder."""

from pneumorph.solution.codec import register
from pneumorph.solution.history import Column, History, Measure, read_csv
from pneumorph.solution.solution import Solution
from pneumorph.solution.solve import Progress, solve
from pneumorph.solution.status import Status
from pneumorph.solution.storage import RunFolder

__all__ = [
    "Column",
    "History",
    "Measure",
    "Progress",
    "RunFolder",
    "Solution",
    "Status",
    "read_csv",
    "register",
    "solve",
]
