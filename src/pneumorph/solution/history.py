"""The history of a run: one row of numbers for each state, with labels and units; written as CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, NameNotFoundError, StorageError, unknown_name
from pneumorph.mechanics import FlowSupply, Model, Programme, State
from pneumorph.mechanics.contact.part import NO_TOUCH
from pneumorph.mechanics.supplies import GasFilled
from pneumorph.mechanics.supports import AXES
from pneumorph.solution.files import write_atomically
from pneumorph.units import printed_unit, to_printed

TEXT = "text"


class Measure(Protocol):
    """A number taken from a state: a name, the kind of its unit and a call."""

    @property
    def name(self) -> str:
        """Key of its column."""

    @property
    def kind(self) -> str:
        """Kind of quantity, see `pneumorph.units.KINDS`."""

    def __call__(self, state: State) -> float:
        """Return the value in inside units."""


@dataclass(frozen=True)
class Column:
    """key: how programs call it; label: how people do; kind: unit kind of the values, or 'text'."""

    key: str
    label: str
    kind: str

    @property
    def header(self) -> str:
        """Key with the printed unit, as in the first line of the CSV file: 'pressure:cavity_1 [kPa]'."""
        unit = "" if self.kind == TEXT else printed_unit(self.kind)
        return f"{self.key} [{unit}]" if unit else self.key


@dataclass(frozen=True, eq=False)
class History:
    """Rows of a run. columns: in order; rows: key -> value in inside units, nan where it is not known."""

    columns: list[Column]
    rows: list[dict[str, Any]]

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def keys(self) -> list[str]:
        """Keys of the columns."""
        return [column.key for column in self.columns]

    def column(self, key: str) -> Column:
        """Return a column; raises NameNotFoundError with the nearest key."""
        for column in self.columns:
            if column.key == key:
                return column
        raise NameNotFoundError(unknown_name("column", key, self.keys))

    def values(self, key: str) -> NDArray[Any]:
        """Return the values of a column (rows,) in inside units: float64, or str for text."""
        kind = self.column(key).kind
        return np.array([row[key] for row in self.rows], dtype=str if kind == TEXT else np.float64)

    def during(self, phase: str) -> NDArray[np.bool_]:
        """Return which rows (rows,) are states of a phase."""
        return np.asarray(self.values("phase") == phase)

    def smallest(self, prefix: str) -> float | None:
        """Return the smallest number in all columns whose keys begin with a prefix; None where there is none."""
        keys = [key for key in self.keys if key.startswith(prefix)]
        values = np.concatenate([np.empty(0), *(self.values(key) for key in keys)])
        values = values[np.isfinite(values)]
        return float(values.min()) if len(values) else None

    @property
    def kept_energy(self) -> NDArray[np.float64]:
        """What the works of the run were turned into (rows,), mJ: stored, of motion, and lost."""
        kinds = ("strain_energy", "contact_energy", "viscous_loss", "friction_loss", "kinetic_energy", "numerical_loss")
        total: NDArray[np.float64] = np.sum([self.values(key) for key in kinds if key in self.keys], axis=0)
        return total

    def write_csv(self, path: Path) -> None:
        """Write the rows in printed units, with all their digits; the file is replaced in one go."""

        def write(temporary: Path) -> None:
            with temporary.open("w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow([column.header for column in self.columns])
                for row in self.rows:
                    writer.writerow([_text(row[column.key], column.kind) for column in self.columns])

        write_atomically(path, write)


def read_csv(path: Path) -> dict[str, list[str] | NDArray[np.float64]]:
    """Return header -> values of a history file, in printed units as they stand there; text columns as lists.

    Raises StorageError where the file is missing or its lines are not of one length.
    """
    try:
        with path.open(newline="", encoding="utf-8") as file:
            header, *lines = list(csv.reader(file))
    except (OSError, ValueError) as error:
        raise StorageError(f"{path} cannot be read: {error}") from error
    if any(len(line) != len(header) for line in lines):
        raise StorageError(f"{path}: expected {len(header)} values in every line")
    result: dict[str, list[str] | NDArray[np.float64]] = {}
    for name, column in zip(header, zip(*lines, strict=True) if lines else [()] * len(header), strict=True):
        try:
            result[name] = np.array([float(text) if text else math.nan for text in column])
        except ValueError:
            result[name] = list(column)
    return result


def _text(value: Any, kind: str) -> str:
    if kind == TEXT:
        return str(value)
    number = to_printed(float(value), kind)
    if math.isnan(number):
        return ""
    return str(int(number)) if kind == "number" and number.is_integer() else repr(number)


def columns(model: Model, programme: Programme, measures: Sequence[Measure]) -> list[Column]:
    """Return the columns of a history; raises InputError for a measure whose name is taken.

    The clock stands there if a phase has a duration, energies of motion if one has inertia.
    """
    result = [Column("index", "state", "number"), Column("phase", "phase", TEXT), Column("time", "time", "number")]
    if any(phase.duration for phase in programme.phases):
        result.append(Column("clock", "time since the start", "time"))
    for cavity in model.surfaces:
        result += [
            Column(f"pressure:{cavity}", f"gauge pressure in {cavity}", "pressure"),
            Column(f"volume:{cavity}", f"volume of {cavity}", "volume"),
            Column(f"added_volume:{cavity}", f"volume added to {cavity}", "volume"),
        ]
        if isinstance(model.supplies[cavity], GasFilled):
            result += [
                Column(f"gas_mass:{cavity}", f"mass of gas in {cavity}", "mass"),
                Column(f"temperature:{cavity}", f"temperature in {cavity}", "temperature"),
            ]
        if isinstance(model.supplies[cavity], FlowSupply):
            result.append(Column(f"source:{cavity}", f"gauge pressure of the source of {cavity}", "pressure"))
    result += [Column(f"value:{n}", n, kind) for n, kind in model.kinds.items() if n not in model.surfaces]
    for name in (contact.name for contact in model.contacts):
        forces = [
            Column(f"contact_force_{a}:{name}", f"force {a} on {name}", "force") for a in AXES[: model.mesh.dimension]
        ]
        result += [
            *forces,
            Column(f"contact_area:{name}", f"contact area of {name}", "area"),
            Column(f"contact_pressure:{name}", f"largest contact pressure of {name}", "stress"),
            Column(f"contact_distance:{name}", f"smallest distance of {name}", "length"),
        ]
    axes = AXES[: model.mesh.dimension]
    for contact in model.contacts:
        if len(contact.faces) > 1:
            parts = ((face, a) for face in contact.faces for a in axes)
            result += [
                Column(f"contact_force_{a}:{contact.name}:{face}", f"force {a} of {contact.name} on {face}", "force")
                for face, a in parts
            ]
    result += [Column(f"body_force_{a}:{body}", f"force {a} on {body}", "force") for body in model.bodies for a in axes]
    for frame in model.frames:
        result += _body_columns(frame.name, axes)
    for measure in measures:
        printed_unit(measure.kind)
        result.append(Column(measure.name, measure.name.replace("_", " "), measure.kind))
    result += [
        Column("strain_energy", "strain energy", "energy"),
        Column("supply_work", "work of the supplies", "energy"),
        Column("load_work", "work of loads and moved supports", "energy"),
        Column("viscous_loss", "energy lost in viscosity", "energy"),
    ]
    if model.contacts:
        result += [
            Column("contact_energy", "energy in contact", "energy"),
            Column("friction_loss", "energy lost in friction", "energy"),
        ]
    if any(phase.inertia for phase in programme.phases):
        result += [
            Column("kinetic_energy", "kinetic energy", "energy"),
            Column("numerical_loss", "energy lost in the time integration", "energy"),
        ]
    result += [
        Column("energy_error", "relative error of the energy balance", "number"),
        Column("iterations", "Newton iterations", "number"),
        Column("unstable_modes", "unstable modes", "number"),
        Column("smallest_volume_ratio", "smallest det F", "number"),
    ]
    keys = [column.key for column in result]
    for measure in measures:
        if keys.count(measure.name) > 1:
            raise InputError(f"measure '{measure.name}': the name is taken; give the measure another one")
    return result


def row(state: State, measures: Sequence[Measure]) -> dict[str, Any]:
    """Return the row of a state: key -> value in inside units."""
    surfaces, energies, dimension = state.model.surfaces, state.energies, state.model.mesh.dimension
    result: dict[str, Any] = {"index": state.index, "phase": state.phase, "time": state.time, "clock": state.clock}
    for cavity, surface in surfaces.items():
        result[f"pressure:{cavity}"] = float(state.pressure[cavity])
        result[f"volume:{cavity}"] = float(state.volume[cavity])
        result[f"added_volume:{cavity}"] = float(state.volume[cavity] - surface.reference_volume)
        if cavity in state.gas.mass:
            result[f"gas_mass:{cavity}"] = float(state.gas.mass[cavity])
            result[f"temperature:{cavity}"] = state.temperature(cavity)
        if isinstance(surface.cavity.supply, FlowSupply):
            result[f"source:{cavity}"] = float(state.values.get(cavity, 0.0))
    result |= {f"value:{n}": float(state.values.get(n, 0.0)) for n in state.model.kinds if n not in surfaces}
    for contact in state.model.contacts:
        touch = state.touches.get(contact.name, NO_TOUCH)
        result |= _vector(f"contact_force_{{}}:{contact.name}", touch.force, dimension)
        result[f"contact_area:{contact.name}"] = touch.area
        result[f"contact_pressure:{contact.name}"] = touch.pressure
        result[f"contact_distance:{contact.name}"] = touch.distance if math.isfinite(touch.distance) else math.nan
        for face in contact.faces if len(contact.faces) > 1 else ():
            result |= _vector(f"contact_force_{{}}:{contact.name}:{face}", touch.by_face.get(face, ()), dimension)
    for body, names in state.model.bodies.items():
        forces = [state.touches.get(name, NO_TOUCH).force or (0.0,) * dimension for name in names]
        total = tuple(-sum(parts) for parts in zip(*forces, strict=True))
        result |= _vector(f"body_force_{{}}:{body}", total, dimension)
    for frame in state.model.frames:
        result |= _body_row(state, frame.name)
    result |= {measure.name: float(measure(state)) for measure in measures}
    return result | {
        "strain_energy": energies.strain,
        "supply_work": energies.supply,
        "load_work": energies.load,
        "viscous_loss": energies.viscous,
        "contact_energy": energies.contact,
        "friction_loss": energies.friction,
        "kinetic_energy": energies.kinetic,
        "numerical_loss": energies.numerical,
        "energy_error": energies.relative_error,
        "iterations": state.iterations,
        "unstable_modes": math.nan if state.unstable_modes is None else state.unstable_modes,
        "smallest_volume_ratio": state.smallest_volume_ratio,
    }


def _body_columns(name: str, axes: Sequence[str]) -> list[Column]:
    """Return the columns of a free body; turned about z alone in the plane."""
    result = [Column(f"body_{a}:{name}", f"centre {a} of {name}", "length") for a in axes]
    result += [Column(f"body_velocity_{a}:{name}", f"velocity {a} of {name}", "speed") for a in axes]
    result += [
        Column(f"body_rotation_{a}:{name}", f"rotation of {name} about {a}", "angle")
        for a in (axes if len(axes) == 3 else "z")
    ]
    result += [Column(f"body_force_{a}:{name}", f"force {a} of contacts on {name}", "force") for a in axes]
    return [*result, Column(f"body_strain:{name}", f"largest strain of {name}", "number")]


def _body_row(state: State, name: str) -> dict[str, float]:
    motion, d = state.body_motion(name), state.model.mesh.dimension
    forces = [touch.by_face[name] for touch in state.touches.values() if name in touch.by_face]
    turned = motion.rotation.tolist()
    result = _vector(f"body_{{}}:{name}", motion.centre.tolist(), d)
    result |= _vector(f"body_velocity_{{}}:{name}", motion.velocity.tolist(), d)
    result |= _vector(f"body_rotation_{{}}:{name}", turned, d) if d == 3 else {f"body_rotation_z:{name}": turned[0]}
    result |= _vector(f"body_force_{{}}:{name}", [sum(parts) for parts in zip(*forces, strict=True)], d)
    return result | {f"body_strain:{name}": motion.strain}


def _vector(key: str, values: Sequence[float], dimension: int) -> dict[str, float]:
    """Return one entry for each axis, zeros where there are no values; `key` has {} in the place of the axis."""
    return {key.format(a): value for a, value in zip(AXES, values or (0.0,) * dimension, strict=False)}
