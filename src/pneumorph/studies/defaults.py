"""What a study file may leave out: the same study with every default written into it."""

from __future__ import annotations

from collections.abc import Iterable

from pneumorph.errors import InputError, NameNotFoundError, StudyError, unknown_name
from pneumorph.geometry import Actuator
from pneumorph.mesh import Imported
from pneumorph.mesh.assembly import name_of
from pneumorph.studies.importing import ImportedSection, imported_body
from pneumorph.studies.parts import Assembly
from pneumorph.studies.schema import (
    ALL_DOMAINS,
    TEMPLATES,
    CavitySection,
    ClampSection,
    GravitySection,
    LibraryMaterial,
    PartSection,
    PhaseSection,
    PrescribedSection,
    RollerSection,
    StudyFile,
    SymmetrySection,
)
from pneumorph.studies.section import built, write
from pneumorph.studies.touching import is_free

GRAVITY = "gravity"

# the silicones of the published actuators, by domain
_MATERIALS = {
    "crawler-2d": {"body": "ecoflex-pneunet", "base": "pdms-pneunet"},
    "finger": {"body": "lsr-finger"},
    "forearm": {"body": "finger-arm"},
    "gripper": {"body": "lsr-finger"},
    "hexagonal-prism": {"body": "shore-a45-platinum"},
    "pipe-robot": {"body": "shore-a45-platinum"},
    "pneunet": {"body": "ecoflex-pneunet", "base": "pdms-pneunet"},
    "quadruped": {"body": "ecoflex-pneunet", "base": "pdms-pneunet"},
    "soft-limb": {"body": "dragon-skin-30-wheel", "base": "smooth-sil-950"},
    "skinned-tube": {"tube": "ecoflex-00-30-tube", "skin": "hei-cast-8400-skin", "cap": "auxetic-end-cap"},
}


def actuator_of(file: StudyFile | PartSection) -> Actuator:
    """Return the body of a study or of a part of it.

    Raises GeometryError for dimensions that do not fit, InputErrors for a file.
    """
    if isinstance(file.actuator, ImportedSection):
        return imported_body(file.actuator, file.mesh)
    dimensions = {
        name: built(getattr(file.actuator, name)) for name in type(file.actuator).model_fields if name != "template"
    }
    return TEMPLATES[file.actuator.template](**dimensions)


def assembly_of(file: StudyFile) -> Assembly:
    """Return all bodies; raises InputErrors, those of a part led by its name, and StudyError for a part's name."""
    parts = {}
    for name, section in file.part.items():
        try:
            parts[name] = actuator_of(section)
        except InputError as error:
            raise type(error)(f"part.{name}: {error}") from error
    return Assembly(actuator_of(file), parts)


def completed(file: StudyFile, assembly: Assembly) -> StudyFile:
    """Return the study with every default filled in.

    Materials: those of the published actuators. Supports: faces "clamp" held, symmetry in the cut faces of a body.
    Cavities: all of the template, by pressure. Phases: named phase_1, ...; gravity, if any, in one before them.

    Raises NameNotFoundError for a face or domain that the actuator does not have, InputError for a face that is
    supported twice or bounds two cavities, StudyError for what is missing and has no default.
    """
    support = file.support
    if support is None:
        clamps = [name_of(part, "clamp") for part, body in assembly.bodies.items() if "clamp" in body.face_names]
        mirrors = [name for part in assembly.bodies for name in assembly.mirrors(part)]
        support = (
            *(ClampSection(type="clamp", face=name) for name in clamps),
            *(SymmetrySection(type="symmetry", face=name) for name in mirrors),
        )
    if isinstance(assembly.main, Imported) and _needs_cavity(file, assembly):
        assembly.main.require_cavity()
    cavity = [
        CavitySection(
            name=item.name,
            faces=_walls(assembly, item.name) if item.faces is None else item.faces,
            supply=item.supply,
            mirrors=assembly.mirrors(assembly.owner(item.name)[0]) if item.mirrors is None else item.mirrors,
        )
        for item in ([CavitySection(name=name) for name in assembly.cavities] if file.cavity is None else file.cavity)
    ]
    bounds = [(c.name, tuple(c.faces or ()), tuple(c.mirrors or ())) for c in cavity]
    free = [name for name, section in file.body.items() if is_free(section)]
    known = (*assembly.face_names, *free)
    _check_faces(known, [(f"support[{i + 1}]", item.face) for i, item in enumerate(support)])
    _check_faces(known, [(f"load[{i + 1}]", item.face) for i, item in enumerate(file.load)])
    known = tuple(dict.fromkeys((*known, *(face for name in assembly.cavities for face in _walls(assembly, name)))))
    touching = [(f"contact[{i + 1}]", item) for i, item in enumerate(file.contact)]
    _check_faces(known, [(owner, face) for owner, item in touching for face in (*item.faces, *(item.against or ()))])
    _check_faces(known, [(f"cavity '{name}'", face) for name, faces, planes in bounds for face in (*faces, *planes)])
    _check_once(
        [((face,), f"cavity '{name}'") for name, faces, _ in bounds for face in faces],
        "a face bounds one cavity, and once only",
    )
    _check_once(
        [((item.face, a), f"support[{i + 1}]") for i, item in enumerate(support) for a in _axes(item)],
        "each direction of a face is supported once",
    )
    return file.model_copy(
        update={
            "material": _materials(file, assembly.main),
            "part": {
                name: item.model_copy(update={"material": _materials(item, assembly.parts[name], f"part.{name}.")})
                for name, item in file.part.items()
            },
            "gravity": _gravity(file, assembly),
            "support": support,
            "cavity": tuple(cavity),
            "phase": _phases(file),
        }
    )


def _gravity(file: StudyFile, assembly: Assembly) -> GravitySection | None:
    if file.gravity is None or file.gravity.direction is not None:
        return file.gravity
    return file.gravity.model_copy(
        update={"direction": (0.0, 0.0, -1.0) if assembly.space == "3d" else (0.0, -1.0, 0.0)}
    )


def _materials(file: StudyFile | PartSection, actuator: Actuator, place: str = "") -> dict[str, object]:
    """Return domain -> material of a body; place: what leads the keys in messages."""
    template = getattr(file.actuator, "template", None)
    for domain in file.material:
        if domain not in (*actuator.domains, ALL_DOMAINS):
            raise NameNotFoundError(f"{place}material: " + unknown_name("domain", domain, actuator.domains))
    chosen = {}
    for domain in actuator.domains:
        section = file.material.get(domain, file.material.get(ALL_DOMAINS))
        if section is None and domain in _MATERIALS.get(template or "", {}):
            section = LibraryMaterial(name=_MATERIALS[template or ""][domain])
        if section is None:
            owner = f"template '{template}'" if template else "file"
            raise StudyError(
                f"{place}material: missing for the domain '{domain}' of the {owner}; give [{place}material] a name "
                'from the library, such as name = "shore-a45-platinum", or a law with its constants'
            )
        chosen[domain] = section
    return chosen


def _phases(file: StudyFile) -> tuple[PhaseSection, ...]:
    if not file.phase:
        raise StudyError(
            'phase: missing; say what is driven how far, such as [[phase]] with targets = { cavity = "50 kPa" }'
        )
    phases = [
        phase if phase.name is not None else phase.model_copy(update={"name": f"phase_{i + 1}"})
        for i, phase in enumerate(file.phase)
    ]
    if file.gravity is not None and not any(GRAVITY in phase.targets for phase in phases):
        targets = {GRAVITY: write(file.gravity.acceleration, "acceleration")}
        # slender fingers sag far before any pressure stiffens them
        first = PhaseSection(name=GRAVITY, targets=targets, first_increment=0.1, largest_increment=0.5)
        if any(is_free(section) for section in file.body.values()):
            first = first.model_copy(update={"duration": 1.0, "inertia": "quasi-static"})
        phases.insert(0, first)
    return tuple(phases)


def _axes(support: ClampSection | RollerSection | SymmetrySection | PrescribedSection) -> Iterable[str]:
    if isinstance(support, RollerSection | PrescribedSection):
        return (support.axis,)
    return "xyz" if isinstance(support, ClampSection) else ("normal",)


def _walls(assembly: Assembly, cavity: str) -> tuple[str, ...]:
    """Return the faces that bound a cavity unless the study says which."""
    return assembly.cavity_faces(cavity) if cavity in assembly.cavities else (cavity,)


def _needs_cavity(file: StudyFile, assembly: Assembly) -> bool:
    """Return whether the main body has cavities, or the study drives what is no load, displacement or other cavity."""
    others = {name for name in assembly.cavities if assembly.owner(name)[0]}
    named = (item.name for item in (*file.load, *(file.support or ())) if hasattr(item, "name"))
    names = {GRAVITY, *others, *file.body, *named}
    own = [item for item in file.cavity or () if item.name not in others]
    return bool(own) or any(name not in names for phase in file.phase for name in phase.targets)


def _check_faces(known: Iterable[str], used: Iterable[tuple[str, str]]) -> None:
    for owner, face in used:
        if face not in known:
            raise NameNotFoundError(f"{owner}: " + unknown_name("face", face, known))


def _check_once(used: Iterable[tuple[tuple[str, ...], str]], rule: str) -> None:
    owners: dict[tuple[str, ...], str] = {}
    for key, owner in used:
        if key in owners:
            raise InputError(f"face '{key[0]}' is named in {owners[key]} and in {owner}: {rule}")
        owners[key] = owner
