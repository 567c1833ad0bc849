"""Fit of the reduced limb: rest angle and compliance of each hinge, as polynomials of the pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError
from pneumorph.terrain.limb import ReducedLimb, chain, cross
from pneumorph.terrain.limb_data import LimbData
from pneumorph.terrain.limb_hinge import fit_hinge

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LimbErrors:
    """How far a reduced limb lies from data of m cases.

    moments:        (m, n), of the tip force about the hinges, N mm. angles: (m, n), of the data, rad.
    angle_error:    (m, n), angle of the law under these moments less that of the data, rad.
    moment_error:   (m, n), moment of the law at the data's angles less the tip force's, N mm.
    tip_error:      (m,), distance of the load point of the loaded chain from that of the data, mm.
    rotation_error: (m,), rotation of the last link of the loaded chain less that of the data, rad.
    link_error:     (m,), the part of `tip_error` that rigid links make: with the data's own angles, mm.
    """

    data: LimbData
    moments: Array
    angles: Array
    angle_error: Array
    moment_error: Array
    tip_error: Array
    rotation_error: Array
    link_error: Array

    @property
    def bounds(self) -> dict[str, float]:
        """The largest size of each error over the cases; rad, N mm, mm."""
        names = ("angle_error", "moment_error", "tip_error", "rotation_error", "link_error")
        return {name: float(np.abs(getattr(self, name)).max()) for name in names}


@dataclass(frozen=True, eq=False)
class LimbFit:
    """A reduced limb, its errors over the data that it was fitted to, and over what was held out (None: nothing)."""

    limb: ReducedLimb
    fitted: LimbErrors
    held_out: LimbErrors | None


def fit_limb(data: LimbData, *, rest_degree: int = 3, compliance_degree: int = 1) -> LimbFit:
    """Return the reduced limb that fits the data best, hinge by hinge, in angle (least squares).

    The moment at a hinge is that of the tip force about it in the loaded shape (statics of a cantilever; the moment of
    the pressure is in the rest angle). angle = r(p) + c(p) M, with r a polynomial of `rest_degree` without constant
    term, as the unloaded shape is the reference, and c one of `compliance_degree`. Where a stop, whose angle is linear
    in the pressure, halves a hinge's sum of squares, it has one: pleats that touch as the limb closes.

    Raises InputError for degrees out of range, fewer cases or pressures than the polynomials need, no tip force, or a
    compliance that is not positive.
    """
    if not 1 <= rest_degree <= 6 or not 0 <= compliance_degree <= 3:
        raise InputError(
            f"limb fit: rest_degree = {rest_degree}, compliance_degree = {compliance_degree}, expected 1 to 6, 0 to 3"
        )
    whole, data = data, data.chosen(~data.held_out)
    loaded = np.linalg.norm(data.forces, axis=1) > 0.0
    _enough("pressures above 0", np.unique(data.pressures[data.pressures != 0.0]).size, rest_degree)
    _enough("pressures with tip forces", np.unique(data.pressures[loaded]).size, compliance_degree + 1)
    largest = float(data.pressures.max())
    moments = tip_moments(data)
    laws = [
        fit_hinge(f"hinge {n + 1}", data.pressures / largest, moments[:, n], data.angles[:, n], rest_degree,
                  compliance_degree)
        for n in range(data.parts)
    ]  # fmt: skip
    rest, compliance, stop = (
        np.array([getattr(law, name) for law in laws])
        / largest ** np.arange(first, first + len(getattr(laws[0], name)))
        for name, first in (("rest", 1), ("compliance", 0), ("stop", 0))
    )
    limb = ReducedLimb(
        data.hinges, data.load_point, data.stations[-1], rest, compliance, stop,
        np.array([law.stop_stiffness for law in laws]), (min(0.0, float(data.pressures.min())), largest),
        data.thickness, data.width, data.foot, data.mount,
    )  # fmt: skip
    rest_of = whole.chosen(whole.held_out) if whole.held_out.any() else None
    return LimbFit(limb, errors(limb, data), None if rest_of is None else errors(limb, rest_of))


def tip_moments(data: LimbData) -> Array:
    """Return the moments (m, n) of the tip forces about the hinges of rigid links with the data's angles, N mm."""
    places, tips = chain(data.links, data.angles)
    return cross(tips[:, None] - places, data.forces[:, None])


def errors(limb: ReducedLimb, data: LimbData) -> LimbErrors:
    """Return how far a reduced limb lies from data; raises InputError for pressures beyond the limb's range."""
    springs = limb.springs(data.pressures)
    loaded = np.array([limb.equilibrium(p, f) for p, f in zip(data.pressures, data.forces, strict=True)])
    angles, moments = data.angles, tip_moments(data)
    (_, ends), (_, tips) = chain(limb.links, loaded), chain(data.links, angles)
    return LimbErrors(
        data, moments, angles,
        angle_error=springs.angles(moments) - angles,
        moment_error=springs.moment(angles) - moments,
        tip_error=np.linalg.norm(ends - data.load_points, axis=1),
        rotation_error=loaded.sum(axis=1) - angles.sum(axis=1),
        link_error=np.linalg.norm(tips - data.load_points, axis=1),
    )  # fmt: skip


def _enough(what: str, found: int, needed: int) -> None:
    if found < needed:
        raise InputError(f"limb fit: the data has {found} {what}, the polynomials need {needed}")
