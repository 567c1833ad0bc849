"""Free rigid bodies with mass, carried by the nodes of a frame as affine bodies.

A body moves as the corners of a simplex do: x(X) = sum_a N_a(X) x_a with the barycentric coordinates N of the frame, so
that all is linear in nodal displacements, as in affine-body dynamics (Lan, Kaufman, Li, Jiang and Yang, ACM Trans.
Graph. 41 (2022) 67). What keeps the frame rigid is in `rigidity`. The frame is the uniform simplex that has the body's
mass, centre and second moments (Routh, Elementary Rigid Dynamics, ch. 1, on equimomental bodies): its consistent mass
matrix, m / ((d + 1)(d + 2)) (1 + delta_ab), is exact for every affine motion of the body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.mechanics.contact.obstacles import Faceted
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class FreeBody:
    """A rigid body that moves as forces make it: weight, contact, and loads or supports on its name.

    name:    how contacts, loads, supports, histories and pictures call it, like a face of the mesh.
    surface: its closed surface where it starts: a `Block`, `Cylinder`, `SurfaceFile` ... without a motion.
    mass:    tonne; in the plane, of the 1 mm that is modelled. It is spread evenly over the enclosed volume.
    density: tonne/mm3; in place of the mass.

    Raises InputError unless one of mass and density is given, more than 0, and for a surface that is moved.
    """

    name: str
    surface: Faceted
    mass: float | None = field(default=None, kw_only=True)
    density: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        owner = f"free body '{self.name}'"
        if (self.mass is None) == (self.density is None):
            raise InputError(f"{owner}: mass = {self.mass}, density = {self.density}: expected one of the two")
        for what, value, unit in (("mass", self.mass, "tonne"), ("density", self.density, "tonne/mm3")):
            if value is not None and not 0.0 < value < float("inf"):
                raise InputError(f"{owner}: {what} = {value} {unit}, allowed: more than 0")
        if not isinstance(self.surface, Faceted):
            allowed = ", ".join(kind.__name__ for kind in get_args(Faceted))
            raise InputError(f"{owner}: surface of kind {type(self.surface).__name__}, allowed: {allowed}")
        if self.surface.motion is not None:
            raise InputError(f"{owner}: a body with a mass moves by itself; leave the motion of its surface out")


@dataclass(frozen=True, eq=False)
class Frame:
    """A free body on a mesh.

    nodes (d + 1,): of the mesh; rest (d + 1, d): where they start, mm.
    points (n, d), facets (m, d): surface at the start; weights (n, d + 1): barycentric coordinates of its points.
    mass: tonne; volume: of the simplex, mm3; slopes (d + 1, d): gradients of N_a, 1/mm.
    """

    name: str
    nodes: Integers
    rest: Array
    points: Array
    facets: Integers
    weights: Array
    mass: float
    volume: float
    slopes: Array

    @property
    def matrix(self) -> Array:
        """Consistent mass matrix (d + 1, d + 1), tonne."""
        count = len(self.nodes)
        result: Array = self.mass / (count * (count + 1)) * (np.eye(count) + 1.0)
        return result

    def gradient(self, position: Array) -> Array:
        """Return dx/dX (d, d) at positions (nodes, d) of all nodes of the mesh."""
        result: Array = position[self.nodes].T @ self.slopes
        return result

    def surface(self, position: Array) -> Array:
        """Return the points (n, d) of its surface, mm, at positions (nodes, d) of all nodes of the mesh."""
        result: Array = self.weights @ position[self.nodes]
        return result


def with_frames(mesh: Mesh, bodies: Sequence[FreeBody]) -> tuple[Mesh, tuple[Frame, ...]]:
    """Return the mesh with nodes for free bodies in place of those it has, and their frames.

    Raises InputError for axial symmetry, a name that is taken, a surface that is not closed.
    """
    if mesh.frames:
        mesh = replace(mesh, points=mesh.points[: mesh.solid], frames={})
    if not bodies:
        return mesh, ()
    if mesh.space == "axisymmetric":
        raise InputError(f"free body '{bodies[0].name}': a model with axial symmetry takes none")
    names = [body.name for body in bodies]
    for name in names:
        if name in mesh.faces or names.count(name) > 1:
            raise InputError(f"free body '{name}': the name is that of a face, or of another body")
    count, d = len(mesh.points), mesh.dimension
    frames = tuple(
        _frame(body, np.arange(count + i * (d + 1), count + (i + 1) * (d + 1)), d) for i, body in enumerate(bodies)
    )
    points = np.concatenate([mesh.points, *(frame.rest for frame in frames)])
    return replace(mesh, points=points, frames={frame.name: frame.nodes for frame in frames}), frames


def moments(points: Array, facets: Integers, owner: str) -> tuple[float, Array, Array]:
    """Return volume (mm3; in the plane of 1 mm), centre (d,) and mean of (x - c)(x - c)' (d, d) of what facets enclose.

    By simplices from a point to each facet: int x x' = V / ((d + 1)(d + 2)) (sum p p' + (sum p)(sum p)') over its
    corners p, with V positive or negative. Raises InputError, naming the owner, for a surface that is not closed.
    """
    _check_closed(points, facets, owner)
    d = points.shape[1]
    origin = points.mean(axis=0)
    corners = points[facets] - origin
    volumes = np.linalg.det(corners) / (2.0 if d == 2 else 6.0)
    volume = float(volumes.sum())
    if abs(volume) <= 1e-9 * float(np.ptp(points, axis=0).max()) ** d:
        raise InputError(f"{owner}: its surface encloses no volume")
    sums = corners.sum(axis=1)
    centre = volumes @ sums / ((d + 1) * volume)
    products = np.einsum("mki,mkj->mij", corners, corners) + sums[:, :, None] * sums[:, None, :]
    mean = np.einsum("m,mij->ij", volumes, products) / ((d + 1) * (d + 2) * volume)
    return abs(volume), origin + centre, mean - np.outer(centre, centre)


def _frame(body: FreeBody, nodes: Integers, dimension: int) -> Frame:
    owner, d = f"free body '{body.name}'", dimension
    points, facets = body.surface.facets(d)
    volume, centre, spread = moments(points, facets, owner)
    mass = body.mass if body.mass is not None else float(body.density or 0.0) * volume
    values, axes = np.linalg.eigh(spread)
    if values[0] <= 1e-12 * values[-1]:
        raise InputError(f"{owner}: its surface encloses a body without thickness")
    # unit vectors to the corners of a regular simplex have sum v v' = (d + 1) / d
    rest = centre + _regular(d) @ (axes * np.sqrt(d * (d + 2) * values) @ axes.T)
    ones = np.linalg.inv(np.column_stack([np.ones(d + 1), rest]))  # N(X) = (1, X) times it
    weights = np.column_stack([np.ones(len(points)), points]) @ ones
    size = abs(float(np.linalg.det(rest[1:] - rest[0]))) / (2.0 if d == 2 else 6.0)
    return Frame(body.name, nodes, rest, points, facets, weights, mass, size, ones[1:].T.copy())


def _regular(d: int) -> Array:
    """Return the corners (d + 1, d) of a regular simplex with its centre at 0, at distance 1 from it."""
    if d == 2:
        angle = 2.0 * np.pi * np.arange(3) / 3.0
        return np.column_stack([np.cos(angle), np.sin(angle)])
    return np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / np.sqrt(3.0)


def _check_closed(points: Array, facets: Integers, owner: str) -> None:
    """Raise an InputError unless each edge (end point in the plane) is met once in each direction."""
    if points.shape[1] == 2:
        ends = np.column_stack([facets.ravel(), np.tile([0, 1], len(facets))])  # point, whether an edge ends there
        turned = np.column_stack([ends[:, 0], 1 - ends[:, 1]])
    else:
        ends = np.concatenate([facets[:, pair] for pair in ((0, 1), (1, 2), (2, 0))])
        turned = ends[:, ::-1]
    found, counts = np.unique(ends, axis=0, return_counts=True)
    other, back = np.unique(turned, axis=0, return_counts=True)
    if np.array_equal(found, other) and np.array_equal(counts, back):
        return
    there = {tuple(end) for end in ends.tolist()}
    lonely = [end for end in turned.tolist() if tuple(end) not in there] or ends.tolist()
    where = ", ".join(f"{x:.4g}" for x in points[lonely[0] if points.shape[1] == 3 else lonely[0][:1]].mean(axis=0))
    raise InputError(
        f"{owner}: its surface is not closed, or not all of its facets are wound the same way: {len(lonely)} open "
        f"edges, one at ({where}) mm"
    )
