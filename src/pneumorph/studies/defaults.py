"""What a study file may leave out: the same study with every default written into it."""

from __future__ import annotations

from collections.abc import Iterable

from pneumorph.errors import InputError, NameNotFoundError, StudyError, unknown_name
from pneumorph.geometry import Actuator
from pneumorph.mesh import Imported
from pneumorph.studies.importing import ImportedSection, imported_body
from pneumorph.studies.schema import (
    ALL_DOMAINS,
    TEMPLATES,
    CavitySection,
    ClampSection,
    GravitySection,
    LibraryMaterial,
    PhaseSection,
    PrescribedSection,
    RollerSection,
    StudyFile,
    SymmetrySection,
)
from pneumorph.studies.section import built, write

GRAVITY = "gravity"

# the silicones of the published actuators, by domain
_MATERIALS = {
    "crawler-2d": {"body": "ecoflex-pneunet", "base": "pdms-pneunet"},
    "finger": {"body": "lsr-finger"},
    "hexagonal-prism": {"body": "shore-a45-platinum"},
    "pneunet": {"body": "ecoflex-pneunet", "base": "pdms-pneunet"},
    "soft-limb": {"body": "dragon-skin-30-wheel", "base": "smooth-sil-950"},
    "skinned-tube": {"tube": "ecoflex-00-30-tube", "skin": "hei-cast-8400-skin", "cap": "auxetic-end-cap"},
}


def actuator_of(file: StudyFile) -> Actuator:
    """Return the actuator; raises GeometryError for dimensions that do not fit, InputErrors for a file."""
    if isinstance(file.actuator, ImportedSection):
        return imported_body(file.actuator, file.mesh)
    dimensions = {
        name: built(getattr(file.actuator, name)) for name in type(file.actuator).model_fields if name != "template"
    }
    return TEMPLATES[file.actuator.template](**dimensions)


def completed(file: StudyFile, actuator: Actuator) -> StudyFile:
    """Return the study with every default filled in.

    Materials: those of the published actuator. Supports: the face "clamp" held, symmetry in the cut faces of a part.
    Cavities: all of the template, by pressure. Phases: named phase_1, ...; gravity, if any, in one before them.

    Raises NameNotFoundError for a face or domain that the actuator does not have, InputError for a face that is
    supported twice or bounds two cavities, StudyError for what is missing and has no default.
    """
    mirrors = tuple(name for name in actuator.face_names if name.startswith("symmetry_"))
    support = file.support
    if support is None:
        clamp = [ClampSection(type="clamp", face="clamp")] if "clamp" in actuator.face_names else []
        support = (*clamp, *(SymmetrySection(type="symmetry", face=name) for name in mirrors))
    if isinstance(actuator, Imported) and _needs_cavity(file):
        actuator.require_cavity()
    cavity = [
        CavitySection(
            name=item.name,
            faces=_walls(actuator, item.name) if item.faces is None else item.faces,
            supply=item.supply,
            mirrors=mirrors if item.mirrors is None else item.mirrors,
        )
        for item in ([CavitySection(name=name) for name in actuator.cavities] if file.cavity is None else file.cavity)
    ]
    bounds = [(c.name, tuple(c.faces or ()), tuple(c.mirrors or ())) for c in cavity]
    known = actuator.face_names
    _check_faces(known, [(f"support[{i + 1}]", item.face) for i, item in enumerate(support)])
    _check_faces(known, [(f"load[{i + 1}]", item.face) for i, item in enumerate(file.load)])
    known = tuple(dict.fromkeys((*known, *(face for name in actuator.cavities for face in _walls(actuator, name)))))
    touching = [(f"contact[{i + 1}]", item) for i, item in enumerate(file.contact)]
    _check_faces(known, [(owner, face) for owner, item in touching for face in (*item.faces, *(item.against or ()))])
    _check_faces(known, [(f"cavity '{name}'", face) for name, faces, planes in bounds for face in (*faces, *planes)])
    _check_once(
        [(face, f"cavity '{name}'") for name, faces, _ in bounds for face in faces],
        "a face bounds one cavity, and once only",
    )
    _check_once(
        [(f"{item.face}.{a}", f"support[{i + 1}]") for i, item in enumerate(support) for a in _axes(item)],
        "each direction of a face is supported once",
    )
    return file.model_copy(
        update={
            "material": _materials(file, actuator),
            "gravity": _gravity(file, actuator),
            "support": support,
            "cavity": tuple(cavity),
            "phase": _phases(file),
        }
    )


def _gravity(file: StudyFile, actuator: Actuator) -> GravitySection | None:
    if file.gravity is None or file.gravity.direction is not None:
        return file.gravity
    return file.gravity.model_copy(
        update={"direction": (0.0, 0.0, -1.0) if actuator.space == "3d" else (0.0, -1.0, 0.0)}
    )


def _materials(file: StudyFile, actuator: Actuator) -> dict[str, object]:
    template = getattr(file.actuator, "template", None)
    for domain in file.material:
        if domain not in (*actuator.domains, ALL_DOMAINS):
            raise NameNotFoundError("material: " + unknown_name("domain", domain, actuator.domains))
    chosen = {}
    for domain in actuator.domains:
        section = file.material.get(domain, file.material.get(ALL_DOMAINS))
        if section is None and domain in _MATERIALS.get(template or "", {}):
            section = LibraryMaterial(name=_MATERIALS[template or ""][domain])
        if section is None:
            owner = f"template '{template}'" if template else "file"
            raise StudyError(
                f"material: missing for the domain '{domain}' of the {owner}; give [material] a name "
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
        phases.insert(0, PhaseSection(name=GRAVITY, targets=targets, first_increment=0.1, largest_increment=0.5))
    return tuple(phases)


def _axes(support: ClampSection | RollerSection | SymmetrySection | PrescribedSection) -> Iterable[str]:
    if isinstance(support, RollerSection | PrescribedSection):
        return (support.axis,)
    return "xyz" if isinstance(support, ClampSection) else ("normal",)


def _walls(actuator: Actuator, cavity: str) -> tuple[str, ...]:
    """Return the faces that bound a cavity unless the study says which."""
    return actuator.cavity_faces(cavity) if cavity in actuator.cavities else (cavity,)


def _needs_cavity(file: StudyFile) -> bool:
    """Return whether the study has cavities, or drives what is neither a load nor a displacement."""
    names = {GRAVITY, *file.body, *(item.name for item in (*file.load, *(file.support or ())) if hasattr(item, "name"))}
    return bool(file.cavity) or any(name not in names for phase in file.phase for name in phase.targets)


def _check_faces(known: Iterable[str], used: Iterable[tuple[str, str]]) -> None:
    for owner, face in used:
        if face not in known:
            raise NameNotFoundError(f"{owner}: " + unknown_name("face", face, known))


def _check_once(used: Iterable[tuple[str, str]], rule: str) -> None:
    owners: dict[str, str] = {}
    for key, owner in used:
        if key in owners:
            raise InputError(f"face '{key.split('.')[0]}' is named in {owners[key]} and in {owner}: {rule}")
        owners[key] = owner
