"""What was asked: the tables of dimensions, materials, supports, cavities, loads and phases of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from pneumorph.errors import InputError
from pneumorph.geometry import Actuator
from pneumorph.materials import Material, library
from pneumorph.mechanics import Model, Programme
from pneumorph.mechanics.supports import Clamp, Prescribed, Symmetry
from pneumorph.report.tables import Cell, Table
from pneumorph.solution import Solution
from pneumorph.studies import study_from
from pneumorph.units import show


def asked_tables(solution: Solution) -> list[Table]:
    """Return the tables of what a run was asked; dimensions only where the run keeps its study."""
    actuator = _actuator(solution.about)
    tables = [dimensions_table(actuator)] if actuator is not None else []
    tables.append(materials_table(solution.model.materials))
    tables += _boundary_tables(solution.model)
    return [*tables, programme_table(solution.model, solution.programme)]


def dimensions_table(actuator: Actuator) -> Table:
    """Return the dimensions of an actuator, each given by the source or assumed."""
    rows = [
        (
            d.help, d.symbol, Cell(f"{d.value:g}" if d.kind == "count" else show(float(d.value), d.kind), number=True),
            Cell("given", "good") if d.given else Cell("assumed", "fair"),
        )
        for d in actuator.dimensions()
    ]  # fmt: skip
    name = "".join(f" {c.lower()}" if c.isupper() else c for c in type(actuator).__name__).strip()
    return Table(f"Dimensions: {name}", ("Dimension", "Symbol", "Value", "Source"), tuple(rows))


def materials_table(materials: Mapping[str, Material]) -> Table:
    """Return the constants of each domain's material, with the source where it is one of the library."""
    rows: list[tuple[Cell | str, ...]] = []
    for domain, material in materials.items():
        known = next((e for e in map(library.entry, library.names()) if e.material == material), None)
        law = f"{type(material).__name__}" + (f" ({known.name})" if known else "")
        for number, item in enumerate(fields(material)):
            value = getattr(material, item.name)
            kind = item.metadata.get("kind", "number")
            if item.name == "bulk" and value is None:
                text = f"{show(material.bulk_modulus, kind)} (1000 × shear modulus)"
            else:
                text = "not given" if value is None else show(float(value), kind)
            if known is None:
                flag: Cell | str = ""
            elif item.name in known.given:
                flag = Cell("given", "good")
            else:
                flag = Cell("assumed", "fair") if item.name in known.assumed else ""
            source = f"{known.source}. {known.note}" if known and number == 0 else ""
            rows.append((domain if number == 0 else "", law if number == 0 else "", item.name, text, flag, source))
    return Table("Materials", ("Domain", "Law", "Constant", "Value", "", "Source and note"), tuple(rows))


def programme_table(model: Model, programme: Programme) -> Table:
    """Return the phases with what they drive to which value."""
    rows = []
    for phase in programme.phases:
        marks = ", ".join(f"{100.0 * mark:.4g} %" for mark in phase.marks)
        for number, (name, value) in enumerate(phase.targets.items()):
            end = Cell(show(value, model.kinds[name]), number=True)
            rows.append((phase.name if number == 0 else "", name, end, marks if number == 0 else ""))
    return Table("Programme", ("Phase", "Drives", "To", "States asked for at"), tuple(rows))


def _boundary_tables(model: Model) -> list[Table]:
    supports: list[tuple[Cell | str, ...]] = []
    for support in model.supports:
        if isinstance(support, Clamp):
            text = "no displacement"
        elif isinstance(support, Symmetry):
            text = "mirror plane: no displacement across it"
        elif isinstance(support, Prescribed):
            text = f"displacement along {support.axis} driven as '{support.name}'"
        else:
            text = f"no displacement along {support.axis}"
        supports.append((type(support).__name__.lower(), support.face, text))
    for load in model.loads:
        direction = ", ".join(f"{c:g}" for c in load.direction)
        face = getattr(load, "face", "all cells")
        supports.append((type(load).__name__.lower(), face, f"along ({direction}), driven as '{load.name}'"))
    result = [Table("Supports and loads", ("Type", "Face", "Meaning"), tuple(supports))] if supports else []
    cavities = [
        (
            cavity.name, type(cavity.supply).__name__.removesuffix("Supply").lower(), ", ".join(cavity.faces),
            Cell(show(model.surfaces[cavity.name].reference_volume, "volume"), number=True),
        )
        for cavity in model.cavities
    ]  # fmt: skip
    if cavities:
        result.append(Table("Cavities", ("Cavity", "Supply sets", "Faces", "Volume at rest"), tuple(cavities)))
    return result


def _actuator(about: Mapping[str, Any]) -> Actuator | None:
    """Return the actuator of the study that a run keeps, None where there is none that can be read."""
    study = about.get("study")
    if not isinstance(study, dict):
        return None
    try:
        return study_from(study, str(about.get("name", "study"))).actuator
    except InputError:
        return None
