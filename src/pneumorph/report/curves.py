"""Which curves a run gets when nobody says."""

from __future__ import annotations

import numpy as np

from pneumorph.mechanics.supports import AXES
from pneumorph.report.figures import Curve
from pneumorph.report.findings import is_part
from pneumorph.solution import Solution

_BESIDE = {"strain_energy", "supply_work", "load_work", "viscous_loss", "energy_error", "iterations"}
_BESIDE |= {"clock", "kinetic_energy", "numerical_loss", "contact_energy", "friction_loss"}
# columns of vectors, without the letter of the axis -> title of the figure that their components share
_VECTORS = {
    "body_": "Centre of", "body_rotation_": "Rotation of", "body_velocity_": "Velocity of",
    "contact_force_": "Force in contact", "body_force_": "Force on body",
}  # fmt: skip
_BESIDE |= {"unstable_modes", "smallest_volume_ratio", "index", "phase", "time"}


def driver(solution: Solution) -> str:
    """Return the column to draw curves over: the clock, else the largest pressure, driven value or the time."""
    history = solution.history
    if "clock" in history.keys:
        return "clock"
    pressures = [key for key in history.keys if key.startswith("pressure:") and np.any(history.values(key))]
    if pressures:
        return max(pressures, key=lambda key: float(np.abs(history.values(key)).max()))
    values = [key for key in history.keys if key.startswith("value:") and np.any(history.values(key))]
    return values[0] if values else "time"


def default_curves(solution: Solution) -> list[Curve]:
    """Return measures over the pressure (angles together, others alone) and the pressure over the added volume."""
    history, over = solution.history, driver(solution)
    beside = ("pressure:", "volume:", "added_volume:", "value:")
    columns = [c for c in history.columns if c.key not in _BESIDE and not c.key.startswith(beside)]
    measures = [c for c in columns if _vector(c.key) is None]
    result = []
    angles = tuple(c.key for c in measures if c.kind == "angle")
    if angles:
        result.append(
            Curve("Bending" if len(angles) > 1 else history.column(angles[0]).label.capitalize(), over, angles)
        )
    for column in measures:
        values = history.values(column.key)
        if column.kind != "angle" and np.isfinite(values).any() and np.ptp(values[np.isfinite(values)]) > 0.0:
            result.append(Curve(column.label.capitalize(), over, (column.key,)))
    for prefix, title in _VECTORS.items():
        vectors = [c for c in columns if _vector(c.key) == prefix]
        for owner in dict.fromkeys(c.key.partition(":")[2] for c in vectors):
            keys = tuple(c.key for c in vectors if c.key.partition(":")[2] == owner)
            if any(history.values(key).any() for key in keys) and not is_part(keys[0]):
                result.append(Curve(f"{title} {owner}", over, keys))
    if over == "clock":
        driven = [c for c in history.columns if c.key.startswith(("pressure:", "value:"))]
        moved = [c for c in driven if history.values(c.key).any()]
        result = [Curve(c.label.capitalize(), over, (c.key,)) for c in moved] + result
    if over.startswith("pressure:"):
        cavity = over.removeprefix("pressure:")
        result.append(Curve("Pressure and volume", f"added_volume:{cavity}", (over,)))
    return result


def _vector(key: str) -> str | None:
    """Return the prefix of a column that holds a component of a vector, such as body_force_z:cup; None for others."""
    prefix, axis = key.partition(":")[0][:-1], key.partition(":")[0][-1:]
    return prefix if prefix in _VECTORS and axis in AXES else None
