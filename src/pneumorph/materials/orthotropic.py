"""Orthotropic layer: a convex energy of the Green strain in its surface, and linear stiffness through its thickness."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError
from pneumorph.materials.material import Array, Material, outputs, voigt
from pneumorph.materials.ridges import Ridges

_SHEARS_TWICE = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
_UPPER = np.triu_indices(6)
FRAMES = ("flat", "cylinder")
# bulk modulus over thickness modulus: a lattice is full of holes and changes its volume freely
_POROUS = 1e-3


@dataclass(frozen=True)
class OrthotropicLayer(Material):
    """Energy per volume W(E11, E22, 2 E12) + k E33² / 2 + g ((2 E13)² + (2 E23)²) / 2, MPa.

    surface:   W, see `Ridges`, of the Green strain in the layer's own axes 1 and 2.
    thickness: k, MPa. transverse: g, MPa.
    frame:     'flat': 1, 2, 3 are x, y, z; 'cylinder': 1 is around the z axis, 2 along it, 3 radial.

    It has no isochoric part: the solver's volumetric energy, with a bulk modulus of a thousandth of k, adds next to
    nothing to W. W, convex in E, is stable in tension; like every law that is quadratic in E, it softens where it is
    pressed to about half its length. It has no density unless one is given: a homogenised skin has the mean one.
    `at` puts it to the places of a body.
    """

    surface: Ridges = field(kw_only=True)
    thickness: float = field(kw_only=True, metadata={"kind": "stress"})
    transverse: float = field(kw_only=True, metadata={"kind": "stress"})
    frame: str = field(default="flat", kw_only=True)

    def _check_law(self) -> None:
        for name in ("thickness", "transverse"):
            self._check_positive(name)
        if self.frame not in FRAMES:
            raise InputError(f"OrthotropicLayer: frame = {self.frame!r}, allowed: {', '.join(FRAMES)}")
        if self.bulk is not None or self.prony is not None:
            raise InputError("OrthotropicLayer: bulk or prony is given, allowed: neither, the layer is porous, elastic")
        shape = (len(self.surface.directions), len(self.surface.knots))
        if self.surface.directions.shape[1] != 3 or self.surface.curvature.shape != shape:
            raise InputError(
                f"OrthotropicLayer: surface has directions {self.surface.directions.shape} and curvatures "
                f"{self.surface.curvature.shape}: expected (m, 3) and (m, {shape[1]})"
            )
        if not (self.surface.curvature >= 0.0).all() or 0.0 not in self.surface.knots:
            raise InputError("OrthotropicLayer: surface: expected curvatures of 0 or more and a knot at 0")

    @property
    def shear_modulus(self) -> float:
        """The transverse one, MPa: the scale for tolerances."""
        return self.transverse

    @property
    def bulk_modulus(self) -> float:
        """A thousandth of the modulus through the thickness, MPa."""
        return _POROUS * self.thickness

    def at(self, place: Array) -> Placed:
        """Return the law in its axes at reference positions (n, 3), mm, in the order of the tensors it will be given.

        Raises InputError for a point on the axis of a cylinder.
        """
        axes = np.broadcast_to(np.eye(3), (len(place), 3, 3))
        if self.frame == "cylinder":
            radius = np.hypot(place[:, 0], place[:, 1])
            if (radius <= 0.0).any():
                raise InputError("OrthotropicLayer: a point of the body is on the axis of its cylinder")
            cosine, sine = place[:, 0] / radius, place[:, 1] / radius
            axes = np.zeros((len(place), 3, 3))
            axes[:, 0, 0], axes[:, 0, 1], axes[:, 1, 2] = -sine, cosine, 1.0
            axes[:, 2, 0], axes[:, 2, 1] = cosine, sine
        return Placed(self, _pairs(axes))

    def energy(self, c: Array) -> Array:
        """Return the energy density (n,) of a flat layer; raises InputError for another frame, see `at`."""
        return self._flat(c).energy(c)

    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S (n, 6) and CC (n, 21) of a flat layer; raises InputError for another frame, see `at`."""
        return self._flat(c).stress_and_tangent(c, out)

    def _flat(self, c: Array) -> Placed:
        if self.frame != "flat":
            raise InputError(f"OrthotropicLayer: frame = '{self.frame}' depends on the place: take the law from `at`")
        return self.at(np.zeros((len(c), 3)))

    def stretch_derivatives(self, stretches: ArrayLike) -> Array:
        """Raise InputError: principal stretches alone do not tell the strain in the layer's axes."""
        raise InputError("OrthotropicLayer: the law depends on directions, not on principal stretches alone")


@dataclass(frozen=True, eq=False)
class Placed:
    """An `OrthotropicLayer` at n places; pairs (n, 6, 6): row a gives entry a of the local strain as B_a : E.

    The entries are E11, E22, 2 E12, E33, 2 E13, 2 E23; columns are tensor components in the order of `Material`.
    """

    law: OrthotropicLayer
    pairs: Array

    def energy(self, c: Array) -> Array:
        """Return the energy density (n,), MPa, see `Material.energy`."""
        e = self._strain(voigt(c))
        across = self.law.thickness * e[:, 3] ** 2 + self.law.transverse * (e[:, 4] ** 2 + e[:, 5] ** 2)
        return np.asarray(self.law.surface.value(e[:, :3]) + 0.5 * across)

    def stress_and_tangent(self, c: Array, out: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
        """Return S (n, 6) and CC (n, 21), MPa, see `Material.stress_and_tangent`."""
        stress, tangent = outputs(len(c), out)
        e = self._strain(voigt(c))
        first, second = self.law.surface.derivatives(e[:, :3])
        across = np.array([self.law.thickness, self.law.transverse, self.law.transverse])
        pairs = self.pairs
        stress[:] = np.einsum("na,nai->ni", np.concatenate([first, across * e[:, 3:]], axis=1), pairs)
        full = np.matmul(pairs[:, :3].transpose(0, 2, 1), np.matmul(second, pairs[:, :3]))
        full += np.matmul(pairs[:, 3:].transpose(0, 2, 1), across[:, None] * pairs[:, 3:])
        tangent[:] = full[:, _UPPER[0], _UPPER[1]]
        return stress, tangent

    def _strain(self, c: Array) -> Array:
        green = 0.5 * (c - np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]))
        return np.asarray(np.matmul(self.pairs, (green * _SHEARS_TWICE)[:, :, None])[:, :, 0])


def _pairs(axes: NDArray[np.float64]) -> Array:
    """Return B (n, 6, 6) of axes (n, 3, 3), one a row."""
    result = np.empty((len(axes), 6, 6))
    for row, (a, b) in enumerate([(0, 0), (1, 1), (0, 1), (2, 2), (0, 2), (1, 2)]):
        for column, (i, j) in enumerate([(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]):
            product = 0.5 * (axes[:, a, i] * axes[:, b, j] + axes[:, a, j] * axes[:, b, i])
            result[:, row, column] = product * (1.0 if a == b else 2.0)
    return result
