"""The [actuator] section of a body from a file: selectors of its faces, caps of its openings."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, Strict, ValidationInfo

from pneumorph.errors import MeshError, StudyError
from pneumorph.mesh import Imported, MeshSize, Selector
from pneumorph.mesh.body import UNITS
from pneumorph.mesh.imported import FEATURE_ANGLE
from pneumorph.studies.direction import Direction
from pneumorph.studies.section import Section, quantity

Length: Any = quantity("length")
Place = Annotated[tuple[Length, Length, Length], Strict(False)]


def _set_alone(value: Any) -> Any:
    """clamp = "BASE" is short for clamp = { set = "BASE" }."""
    return {"set": value} if isinstance(value, str) else value


def located(value: object, info: ValidationInfo) -> object:
    """Return file names of a study file as seen from everywhere: they are relative to its folder."""
    names = [value] if isinstance(value, str) else value
    if not isinstance(names, list | tuple) or not names or not all(isinstance(n, str) and n.strip() for n in names):
        raise StudyError(f"file = {value!r}: expected the name of a file, or a list of names")
    folder = (info.context or {}).get("folder")
    found = tuple(str((Path(folder) / name).resolve()) if folder is not None else name for name in names)
    return found[0] if isinstance(value, str) else found


class SelectorSection(Section):
    """Which facets bear a name: all conditions that are given hold. A text alone is the name of a set.

    set: they are in a set of the file: CAD face by name or colour, surface, node or element set, physical group.
    normal: their outward normal, an axis with its sign or three numbers.
    axis: axis across the plane that they lie in.
    at: where that plane lies on the axis.
    box: low and high corner of a box around them.
    largest_planar: the largest flat patch of those that are left.
    nearest: the patch nearest to this point of those that are left.
    """

    set: str | None = None
    normal: Direction | None = None
    axis: Literal["x", "y", "z"] | None = None
    at: Length | None = None
    box: Annotated[tuple[Place, Place], Strict(False)] | None = None
    largest_planar: Literal[True] | None = None
    nearest: Place | None = None


class ImportedSection(Section):
    """A body from a CAD or mesh file.

    file: .step, .iges, .stl, .msh, .inp or .vtu, or a list of .stl files that are one body; seen from the study file.
    unit: unit of the numbers in the file; STEP and IGES files say it themselves.
    faces: name of a face and the selector of its facets; what is left of the outside is "outer".
    caps: name of a cap that closes an opening, and a point near the middle of the opening's rim.
    feature_angle: patches of the surface and rims end where the surface turns by more than this.
    """

    file: Annotated[str | Annotated[tuple[str, ...], Strict(False)], BeforeValidator(located)]
    unit: Literal[tuple(UNITS)] | None = None  # type: ignore[valid-type]
    faces: dict[str, Annotated[SelectorSection, BeforeValidator(_set_alone)]] = Field(default_factory=dict)
    caps: dict[str, Place] = Field(default_factory=dict)
    feature_angle: quantity("angle") = FEATURE_ANGLE  # type: ignore[valid-type]


def imported_body(section: Any, mesh: Any) -> Imported:
    """Return the body of an `ImportedSection`, meshed as the [mesh] section says. Raises InputErrors."""
    if mesh.wall_size is not None:
        raise MeshError("mesh: wall_size: only templates know their walls before they are meshed; leave it out")
    size = mesh.size if isinstance(mesh.size, float) else None
    return Imported(
        section.file,
        section.unit,
        {name: _selector(name, item) for name, item in section.faces.items()},
        dict(section.caps),
        section.feature_angle,
        MeshSize(size, mesh.size == "coarse", mesh.grading, mesh.detail),
    )


def _selector(name: str, section: Any) -> Selector:
    values: Mapping[str, Any] = {
        key: getattr(section, key) for key in type(section).model_fields if getattr(section, key) is not None
    }
    try:
        return Selector(**values)
    except ValueError as error:
        raise StudyError(f"actuator.faces.{name}: {error}") from None
