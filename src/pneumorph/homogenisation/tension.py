"""Tension tests of flat lattice sheets: force and lateral strain against strain, along and around."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.geometry.lattice import Cell
from pneumorph.homogenisation.law import SKIN
from pneumorph.homogenisation.periodic import PeriodicCell
from pneumorph.materials import Material
from pneumorph.mechanics import Model, Phase, Prescribed, Programme, Roller, Settings, State, march
from pneumorph.mesh.flat_sheet import mesh_panel, mesh_unit_cell
from pneumorph.mesh.mesh import FaceBlock, Mesh

Array = NDArray[np.float64]

DIRECTIONS = ("along", "around")


@dataclass(frozen=True)
class Sheet:
    """A flat sheet of equal cells.

    cell: kind and cg. columns (even), rows: cells across (x) and along (y). width, height: of a cell, beam: width of
    its straight beams, depth: of the sheet, mm. Default: the study's skin, laid flat. Raises InputError.
    """

    cell: Cell
    columns: int = 12
    rows: int = 7
    width: float = 2.0 * np.pi * 15.5 / 12.0
    height: float = 104.3 / 7.0
    beam: float = 1.57
    depth: float = 2.0

    def __post_init__(self) -> None:
        for name, least in (("columns", 2), ("rows", 1)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or value < least or (least == 2 and value % 2):
                even = "an even number" if least == 2 else "a whole number"
                raise InputError(f"sheet: {name} = {value!r}, allowed: {even} of at least {least}")

    @property
    def lengths(self) -> tuple[float, float, float]:
        """Width, height and beam of a cell, mm."""
        return self.width, self.height, self.beam


@dataclass(frozen=True, eq=False)
class TensionTest:
    """Curves of one test, from rest: strain (n,) of the sheet between its grips, force (n,), N per mm of its width;
    gauge and lateral (n,): mean strains along and across the pull over the inner cells."""

    strain: Array
    force: Array
    gauge: Array
    lateral: Array

    @property
    def stiffness(self) -> float:
        """Initial force per width over gauge strain, N/mm: effective Young's modulus times depth."""
        return float(self.force[1] / self.gauge[1])

    @property
    def poisson_ratio(self) -> float:
        """Initial lateral contraction over extension; negative for an auxetic sheet."""
        return float(-self.lateral[1] / self.gauge[1])


def tension_test(
    sheet: Sheet, direction: str = "along", strain: float = 0.3, *, material: Material = SKIN,
    size: float | None = None, steps: int = 6, settings: Settings | None = None,
    progress: Callable[[State], None] | None = None,
) -> TensionTest:  # fmt: skip
    """Return the tension test of a sheet, pulled 'along' (y) or 'around' (x) to an engineering strain.

    The grips hold the ends of the sheet along the pull only: they slide across it. The model is the half of the sheet
    beside its line of symmetry x = 0, and of its depth under the plane of symmetry. The first step is a hundredth of
    the strain, for the initial values. size: largest edge of the mesh, mm; automatic half a cell's height.

    Raises NameNotFoundError for another direction, InputError for a strain of 0 or less, NotConvergedError.
    """
    if direction not in DIRECTIONS:
        raise NameNotFoundError(unknown_name("direction of a tension test", direction, DIRECTIONS))
    _check_strain(strain)
    counts = (sheet.columns // 2, sheet.rows)
    mesh = mesh_panel(
        sheet.cell, counts, sheet.lengths, [(sheet.depth / 2.0, "skin", True)], size or sheet.height / 2.0
    )
    mesh = _pinned(mesh)
    axis, pulled = (1, "y1") if direction == "along" else (0, "x1")
    hold = (Roller("bottom", "z"), Roller("x0", "x"), Roller("pin", "x"))
    across = Roller("y0" if direction == "along" else "pin", "y")
    model = Model(mesh, {"skin": material}, (*hold, across, Prescribed(pulled, "xy"[axis], "pull")))
    extent = (sheet.width * counts[0], sheet.height * counts[1])
    marks = (0.01, *(i / steps for i in range(1, steps)))
    phase = Phase("pull", {"pull": strain * extent[axis]}, marks, first=0.01, largest=max(0.01, 1.0 / steps))
    nodes = mesh.face_nodes(pulled)
    gauges = [_Gauge(mesh, sheet, i) for i in (0, 1)]
    rows = []
    for state in march(model, Programme((phase,)), settings):
        force = 2.0 * float(state.reactions.reshape(-1, 3)[nodes, axis].sum()) / extent[1 - axis]
        rows.append((state.time * strain, force, gauges[axis](state), gauges[1 - axis](state)))
        if progress is not None:
            progress(state)
    return TensionTest(*np.array(rows).T)


def periodic_test(
    sheet: Sheet, direction: str = "along", strain: float = 0.3, *, material: Material = SKIN,
    size: float | None = None, steps: int = 6,
) -> TensionTest:  # fmt: skip
    """Return the same test of an endless sheet: one periodic cell, without stress across the pull.

    Raises as `tension_test`.
    """
    if direction not in DIRECTIONS:
        raise NameNotFoundError(unknown_name("direction of a tension test", direction, DIRECTIONS))
    _check_strain(strain)
    layers = [(sheet.depth / 2.0, "skin", True)]
    mesh = mesh_unit_cell(sheet.cell, sheet.lengths, layers, size or sheet.height / 2.0)
    cell = PeriodicCell(mesh, (sheet.width, sheet.height), {"skin": material}, mirrored=True)
    axis, part = (1, "yy") if direction == "along" else (0, "xx")
    strains = strain * np.array([0.01, *(i / steps for i in range(1, steps + 1))])
    states = cell.path([{part: float(e), "xy": 0.0, "yx": 0.0} for e in strains])
    rows = [(0.0,) * 4]
    for e, state in zip(strains, states, strict=True):
        stretch = np.diag(state.gradient) - 1.0
        rows.append((float(e), float(state.force[axis, axis]), float(stretch[axis]), float(stretch[1 - axis])))
    return TensionTest(*np.array(rows).T)


def _check_strain(strain: float) -> None:
    if not 0.0 < strain < 10.0:
        raise InputError(f"tension test: strain = {strain!r}, allowed: more than 0, less than 10")


def _pinned(mesh: Mesh) -> Mesh:
    """Return the mesh with the face of x0 nearest to mid-length under a name of its own: 'pin'."""
    (faces,) = mesh.face_blocks("x0")
    heights = mesh.points[faces.nodes, 1].mean(axis=1)
    chosen = np.zeros(len(heights), dtype=bool)
    chosen[int(np.argmin(np.abs(heights - np.ptp(mesh.points[:, 1]) / 2.0)))] = True
    named = {**mesh.faces, "x0": (FaceBlock(faces.kind, faces.nodes[~chosen]),)}
    return replace(mesh, faces=MappingProxyType(named | {"pin": (FaceBlock(faces.kind, faces.nodes[chosen]),)}))


class _Gauge:
    """Mean strain along an axis, from nodes that are whole cells apart, over the inner half of the cells both ways."""

    def __init__(self, mesh: Mesh, sheet: Sheet, axis: int):
        lengths = (sheet.width, sheet.height)
        # x = 0 is the middle of the sheet, the inner cells begin there
        windows = [(0, max(1, sheet.columns // 4)), (sheet.rows // 4, sheet.rows - sheet.rows // 4)]
        first, last = windows[axis]
        self.axis, self.distance = axis, max(1, last - first - 1) * lengths[axis]
        small = 1e-6 * sheet.width
        inside = np.ones(len(mesh.points), dtype=bool)
        for i, (low, high) in enumerate(windows):
            end = low + 1 if i == axis else high
            x = mesh.points[:, i]
            inside &= (x > low * lengths[i] - small) & (x < end * lengths[i] + small)
        step = np.zeros(3)
        step[axis] = self.distance
        nodes = np.flatnonzero(inside)
        away, images = cKDTree(mesh.points).query(mesh.points[nodes] + step)
        same = away < small  # not so in the outermost rows, where the mesh has lines of its own
        self.low, self.high = nodes[same], images[same]

    def __call__(self, state: State) -> float:
        moved = state.displacement[:, self.axis]
        return float((moved[self.high] - moved[self.low]).mean() / self.distance)
