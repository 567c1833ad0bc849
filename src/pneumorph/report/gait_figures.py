"""Gaits in a report: the schedule, forces of the feet and centre of mass, and a table of the cycles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pneumorph.errors import InputError
from pneumorph.gaits import Foot, Locomotion, locomotion
from pneumorph.mechanics import Pipe, Programme
from pneumorph.report import style
from pneumorph.report.figures import Curve, named, new_figure, printed, styled, svg
from pneumorph.report.tables import Cell, Table
from pneumorph.solution import Solution
from pneumorph.units import show

_MOST_NAMES = 24  # phases whose names are written out


def cycle_ends(solution: Solution) -> tuple[int, ...]:
    """Return the times, in phases, between the cycles of a run whose study has a [cycle]; () of any other."""
    study = solution.about.get("study")
    cycle: Any = study.get("cycle") if isinstance(study, dict) else None
    if not cycle:
        return ()
    count, repeat = len(cycle["phases"]), int(cycle["repeat"])
    first = len(solution.programme.phases) - count * repeat
    return tuple(first + number * count for number in range(repeat + 1))


@styled
def schedule_figure(programme: Programme, cavities: Sequence[str], kind: str = "pressure") -> bytes:
    """Return the target of each cavity through the programme as SVG, over the clock or, without one, the phases.

    kind: of the unit of the targets. Raises InputError for a cavity that no phase drives.
    """
    driven = {name for phase in programme.phases for name in phase.targets}
    for name in cavities:
        if name not in driven:
            raise InputError(f"schedule: no phase drives '{name}'; driven: {', '.join(sorted(driven))}")
    times = np.arange(len(programme.phases) + 1)
    timed = any(phase.duration for phase in programme.phases)
    places = np.array([programme.clock(float(t)) for t in times]) if timed else times.astype(float)
    figure, rows = new_figure("Schedule", *[1.0] * len(cavities))
    for number, (axes, cavity) in enumerate(zip(rows, cavities, strict=True)):
        values = np.array([programme.values(float(time)).get(cavity, 0.0) for time in times])
        colour = style.LINES[number % len(style.LINES)]
        axes.plot(places, printed(values, kind), color=colour)
        axes.fill_between(places, printed(values, kind), color=colour, alpha=0.15, linewidth=0.0)
        axes.set_ylabel(named(cavity, kind).replace(" [", "\n["), rotation=0, ha="right", va="center")
        for place in places[1:-1]:
            axes.axvline(place, color=style.GRID, linewidth=0.8)
    if len(programme.phases) <= _MOST_NAMES:
        top = rows[0].secondary_xaxis("top")
        names = [phase.name for phase in programme.phases]
        top.set_xticks(0.5 * (places[1:] + places[:-1]), names, rotation=90 if len(names) > 8 else 0, fontsize=7)
        top.tick_params(length=0.0)
    rows[-1].set_xlabel("time [s]" if timed else "time of the programme [phases]")
    return svg(figure)


def gait_curves(solution: Solution) -> list[Curve]:
    """Return the figures of a gait: forces of each contact's faces against gravity, and the centre of mass."""
    keys = solution.history.keys
    over = "clock" if "clock" in keys else "time"
    axis = "xyz"[solution.model.mesh.dimension - 1]
    result = []
    for contact in solution.model.contacts:
        columns = tuple(f"contact_force_{axis}:{contact.name}:{face}" for face in contact.faces)
        if contact.body and all(column in keys for column in columns):
            result.append(Curve(f"Forces of {contact.name}", over, columns))
    centre = [key for key in keys if key.startswith("centre_of_mass_")]
    return result + [Curve(solution.history.column(key).label.capitalize(), over, (key,)) for key in centre]


def gait_table(solution: Solution) -> Table | None:
    """Return displacement, slip and cost of transport of each finished cycle; None where there is no gait.

    Forward is along x, in a pipe along its axis.
    A gait is a run whose study has a [cycle], with gravity, over a body that faces touch with friction.
    """
    ends = cycle_ends(solution)
    feet = [Foot(face, c.name) for c in solution.model.contacts if c.body and c.friction for face in c.faces]
    if not ends or not feet or "gravity" not in {load.name for load in solution.model.loads}:
        return None
    forward = (1.0, *(0.0,) * (solution.model.mesh.dimension - 1))
    for contact in solution.model.contacts:
        if isinstance(contact.against, Pipe) and contact.against.axis:
            forward = contact.against.axis
    return _table(locomotion(solution.states, ends, feet, forward))


def _table(found: Locomotion) -> Table | None:
    if not len(found.displacements):
        return None
    head = ["Cycle", *(f"Displacement {axis}" for axis in "xyz"[: found.centre.shape[1]])]
    for foot in found.slip:
        head += [f"{foot}: slip forward", "backward"]
    forward, backward, cost = found.forward_slip, found.backward_slip, found.cost_of_transport
    rows: list[tuple[Cell | str, ...]] = []
    for number, moved in enumerate(found.displacements):
        ways = [float(way) for way in moved]
        for foot in found.slip:
            ways += [float(forward[foot][number]), float(backward[foot][number])]
        cells = [Cell(show(way, "length", 3), number=True) for way in ways]
        cells.append(Cell(f"{cost[number]:.3g}" if np.isfinite(cost[number]) else "–", number=True))
        rows.append((str(number + 1), *cells))
    note = (
        "Displacement of the centre of mass. Slip: mean way of a foot, weighted by its normal forces. Cost of "
        "transport: work that the supplies deliver over weight and forward way; what a cavity gives back as it empties "
        "is not counted as gain."
    )
    return Table("Cycles of the gait", (*head, "Cost of transport"), tuple(rows), note)
