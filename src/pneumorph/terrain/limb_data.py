"""What a reduced limb is fitted to: shapes of a bending limb at several pressures and tip forces, and their file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, StorageError

Array = NDArray[np.float64]

KIND = "pneumorph limb data"
FORMAT = 1
SHIPPED = Path(__file__).with_name("soft_limb.json")


@dataclass(frozen=True, eq=False)
class LimbData:
    """Shapes of a limb that bends in a plane, in m cases; lengths in mm, angles in rad, forces in N, MPa.

    Everything lies in the limb's own axes: the clamp at the origin, x along the limb there, and angles counted from x
    to y. Stations cut a line along the limb into n parts that bend; station 0 is the clamp, station n the end.

    stations:   (n + 1, 2), places in the unloaded shape. hinges: (n, 2), the middle of where each part bends.
    load_point: (2,), where the tip force acts in the unloaded shape; it goes with the last station.
    pressures:  (m,), gauge, in the cavity.
    forces:     (m, 2), the tip force, which keeps its direction.
    rotations:  (m, n + 1), of the sections at the stations against the unloaded shape.
    points:     (m, n + 1, 2), where the stations are; load_points: (m, 2), where the load point is.
    held_out:   (m,), cases that test the fit and are not used by it.
    thickness:  of the limb across the line, as (below, above): towards -y and +y at the clamp. width: out of the plane.
    foot:       radius of the rounded foot that touches the ground at the load point; 0 for none.
    mount:      (x, y, angle) of the limb's axes in the wheel's, whose origin is the axle; of the first limb.
    provenance: how the data came about: command, inputs and their hash, versions.

    Raises InputError where shapes do not fit together, a number is not finite, or there are fewer than 2 parts.
    """

    stations: Array
    hinges: Array
    load_point: Array
    pressures: Array
    forces: Array
    rotations: Array
    points: Array
    load_points: Array
    held_out: NDArray[np.bool_]
    thickness: tuple[float, float]
    width: float
    foot: float
    mount: tuple[float, float, float]
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in _ARRAYS:
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=float))
        object.__setattr__(self, "held_out", np.asarray(self.held_out, dtype=bool))
        for name in ("thickness", "mount"):
            object.__setattr__(self, name, tuple(float(value) for value in getattr(self, name)))
        if self.stations.ndim != 2 or len(self.stations) < 3:
            raise InputError(
                f"limb data: stations of shape {self.stations.shape}, expected 3 or more, two numbers each"
            )
        stations, cases = len(self.stations), self.pressures.size
        expected = {
            "stations": (stations, 2), "hinges": (stations - 1, 2), "load_point": (2,), "pressures": (cases,),
            "forces": (cases, 2), "rotations": (cases, stations), "points": (cases, stations, 2),
            "load_points": (cases, 2), "held_out": (cases,),
        }  # fmt: skip
        for name, shape in expected.items():
            values = getattr(self, name)
            if values.shape != shape:
                raise InputError(f"limb data: {name} has the shape {values.shape}, expected {shape}")
            if not np.isfinite(values).all():
                raise InputError(f"limb data: {name} has a number that is not finite")
        if len(self.thickness) != 2 or min(*self.thickness, self.width) < 0.0 or sum(self.thickness) * self.width <= 0:
            raise InputError(
                f"limb data: thickness = {self.thickness}, width = {self.width:g}, expected two numbers of at least 0 "
                "and of a sum above 0, and more than 0"
            )
        if not 0.0 <= self.foot < float("inf"):
            raise InputError(f"limb data: foot = {self.foot}, expected at least 0")
        if len(self.mount) != 3:
            raise InputError(f"limb data: mount has {len(self.mount)} numbers, expected x, y and angle")

    @property
    def parts(self) -> int:
        """Number n of parts, and so of hinges."""
        return len(self.stations) - 1

    @property
    def angles(self) -> Array:
        """(m, n), the turn of each part, from its first station to its last."""
        return np.diff(self.rotations, axis=1)

    @property
    def links(self) -> Array:
        """(n + 1, 2), from the clamp to the first hinge, from hinge to hinge, from the last one to the load point."""
        return np.diff(np.vstack([np.zeros(2), self.hinges, self.load_point]), axis=0)

    def chosen(self, cases: NDArray[np.bool_]) -> LimbData:
        """Return the data of some cases only; cases: (m,)."""
        names = ("pressures", "forces", "rotations", "points", "load_points", "held_out")
        return replace(self, **{name: getattr(self, name)[cases] for name in names})

    def text(self) -> str:
        """Return the content of the file that `read_limb_data` reads; numbers to 1e-6."""
        values: dict[str, Any] = {"kind": KIND, "format": FORMAT, "provenance": dict(self.provenance)}
        for name in _ARRAYS:
            # + 0.0 turns -0.0 into 0.0
            values[name] = (np.round(getattr(self, name), 6) + 0.0).tolist()
        values["held_out"] = self.held_out.tolist()
        values |= {name: list(getattr(self, name)) for name in ("thickness", "mount")}
        values |= {"width": self.width, "foot": self.foot}
        lines = [f" {json.dumps(key)}: {json.dumps(value)}" for key, value in values.items()]
        return "{\n" + ",\n".join(lines) + "\n}\n"


_ARRAYS = ("stations", "hinges", "load_point", "pressures", "forces", "rotations", "points", "load_points")


def read_limb_data(path: Path | str = SHIPPED) -> LimbData:
    """Return the limb data of a file; without a path that of the default limb, which comes with the package.

    Raises StorageError for a file that cannot be read, InputError for one of another kind or with wrong numbers.
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise StorageError(f"limb data '{path}' cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise InputError(f"'{path}' is no limb data: {error}") from error
    if not isinstance(content, dict) or content.get("kind") != KIND:
        raise InputError(f'\'{path}\' is no limb data: expected a JSON file with "kind": "{KIND}"')
    if content.get("format") != FORMAT:
        raise InputError(f"'{path}' has the format {content.get('format')}, this version reads {FORMAT}")
    names = (*_ARRAYS, "held_out", "thickness", "width", "foot", "mount", "provenance")
    missing = [name for name in names if name not in content]
    if missing:
        raise InputError(f"'{path}' is damaged: no {', '.join(missing)}")
    try:
        return LimbData(**{name: content[name] for name in names})
    except (TypeError, ValueError) as error:
        text = str(error)
        raise InputError(f"'{path}' is damaged: {text.removeprefix('limb data: ')}") from error
