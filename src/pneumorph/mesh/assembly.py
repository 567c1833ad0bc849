"""Several bodies in one mesh: each turned and shifted to its place, its names led by that of the part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pneumorph.errors import MeshError
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh

Array = NDArray[np.float64]
Vector = tuple[float, ...]


def name_of(part: str, name: str) -> str:
    """Return what a face, domain or cavity of a part is called in the whole; '' is the main body, with its own names.

    >>> name_of("arm", "skin"), name_of("", "tip")
    ('arm.skin', 'tip')
    """
    return f"{part}.{name}" if part else name


@dataclass(frozen=True)
class Turn:
    """A turn by the right-hand rule.

    axis:  direction of the axis, (3,), not zero.
    angle: rad.
    about: a point on the axis, (3,), mm.

    Raises MeshError for an axis without direction, or numbers that are not finite.
    """

    axis: Vector
    angle: float
    about: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name, values in (("axis", self.axis), ("about", self.about)):
            if len(values) != 3 or not np.isfinite(values).all():
                raise MeshError(f"turn: {name} = {values}: expected 3 finite numbers")
        if not any(self.axis):
            raise MeshError(f"turn: axis = {self.axis}: expected a direction, not all zero")
        if not np.isfinite(self.angle):
            raise MeshError(f"turn: angle = {self.angle!r} rad: expected a finite number")

    def __call__(self, points: Array) -> Array:
        """Return turned points (n, 3), mm."""
        axis, about = np.asarray(self.axis, dtype=float), np.asarray(self.about, dtype=float)
        turn = Rotation.from_rotvec(self.angle * axis / np.linalg.norm(axis))
        return np.asarray(about + turn.apply(points - about))


@dataclass(frozen=True)
class Placement:
    """Where a body stands: turns in their order, and then a shift (3,), mm.

    A plane body is turned about axes along z and shifted in its plane, one with axial symmetry only shifted along y.
    """

    turns: tuple[Turn, ...] = ()
    shift: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if len(self.shift) != 3 or not np.isfinite(self.shift).all():
            raise MeshError(f"shift = {self.shift}: expected 3 finite lengths")

    def __call__(self, mesh: Mesh) -> Mesh:
        """Return the mesh in its place; raises MeshError for a way that leaves the plane of the mesh."""
        self._check(mesh)
        points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dimension)))
        for turn in self.turns:
            points = turn(points)
        moved = points + np.asarray(self.shift)
        return replace(mesh, points=np.ascontiguousarray(moved[:, : mesh.dimension]))

    def _check(self, mesh: Mesh) -> None:
        if mesh.space == "3d":
            return
        if self.shift[2] or any(turn.axis[0] or turn.axis[1] for turn in self.turns):
            raise MeshError("the body is moved out of its plane x, y: turn it about z, and shift it along x and y")
        if mesh.space == "axisymmetric" and (self.shift[0] or self.turns):
            raise MeshError("a body with axial symmetry is moved off its axis: shift it along y only")


def assembled(main: Mesh, parts: Mapping[str, Mesh]) -> Mesh:
    """Return bodies side by side in one mesh, no node shared.

    The main body keeps its node numbers and names; domains, faces, walls and caps of the others are called 'part.name'.
    Raises MeshError for a part of another space than the main body.
    """
    points, blocks = [main.points], list(main.blocks)
    faces, caps, walls = dict(main.faces), dict(main.caps), dict(main.bending_walls)
    first = len(main.points)
    for part, mesh in parts.items():
        if mesh.space != main.space:
            raise MeshError(f"part '{part}' is {mesh.space}, the main body {main.space}: expected the same")
        points.append(mesh.points)
        blocks += [CellBlock(b.kind, name_of(part, b.domain), b.nodes + first) for b in mesh.blocks]
        for whole, own in ((faces, mesh.faces), (caps, mesh.caps)):
            for name, sides in own.items():
                whole[name_of(part, name)] = tuple(FaceBlock(b.kind, b.nodes + first) for b in sides)
        walls |= {name_of(part, name): thickness for name, thickness in mesh.bending_walls.items()}
        first += len(mesh.points)
    return Mesh(
        np.concatenate(points), tuple(blocks), MappingProxyType(faces), main.space, MappingProxyType(walls),
        MappingProxyType(caps),
    )  # fmt: skip
