"""The measures that a study file can ask for by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from pneumorph.errors import NameNotFoundError, StudyError, unknown_name
from pneumorph.geometry import Actuator, BendingSkin, Finger, HexagonalPrism, PneuNet, SoftLimb
from pneumorph.measures import (
    CentreOfMass,
    ChordAngle,
    CircumscribedDiameter,
    Curvature,
    CurvatureResidual,
    Diameter,
    LargestDisplacement,
    LargestStress,
    LineLength,
    MeanContactPressure,
    MeanStress,
    NormalForce,
    ReactionForce,
    ReactionMoment,
    TipRotation,
    TurnRate,
)
from pneumorph.solution import Measure

Vector = tuple[float, float, float]

_ENDS = ("clamp", "tip")
# name -> (faces that it needs, how it is made from the axis about which the actuator bends)
_MEASURES: dict[str, tuple[tuple[str, ...], Callable[[Vector | None], Measure]]] = {
    "tip_rotation": (_ENDS, lambda axis: TipRotation(axis=axis)),
    "chord_angle": (_ENDS, lambda axis: ChordAngle(axis=axis)),
    "curvature": (_ENDS, lambda axis: Curvature(axis=axis)),
    "curvature_residual": (_ENDS, lambda axis: CurvatureResidual(Curvature(axis=axis))),
    "turn_rate": (_ENDS, lambda axis: TurnRate(axis=axis)),
    "line_length": (_ENDS, lambda axis: LineLength()),
    "diameter": ((*_ENDS, "outer"), lambda axis: Diameter()),
    "largest_diameter": ((*_ENDS, "outer"), lambda axis: Diameter(station=None, name="largest_diameter")),
    "reaction_force": (("clamp",), lambda axis: ReactionForce()),
    "reaction_moment": (("clamp",), lambda axis: ReactionMoment()),
    "centre_of_mass_x": ((), lambda axis: CentreOfMass("x")),
    "centre_of_mass_y": ((), lambda axis: CentreOfMass("y")),
    "centre_of_mass_z": ((), lambda axis: CentreOfMass("z")),
    "largest_displacement": ((), lambda axis: LargestDisplacement()),
    "peak_von_mises": ((), lambda axis: LargestStress("von_mises")),
    "mean_von_mises": ((), lambda axis: MeanStress("von_mises", name="mean_von_mises")),
    "mean_equivalent_strain": ((), lambda axis: MeanStress("equivalent_strain", name="mean_equivalent_strain")),
    "peak_principal_stress": (
        (),
        lambda axis: LargestStress("largest_principal_stress", name="peak_principal_stress"),
    ),
    "peak_stretch": ((), lambda axis: LargestStress("largest_stretch", name="peak_stretch")),
}
# of one material domain by "name:domain"
_BY_DOMAIN: dict[str, Callable[[str, str], Measure]] = {
    "largest_displacement": lambda domain, name: LargestDisplacement((domain,), name),
    "peak_von_mises": lambda domain, name: LargestStress("von_mises", domain, name),
    "mean_von_mises": lambda domain, name: MeanStress("von_mises", domain, name),
    "peak_principal_stress": lambda domain, name: LargestStress("largest_principal_stress", domain, name),
    "peak_stretch": lambda domain, name: LargestStress("largest_stretch", domain, name),
}
# of one contact by "name:contact"
_BY_CONTACT: dict[str, Callable[[str, str], Measure]] = {
    "mean_contact_pressure": lambda contact, name: MeanContactPressure(contact),
    "normal_force": NormalForce,
}
_OUTSIDES = ("outer", "rear", "front")
# of one template, by name
_OF_TEMPLATE: dict[str, tuple[type[Actuator], Callable[[Any, Vector | None], Measure]]] = {
    "circumscribed_diameter": (
        HexagonalPrism,
        lambda prism, axis: CircumscribedDiameter(tuple(f for f in _OUTSIDES if f in prism.face_names)),
    ),
    "edge_curvature": (
        BendingSkin,
        lambda skin, axis: Curvature(line=skin.outer_edge, axis=axis, sections=_EDGE_POINTS, name="edge_curvature"),
    ),
}
_EDGE_POINTS = 41
_DEFAULT = ("tip_rotation", "chord_angle")
# templates that bend one way: angles about this axis have a sign and count full turns
_AXES: dict[type[Actuator], Vector] = {
    Finger: (0.0, 1.0, 0.0),
    PneuNet: (0.0, 1.0, 0.0),
    BendingSkin: (0.0, -1.0, 0.0),
    SoftLimb: (0.0, -1.0, 0.0),
}


def _axis(actuator: Actuator) -> Vector | None:
    """Return the axis about which an actuator bends; None where it may bend any way."""
    if isinstance(actuator, HexagonalPrism) and actuator.half:
        return (1.0, 0.0, 0.0)  # away from cavity_2 and its mirror image
    return _AXES.get(type(actuator))


def measures_of(
    names: Sequence[str] | None,
    actuator: Actuator,
    domains: Sequence[str] | None = None,
    contacts: Sequence[str] = (),
) -> tuple[Measure, ...]:
    """Return measures by name; by default the angles, if the actuator has a clamp and a tip.

    Stress and stretch of one material domain are called "peak_von_mises:skin" and so on; "normal_force:pipe" and
    "mean_contact_pressure:pipe" are those of the contact "pipe", "edge_curvature" is that of the outer edge line of a
    skinned tube. domains, contacts: of the study; what names no domain is measured on the actuator alone.
    Raises NameNotFoundError for an unknown name or domain, StudyError for one whose faces are missing or that is given
    twice.
    """
    faces = actuator.face_names
    known = actuator.domains if domains is None else domains
    if names is None:
        names = _DEFAULT if set(_ENDS) <= set(faces) else ()
    measures = []
    for name in names:
        if names.count(name) > 1:
            raise StudyError(f"measures: '{name}' is given {names.count(name)} times")
        quantity, colon, domain = name.partition(":")
        if colon and quantity in _BY_DOMAIN:
            if domain not in known:
                raise NameNotFoundError(f"measures: '{name}': " + unknown_name("domain", domain, known))
            measures.append(_BY_DOMAIN[quantity](domain, name))
            continue
        if colon and quantity in _BY_CONTACT:
            if domain not in contacts:
                raise NameNotFoundError(f"measures: '{name}': " + unknown_name("contact", domain, contacts))
            measures.append(_BY_CONTACT[quantity](domain, name))
            continue
        if name in _OF_TEMPLATE and isinstance(actuator, _OF_TEMPLATE[name][0]):
            measures.append(_OF_TEMPLATE[name][1](actuator, _axis(actuator)))
            continue
        if name not in _MEASURES:
            raise NameNotFoundError("measures: " + unknown_name("measure", name, _MEASURES))
        needed, make = _MEASURES[name]
        missing = [face for face in needed if face not in faces]
        if missing:
            raise StudyError(f"measures: '{name}' needs the face '{missing[0]}', the actuator has {', '.join(faces)}")
        measures.append(make(_axis(actuator)))
        if set(known) != set(actuator.domains):  # further bodies do not count
            measures[-1] = _of(measures[-1], actuator.domains)
    return tuple(measures)


def _of(measure: Measure, domains: tuple[str, ...]) -> Measure:
    """Return the measure of some domains alone, if it is one of domains at all."""
    if isinstance(measure, CentreOfMass | LargestDisplacement | LargestStress | MeanStress):
        return replace(measure, domain=domains)
    return measure


def names() -> tuple[str, ...]:
    """Return the names of all measures that a study file can ask for, in the order of the documentation."""
    return (*_MEASURES, *_OF_TEMPLATE)


def names_by_domain() -> tuple[str, ...]:
    """Return the names of those that are asked for of one material domain, as "peak_von_mises:skin", or contact."""
    return (*_BY_DOMAIN, *_BY_CONTACT)
