"""The deformable body: element arrays of a mesh with its materials, and what they add up to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.materials import Material
from pneumorph.materials.material import PointLaw
from pneumorph.materials.prony import ViscousStep
from pneumorph.mechanics import kernels
from pneumorph.mechanics.contact.rigidity import Rigidity
from pneumorph.mechanics.pattern import Pattern
from pneumorph.mechanics.tables import CellTable, cell_table
from pneumorph.mechanics.volumetric import local_pressure, split_bulk
from pneumorph.mesh.mesh import CellBlock, Mesh
from pneumorph.threads import parallel, slices

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Piece:
    """One thread's cells of one block.

    slots: where their matrices go in the pattern; bulk: moduli of pressure modes and points, see `volumetric`.
    law: the material at the quadrature points of the cells.
    """

    cells: NDArray[np.int64]
    slots: NDArray[np.int32]
    material: Material
    law: PointLaw
    table: CellTable
    bulk: tuple[float, float]
    sizes: tuple[tuple[int, ...], ...]
    block: int
    part: slice


@dataclass(eq=False)
class Assembly:
    """What one pass over the elements gives.

    force (nodes * d,): internal force with the pressure condensed; values: tangent in the pattern's order;
    gains: for each piece K M^-1 r_q (cells, k) and K M^-1 B' (cells, k, d, n), for the pressure update.
    stresses: for each piece S and U' (cells, q, 7) and the moduli dS/dE (cells, q, 21), for `carry`.
    """

    force: Array
    values: Array
    gains: list[tuple[Array, Array]]
    stresses: list[tuple[Array, Array]]


class Body:
    """Elements of a mesh, ready to be integrated on all threads.

    pressure: 'linear' (four modes in a solid cell, three in a plane one; discontinuous) or 'constant'.
    The pressure state is a list with one array (cells, modes) for each block of the mesh.
    rigidity: of the frames of free bodies on the mesh; lists of stresses end with theirs.
    """

    def __init__(
        self, mesh: Mesh, materials: dict[str, Material], pressure: str = "constant", rigidity: Rigidity | None = None
    ):
        self.mesh = mesh
        self.rigidity = rigidity
        self.dimension = mesh.dimension
        coupled = [block.nodes for block in mesh.blocks]
        coupled += [cap.nodes for blocks in mesh.caps.values() for cap in blocks]  # they join nodes of no common cell
        coupled += [nodes[None] for nodes in mesh.frames.values()]
        self.pattern = Pattern.of_cells(len(mesh.points), self.dimension, coupled)
        self.unknowns = mesh.points.size
        self.tables = [cell_table(block.kind, pressure) for block in mesh.blocks]
        self._materials = [materials[block.domain] for block in mesh.blocks]
        self._teams = self._divide()

    def _divide(self) -> list[list[Piece]]:
        """Return, for each thread, its pieces; each thread adds into arrays of its own."""
        teams: list[list[Piece]] = []
        for i, (block, table, material) in enumerate(zip(self.mesh.blocks, self.tables, self._materials, strict=True)):
            sizes = kernels.sizes_of(
                block.nodes.shape[1], self.dimension, table.modes.shape[1], self.mesh.space == "axisymmetric"
            )
            for thread, part in enumerate(slices(len(block.nodes))):
                cells = np.ascontiguousarray(block.nodes[part], dtype=np.int64)
                law = material.at(quadrature_places(self.mesh, cells, table))
                bulk = split_bulk(material)
                piece = Piece(cells, self.pattern.slots(cells), material, law, table, bulk, sizes, i, part)
                if thread == len(teams):
                    teams.append([])
                teams[thread].append(piece)
        return teams

    def zero_pressure(self) -> list[Array]:
        """Return the pressure modes of the reference state."""
        pairs = zip(self.mesh.blocks, self.tables, strict=True)
        return [np.zeros((len(block.nodes), table.modes.shape[1])) for block, table in pairs]

    def assemble(
        self, position: Array, pressure: list[Array], tangent: bool = True, *, memory: list[Array] | None = None,
        seconds: float = 0.0, carried: list[Array] | None = None,
    ) -> Assembly:  # fmt: skip
        """Return internal forces and, with `tangent`, the stiffness at deformed nodes (nodes, d).

        memory, seconds: what viscous materials remember (see `State`), and the time since; none: no time limits them.
        carried: stresses of the tangent's geometric part (see `carry`), one array a block; None takes the present ones.
        """
        points = self.mesh.points

        def work(team: list[Piece]) -> Assembly:
            result = Assembly(np.zeros(self.unknowns), np.zeros(self.pattern.indptr[-1] if tangent else 0), [], [])
            for piece in team:
                table = piece.table
                c, ratio, _ = self._deformation(piece, position)
                stress, moduli = piece.law.stress_and_tangent(c.reshape(-1, 6))
                step = _viscous_step(piece, memory, stress, seconds)
                if step is not None:
                    stress = step.factor * stress + step.history
                    moduli *= step.factor
                own, moduli = _with_local(piece, stress, ratio), moduli.reshape(*ratio.shape, 21)
                count, modes, nodes = len(piece.cells), table.modes.shape[1], piece.cells.shape[1]
                constant = np.zeros((count, modes) if tangent else (0, modes))
                gain = np.zeros((count if tangent else 0, modes, self.dimension, nodes))
                kernels.integrate(
                    piece.sizes, points, position, piece.cells, table.shape, table.gradient, table.weight, table.modes,
                    *piece.bulk, pressure[piece.block][piece.part],
                    stress.reshape(count, -1, 6), moduli, own if carried is None else carried[piece.block][piece.part],
                    piece.slots, self.pattern.indptr, result.force, result.values, constant, gain, tangent,
                )  # fmt: skip
                result.gains.append((constant, gain))
                result.stresses.append((own, moduli))
            return result

        parts = parallel(work, self._teams)
        total = parts[0]
        for part in parts[1:]:
            total.force += part.force
            total.values += part.values
            total.gains += part.gains
            total.stresses += part.stresses
        if self.rigidity is not None:
            self.rigidity.add_force(position, total.force)
            if tangent:
                stress = self.rigidity.stresses(position) if carried is None else carried[-1]
                rows, columns, values = self.rigidity.tangent(position, stress)
                np.add.at(total.values, self.pattern.places(rows, columns), values)
        return total

    def zero_memory(self) -> list[Array]:
        """Return what the materials remember of the reference state: nothing, or overstresses of zero."""
        result = []
        for block, table, material in zip(self.mesh.blocks, self.tables, self._materials, strict=True):
            terms = 0 if material.prony is None else len(material.prony.g) + 1
            result.append(np.zeros((terms, len(block.nodes) if terms else 0, len(table.weight), 6)))
        return result

    def remember(self, position: Array, memory: list[Array], seconds: float) -> list[Array]:
        """Return the memory after an increment that ends at deformed nodes; in no time all overstress is gone."""
        result = [np.zeros_like(item) for item in memory]
        for piece in (piece for team in self._teams for piece in team):
            if piece.material.prony is None:
                continue
            c, *_ = self._deformation(piece, position)
            stress, _ = piece.law.stress_and_tangent(c.reshape(-1, 6))
            new = result[piece.block][:, piece.part]
            new[0] = stress.reshape(c.shape)
            step = _viscous_step(piece, memory, stress, seconds)
            if step is not None:
                new[1:] = step.overstress.reshape(-1, *c.shape)
        return result

    def overstress_work(self, positions: tuple[Array, Array], memories: tuple[list[Array], list[Array]]) -> float:
        """Return the work of the overstresses from one state to the next, mJ, by the trapezoidal rule."""
        total = 0.0
        factors = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])  # each shear stands twice in S : dC
        for piece in (piece for team in self._teams for piece in team):
            if piece.material.prony is None:
                continue
            before, after = (self._deformation(piece, position)[0] for position in positions)
            stress = sum(memory[piece.block][1:, piece.part].sum(axis=0) for memory in memories)
            volumes = cell_volumes(self.mesh, self.mesh.blocks[piece.block])[piece.part]
            total += float(np.einsum("eqi,eqi,i,eq->", stress, after - before, factors, volumes)) / 4.0
        return total

    def pressure_step(self, gains: list[tuple[Array, Array]], step: Array) -> list[Array]:
        """Return the change of the pressure modes that goes with a displacement step (nodes, d)."""
        result = self.zero_pressure()
        pieces = [piece for team in self._teams for piece in team]
        for piece, (constant, gain) in zip(pieces, gains, strict=True):
            moved = np.ascontiguousarray(step[piece.cells].transpose(0, 2, 1)).reshape(len(piece.cells), -1, 1)
            change = np.matmul(gain.reshape(*gain.shape[:2], -1), moved)[:, :, 0]
            result[piece.block][piece.part] = constant + change
        return result

    def stresses(self, position: Array, memory: list[Array]) -> list[Array]:
        """Return S and U'(J) (cells, q, 7) of each block in a state, MPa, without pressure modes; then frames' S."""
        result = self._room()
        for piece in (piece for team in self._teams for piece in team):
            c, ratio, _ = self._deformation(piece, position)
            stress, _ = piece.law.stress_and_tangent(c.reshape(-1, 6))
            if piece.material.prony is not None:
                stress = stress + memory[piece.block][1:, piece.part].sum(axis=0).reshape(-1, 6)
            result[piece.block][piece.part] = _with_local(piece, stress, ratio)
        if self.rigidity is not None:
            result.append(self.rigidity.stresses(position))
        return result

    def _room(self) -> list[Array]:
        pairs = zip(self.mesh.blocks, self.tables, strict=True)
        return [np.empty((len(block.nodes), len(table.weight), 7)) for block, table in pairs]

    def carry(self, assembly: Assembly, position: Array, step: Array) -> list[Array]:
        """Return the stresses (cells, q, 7) of each block after a step (nodes, d), to first order in the step."""
        result = self._room()
        numbers = iter(assembly.stresses)
        jobs = [[(piece, *next(numbers)) for piece in team] for team in self._teams]

        def work(team: list[tuple[Piece, Array, Array]]) -> None:
            for piece, stress, moduli in team:
                carried, table = stress.copy(), piece.table
                kernels.advance(
                    piece.sizes, self.mesh.points, position, step, piece.cells, table.shape, table.gradient,
                    piece.bulk[1], moduli, carried,
                )  # fmt: skip
                result[piece.block][piece.part] = carried

        parallel(work, jobs)
        if self.rigidity is not None:
            result.append(self.rigidity.carried(position, step))
        return result

    def energies(self, position: Array, pressure: list[Array]) -> tuple[float, float]:
        """Return (condensed energy max over q of L(u, q), mixed energy L(u, q)), mJ."""

        def work(team: list[Piece]) -> Array:
            total = np.zeros(2)
            for piece in team:
                table = piece.table
                c, *_ = self._deformation(piece, position)
                density = piece.law.energy(c.reshape(-1, 6)).reshape(c.shape[:2])
                isochoric, condensed, mixed = kernels.volumetric(
                    piece.sizes, self.mesh.points, position, piece.cells, table.shape, table.gradient, table.weight,
                    table.modes, *piece.bulk, pressure[piece.block][piece.part], density,
                )  # fmt: skip
                total += isochoric + np.array([condensed, mixed])
            return total

        condensed, mixed = np.sum(parallel(work, self._teams), axis=0)
        stiff = self.rigidity.energy(position) if self.rigidity is not None else 0.0
        return float(condensed) + stiff, float(mixed) + stiff

    def smallest_volume_ratio(self, position: Array, fine: bool) -> float:
        """Return the smallest det F at the quadrature points or, `fine`, at those of a finer rule."""

        def work(team: list[Piece]) -> float:
            return min(self._deformation(piece, position, fine)[2] for piece in team)

        return min(parallel(work, self._teams))

    def _deformation(self, piece: Piece, position: Array, fine: bool = False) -> tuple[Array, Array, float]:
        table = piece.table
        shape = table.check_shape if fine else table.shape
        gradient = table.check_gradient if fine else table.gradient
        c = np.empty((len(piece.cells), len(shape), 6))
        ratio = np.empty(c.shape[:2])
        smallest = kernels.deformation(piece.sizes, self.mesh.points, position, piece.cells, shape, gradient, c, ratio)
        return c, ratio, smallest


def _with_local(piece: Piece, stress: Array, ratio: Array) -> Array:
    """Return S (n, 6) and U'(J) of the points in one array (cells, q, 7)."""
    return np.concatenate([stress.reshape(*ratio.shape, 6), local_pressure(ratio, piece.bulk[1])[..., None]], axis=2)


def _viscous_step(piece: Piece, memory: list[Array] | None, stress: Array, seconds: float) -> ViscousStep | None:
    """Return the step of the overstresses to an elastic stress (n, 6); None without memory, time or a Prony series."""
    prony = piece.material.prony
    if not memory or seconds <= 0.0 or prony is None:
        return None
    old = memory[piece.block][:, piece.part].reshape(-1, len(stress), 6)
    return prony.step(seconds, old[1:], old[0], stress)


def quadrature_places(mesh: Mesh, cells: NDArray[np.int64], table: CellTable) -> Array:
    """Return the reference positions (cells * q, 3), mm, of the quadrature points of cells; z = 0 in the plane."""
    places = np.einsum("qm,emi->eqi", table.shape, mesh.points[cells]).reshape(-1, mesh.dimension)
    return np.pad(places, ((0, 0), (0, 3 - mesh.dimension)))


def cell_volumes(mesh: Mesh, block: CellBlock, rule: tuple[Array, Array, Array] | None = None) -> Array:
    """Return the reference volume (cells, q) that each quadrature point of a block stands for, mm3.

    rule: shape, gradient and weight of other points than those of stress.
    """
    table = cell_table(block.kind)
    shape, gradient, weight = rule or (table.shape, table.gradient, table.weight)
    x = mesh.points[block.nodes]
    jacobian = np.einsum("qmj,emi->eqij", gradient, x)
    volume = np.linalg.det(jacobian) * weight
    if mesh.space == "axisymmetric":
        volume = volume * 2 * np.pi * np.einsum("qm,em->eq", shape, x[:, :, 0])
    return volume
