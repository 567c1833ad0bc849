"""The bodies of a study: the main one, whose names stand alone, and parts, whose names are led by theirs."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from pneumorph.errors import InputError, MeshError, StudyError
from pneumorph.geometry import Actuator
from pneumorph.mechanics.contact.apart import check_parts_apart
from pneumorph.mesh import Imported, Mesh, generate, inspect
from pneumorph.mesh.assembly import Placement, assembled, name_of
from pneumorph.studies.schema import MeshSection, StudyFile

_log = logging.getLogger(__name__)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


@dataclass(frozen=True)
class Assembly:
    """The bodies of a study and what everything in them is called.

    main: its faces, cavities and domains bear their own names. parts: name -> body; theirs are called 'part.name'.
    Raises StudyError for a part's name that cannot lead others, or for bodies of different spaces.
    """

    main: Actuator
    parts: Mapping[str, Actuator] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, part in self.parts.items():
            if not _NAME.fullmatch(name):
                raise StudyError(f"part '{name}': expected a name of letters, digits, _ and -, beginning with a letter")
            if part.space != self.main.space:
                raise StudyError(f"part.{name} is {part.space}, the main body {self.main.space}: expected the same")

    @cached_property
    def bodies(self) -> dict[str, Actuator]:
        """Name of the part, '' for the main body -> body."""
        return {"": self.main, **self.parts}

    @property
    def space(self) -> str:
        """'3d' or 'plane_strain'."""
        return self.main.space

    @cached_property
    def face_names(self) -> tuple[str, ...]:
        """All faces of all bodies."""
        return self._names(lambda body: body.face_names)

    @cached_property
    def cavities(self) -> tuple[str, ...]:
        """All cavities of all bodies."""
        return self._names(lambda body: body.cavities)

    @cached_property
    def domains(self) -> tuple[str, ...]:
        """All material domains of all bodies."""
        return self._names(lambda body: body.domains)

    def cavity_faces(self, cavity: str) -> tuple[str, ...]:
        """Return the faces that bound a cavity."""
        part, own = self.owner(cavity)
        return tuple(name_of(part, face) for face in self.bodies[part].cavity_faces(own))

    def mirrors(self, part: str) -> tuple[str, ...]:
        """Return the faces of a part, '' for the main body, that lie in planes of symmetry."""
        own = (name for name in self.bodies[part].face_names if name.startswith("symmetry_"))
        return tuple(name_of(part, name) for name in own)

    def owner(self, name: str) -> tuple[str, str]:
        """Return the part, '' for the main body, that a name belongs to, and the name without it."""
        part, dot, own = name.partition(".")
        return (part, own) if dot and part in self.parts else ("", name)

    def _names(self, of: Callable[[Actuator], tuple[str, ...]]) -> tuple[str, ...]:
        return tuple(name_of(part, name) for part, body in self.bodies.items() for name in of(body))


def check_held(assembly: Assembly, file: StudyFile) -> None:
    """Raise StudyError for a part that no support holds and no contact names."""
    used = [item.face for item in file.support or ()]
    used += [face for item in file.contact for face in (*item.faces, *(item.against or ()))]
    owners = {assembly.owner(face)[0] for face in used}
    for part in assembly.parts:
        if part not in owners:
            faces = ", ".join(name_of(part, face) for face in assembly.parts[part].face_names)
            raise StudyError(
                f"part.{part}: nothing holds or touches it; name one of its faces, {faces}, in a [[support]] or a "
                "[[contact]]"
            )


def meshed(actuator: Actuator, section: MeshSection, owner: str = "") -> Mesh:
    """Return the mesh of a body; what its quality check warns of goes to the log, led by `owner`. Raises MeshError."""
    if isinstance(actuator, Imported):
        for note in actuator.notes:
            _log.warning("%s%s", owner, note)
    size = section.size if isinstance(section.size, float) else None
    try:
        mesh = generate(
            actuator,
            size,
            coarse=section.size == "coarse",
            grading=section.grading,
            detail=section.detail,
            wall_size=section.wall_size,
            hexahedra=section.hexahedra,
        )
    except MeshError as error:
        raise MeshError(f"{owner}{error}") from error
    for warning in inspect(mesh).warnings:
        _log.warning("%smesh: %s", owner, warning)
    return mesh


def put_together(main: Mesh, parts: Mapping[str, tuple[Mesh, Placement]]) -> Mesh:
    """Return all bodies in one mesh, each part in its place. Raises InputError for bodies that intersect."""
    placed = {}
    for name, (mesh, placement) in parts.items():
        try:
            placed[name] = placement(mesh)
        except InputError as error:
            raise type(error)(f"part.{name}: {error}") from error
    if not placed:
        return main
    whole = assembled(main, placed)
    check_parts_apart(
        whole,
        [("the main body", len(main.points)), *((f"part '{name}'", len(m.points)) for name, m in placed.items())],
    )
    return whole
