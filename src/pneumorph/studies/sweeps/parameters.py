"""A varied parameter: its path, the kind of its values, and the value at a share of its range."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pneumorph.errors import StudyError, UnitError, shortened
from pneumorph.solution.history import TEXT
from pneumorph.studies.section import write
from pneumorph.studies.sweeps.schema import RangeSection
from pneumorph.units import KINDS, parse, show

NUMBER = "number"
# an angle is a ratio, so that plain numbers would pass for one
_ANGLE = re.compile(r"(deg|rad|°|turn|arc)")
_DIGITS = 6  # of a sampled quantity: the study of a design stays readable


def kind_of(values: Sequence[Any]) -> str:
    """Return the kind of quantity that all values are, 'number', or 'text' for anything else.

    >>> kind_of(["1 mm", "0.2 cm"]), kind_of([5, 7]), kind_of(["ecoflex-00-30", "lsr"])
    ('length', 'number', 'text')
    """
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        return NUMBER
    if not all(isinstance(value, str) for value in values):
        return TEXT
    for kind in (NUMBER, *KINDS):
        if (kind == "angle") != all(_ANGLE.search(value) for value in values):
            continue
        try:
            for value in values:
                parse(value, kind)
        except UnitError:
            continue
        return kind
    return TEXT


@dataclass(frozen=True)
class Parameter:
    """path: into the study file; values: those that are listed or stepped through, empty for a range without steps;
    kind: of quantity, 'number' or 'text'; bounds: of a range, as they stand in the file; whole: only whole numbers.
    """  # fmt: skip

    path: str
    kind: str
    values: tuple[Any, ...] = ()
    bounds: tuple[Any, Any] | None = None
    log: bool = False
    whole: bool = False

    def inside(self, value: Any) -> float | str:
        """Return a value for the table: in inside units, or as text."""
        if self.kind == TEXT:
            return value if isinstance(value, str) else str(value)
        return parse(value, self.kind, self.path) if isinstance(value, str) else float(value)

    def at(self, share: float) -> Any:
        """Return the value at a share, 0 to below 1, of the range; or that one of the listed values."""
        if self.bounds is None:
            return self.values[min(int(share * len(self.values)), len(self.values) - 1)]
        low, high = (float(self.inside(bound)) for bound in self.bounds)
        if self.whole:
            return int(low) + min(int(share * (high - low + 1.0)), int(high - low))
        return self._written(_between(low, high, share, self.log), _DIGITS)

    def _written(self, value: float, digits: int) -> Any:
        if isinstance((self.bounds or self.values)[0], str):
            return write(value, self.kind) if digits > _DIGITS else show(value, self.kind, digits)
        return float(f"{value:.{digits}g}")


def parameter_of(path: str, given: Sequence[Any] | RangeSection) -> Parameter:
    """Return the parameter that a sweep file describes; raises StudyError, UnitError for one that is not one."""
    if not isinstance(given, RangeSection):
        if not given:
            raise StudyError(f"parameters: '{path}' = []: expected at least one value")
        return Parameter(path, kind_of(given), tuple(given))
    bounds = (given.low, given.high)
    where = f"parameters: '{path}': low = {shortened(repr(given.low))}, high = {shortened(repr(given.high))}"
    kind = kind_of(bounds)
    if kind == TEXT:
        raise UnitError(f"{where}: expected two quantities of one kind with their units, or two numbers")
    log = given.spacing == "log"
    empty = Parameter(path, kind, bounds=bounds, log=log, whole=all(type(bound) is int for bound in bounds))
    low, high = float(empty.inside(given.low)), float(empty.inside(given.high))
    if not low < high:
        raise StudyError(f"{where}: expected low below high")
    if log and low <= 0.0:
        raise StudyError(f"{where}: spacing = 'log' needs values above zero")
    if given.steps is None:
        return empty
    if given.steps < 2:
        raise StudyError(f"parameters: '{path}': steps = {given.steps}: expected at least 2")
    numbers = [_between(low, high, i / (given.steps - 1), log) for i in range(given.steps)]
    if empty.whole:
        if any(abs(number - round(number)) > 1e-9 for number in numbers):
            raise StudyError(f"{where}: {given.steps} steps do not fall on whole numbers; list the values")
        values: tuple[Any, ...] = tuple(round(number) for number in numbers)
    else:
        values = tuple(empty._written(number, 12) for number in numbers)
    return Parameter(path, kind, values, bounds, log, empty.whole)


def _between(low: float, high: float, share: float, log: bool) -> float:
    if log:
        return math.exp(math.log(low) + share * (math.log(high) - math.log(low)))
    return low + share * (high - low)
