"""What was asked: the tables of dimensions, materials, supports, cavities, loads and phases of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from pneumorph.errors import InputError
from pneumorph.geometry import Actuator
from pneumorph.materials import LinearElastic, Material, Prony, library
from pneumorph.mechanics import Model, Programme, Supply, Tube
from pneumorph.mechanics.supports import Clamp, Prescribed, Symmetry
from pneumorph.report.tables import Cell, Table
from pneumorph.solution import Solution
from pneumorph.studies import study_from
from pneumorph.units import show


def asked_tables(solution: Solution) -> list[Table]:
    """Return the tables of what a run was asked; dimensions only where the run keeps its study."""
    tables = [dimensions_table(body, part) for part, body in _bodies(solution.about).items()]
    tables.append(materials_table(solution.model.materials))
    tables += _boundary_tables(solution.model)
    return [*tables, programme_table(solution.model, solution.programme)]


def dimensions_table(actuator: Actuator, part: str = "") -> Table:
    """Return the dimensions of an actuator, or of a part of the study, each given by the source or assumed."""
    rows = [
        (
            d.help, d.symbol, Cell(f"{d.value:g}" if d.kind == "count" else show(float(d.value), d.kind), number=True),
            Cell("given", "good") if d.given else Cell("assumed", "fair"),
        )
        for d in actuator.dimensions()
    ]  # fmt: skip
    name = "".join(f" {c.lower()}" if c.isupper() else c for c in type(actuator).__name__).strip()
    title = f"Dimensions of '{part}': {name}" if part else f"Dimensions: {name}"
    return Table(title, ("Dimension", "Symbol", "Value", "Source"), tuple(rows))


def materials_table(materials: Mapping[str, Material]) -> Table:
    """Return the constants of each domain's material, with the source where it is one of the library."""
    rows: list[tuple[Cell | str, ...]] = []
    for domain, material in materials.items():
        known = library.entry_of(material)
        law = f"{type(material).__name__}" + (f" ({known.name})" if known else "")
        constants = [item for item in fields(material) if item.name != "prony" or material.prony is not None]
        for number, item in enumerate(constants):
            value = getattr(material, item.name)
            if item.name == "bulk" and value is None:
                rule = "from the others" if isinstance(material, LinearElastic) else "1000 × shear modulus"
                text = f"{show(material.bulk_modulus, 'stress')} ({rule})"
            else:
                text = "not given" if value is None else _constant(value, item.metadata.get("kind", "number"))
            if known is None:
                flag: Cell | str = ""
            elif item.name in known.given:
                flag = Cell("given", "good")
            elif item.name in known.derived:
                flag = Cell("derived", "good")
            else:
                flag = Cell("assumed", "fair") if item.name in known.assumed else ""
            source = f"{known.source}. {known.note}" if known and number == 0 else ""
            rows.append((domain if number == 0 else "", law if number == 0 else "", item.name, text, flag, source))
    return Table("Materials", ("Domain", "Law", "Constant", "Value", "", "Source and note"), tuple(rows))


def _constant(value: float | tuple[float, ...] | Prony, kind: str) -> str:
    """Return a constant of a law with its unit: one number, the terms of a series, or a series of relaxations."""
    if isinstance(value, Prony):
        terms = zip(value.g, value.tau, strict=True)
        return ", ".join(f"{show(share, 'number')} in {show(time, 'time')}" for share, time in terms)
    return ", ".join(show(one, kind) for one in value) if isinstance(value, tuple) else show(float(value), kind)


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
            cavity.name, _with_numbers(cavity.supply), ", ".join(cavity.faces),
            Cell(show(model.surfaces[cavity.name].reference_volume, "volume"), number=True),
        )
        for cavity in model.cavities
    ]  # fmt: skip
    if cavities:
        result.append(Table("Cavities", ("Cavity", "Supply", "Faces", "Volume at rest"), tuple(cavities)))
    tubes = tuple((" and ".join(tube.between), _with_numbers(tube)) for tube in model.tubes)
    result += [Table("Tubes", ("Between", "Line"), tubes)] if tubes else []
    result += [_bodies_table(model)] if model.frames else []
    return [*result, _contact_table(model)] if model.contacts else result


def _bodies_table(model: Model) -> Table:
    """Return the free rigid bodies: kind of surface, mass, centre at the start."""
    rows = []
    for body, frame in zip(model.free_bodies, model.frames, strict=True):
        centre = ", ".join(f"{x:.4g}" for x in frame.rest.mean(axis=0))
        mass = Cell(f"{1e6 * frame.mass:.4g} g", number=True)
        rows.append((body.name, type(body.surface).__name__, mass, f"({centre}) mm"))
    return Table("Free bodies", ("Body", "Surface", "Mass", "Centre of mass at the start"), tuple(rows))


def _contact_table(model: Model) -> Table:
    """Return what may touch what, with the settings that were used."""
    rows: list[tuple[Cell | str, ...]] = []
    for contact, pair in zip(model.contacts, model.contact.pairs, strict=True):
        moved = f", driven as '{contact.motion.name}'" if contact.motion else ""
        numbers = (f"{contact.friction:g}", show(pair.reach, "length", 3), show(pair.stiffness, "stress", 3))
        cells = (Cell(text, number=True) for text in numbers)
        rows.append((contact.name, ", ".join(contact.faces), contact.other + moved, *cells))
    return Table("Contact", ("Contact", "Faces", "Against", "Friction", "Reach", "Stiffness"), tuple(rows))


def _with_numbers(item: Supply | Tube) -> str:
    """Return a supply or tube in words: 'flow, conductance 6 L/(min·bar), critical ratio 0.3'."""
    values = {field: getattr(item, field.name) for field in fields(item) if "kind" in field.metadata}  # type: ignore[arg-type]
    numbers = [f"{field.name.replace('_', ' ')} {show(v, field.metadata['kind'])}" for field, v in values.items()]
    return ", ".join([type(item).__name__.removesuffix("Supply").lower(), *numbers])


def _bodies(about: Mapping[str, Any]) -> Mapping[str, Actuator]:
    """Return part, '' for the actuator -> body of the study that a run keeps; none where none can be read."""
    study = about.get("study")
    if not isinstance(study, dict):
        return {}
    try:
        return study_from(study, str(about.get("name", "study"))).assembly.bodies
    except InputError:
        return {}
