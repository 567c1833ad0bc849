"""What a run found: results at the marks, largest stresses, checks with a verdict, versions."""

from __future__ import annotations

import numpy as np

from pneumorph.materials import USUAL_RANGE, instabilities
from pneumorph.measures import LargestStress, MeanStress
from pneumorph.mechanics import State
from pneumorph.mesh import Quality
from pneumorph.report.tables import Cell, Table
from pneumorph.solution import Column, Solution, Status
from pneumorph.units import printed_unit, show, to_printed

_BALANCE = 0.02  # relative error of the energy balance that passes
_RIGID = 1e-4  # strain of a free rigid body that passes
_LOSS = 0.01  # share of the work that regularisation may take
_PLAIN = ("index", "phase", "time", "strain_energy", "supply_work", "load_work", "viscous_loss", "energy_error")
_SOLVER = ("iterations", "unstable_modes", "smallest_volume_ratio")
_INSIDE = (*_PLAIN, "kinetic_energy", "numerical_loss", "contact_energy", "friction_loss", *_SOLVER)


def marked_rows(solution: Solution) -> list[int]:
    """Return the rows of the history at marks and ends of phases, and the last one."""
    wanted = [n + mark for n, phase in enumerate(solution.programme.phases) for mark in (*phase.marks, 1.0)]
    time = solution.history.values("time")
    rows = {int(np.argmin(np.abs(time - w))) for w in wanted if np.abs(time - w).min(initial=np.inf) < 1e-9}
    return sorted(rows | {len(time) - 1})


def results_table(solution: Solution, rows: list[int], title: str) -> Table:
    """Return pressures, driven values and measures of some rows of the history."""
    history = solution.history
    columns = [history.column("index"), history.column("phase"), *_shown(solution)]
    body = [tuple(_cell(history.rows[row][column.key], column) for column in columns) for row in rows]
    head = tuple(_head(column) for column in columns)
    return Table(title, head, tuple(body))


def stress_table(state: State) -> Table:
    """Return largest and mean stresses and stretch of a state, with the place of the largest."""
    rows = []
    for label, name in (
        ("Von Mises stress", "von_mises"), ("Largest principal stress", "largest_principal_stress"),
        ("Largest principal stretch", "largest_stretch"),
    ):  # fmt: skip
        largest = LargestStress(name)
        value, where = largest.place(state)
        place = ", ".join(f"{x:.1f}" for x in where)
        mean = show(MeanStress(name)(state), largest.kind, 3)
        rows.append((label, Cell(show(value, largest.kind, 3), number=True), f"({place}) mm", Cell(mean, number=True)))
    note = (
        "Cauchy stress, at the quadrature points; places in the undeformed body. At the edge of a clamp or in a sharp "
        "corner the exact value is infinite, so the largest one grows as the mesh is refined. The pictures show values "
        "averaged at the nodes, the largest of which is lower."
    )
    return Table(
        f"Largest stress and stretch in state {state.index}", ("Quantity", "Largest", "At", "Mean"), tuple(rows), note
    )


def checks_table(solution: Solution, quality: Quality) -> Table:
    """Return the checks of a run with their verdicts."""
    history = solution.history
    work = history.values("supply_work") + history.values("load_work")
    kept = history.kept_energy
    largest = max(np.abs(work).max(initial=0.0), np.abs(kept).max(initial=0.0), 1e-300)
    balance = float(np.abs(work - kept).max(initial=0.0) / largest)
    loss = float(history.values("viscous_loss").max(initial=0.0) / largest)
    # only of states in static equilibrium is stability known
    moving = {phase.name for phase in solution.programme.phases if phase.inertia}
    still = ~np.isin(history.values("phase"), list(moving))
    unstable = history.values("index")[np.nan_to_num(history.values("unstable_modes")) > 0].astype(int)
    known = not np.isnan(history.values("unstable_modes")[still]).any()
    ratio = float(history.values("smallest_volume_ratio").min(initial=1.0))
    reached = float(history.values("time")[-1]) if len(history) else 0.0
    phases, jacobian = len(solution.programme.phases), quality.smallest_jacobian
    counted = f"{int(still.sum())} states" + (" without inertia" if moving else "")
    stability = f"none in {counted}" if known else "the linear solver cannot tell"
    if len(unstable):
        stability = f"in {len(unstable)} of {len(history)} states: {_ranges(unstable.tolist())}"
    least, most = USUAL_RANGE
    stretches = f"stretches {least:g} to {most:g}"
    softening = "; ".join(
        f"{domain}: {instability}"
        for domain, material in solution.model.materials.items()
        for instability in instabilities(material, least, most)
    )
    viscous = any(material.prony is not None for material in solution.model.materials.values())
    limit = "no limit: the material is viscous" if viscous else f"at most {_LOSS:.0%}"
    rows = [
        ("Programme", f"{reached:.4g} of {phases} phases", "to the end", solution.status is Status.DONE),
        ("Energy: work against stored and lost", f"{balance:.2%}", f"at most {_BALANCE:.0%}", balance <= _BALANCE),
        ("Energy lost in viscosity", f"{loss:.2%} of the work", limit, viscous or loss <= _LOSS),
        ("Unstable modes", stability, "none", known and not len(unstable)),
        ("Smallest det F", f"{ratio:.3f}", "more than 0", ratio > 0.0),
        *_contact_rows(solution),
        ("Smallest Jacobian ratio of the mesh", f"{jacobian:.3f}", "more than 0", jacobian > 0.0),
        ("Stability of the materials (Drucker)", softening or "stable", stretches, not softening),
        ("Warnings of the mesh", str(len(quality.warnings) or "none"), "none", not quality.warnings),
    ]  # fmt: skip
    body = tuple(
        (what, found, wanted, Cell("pass", "good") if good else Cell("warn", "fair"))
        for what, found, wanted, good in rows
    )
    return Table("", ("Check", "Found", "Wanted", "Verdict"), body)


def _contact_rows(solution: Solution) -> list[tuple[str, str, str, bool]]:
    """Return the smallest distance of surfaces that may touch, in a run with contact."""
    if not solution.model.contacts:
        return []
    least = solution.history.smallest("contact_distance:")
    text = "none within reach" if least is None else show(least, "length", 3)
    rows = [("Smallest distance in contact", text, "more than 0", least is None or least > 0.0)]
    for name in (frame.name for frame in solution.model.frames):
        strain = float(solution.history.values(f"body_strain:{name}").max())
        rows.append((f"Strain of the rigid body {name}", f"{strain:.1e}", f"at most {_RIGID:.0e}", strain <= _RIGID))
    return rows


def mesh_table(solution: Solution, quality: Quality) -> Table:
    """Return counts and quality of the mesh."""
    mesh = solution.model.mesh
    kinds = ", ".join(dict.fromkeys(block.kind for block in mesh.blocks))
    rows = [
        ("Cells", f"{quality.cells:,} ({kinds})"), ("Nodes", f"{quality.nodes:,}"),
        ("Unknowns", f"{quality.unknowns:,}"), ("Space", mesh.space.replace("_", " ")),
        ("Volume of the solid", show(quality.volume, "volume")),
        ("Smallest edge", show(quality.smallest_edge, "length", 3)),
        ("Median edge", show(quality.median_edge, "length", 3)),
        ("Smallest Jacobian ratio", f"{quality.smallest_jacobian:.3f}"),
        ("Worst aspect ratio", f"{quality.worst_aspect:.2f}"),
    ]  # fmt: skip
    for name, across in quality.elements_across.items():
        thick = show(mesh.bending_walls[name], "length")
        rows.append((f"Elements across {name} ({thick})", "wall not found" if np.isnan(across) else f"{across:.2f}"))
    return Table("", ("", ""), tuple((what, Cell(text, number=True)) for what, text in rows))


def versions_table(solution: Solution, drawn_with: dict[str, str]) -> Table:
    """Return what the run was computed and drawn with."""
    meta = solution.meta
    rows = [
        ("Wall time", f"{meta['wall_time']:.1f} s" if "wall_time" in meta else ""),
        ("Newton iterations", str(meta.get("iterations", ""))), ("Threads", str(meta.get("threads", ""))),
        ("Linear solver", str(meta.get("linear_solver", ""))), ("Platform", str(meta.get("platform", ""))),
    ]  # fmt: skip
    rows += [(name, str(version)) for name, version in {**meta.get("versions", {}), **drawn_with}.items()]
    return Table("", ("", ""), tuple(row for row in rows if row[1]))


def _shown(solution: Solution) -> list[Column]:
    """Return the columns that a reader looks for: pressures, driven values, measures, added volumes, stability.

    Cavities that stay without pressure are left out; those that always have the same one share a column.
    """
    history = solution.history
    groups: list[list[str]] = []
    for cavity in solution.model.surfaces:
        pressure = history.values(f"pressure:{cavity}")
        alike = [g for g in groups if np.array_equal(history.values(f"pressure:{g[0]}"), pressure)]
        if alike:
            alike[0].append(cavity)
        elif pressure.any():
            groups.append([cavity])
    result = [Column(f"pressure:{g[0]}", f"gauge pressure in {', '.join(g)}", "pressure") for g in groups]
    beside = ("pressure:", "volume:", "added_volume:", "body_velocity_", "body_rotation_", "body_strain:")
    result += [c for c in history.columns if not (c.key in _INSIDE or c.key.startswith(beside) or is_part(c.key))]
    result += [history.column(f"added_volume:{cavity}") for g in groups for cavity in g]
    return [*result, history.column("unstable_modes")]


def is_part(key: str) -> bool:
    """Return whether a column is a part of another one: the force of a contact on one of its faces."""
    return key.startswith("contact_force_") and key.count(":") == 2


def _head(column: Column) -> str:
    unit = "" if column.kind == "text" else printed_unit(column.kind)
    return f"{column.label} [{unit}]" if unit else column.label


def _cell(value: object, column: Column) -> Cell | str:
    if column.kind == "text":
        return str(value)
    number = to_printed(float(value), column.kind)  # type: ignore[arg-type]
    return Cell("–" if np.isnan(number) else f"{number:.4g}", number=True)


def _ranges(numbers: list[int]) -> str:
    """Return whole numbers as text: 1, 3-5."""
    parts: list[list[int]] = []
    for n in numbers:
        if parts and n == parts[-1][-1] + 1:
            parts[-1].append(n)
        else:
            parts.append([n])
    return ", ".join(f"{p[0]}" if len(p) == 1 else f"{p[0]}–{p[-1]}" for p in parts)
