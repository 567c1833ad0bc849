"""A periodic cell at finite strain: u = H X + v with v periodic in the plane, and the mean stress that H takes.

The nodal displacements are u = T v + M h, with one v for all nodes that are images of each other and the four numbers h
of the mean displacement gradient H in the plane as unknowns of their own. So the residuals are T' f and M' f of the
ordinary assembly, and so is the tangent: M' f is the mean first Piola-Kirchhoff stress times the area of the cell
(Hill's condition), and eliminating v leaves its exact derivative dP/dF. T has a single 1 in each row, so that T' K T is
the assembled tangent with its entries renumbered: the pattern is found once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray

from pneumorph.errors import InputError, MeshError, NotConvergedError
from pneumorph.materials import Material
from pneumorph.mechanics.body import Body
from pneumorph.mechanics.linear import linear_solver
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_PARTS = ("xx", "xy", "yx", "yy")  # of H, row by row
_ITERATIONS = 15
_TOLERANCE = 1e-8


@dataclass(frozen=True, eq=False)
class Mean:
    """Mean state of a cell.

    gradient (2, 2): F in the plane. force (2, 2): first Piola-Kirchhoff stress per width of the sheet, thickness
    included, N/mm. energy: stored per area, mJ/mm². tangent (4, 4): d force / d F, both row by row, N/mm.
    position (nodes, 3): deformed nodes, mm; modes: pressure modes of the body.
    """

    gradient: Array
    force: Array
    energy: float
    tangent: Array
    position: Array = field(repr=False)
    modes: list[Array] = field(repr=False)


class PeriodicCell:
    """A cell that repeats along x and y; its bottom and top are free, but for a plane of symmetry at the bottom.

    mesh:      of one cell, whose nodes at one end are images of those at the other (`mesh.flat_sheet.mesh_unit_cell`);
               its ends need not be straight.
    lengths:   period along x and y, mm. materials: domain -> material.
    mirrored:  z = 0 is the middle of the sheet: forces and energies are those of both halves.

    Raises MeshError for ends that do not match, InputError for a domain without material or other lengths.
    """

    def __init__(
        self, mesh: Mesh, lengths: tuple[float, float], materials: Mapping[str, Material], *, mirrored: bool = False
    ):
        if not all(0.0 < length < np.inf for length in lengths):
            raise InputError(f"periodic cell: lengths = {lengths!r}, allowed: two finite numbers of mm more than 0")
        for domain in mesh.domains:
            if domain not in materials:
                raise InputError(f"no material for the domain '{domain}' of the cell")
        self.mesh = mesh
        self.body = Body(mesh, dict(materials))
        self.lengths = np.array(lengths, dtype=np.float64)
        self._copies = 2.0 if mirrored else 1.0
        self._number = self._numbered(_masters(mesh.points, self.lengths), mirrored)
        self._free = int(self._number.max()) + 1
        self._mean = self._carried()
        self._target, self._factor, self._pattern = self._renumbered()
        self._scale = max(item.shear_modulus for item in materials.values()) * float(self.lengths.max()) ** 2
        self._linear = linear_solver()

    @property
    def area(self) -> float:
        """Area of the cell in the plane, mm²."""
        return float(np.prod(self.lengths))

    def rest(self) -> Mean:
        """Return the state without strain; its tangent is the initial one."""
        zero = np.zeros((2, 2))
        still = Mean(np.eye(2), zero, 0.0, np.zeros((4, 4)), self.mesh.points, self.body.zero_pressure())
        return self.stretched(still, dict.fromkeys(_PARTS, 0.0))

    def stretched(self, start: Mean, given: Mapping[str, float]) -> Mean:
        """Return the equilibrium next to `start` at a mean displacement gradient.

        given: entries of H = F - 1 ('xx', 'xy', 'yx', 'yy'); in those left out the mean stress is zero. At least one
        of 'xy' and 'yx' must be given: a rotation costs nothing.

        Raises InputError for other names, NotConvergedError where Newton's method finds no equilibrium.
        """
        if unknown := set(given) - set(_PARTS):
            raise InputError(f"periodic cell: '{sorted(unknown)[0]}' is given, allowed: {', '.join(_PARTS)}")
        if not {"xy", "yx"} & set(given):
            raise InputError("periodic cell: neither 'xy' nor 'yx' is given: the cell is free to rotate")
        fixed = np.array([part in given for part in _PARTS])
        wanted = np.array([given.get(part, 0.0) for part in _PARTS]) + np.eye(2).ravel()
        loose = np.flatnonzero(~fixed)
        position, modes, gradient = start.position, start.modes, start.gradient
        for iteration in range(_ITERATIONS):
            assembly = self.body.assemble(position, modes)
            inner, outer = self._gathered(assembly.force), self._mean.T @ assembly.force
            missed = np.where(fixed, wanted - gradient.ravel(), 0.0)
            error = float(np.hypot(np.linalg.norm(inner), np.linalg.norm(outer[loose]))) / self._scale
            if not np.isfinite(error):
                break
            coupling, followed, tangent = self._condense(assembly.values)
            if error < _TOLERANCE and iteration > 0:
                energy = self.body.energies(position, modes)[1]
                share = self._copies / self.area
                return Mean(gradient, share * outer.reshape(2, 2), share * energy, share * tangent, position, modes)
            first = self._linear.solve(-inner)
            step = missed.copy()
            if len(loose):
                # the forces on the loose entries once v has followed
                right = -(outer + coupling.T @ first) - tangent @ missed
                step[loose] = np.linalg.solve(tangent[np.ix_(loose, loose)], right[loose])
            move = (self._spread(first - followed @ step) + self._mean @ step).reshape(-1, 3)
            if self.body.smallest_volume_ratio(position + move, fine=False) <= 0.0:
                break
            modes = [q + d for q, d in zip(modes, self.body.pressure_step(assembly.gains, move), strict=True)]
            position, gradient = position + move, gradient + step.reshape(2, 2)
        asked = ", ".join(f"{part} = {value:.4g}" for part, value in given.items())
        raise NotConvergedError(f"periodic cell: no equilibrium at H {asked}")

    def path(
        self, steps: Sequence[Mapping[str, float]], *, start: Mean | None = None, smallest: float = 1 / 16
    ) -> list[Mean]:
        """Return the states at a row of mean displacement gradients; a step that fails is halved, down to `smallest`.

        start: where to go on from, the state without strain if left out. Every step gives the same entries of H.
        Raises NotConvergedError.
        """
        result: list[Mean] = []
        last = self.rest() if start is None else start
        for given in steps:
            begin = {part: (last.gradient - np.eye(2)).ravel()[_PARTS.index(part)] for part in given}
            done, width = 0.0, 1.0
            while done < 1.0:
                share = min(1.0, done + width)
                try:
                    last = self.stretched(last, {p: begin[p] + share * (given[p] - begin[p]) for p in given})
                except NotConvergedError:
                    width /= 2.0
                    if width < smallest:
                        raise
                else:
                    done = share
            result.append(last)
        return result

    def _gathered(self, force: Array) -> Array:
        """Return T' f."""
        kept = self._number >= 0
        return np.bincount(self._number[kept], weights=force[kept], minlength=self._free).astype(np.float64)

    def _spread(self, free: Array) -> Array:
        """Return T v."""
        return np.where(self._number >= 0, free[self._number], 0.0)

    def _condense(self, values: Array) -> tuple[Array, Array, Array]:
        """Factor T' K T; return T' K M (v, 4), its solution, and the tangent of M' f with v eliminated (4, 4)."""
        pattern = self.body.pattern
        reduced = sparse.csr_matrix((self._free, self._free))
        data = np.bincount(self._target, weights=self._factor * values, minlength=len(self._pattern[0]) + 1)[:-1]
        reduced.data, (reduced.indices, reduced.indptr) = data, self._pattern
        reduced.has_sorted_indices = True
        self._linear.factorise(reduced)
        upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(self.body.unknowns,) * 2)
        stiff = upper @ self._mean + upper.T @ self._mean - upper.diagonal()[:, None] * self._mean
        coupling = np.stack([self._gathered(column) for column in stiff.T], axis=1)
        followed = self._linear.solve(coupling)
        return coupling, followed, self._mean.T @ stiff - coupling.T @ followed

    def _numbered(self, masters: Integers, mirrored: bool) -> Integers:
        """Return for each displacement (nodes * 3,) the number of its unknown in v, -1 where it is held."""
        points = self.mesh.points
        heads = np.unique(masters)
        held = np.zeros((len(points), 3), dtype=bool)
        corner = heads[np.argmin(np.abs(points[heads]).sum(axis=1))]
        held[corner] = True
        if mirrored:
            held[corner, 2] = False
            held[points[:, 2] < 1e-9 * self.mesh.size, 2] = True
        number = np.full((len(points), 3), -1, dtype=np.int64)
        free = ~held[heads]
        table = np.full(free.shape, -1, dtype=np.int64)
        table[free] = np.arange(free.sum())
        number[:] = table[np.searchsorted(heads, masters)]
        return number.ravel()

    def _carried(self) -> Array:
        """Return M (nodes * 3, 4): what H alone does to the nodes."""
        points = self.mesh.points
        result = np.zeros((len(points), 3, 4))
        for i in (0, 1):
            for j in (0, 1):
                result[:, i, 2 * i + j] = points[:, j]
        return result.reshape(-1, 4)

    def _renumbered(self) -> tuple[Integers, Array, tuple[NDArray[np.int32], NDArray[np.int32]]]:
        """Return where the values of the body's tangent go in that of v, with which factor, and its pattern.

        Values of held unknowns go behind the last. Two different nodes that are images of each other meet in a diagonal
        entry: the one stored value counts for both triangles.
        """
        pattern = self.body.pattern
        rows = np.repeat(np.arange(self.body.unknowns), np.diff(pattern.indptr))
        a, b = self._number[rows], self._number[pattern.indices]
        keys = np.minimum(a, b) * self._free + np.maximum(a, b)
        keys[(a < 0) | (b < 0)] = self._free**2
        used, target = np.unique(np.append(keys, self._free**2), return_inverse=True)
        used = used[:-1]
        indptr = np.searchsorted(used, np.arange(self._free + 1) * self._free).astype(np.int32)
        factor = np.where((a == b) & (rows != pattern.indices), 2.0, 1.0)
        return target.ravel()[:-1], factor, ((used % self._free).astype(np.int32), indptr)


def _masters(points: Array, lengths: Array) -> Integers:
    """Return for each node the one that stands for it and its images, whole periods away."""
    places = np.column_stack([(points[:, :2] - points[:, :2].min(axis=0)) / lengths, points[:, 2] / lengths.max()])
    small = 1e-6
    places[:, :2] -= np.floor(places[:, :2] + small)
    # neighbouring cells of the rounding are one place: nodes differ in their last digits only
    _, first, group = np.unique(np.round(places / (10.0 * small)), axis=0, return_index=True, return_inverse=True)
    masters: Integers = first[group.ravel()]
    for axis in (0, 1):
        ends = points[:, axis] < points[masters, axis] - small * lengths[axis]
        ends |= points[:, axis] > points[masters, axis] + small * lengths[axis]
        if not ends.any():
            raise MeshError(f"periodic cell: no nodes are images of each other along {'xy'[axis]}")
    return masters
