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
    FreeBody,
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
from pneumorph.mechanics.contact.obstacles import Obstacle
from pneumorph.mechanics.loads import Load
from pneumorph.mechanics.supplies.checks import check_driven, check_phases, check_tubes
from pneumorph.mechanics.supports import Support
from pneumorph.mesh import Mesh
from pneumorph.mesh.assembly import Placement, name_of
from pneumorph.studies.cycles import cycle_ends, repeated
from pneumorph.studies.defaults import GRAVITY, assembly_of, completed
from pneumorph.studies.homogenised import check_homogenised, homogenised
from pneumorph.studies.measuring import Measure, measures_of
from pneumorph.studies.parts import Assembly, check_held, meshed, put_together
from pneumorph.studies.placing import placement_of
from pneumorph.studies.schema import TAGS, LibraryMaterial, PhaseSection, StudyFile
from pneumorph.studies.section import refusal
from pneumorph.studies.supplies import supply_of, tube_of
from pneumorph.studies.toml_file import read_toml
from pneumorph.studies.touching import bodies_of, check_free, contacts_of
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
        object.__setattr__(self, "file", completed(self.file, self.assembly))
        check_homogenised(self.actuator, self.file.mesh)
        check_held(self.assembly, self.file)
        _ = self.placements, self.materials, self.supports, self.loads, self.cavities, self.measures, self.settings
        supplies = {cavity.name: cavity.supply for cavity in self.cavities}
        check_tubes(self.tubes, supplies)
        for phase in self.file.phase:
            for name in phase.targets:
                check_driven(str(phase.name), name, supplies)
        check_phases(self.programme.phases, supplies, self.tubes, self.atmosphere)
        _check_driven([name for name in self.kinds if name not in supplies], self.programme)
        clamped = [item.face for item in self.file.support or () if item.type == "clamp"]
        check_free(self.file.body, self.file.gravity, self.file.phase, clamped)
        if self.file.gravity is not None:
            for domain, material in self.materials.items():
                if material.density is None:
                    raise InputError(f"gravity: the material of '{domain}' has no density; give density in [material]")

    @property
    def title(self) -> str:
        """The title, or the name of the study."""
        return self.file.title or self.name

    @cached_property
    def assembly(self) -> Assembly:
        """The actuator and all other bodies."""
        return assembly_of(self.file)

    @property
    def actuator(self) -> Actuator:
        """The actuator, which is the main body, with its dimensions."""
        return self.assembly.main

    @cached_property
    def placements(self) -> dict[str, Placement]:
        """Part -> where it stands."""
        return {name: placement_of(name, item.turn, item.shift) for name, item in self.file.part.items()}

    @cached_property
    def materials(self) -> dict[str, Material]:
        """Domain -> material, of all bodies."""
        return {
            name_of(part, domain): material_of(section)
            for part, sections in {"": self.file.material, **{k: v.material for k, v in self.file.part.items()}}.items()
            for domain, section in sections.items()
        }

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
        return contacts_of(self.file.contact, self._bodies)

    @cached_property
    def _bodies(self) -> dict[str, Obstacle | FreeBody]:
        return bodies_of(self.file.body, 3 if self.actuator.space == "3d" else 2)

    @property
    def free_bodies(self) -> tuple[FreeBody, ...]:
        """Rigid bodies with mass."""
        return tuple(body for body in self._bodies.values() if isinstance(body, FreeBody))

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
        for body in self.free_bodies:
            if body.name in kinds or body.name in names or body.name in self.assembly.face_names:
                raise InputError(f"body.{body.name}: the name is taken; give the free body another one")
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
        return measures_of(
            self.file.measures, self.actuator, self.assembly.domains, [item.name for item in self.contacts]
        )

    def mesh(self) -> Mesh:
        """Return the mesh of all bodies; what the quality check warns of goes to the log.

        Raises MeshError, and InputError for bodies that intersect.
        """
        return self._with_parts(meshed(self.actuator, self.file.mesh))

    def _with_parts(self, main: Mesh) -> Mesh:
        made = {
            name: (meshed(self.assembly.parts[name], item.mesh, f"part.{name}: "), self.placements[name])
            for name, item in self.file.part.items()
        }
        return put_together(main, made)

    def build(self) -> Problem:
        """Return model, programme, measures and settings; meshes. Raises MeshError, LeakingCavityError."""
        for domain, material in self.materials.items():
            for instability in instabilities(material, *USUAL_RANGE):
                _log.warning("material of '%s': %s", domain, instability)
        if self.file.mesh.homogenised:
            main, materials = homogenised(self.actuator, self.file.mesh, self.materials)
            mesh = self._with_parts(main)
            materials |= {name: self.materials[name] for name in self.assembly.domains if self.assembly.owner(name)[0]}
        else:
            mesh, materials = self.mesh(), self.materials
        model = Model(
            mesh, materials, self.supports, self.loads, self.cavities,
            tubes=self.tubes, atmosphere=self.atmosphere, contacts=self.contacts, free_bodies=self.free_bodies,
        )  # fmt: skip
        return Problem(model, self.programme, self.measures, self.settings)

    def resolved(self) -> dict[str, Any]:
        """Return the study as plain data with every default written out, quantities as text with units."""
        data = self.file.model_dump(exclude_none=True)
        data["phase"] = [{key: value for key, value in item.items() if value != {}} for item in data["phase"]]
        for key in ("part", "load", "tube", "body", "contact"):
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


def material_of(section: Any) -> Material:
    """Return the material of a [material] section."""
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
