"""Files of test data -> tests, with every unit known and every value checked."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, UnitError
from pneumorph.materials.fitting.columns import Column, factor_of, only, plain_factor, understand
from pneumorph.materials.fitting.specimen import SpecimenTest, mode_named
from pneumorph.materials.fitting.table import Table, is_number, read_table

Array = NDArray[np.float64]

STRESSES = ("engineering", "true")


@dataclass(frozen=True)
class ReadOptions:
    """What the header of a file does not say.

    mode:        test of files that have no column `test` and no comment such as '# test: planar'.
    stress:      "engineering" (over the undeformed area) or "true", where the header says neither.
    strain_unit: unit of a strain without one: "-" or "%".
    stress_unit: unit of a stress without one, such as "kPa".
    area:        undeformed cross-section in mm², for columns of force.
    length:      undeformed gauge length in mm, for columns of displacement.

    Raises InputError for values out of range, UnitError for unknown units.
    """

    mode: str | None = None
    stress: str | None = None
    strain_unit: str | None = None
    stress_unit: str | None = None
    area: float | None = None
    length: float | None = None

    def __post_init__(self) -> None:
        if self.mode is not None:
            object.__setattr__(self, "mode", mode_named(self.mode))
        if self.stress is not None and self.stress not in STRESSES:
            raise InputError(f"stress = '{self.stress}', allowed: {' or '.join(STRESSES)}")
        if self.strain_unit is not None:
            plain_factor(self.strain_unit, "strain unit")
        if self.stress_unit is not None:
            factor_of(self.stress_unit, "stress", "stress unit")
        for name in ("area", "length"):
            value = getattr(self, name)
            if value is not None and not (np.isfinite(value) and value > 0.0):
                raise InputError(f"{name} = {value:g}, allowed: finite and more than 0")


def read_tests(paths: Iterable[Path], options: ReadOptions | None = None) -> tuple[SpecimenTest, ...]:
    """Return the tests in some files: one for each test and specimen that a file tells apart, as recorded.

    A file needs a deformation (stretch, strain, or displacement with `length`) and a stress (or force with `area`),
    each with its unit in the header, in a row below it or in the options; and its test in a column `test`, in a comment
    or in the options. Other columns are left alone. Raises InputError, one of its kinds, with file, line and column.
    """
    options = options or ReadOptions()
    tests = tuple(test for path in paths for test in _read(Path(path), options))
    if not tests:
        raise InputError("no test data given, expected one file or more")
    return tests


def _read(path: Path, options: ReadOptions) -> list[SpecimenTest]:
    table = read_table(path)
    units = None
    if not any(is_number(cell) for cell in table.rows[0]) and _looks_like_units(table.rows[0]):
        units = table.rows.pop(0)
        table.lines.pop(0)
    columns = understand(table.header, units)
    source = str(path)
    deformation = only(columns, ("stretch", "strain"), source, "deformation")
    deformation = deformation or only(columns, ("displacement",), source, "deformation")
    load = only(columns, ("stress",), source, "stress") or only(columns, ("force",), source, "stress")
    for found, what, example in (
        (deformation, "deformation", "stretch [-], strain [%] or displacement [mm]"),
        (load, "stress", "nominal stress [MPa], true stress [kPa] or force [N]"),
    ):
        if found is None:
            named = ", ".join(f"'{title}'" for title in table.header)
            raise InputError(f"{path}: no column for the {what} among {named}, expected one such as '{example}'")
    assert deformation is not None
    assert load is not None

    count = len(table.rows)
    stretch = _stretch(deformation, _numbers(table, deformation), options, source)
    stress = _nominal(load, _numbers(table, load), stretch, options, source)
    lines = np.array(table.lines, dtype=np.int64)
    groups: dict[tuple[str, str], list[int]] = {}
    modes = _modes(table, only(columns, ("test",), source, "test"), options)
    specimen = only(columns, ("specimen",), source, "specimen")
    for row in range(count):
        name = table.rows[row][specimen.index].strip() if specimen else ""
        groups.setdefault((modes[row], name), []).append(row)
    return [
        SpecimenTest(mode, stretch[rows], stress[rows], f"{path} ({name})" if name else source, lines[rows])
        for (mode, name), rows in groups.items()
    ]


def _looks_like_units(cells: list[str]) -> bool:
    given = [cell.strip() for cell in cells if cell.strip()]
    return bool(given) and all(cell[0] in "[(" or len(cell) <= 8 for cell in given)


def _numbers(table: Table, column: Column) -> Array:
    return np.array([table.number(row, column.index) for row in range(len(table.rows))])


def _unit(column: Column, option: str | None, flag: str, source: str) -> str:
    """Return the unit that the header or the option gives; the two must not differ."""
    if column.unit is None and option is None:
        raise UnitError(f"{source}: column '{column.title}' has no unit; write it in the header, or give {flag}")
    if column.unit is not None and option is not None and column.unit != option:
        raise UnitError(f"{source}: column '{column.title}' has the unit '{column.unit}', but {flag} is '{option}'")
    return column.unit if column.unit is not None else str(option)


def _stretch(column: Column, values: Array, options: ReadOptions, source: str) -> Array:
    what = f"{source}, column '{column.title}'"
    if column.quantity == "stretch":  # a ratio by its nature
        return values * plain_factor(column.unit or "-", what)
    if column.quantity == "strain":
        strain = values * plain_factor(_unit(column, options.strain_unit, "--strain-unit", source), what)
        if column.true:
            with np.errstate(over="ignore"):
                return np.exp(strain)
        return 1.0 + strain
    if options.length is None:
        raise InputError(f"{what}: a displacement needs the undeformed gauge length, give --length")
    return 1.0 + values * factor_of(_unit(column, None, "a length", source), "length", what) / options.length


def _nominal(column: Column, values: Array, stretch: Array, options: ReadOptions, source: str) -> Array:
    what = f"{source}, column '{column.title}'"
    if column.quantity == "force":
        if options.area is None:
            raise InputError(f"{what}: a force needs the undeformed cross-section, give --area")
        return values * factor_of(_unit(column, None, "a unit of force", source), "force", what) / options.area
    said = None if column.true is None else STRESSES[column.true]
    if said and options.stress and said != options.stress:
        raise InputError(f"{what}: the header says {said}, but --stress is {options.stress}")
    stress = values * factor_of(_unit(column, options.stress_unit, "--stress-unit", source), "stress", what)
    if (said or options.stress) != "true":
        return stress
    # of an incompressible specimen, in each of the three tests
    return np.divide(stress, stretch, out=np.full_like(stress, np.nan), where=stretch > 0.0)


def _modes(table: Table, column: Column | None, options: ReadOptions) -> list[str]:
    """Return the mode of each row."""
    if column is not None:
        modes = []
        for row, cells in enumerate(table.rows):
            try:
                modes.append(mode_named(cells[column.index]))
            except InputError as error:
                raise type(error)(f"{table.path} line {table.lines[row]}, column '{column.title}': {error}") from None
        return modes
    for comment in table.comments:
        key, colon, value = comment.partition(":")
        if colon and key.strip().lower() == "test":
            return [mode_named(value)] * len(table.rows)
    if options.mode is None:
        raise InputError(
            f"{table.path}: which test is it? Give --test uniaxial, equibiaxial or planar, a column 'test', or a line "
            "'# test: uniaxial'"
        )
    return [options.mode] * len(table.rows)
