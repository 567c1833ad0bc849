"""A study: the checked contents of a study file, and what it builds."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from pneumorph.errors import InputError, NameNotFoundError, StudyError, unknown_name
from pneumorph.geometry import Actuator
from pneumorph.materials import LAWS, USUAL_RANGE, Material, Prony, instabilities, library
from pneumorph.mechanics import (
    Atmosphere,
    Cavity,
    Clamp,
    Contact,
    Force,
    Gravity,
    Model,
    Motion,
    Phase,
    Prescribed,
    Programme,
    Roller,
    Settings,
    Symmetry,
    Traction,
    Tube,
)
from pneumorph.mechanics.loads import Load
from pneumorph.mechanics.supplies.checks import check_driven, check_phases, check_tubes
from pneumorph.mechanics.supports import Support
from pneumorph.mesh import Imported, Mesh, generate, inspect
from pneumorph.studies.cycles import cycle_ends, repeated
from pneumorph.studies.defaults import GRAVITY, actuator_of, completed
from pneumorph.studies.homogenised import check_homogenised, homogenised
from pneumorph.studies.measuring import Measure, measures_of
from pneumorph.studies.schema import TAGS, LibraryMaterial, PhaseSection, StudyFile
from pneumorph.studies.section import refusal
from pneumorph.studies.supplies import supply_of, tube_of
from pneumorph.studies.toml_file import read_toml
from pneumorph.studies.touching import bodies_of, contacts_of
from pneumorph.studies.writing import to_toml
from pneumorph.units import parse, show

_log = logging.getLogger(__name__)
_SUPPORTS = {"clamp": Clamp, "roller": Roller, "symmetry": Symmetry, "prescribed": Prescribed}
_LOADS: dict[str, Any] = {"force": Force, "traction": Traction}


@dataclass(frozen=True)
class Problem:
    """What a study builds: all that `solve` takes."""

    model: Model
    programme: Programme
    measures: tuple[Measure, ...]
    settings: Settings


@dataclass(frozen=True)
class Study:
    """A checked study: everything in it but the mesh is made, and refused if wrong, when the study is.

    name: short name, that of the file. file: the sections with every default filled in (see `defaults.completed`).
    Raises InputError, one of its kinds, with the section and key that is wrong.
    """

    name: str
    file: StudyFile

    def __post_init__(self) -> None:
        object.__setattr__(self, "file", completed(self.file, self.actuator))
        check_homogenised(self.actuator, self.file.mesh)
        _ = self.materials, self.supports, self.loads, self.cavities, self.measures, self.settings
        supplies = {cavity.name: cavity.supply for cavity in self.cavities}
        check_tubes(self.tubes, supplies)
        for phase in self.file.phase:
            for name in phase.targets:
                check_driven(str(phase.name), name, supplies)
        check_phases(self.programme.phases, supplies, self.tubes, self.atmosphere)
        _check_driven([name for name in self.kinds if name not in supplies], self.programme)
        if self.file.gravity is not None:
            for domain, material in self.materials.items():
                if material.density is None:
                    raise InputError(f"gravity: the material of '{domain}' has no density; give density in [material]")

    @property
    def title(self) -> str:
        """The title, or the name of the study."""
        return self.file.title or self.name

    @cached_property
    def actuator(self) -> Actuator:
        """The actuator with its dimensions."""
        return actuator_of(self.file)

    @cached_property
    def materials(self) -> dict[str, Material]:
        """Domain -> material."""
        return {domain: _material(section) for domain, section in self.file.material.items()}

    @cached_property
    def supports(self) -> tuple[Support, ...]:
        """Clamps, rollers, symmetry planes and prescribed displacements."""
        return tuple(_SUPPORTS[item.type](**_fields(item, "type")) for item in self.file.support or ())

    @cached_property
    def loads(self) -> tuple[Load, ...]:
        """Forces, tractions and gravity."""
        loads: list[Load] = [_LOADS[item.type](**_fields(item, "type")) for item in self.file.load]
        if self.file.gravity is not None:
            loads.append(Gravity(self.file.gravity.direction or (), GRAVITY))
        for load in loads:
            if len(load.direction) != 3 or not any(load.direction):
                raise StudyError(f"load '{load.name}': direction = {load.direction}: expected 3 numbers, not all zero")
            if self.actuator.space != "3d" and load.direction[2]:
                raise StudyError(f"load '{load.name}': direction = {load.direction} leaves the plane of the model")
        if self.actuator.space != "3d":
            loads = [replace(load, direction=load.direction[:2]) for load in loads]
        return tuple(loads)

    @cached_property
    def cavities(self) -> tuple[Cavity, ...]:
        """The cavities with their supplies."""
        return tuple(
            Cavity(item.name, item.faces or (), supply_of(item.supply, item.name), item.mirrors or ())
            for item in self.file.cavity or ()
        )

    @cached_property
    def tubes(self) -> tuple[Tube, ...]:
        """Tubes between cavities."""
        return tuple(tube_of(item, number) for number, item in enumerate(self.file.tube, 1))

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """What may touch what."""
        return contacts_of(self.file.contact, bodies_of(self.file.body, 3 if self.actuator.space == "3d" else 2))

    @cached_property
    def atmosphere(self) -> Atmosphere:
        """What is outside."""
        return Atmosphere(**_fields(self.file.atmosphere))

    @cached_property
    def kinds(self) -> dict[str, str]:
        """Name -> unit kind of all that the phases can drive; raises InputError for a name given twice."""
        kinds: dict[str, str] = {}
        moved = [support for support in self.supports if isinstance(support, Prescribed)]
        pairs = [(item.name, item.supply.kind) for item in self.cavities if item.supply.kind is not None]
        motions = {contact.motion.name: Motion.kind for contact in self.contacts if contact.motion}
        for name, kind in [*pairs, *((item.name, item.kind) for item in (*self.loads, *moved)), *motions.items()]:
            if name in kinds:
                raise InputError(f"the name '{name}' is given to more than one cavity, load, displacement or body")
            kinds[name] = kind
        names = [contact.name for contact in self.contacts]
        for name in names:
            if names.count(name) > 1 or name in kinds:
                raise InputError(f"contact '{name}': the name is taken; give the contact another one")
        return kinds

    @cached_property
    def programme(self) -> Programme:
        """The phases with values in inside units."""
        phases, values = [], dict.fromkeys(self.kinds, 0.0)
        for section in repeated(self.file.phase, self.file.cycle):
            phases.append(_phase(section, self.kinds, values))
            values |= phases[-1].targets
        return Programme(tuple(phases))

    @property
    def cycle_ends(self) -> tuple[int, ...]:
        """Times, in phases, at which the first cycle starts and each ends; () where nothing repeats."""
        return cycle_ends(self.file.phase, self.file.cycle)

    @cached_property
    def settings(self) -> Settings:
        """Settings of the solver."""
        return Settings(**_fields(self.file.solver))

    @cached_property
    def measures(self) -> tuple[Measure, ...]:
        """What is measured in every state; by default all that the actuator's faces allow."""
        return measures_of(self.file.measures, self.actuator)

    def mesh(self) -> Mesh:
        """Return the mesh; what its quality check warns of goes to the log. Raises MeshError."""
        if isinstance(self.actuator, Imported):
            for note in self.actuator.notes:
                _log.warning("%s", note)
        section = self.file.mesh
        size = section.size if isinstance(section.size, float) else None
        mesh = generate(
            self.actuator,
            size,
            coarse=section.size == "coarse",
            grading=section.grading,
            detail=section.detail,
            wall_size=section.wall_size,
        )
        for warning in inspect(mesh).warnings:
            _log.warning("mesh: %s", warning)
        return mesh

    def build(self) -> Problem:
        """Return model, programme, measures and settings; meshes. Raises MeshError, LeakingCavityError."""
        for domain, material in self.materials.items():
            for instability in instabilities(material, *USUAL_RANGE):
                _log.warning("material of '%s': %s", domain, instability)
        if self.file.mesh.homogenised:
            mesh, materials = homogenised(self.actuator, self.file.mesh, self.materials)
        else:
            mesh, materials = self.mesh(), self.materials
        model = Model(
            mesh, materials, self.supports, self.loads, self.cavities,
            tubes=self.tubes, atmosphere=self.atmosphere, contacts=self.contacts,
        )  # fmt: skip
        return Problem(model, self.programme, self.measures, self.settings)

    def resolved(self) -> dict[str, Any]:
        """Return the study as plain data with every default written out, quantities as text with units."""
        data = self.file.model_dump(exclude_none=True)
        data["phase"] = [{key: value for key, value in item.items() if value != {}} for item in data["phase"]]
        for key in ("load", "tube", "body", "contact"):
            if not data[key]:
                del data[key]
        return data | {"title": self.title, "measures": [measure.name for measure in self.measures]}

    def resolved_text(self) -> str:
        """Return the same as the text of a study file that makes an equal study."""
        return to_toml(self.resolved())


def load_study(path: Path | str) -> Study:
    """Return the study in a TOML file.

    Raises StudyError for a file that is missing, not readable or not TOML, and for unknown keys, missing entries and
    wrong types; UnitError, GeometryError, NameNotFoundError and other InputErrors for values that are refused.
    """
    path = Path(path)
    table = read_toml(path, "study file")
    try:
        return study_from(table, path.stem, path.parent)
    except InputError as error:
        raise type(error)(f"{path}: {error}") from error


def study_from(table: Mapping[str, Any], name: str, folder: Path | None = None) -> Study:
    """Return the study with the contents of a study file as plain data (quantities as text with units).

    folder: where files that the study names are sought; None: where the program runs.
    """
    try:
        file = StudyFile.model_validate(table, context={"quantities": "text", "folder": folder or Path()})
    except ValidationError as error:
        raise refusal(error, TAGS) from None
    return Study(name, file)


def _fields(section: Any, *but: str) -> dict[str, Any]:
    return {name: getattr(section, name) for name in type(section).model_fields if name not in but}


def _material(section: Any) -> Material:
    constants = _fields(section, "law", "name", "prony")
    if section.prony is not None:
        constants["prony"] = Prony(**_fields(section.prony))
    if not isinstance(section, LibraryMaterial):
        return LAWS[section.law](**constants)
    changes = {name: value for name, value in constants.items() if value is not None}
    found = library.material(section.name)
    return replace(found, **changes) if changes else found


def _phase(section: PhaseSection, kinds: Mapping[str, str], start: Mapping[str, float]) -> Phase:
    """Return a phase; `start` is where the targets stand before it."""
    owner = f"phase '{section.name}'"

    def value(name: str, text: str, what: str) -> float:
        if name not in kinds:
            raise NameNotFoundError(f"{owner}: " + unknown_name("target", name, kinds))
        return parse(text, kinds[name], f"{owner}: {what}.{name}")

    targets = {name: value(name, text, "targets") for name, text in section.targets.items()}
    marks = set()
    for name, texts in section.states_at.items():
        for text in texts:
            wanted = value(name, text, "states_at")
            if name not in targets:
                raise StudyError(f"{owner}: states_at.{name}: expected one of its targets, {', '.join(targets)}")
            first, last = start[name], targets[name]
            fraction = (wanted - first) / (last - first) if last != first else -1.0
            if not 0.0 < fraction <= 1.0:
                limits = f"after {show(first, kinds[name])}, up to {show(last, kinds[name])}"
                raise StudyError(f"{owner}: states_at.{name} = '{text}': expected a value of the phase, {limits}")
            marks.add(fraction)
    return Phase(
        str(section.name),
        targets,
        tuple(sorted(marks - {1.0})),
        section.first_increment,
        section.largest_increment,
        section.smallest_increment,
        section.duration,
        section.inertia,
    )


def _check_driven(names: Iterable[str], programme: Programme) -> None:
    driven = {name for phase in programme.phases for name in phase.targets}
    for name in names:
        if name not in driven:
            raise StudyError(f"'{name}' is in the study, but no phase drives it")
