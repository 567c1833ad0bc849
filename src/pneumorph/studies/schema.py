"""The schema of a study file: which sections and keys there are, and of which kind each value is.

Data only: no value is ever evaluated. The sections of actuators, materials and solver settings are made from the
dataclasses themselves, so that a new dimension or constant can be given in a study file without a change here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Union

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    PlainSerializer,
    Strict,
    Tag,
    ValidationInfo,
    WithJsonSchema,
)

from pneumorph.errors import UnitError
from pneumorph.geometry import (
    Actuator,
    BendingSkin,
    Finger,
    Forearm,
    Gripper,
    HexagonalPrism,
    PipeRobot,
    PlaneCrawler,
    PneuNet,
    Quadruped,
    SoftLimb,
    ThickSphere,
    ThickTube,
)
from pneumorph.materials import LAWS, Prony
from pneumorph.mechanics import Settings
from pneumorph.studies.direction import Direction
from pneumorph.studies.importing import ImportedSection
from pneumorph.studies.json_types import AloneOrByName, any_quantity_schema, size_schema
from pneumorph.studies.placing import TurnSection
from pneumorph.studies.section import IMPORTED, LIBRARY, Section, quantity, section_of, write
from pneumorph.studies.supplies import SUPPLY_SECTIONS, AtmosphereSection, SupplySection, TubeSection
from pneumorph.studies.touching import BODY_SECTIONS, BodySection, ContactSection, Place
from pneumorph.units import EARTH, parse

TEMPLATES: dict[str, type[Actuator]] = {
    "crawler-2d": PlaneCrawler,
    "finger": Finger,
    "forearm": Forearm,
    "gripper": Gripper,
    "hexagonal-prism": HexagonalPrism,
    "pipe-robot": PipeRobot,
    "pneunet": PneuNet,
    "quadruped": Quadruped,
    "skinned-tube": BendingSkin,
    "soft-limb": SoftLimb,
    "thick-sphere": ThickSphere,
    "thick-tube": ThickTube,
}
ALL_DOMAINS = "all"

Axis = Literal["x", "y", "z"]


Names = Annotated[tuple[str, ...], Strict(False)]
# read when it is known what it drives, and so which unit it must have
TargetText = Annotated[str, WithJsonSchema(any_quantity_schema())]


class LibraryMaterial(Section):
    """A material of the library.

    name: name in the library; upper and lower case are alike.
    bulk: bulk modulus, in place of the library's.
    density: mass density, in place of the library's; gravity needs one.
    prony: relaxation, which the library does not give.
    """

    name: str
    bulk: quantity("stress") | None = None  # type: ignore[valid-type]
    density: quantity("density") | None = None  # type: ignore[valid-type]
    prony: section_of(Prony) | None = None  # type: ignore[valid-type]


def law(value: Any) -> str:
    """Return which section reads a material: that of its law, or the library's."""
    name = value.get("law", LIBRARY) if isinstance(value, Mapping) else getattr(value, "law", LIBRARY)
    return str(name)


def template(value: Any) -> str | None:
    """Return which section reads an actuator: that of its template, or that of a file."""
    if isinstance(value, ImportedSection) or (isinstance(value, Mapping) and "file" in value):
        return IMPORTED
    name = value.get("template") if isinstance(value, Mapping) else getattr(value, "template", None)
    return None if name is None else str(name)


_ACTUATORS = tuple(Annotated[section_of(owner, template=name), Tag(name)] for name, owner in TEMPLATES.items())
_MATERIALS = tuple(Annotated[section_of(owner, law=name), Tag(name)] for name, owner in LAWS.items())
ActuatorSection: Any = Annotated[
    Union[(*_ACTUATORS, Annotated[ImportedSection, Tag(IMPORTED)])],
    Discriminator(template),
]
MaterialSection: Any = Annotated[
    Union[(Annotated[LibraryMaterial, Tag(LIBRARY)], *_MATERIALS)],
    Discriminator(law),
]


def _joined(value: Any) -> Any:
    """arm.cavity = "..." is a table in a table in TOML: it means the name "arm.cavity"."""
    if not isinstance(value, Mapping):
        return value
    flat: dict[Any, Any] = {}
    for name, item in value.items():
        for own, one in item.items() if isinstance(item, Mapping) else (("", item),):
            flat[f"{name}.{own}" if own else name] = one
    return flat


def _by_domain(value: Any) -> Any:
    """[material] stands for all domains unless every entry is a table of its own."""
    if isinstance(value, Mapping) and value and not all(isinstance(item, Mapping | Section) for item in value.values()):
        return {ALL_DOMAINS: value}
    return value


def _read_size(value: object, info: ValidationInfo) -> float | str:
    if (isinstance(value, float) and info.context is None) or value in ("automatic", "coarse"):
        return value
    try:
        return parse(value, "length", "size")  # type: ignore[arg-type]
    except UnitError as error:
        raise UnitError(f"{error}; or 'automatic', 'coarse'") from None


def _write_size(value: float | str) -> str:
    return value if isinstance(value, str) else write(value, "length")


class MeshSection(Section):
    """How fine the mesh is.

    size: largest edge, or "automatic" for the template's choice, "coarse" for the fewest cells that keep the shape.
    wall_size: largest edge on the cavity faces, if smaller than `size`.
    grading: how fast the size may change, above 0 (slowly) to 1; automatic 0.8.
    detail: how much short edges refine their surroundings, 1 for a cell no larger than the edge; automatic 1, coarse
        0.2.
    hexahedra: a block grid in place of tetrahedra, from wall to wall unless a size is given; finger, hexagonal-prism.
    homogenised: a closed layer with the law of its lattice in place of a skin; only for skinned-tube.
    """

    size: Annotated[
        float | str, BeforeValidator(_read_size), PlainSerializer(_write_size), WithJsonSchema(size_schema())
    ] = "automatic"
    wall_size: quantity("length") | None = None  # type: ignore[valid-type]
    grading: float | None = None
    detail: float | None = None
    hexahedra: bool = False
    homogenised: bool = False


# one material for all domains, or one for each
Materials = Annotated[dict[str, MaterialSection], BeforeValidator(_by_domain), AloneOrByName()]


class PartSection(Section):
    """A further body, called by its name: its faces, cavities and domains are "NAME.skin" and so on.

    actuator: what it is, with the keys of [actuator].
    material: what it is made of, as in [material].
    mesh: how fine its mesh is, with the keys of [mesh].
    turn: turns, one after the other, from where the template or the file has it.
    shift: how far it is moved after them.
    """

    actuator: ActuatorSection = Field(json_schema_extra={"examples": [{"template": "forearm"}]})
    material: Materials = Field(default_factory=dict, json_schema_extra={"examples": [{"name": "lsr-finger"}]})
    mesh: MeshSection = Field(default_factory=MeshSection, json_schema_extra={"examples": [{"size": "coarse"}]})
    turn: Annotated[tuple[TurnSection, ...], Strict(False)] = ()
    shift: Place = (0.0, 0.0, 0.0)


class GravitySection(Section):
    """Weight; ramped up in a phase of its own, before the others, unless a phase names it.

    direction: which way things fall, an axis with its sign or three numbers; left out, -z, in plane models -y.
    acceleration: how strong it is.
    """

    direction: Direction | None = None
    acceleration: quantity("acceleration") = EARTH  # type: ignore[valid-type]


class ClampSection(Section):
    """All displacements of a face are zero.

    face: name of the face.
    """

    type: Literal["clamp"]
    face: str


class RollerSection(Section):
    """The displacement of a face along one axis is zero.

    face: name of the face.
    axis: axis along which it does not move.
    """

    type: Literal["roller"]
    face: str
    axis: Axis


class SymmetrySection(Section):
    """A plane face in a mirror plane of the whole.

    face: name of the face.
    """

    type: Literal["symmetry"]
    face: str


class PrescribedSection(Section):
    """A face is moved along one axis by a length that the phases set under `name`.

    face: name of the face.
    axis: axis along which it is moved; it is free across it.
    name: name under which the phases set the length.
    """

    type: Literal["prescribed"]
    face: str
    axis: Axis
    name: str


class ForceSection(Section):
    """A force spread evenly over a face, of fixed direction.

    face: name of the face.
    direction: an axis with its sign, or three numbers.
    name: name under which the phases set the force.
    """

    type: Literal["force"]
    face: str
    direction: Direction
    name: str


class TractionSection(Section):
    """A force per undeformed area on a face, of fixed direction.

    face: name of the face.
    direction: an axis with its sign, or three numbers.
    name: name under which the phases set the stress.
    """

    type: Literal["traction"]
    face: str
    direction: Direction
    name: str


PRESSURE = SUPPLY_SECTIONS["pressure"].model_validate({"type": "pressure"})


class CavitySection(Section):
    """A cavity and what fills it.

    name: name under which the phases set the target of its supply.
    faces: names of all its faces; left out, the face of its own name.
    supply: what fills it, and so what the phases set: the gauge pressure (negative for a vacuum), the volume of liquid
        added, the mass of gas added, nothing where it is sealed with the air in it, or by a table with type "flow" the
        gauge pressure of a source behind a valve or tube.
    mirrors: symmetry planes in which it may lie open; left out, all of the actuator.
    """

    name: str
    faces: Names | None = None
    supply: SupplySection = Field(default_factory=lambda: PRESSURE)
    mirrors: Names | None = None


class PhaseSection(Section):
    """One ramp: every target goes to its value, what is not named stays where it is; all starts from zero.

    name: name in progress and report; left out, phase_1 and so on.
    targets: name of a cavity, load, displacement or "gravity" -> value at the end of the phase.
    states_at: name of a target -> values on the way at which a state is wanted exactly.
    first_increment: first increment as a fraction of the phase.
    largest_increment: largest increment as a fraction of the phase.
    smallest_increment: fraction of the phase under which an increment is not cut any further.
    duration: time that the phase takes; inertia and flow need one.
    inertia: "transient" keeps the swinging, "moderate" damps its high frequencies, "quasi-static" brings the body to
        rest; left out, the phase has no inertia.
    """

    name: str | None = None
    targets: Annotated[dict[str, TargetText], BeforeValidator(_joined)]
    states_at: Annotated[dict[str, Annotated[tuple[TargetText, ...], Strict(False)]], BeforeValidator(_joined)] = Field(
        default_factory=dict
    )
    first_increment: float = 0.05
    largest_increment: float = 0.2
    smallest_increment: float = 1e-5
    duration: quantity("time") | None = None  # type: ignore[valid-type]
    inertia: Literal["transient", "moderate", "quasi-static"] | None = None


class CycleSection(Section):
    """A gait: phases at the end of the file that repeat.

    phases: names of the phases of one cycle, the last ones of the file in their order.
    repeat: how often they are run, in all; 1 or more.
    """

    phases: Names
    repeat: int = 1


SupportSection: Any = Annotated[
    ClampSection | RollerSection | SymmetrySection | PrescribedSection, Field(discriminator="type")
]
LoadSection: Any = Annotated[ForceSection | TractionSection, Field(discriminator="type")]
SolverSection: Any = section_of(Settings, "SolverSection")


class StudyFile(Section):
    """A study of a soft pneumatic actuator, its sections in the order in which they are written out.

    title: title of the report; left out, the name of the file.
    measures: what is measured in every state, stress and stretch also of one domain, as "peak_von_mises:skin", and the
        "normal_force:ground" of a contact; left out, both angles where there are a clamp and a tip.
    actuator: the template and its dimensions; what is left out has the template's value.
    material: one material for all domains, or a table for each domain; left out, that of the published actuator.
    mesh: how fine the mesh is.
    part: further bodies by name, which supports, contacts and phases refer to.
    gravity: weight; left out, there is none.
    support: how the body is held; left out, "clamp" is clamped and planes of symmetry are kept.
    load: forces and tractions that the phases drive.
    cavity: cavities and their supplies; left out, every cavity of the template by pressure.
    tube: tubes between cavities that are filled with gas.
    atmosphere: pressure and temperature outside, and the gas.
    body: rigid bodies by name, which contacts refer to.
    contact: what may touch what, with friction or without; left out, surfaces pass through each other.
    phase: what is driven how far, one ramp after the other.
    cycle: phases that repeat; left out, each is run once.
    solver: how the solver steps and when it is content.
    """

    title: str = ""
    measures: Names | None = None
    actuator: ActuatorSection
    material: Materials = Field(default_factory=dict)
    mesh: MeshSection = Field(default_factory=MeshSection)
    part: dict[str, PartSection] = Field(default_factory=dict)
    gravity: GravitySection | None = None
    support: Annotated[tuple[SupportSection, ...], Strict(False)] | None = None
    load: Annotated[tuple[LoadSection, ...], Strict(False)] = ()
    cavity: Annotated[tuple[CavitySection, ...], Strict(False)] | None = None
    tube: Annotated[tuple[TubeSection, ...], Strict(False)] = ()
    atmosphere: AtmosphereSection = Field(default_factory=AtmosphereSection)
    body: dict[str, BodySection] = Field(default_factory=dict)
    contact: Annotated[tuple[ContactSection, ...], Strict(False)] = ()
    phase: Annotated[tuple[PhaseSection, ...], Strict(False)] = ()
    cycle: CycleSection | None = None
    solver: SolverSection = Field(default_factory=SolverSection)


# names of union members that pydantic adds to the path of an error
TAGS = {
    *TEMPLATES, IMPORTED, *LAWS, ALL_DOMAINS, LIBRARY, "clamp", "roller", "symmetry", "prescribed", "force", "traction",
    *SUPPLY_SECTIONS, *BODY_SECTIONS,
}  # fmt: skip
