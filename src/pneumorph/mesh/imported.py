"""Bodies from files: CAD solids, closed surfaces and meshes, with faces by selector and cavities found."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import GeometryError, MeshError
from pneumorph.geometry import occ
from pneumorph.geometry.actuator import Actuator, Dimension
from pneumorph.mesh.body import CAD_SUFFIXES, Body, MeshSize, check_files, read_body
from pneumorph.mesh.cavities import Space, describe, openings, spaces
from pneumorph.mesh.mesh import Mesh
from pneumorph.mesh.selectors import Selector, named_facets
from pneumorph.mesh.skin import Index, Mask

Array = NDArray[np.float64]
Point = tuple[float, float, float]

FEATURE_ANGLE = math.radians(30.0)


@dataclass(frozen=True)
class Imported(Actuator):
    """An actuator from a file, or from several STL files: a mesh with named faces and cavities.

    file: .step, .stp, .iges, .igs (exact solids), .stl (closed surfaces), .msh, .inp, .vtu (meshes), or several .stl.
    unit: of the numbers in the file, one of `UNITS`; STEP and IGES files say it themselves.
    faces: name -> selector. Named CAD faces, *SURFACEs and physical groups of the file are faces too, unless they share
    facets with a face that is named here. What is left of the outside is called "outer".
    caps: name -> a point (mm) near the middle of an opening's rim, where a virtual membrane closes a cavity.
    feature_angle: rad; patches of the surface, and rims, end at edges where it turns by more.
    meshing: for files that hold no mesh.

    Cavities are the closed inner shells: "cavity", or "cavity_1", "cavity_2", ... along the longest side of the body;
    one whose wall is one named face bears its name. The file is read, and meshed, when the object is made. Raises
    InputError (one of its kinds) for a file that is missing, damaged, in no unit, with holes, with solids that overlap
    or in separate parts, and for selectors and caps that catch nothing.
    """

    file: str | tuple[str, ...]
    unit: str | None = None
    faces: Mapping[str, Selector] = field(default_factory=dict)
    caps: Mapping[str, Point] = field(default_factory=dict)
    feature_angle: float = FEATURE_ANGLE
    meshing: MeshSize = field(default_factory=MeshSize)

    def _check_fit(self) -> None:
        self._require(
            0.0 < self.feature_angle < math.pi, f"feature_angle = {self.feature_angle!r} rad, expected 0 to pi"
        )
        _ = self.mesh

    @property
    def paths(self) -> tuple[Path, ...]:
        """The files."""
        return tuple(map(Path, (self.file,) if isinstance(self.file, str) else self.file))

    @cached_property
    def body(self) -> Body:
        """What was read, and meshed."""
        check_files(self.paths, self.unit)
        return read_body(tuple((str(path), path.stat().st_mtime_ns) for path in self.paths), self.unit, self.meshing)

    @cached_property
    def patches(self) -> Index:
        """Number (facets,) of each facet's smooth patch."""
        return self.body.skin.patches(self.feature_angle)

    @cached_property
    def _spaces(self) -> list[Space]:
        return spaces(self.body.skin, self.patches, self.caps)

    @cached_property
    def _naming(self) -> tuple[dict[str, Mask], dict[str, Space], tuple[str, ...]]:
        """Name -> facets of all faces; name -> cavity; notes."""
        body, notes = self.body, list(self.body.notes)
        inner = np.zeros(body.skin.count, dtype=bool)
        for space in self._spaces:
            inner |= space.facets
        faces = named_facets(body.skin, ~inner, self.patches, body.sets, self.faces)
        for name, mask in faces.items():
            if mask[inner].any() and mask[~inner].any():
                raise MeshError(
                    f"face '{name}' lies partly outside and partly in a cavity: choose with a second condition"
                )
        taken = np.zeros_like(inner)
        for mask in faces.values():
            taken |= mask
        for name in body.adopted:
            mask = body.sets[name]
            if name in faces or not mask.any():
                continue
            if (mask & taken).any() or (mask[inner].any() and mask[~inner].any()):
                why = "another face has some of its facets" if (mask & taken).any() else "it is inside and outside"
                notes.append(f"the file's set '{name}' is no face: {why}")
                continue
            faces[name] = mask
            taken |= mask
        cavities = {}
        for number, space in enumerate(self._spaces):
            own = [name for name, mask in faces.items() if np.array_equal(mask, space.facets)]
            name = own[0] if own else "cavity" if len(self._spaces) == 1 else f"cavity_{number + 1}"
            left = space.facets & ~taken
            if not own and left.any() and name in faces:
                raise MeshError(f"the face '{name}' bears the name of a cavity that it does not cover: choose another")
            if left.any():
                faces[name] = left
            cavities[name] = space
        outer = ~inner & ~taken
        if outer.any():
            if "outer" in faces:
                raise MeshError(
                    "the face 'outer' does not cover all of the outside that has no name: choose another name"
                )
            faces["outer"] = outer
        for name in self.caps:
            if name in faces:
                raise MeshError(f"cap '{name}' bears the name of a face")
        return faces, cavities, tuple(notes)

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh with its named faces and caps."""
        faces, cavities, _ = self._naming
        caps = {name: blocks for space in cavities.values() for name, blocks in space.caps.items()}
        named = {name: self.body.skin.part(mask) for name, mask in faces.items()}
        return Mesh(self.body.points, self.body.cells, MappingProxyType(named), caps=MappingProxyType(caps))

    @property
    def facets(self) -> Mapping[str, Mask]:
        """Name -> facets (count,) of `body.skin`."""
        return self._naming[0]

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader should know about the import."""
        return self._naming[2]

    @property
    def cavities(self) -> tuple[str, ...]:
        """The cavities found."""
        return tuple(self._naming[1])

    def cavity_faces(self, cavity: str) -> tuple[str, ...]:
        """Return the faces of a cavity's wall and the caps that close it."""
        faces, cavities, _ = self._naming
        space = cavities[cavity]
        return (*(name for name, mask in faces.items() if (mask & space.facets).any()), *space.caps)

    @property
    def volumes(self) -> Mapping[str, float]:
        """Volume of each cavity as meshed, mm³."""
        return {name: space.volume for name, space in self._naming[1].items()}

    @property
    def cavity_volume(self) -> float:
        """Volume of the first cavity as meshed, mm³; 0 without a cavity."""
        return next(iter(self.volumes.values()), 0.0)

    def openings(self) -> list[str]:
        """Return where the body has openings with space behind them, as text, the largest space first."""
        return [describe(opening) for opening in openings(self.body.skin, self.patches)]

    def require_cavity(self) -> None:
        """Raise GeometryError if there is no cavity, with the openings that a cap could close."""
        if not self.cavities:
            found = self.openings()[:3]
            hint = (
                f"caps could close it at {'; or at '.join(found)}" if found else "nor an opening with space behind it"
            )
            raise GeometryError(f"{self._files}: the solid has no closed cavity; {hint}")

    @property
    def _files(self) -> str:
        return ", ".join(f"'{path}'" for path in self.paths)

    @property
    def face_names(self) -> tuple[str, ...]:
        """Names of all faces."""
        return tuple(self.facets)

    @property
    def domains(self) -> tuple[str, ...]:
        """Names of the material domains in the file."""
        return self.mesh.domains

    @property
    def bending_walls(self) -> Mapping[str, float]:
        """None are known."""
        return {}

    @property
    def default_size(self) -> float:
        """Largest edge of the mesh that was made, or the mean edge of the cells in the file, mm."""
        return self.body.size

    @property
    def axis(self) -> tuple[float, float, float]:
        """Along the longest side of the body."""
        along = int(np.argmax(np.ptp(self.body.points, axis=0)))
        return (float(along == 0), float(along == 1), float(along == 2))

    def shape(self) -> occ.Shape:
        """Return the CAD solid; raises GeometryError for a file that holds none."""
        if self.paths[0].suffix.lower() not in CAD_SUFFIXES:
            raise GeometryError(f"{self._files}: holds no CAD solid")
        return occ.read_cad(self.paths[0]).shape

    def dimensions(self) -> tuple[Dimension, ...]:
        """Return the sides of the bounding box, which the file gives."""
        extent = np.ptp(self.body.points, axis=0)
        return tuple(
            Dimension(f"extent_{axis}", axis, float(value), "length", True, f"extent along {axis}")
            for axis, value in zip("xyz", extent, strict=True)
        )
