"""From a cell of the skin, bonded to its tube, to the law of a closed layer that replaces the lattice."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, NotConvergedError
from pneumorph.geometry.lattice import Cell, Lattice, SkinnedTube
from pneumorph.homogenisation.periodic import Mean, PeriodicCell
from pneumorph.materials import Material, library
from pneumorph.materials.orthotropic import OrthotropicLayer
from pneumorph.materials.ridges import Ridges, fit
from pneumorph.mesh.flat_sheet import mesh_unit_cell
from pneumorph.mesh.structured import box

Array = NDArray[np.float64]

# of the study, Pu et al. 2024
TUBE = library.material("ecoflex-00-30-tube")
SKIN = library.material("hei-cast-8400-skin")

# directions in the plane of E11 and E22, each also leaning to the shear 2 E12 on both sides
_ANGLES = np.radians(np.arange(0.0, 180.0, 15.0))
_LEAN = 0.6
_SHEAR = np.array([[0.0, 0.0, 1.0]])
_KNOTS = np.array([-0.5, -0.3, -0.15, -0.05, 0.0, 0.05, 0.15, 0.3, 0.5, 0.75, 1.0])
# rays of strain that the cell is taken along, degrees from E11 (around) to E22 (along): densest where a tube goes
_RAYS = np.radians([-45.0, -22.5, 0.0, 22.5, 45.0, 67.5, 90.0, 112.5, 135.0, 180.0, 225.0, 270.0])
_REACH = (-0.12, 0.65)  # of E11 and E22: beyond, a cell that is pressed buckles
_SHARES = (0.15, 0.4, 0.7, 1.0)


@dataclass(frozen=True, eq=False)
class Sample:
    """Strains (n, 2), E11 and E22, with the second Piola-Kirchhoff forces (n, 2), N/mm, and dS12/d(2 E12) (n,)."""

    strain: Array
    force: Array
    shear: Array


def sample(cell: PeriodicCell) -> Sample:
    """Return the answer of a cell along rays of plane strain without shear, as far as it has equilibria on them."""
    strain: list[Array] = []
    force: list[Array] = []
    shear: list[float] = []
    for angle in _RAYS:
        direction = np.array([np.cos(angle), np.sin(angle)])
        direction[np.abs(direction) < 1e-9] = 0.0
        limits = np.where(direction > 0.0, _REACH[1], -_REACH[0])
        reach = float(np.min(limits[direction != 0.0] / np.abs(direction[direction != 0.0])))
        state = cell.rest()
        if not strain:
            _add(state, strain, force, shear)
        for share in _SHARES:
            stretch = np.sqrt(1.0 + 2.0 * share * reach * direction) - 1.0
            try:
                (state,) = cell.path([{"xx": stretch[0], "yy": stretch[1], "xy": 0.0, "yx": 0.0}], start=state)
            except NotConvergedError:  # a beam that folds: the law goes as far as the cell does
                break
            _add(state, strain, force, shear)
    return Sample(np.array(strain), np.array(force), np.array(shear))


def _add(state: Mean, strain: list[Array], force: list[Array], shear: list[float]) -> None:
    f = state.gradient
    s = np.linalg.solve(f, state.force)
    # dF that strains in shear alone, 2 E12 = 1: dF = F^-T dE; then F dS = dP - dF S
    turn = np.linalg.solve(f.T, np.array([[0.0, 0.5], [0.5, 0.0]]))
    change = np.linalg.solve(f, (state.tangent @ turn.ravel()).reshape(2, 2) - turn @ s)
    strain.append(np.diag(f.T @ f - np.eye(2)) / 2.0)
    force.append(np.diag(s))
    shear.append(float(change[0, 1] + change[1, 0]) / 2.0)


@dataclass(frozen=True, eq=False)
class SkinLaw:
    """A fitted layer, with what it was fitted to: strains (n, 2), and misfit, root mean square of the difference in
    force over that of the forces of tube and skin together."""

    layer: OrthotropicLayer
    strain: Array
    misfit: float


def skin_law(
    cell: Cell, tube: SkinnedTube, *, tube_material: Material = TUBE, skin_material: Material = SKIN,
    size: float | None = None, bonded: bool = True,
) -> SkinLaw:  # fmt: skip
    """Return the law of the layer that stands for a lattice of equal cells on a tube.

    bonded: the cell is tube wall and skin together, and what the plain wall bears is taken off: the law then holds what
            the wall between the beams suffers beyond the mean strain. Otherwise the skin alone.
    size:   largest edge in the mesh of the cell, mm; automatic half its height, as the coarse mesh of a skinned tube.
    Results are kept: a second call with the same arguments costs nothing.

    The stiffness through the layer's thickness and its transverse shear moduli are those of the solid share of the skin
    (Voigt's bound: 3 mu and mu times the share); results depend on them little. Raises NotConvergedError, InputError.
    """
    if skin_material.prony is not None:
        raise InputError("homogenised skin: the skin's material is viscous, expected one without a Prony series")
    lattice = tube.lattice
    lengths = (lattice.width, lattice.height, lattice.beam)
    chosen = lattice.height / 2.0 if size is None else size
    return _fitted(cell, lengths, (tube.wall, tube.depth), (tube_material, skin_material), chosen, bonded)


@lru_cache(maxsize=256)
def _fitted(
    cell: Cell, lengths: tuple[float, float, float], depths: tuple[float, float], materials: tuple[Material, Material],
    size: float, bonded: bool,
) -> SkinLaw:  # fmt: skip
    wall, depth = depths
    both = dict(zip(("tube", "skin"), materials, strict=True))
    if bonded:
        mesh = mesh_unit_cell(cell, lengths, [(wall, "tube", False), (depth, "skin", True)], size)
        periodic = PeriodicCell(mesh, lengths[:2], both)
    else:
        mesh = mesh_unit_cell(cell, lengths, [(depth / 2.0, "skin", True)], size)
        periodic = PeriodicCell(mesh, lengths[:2], {"skin": materials[1]}, mirrored=True)
    found = sample(periodic)
    plain = (
        _wall(materials[0], wall, found.strain)
        if bonded
        else Sample(found.strain, 0.0 * found.force, 0.0 * found.shear)
    )
    force, shear = (found.force - plain.force) / depth, (found.shear - plain.shear) / depth
    # relative to what tube and skin bear together, but not less than a tenth of the stiffest state
    whole = np.linalg.norm(found.force, axis=1) / depth
    weight = 1.0 / np.maximum(whole, 0.05 * whole.max())
    plane = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES), np.zeros(len(_ANGLES))])
    leaning = plane[::2]
    directions = np.vstack([plane, leaning + _SHEAR * _LEAN, leaning - _SHEAR * _LEAN, _SHEAR])
    count = len(plane)
    groups = np.concatenate([np.arange(count), count + np.tile(np.arange(len(leaning)), 2), [count + len(leaning)]])
    e = np.column_stack([found.strain, np.zeros(len(found.strain))])
    slopes = np.column_stack([force, np.zeros(len(force))])
    ridges = fit(
        directions, groups, _KNOTS, e, slopes, np.repeat(weight[:, None], 3, axis=1),
        (2, shear),
    )  # fmt: skip
    left = (ridges.derivatives(e)[0][:, :2] - force) * depth
    misfit = float(np.sqrt((left**2).sum() / (found.force**2).sum()))
    share = _solid_share(cell, lengths)
    stiff, density = share * materials[1].shear_modulus, materials[1].density
    layer = OrthotropicLayer(
        surface=ridges, thickness=3.0 * stiff, transverse=stiff, frame="cylinder",
        density=None if density is None else share * density,
    )  # fmt: skip
    return SkinLaw(layer, found.strain, misfit)


def _solid_share(cell: Cell, lengths: tuple[float, float, float]) -> float:
    lattice = Lattice(*lengths, cells=((cell,),))
    return lattice.area / (lattice.around * lattice.length)


def _wall(material: Material, thickness: float, strain: Array) -> Sample:
    """Return what a plain wall answers to the same strains."""
    cell = PeriodicCell(box(1, 1, 1, "hexahedron27", lengths=(1.0, 1.0, thickness)), (1.0, 1.0), {"body": material})
    strains: list[Array] = []
    force: list[Array] = []
    shear: list[float] = []
    for e in strain:
        stretch = np.sqrt(1.0 + 2.0 * e) - 1.0
        _add(cell.path([{"xx": stretch[0], "yy": stretch[1], "xy": 0.0, "yx": 0.0}])[0], strains, force, shear)
    return Sample(np.array(strains), np.array(force), np.array(shear))


def blended(first: OrthotropicLayer, second: OrthotropicLayer, share: float) -> OrthotropicLayer:
    """Return the layer a share (0 to 1) of the way from one to the other: energies are mixed, so it stays convex.

    Raises InputError for laws with other directions or knots, or a share out of range.
    """
    a, b = first.surface, second.surface
    if not 0.0 <= share <= 1.0:
        raise InputError(f"blended: share = {share!r}, allowed: 0 to 1")
    if a.directions.shape != b.directions.shape or not np.array_equal(a.knots, b.knots):
        raise InputError("blended: the two laws have other directions or knots")
    mixed = Ridges(a.directions, a.knots, (1.0 - share) * a.curvature + share * b.curvature)
    return OrthotropicLayer(
        surface=mixed, thickness=(1.0 - share) * first.thickness + share * second.thickness,
        transverse=(1.0 - share) * first.transverse + share * second.transverse, frame=first.frame,
    )  # fmt: skip
