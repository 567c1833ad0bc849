"""The schema of a study file: which sections and keys there are, and of which kind each value is.

Data only: no value is ever evaluated. The sections of actuators, materials and solver settings are made from the
dataclasses themselves, so that a new dimension or constant can be given in a study file without a change here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Union

from pydantic import BeforeValidator, Discriminator, Field, PlainSerializer, Strict, Tag, ValidationInfo

from pneumorph.errors import StudyError, UnitError
from pneumorph.geometry import Actuator, Finger, HexagonalPrism, PneuNet, ThickSphere, ThickTube
from pneumorph.materials import Material, NeoHookean, Yeoh
from pneumorph.mechanics import Settings
from pneumorph.studies.section import LIBRARY, Section, quantity, section_of, write
from pneumorph.units import parse

TEMPLATES: dict[str, type[Actuator]] = {
    "finger": Finger,
    "hexagonal-prism": HexagonalPrism,
    "pneunet": PneuNet,
    "thick-sphere": ThickSphere,
    "thick-tube": ThickTube,
}
LAWS: dict[str, type[Material]] = {"neo-hookean": NeoHookean, "yeoh": Yeoh}
ALL_DOMAINS = "all"

Axis = Literal["x", "y", "z"]


def _direction(value: object) -> tuple[float, ...]:
    """Return the components of "-z", or of a list of numbers."""
    if isinstance(value, str) and value.lstrip("+-") in ("x", "y", "z") and len(value) <= 2:
        sign = -1.0 if value.startswith("-") else 1.0
        return tuple(sign if value[-1] == axis else 0.0 for axis in "xyz")
    if isinstance(value, list | tuple) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in value):
        return tuple(map(float, value))
    raise StudyError(f"direction = {value!r}: expected an axis such as '-z', or a list of 3 numbers")


Direction = Annotated[tuple[float, ...], BeforeValidator(_direction)]
Names = Annotated[tuple[str, ...], Strict(False)]


class LibraryMaterial(Section):
    """A material of the library by name; `bulk` and `density` replace what the library says."""

    name: str
    bulk: quantity("stress") | None = None  # type: ignore[valid-type]
    density: quantity("density") | None = None  # type: ignore[valid-type]


def law(value: Any) -> str:
    """Return which section reads a material: that of its law, or the library's."""
    name = value.get("law", LIBRARY) if isinstance(value, Mapping) else getattr(value, "law", LIBRARY)
    return str(name)


_ACTUATORS = tuple(section_of(owner, template=name) for name, owner in TEMPLATES.items())
_MATERIALS = tuple(Annotated[section_of(owner, law=name), Tag(name)] for name, owner in LAWS.items())
ActuatorSection: Any = Annotated[Union[_ACTUATORS], Field(discriminator="template")]  # noqa: UP007
MaterialSection: Any = Annotated[
    Union[(Annotated[LibraryMaterial, Tag(LIBRARY)], *_MATERIALS)],
    Discriminator(law),
]


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
    """size: largest edge, "automatic" or "coarse"; the others as in `mesh.generate`."""

    size: Annotated[float | str, BeforeValidator(_read_size), PlainSerializer(_write_size)] = "automatic"
    wall_size: quantity("length") | None = None  # type: ignore[valid-type]
    grading: float | None = None
    detail: float | None = None


class GravitySection(Section):
    """Weight; ramped up in a phase of its own, before the others, unless a phase names it."""

    direction: Direction = (0.0, 0.0, -1.0)
    acceleration: quantity("acceleration") = 9810.0  # type: ignore[valid-type]


class ClampSection(Section):
    """All displacements of a face are zero."""

    type: Literal["clamp"]
    face: str


class RollerSection(Section):
    """The displacement of a face along one axis is zero."""

    type: Literal["roller"]
    face: str
    axis: Axis


class SymmetrySection(Section):
    """A plane face in a mirror plane of the whole."""

    type: Literal["symmetry"]
    face: str


class PrescribedSection(Section):
    """A face is moved along one axis by a length that the phases set under `name`."""

    type: Literal["prescribed"]
    face: str
    axis: Axis
    name: str


class ForceSection(Section):
    """A force spread evenly over a face; the phases set its size in N under `name`."""

    type: Literal["force"]
    face: str
    direction: Direction
    name: str


class TractionSection(Section):
    """A force per area on a face; the phases set it in MPa under `name`."""

    type: Literal["traction"]
    face: str
    direction: Direction
    name: str


class CavitySection(Section):
    """A cavity; by default its faces bear its name, and it may lie open in all symmetry planes."""

    name: str
    faces: Names | None = None
    supply: Literal["pressure", "volume"] = "pressure"
    mirrors: Names | None = None


class PhaseSection(Section):
    """One ramp. states_at: name of a target -> values on the way at which a state is wanted exactly.

    The increments are fractions of the phase.
    """

    name: str | None = None
    targets: dict[str, str]
    states_at: dict[str, Annotated[tuple[str, ...], Strict(False)]] = Field(default_factory=dict)
    first_increment: float = 0.05
    largest_increment: float = 0.2
    smallest_increment: float = 1e-5


SupportSection: Any = Annotated[
    ClampSection | RollerSection | SymmetrySection | PrescribedSection, Field(discriminator="type")
]
LoadSection: Any = Annotated[ForceSection | TractionSection, Field(discriminator="type")]
SolverSection: Any = section_of(Settings, "SolverSection")


class StudyFile(Section):
    """A whole study file, in the order in which it is written out."""

    title: str = ""
    measures: Names | None = None
    actuator: ActuatorSection
    material: Annotated[dict[str, MaterialSection], BeforeValidator(_by_domain)] = Field(default_factory=dict)
    mesh: MeshSection = Field(default_factory=MeshSection)
    gravity: GravitySection | None = None
    support: Annotated[tuple[SupportSection, ...], Strict(False)] | None = None
    load: Annotated[tuple[LoadSection, ...], Strict(False)] = ()
    cavity: Annotated[tuple[CavitySection, ...], Strict(False)] | None = None
    phase: Annotated[tuple[PhaseSection, ...], Strict(False)] = ()
    solver: SolverSection = Field(default_factory=SolverSection)


# names of union members that pydantic adds to the path of an error
TAGS = {
    *TEMPLATES, *LAWS, ALL_DOMAINS, LIBRARY, "clamp", "roller", "symmetry", "prescribed", "force", "traction",
}  # fmt: skip
