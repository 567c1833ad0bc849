"""The measures that a study file can ask for by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pneumorph.errors import NameNotFoundError, StudyError, unknown_name
from pneumorph.geometry import Actuator, BendingSkin, Finger, PneuNet
from pneumorph.measures import (
    ChordAngle,
    Curvature,
    CurvatureResidual,
    Diameter,
    LargestStress,
    MeanStress,
    ReactionForce,
    ReactionMoment,
    TipRotation,
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
    "diameter": ((*_ENDS, "outer"), lambda axis: Diameter()),
    "largest_diameter": ((*_ENDS, "outer"), lambda axis: Diameter(station=None, name="largest_diameter")),
    "reaction_force": (("clamp",), lambda axis: ReactionForce()),
    "reaction_moment": (("clamp",), lambda axis: ReactionMoment()),
    "peak_von_mises": ((), lambda axis: LargestStress("von_mises")),
    "mean_von_mises": ((), lambda axis: MeanStress("von_mises", name="mean_von_mises")),
    "peak_principal_stress": (
        (),
        lambda axis: LargestStress("largest_principal_stress", name="peak_principal_stress"),
    ),
    "peak_stretch": ((), lambda axis: LargestStress("largest_stretch", name="peak_stretch")),
}
_DEFAULT = ("tip_rotation", "chord_angle")
# templates that bend one way: angles about this axis have a sign and count full turns
_AXES: dict[type[Actuator], Vector] = {Finger: (0.0, 1.0, 0.0), PneuNet: (0.0, 1.0, 0.0), BendingSkin: (0.0, -1.0, 0.0)}


def measures_of(names: Sequence[str] | None, actuator: Actuator) -> tuple[Measure, ...]:
    """Return measures by name; by default the angles, if the actuator has a clamp and a tip.

    Raises NameNotFoundError for an unknown name, StudyError for one whose faces are missing or that is given twice.
    """
    faces = actuator.face_names
    if names is None:
        names = _DEFAULT if set(_ENDS) <= set(faces) else ()
    measures = []
    for name in names:
        if name not in _MEASURES:
            raise NameNotFoundError("measures: " + unknown_name("measure", name, _MEASURES))
        needed, make = _MEASURES[name]
        missing = [face for face in needed if face not in faces]
        if missing:
            raise StudyError(f"measures: '{name}' needs the face '{missing[0]}', the actuator has {', '.join(faces)}")
        if names.count(name) > 1:
            raise StudyError(f"measures: '{name}' is given {names.count(name)} times")
        measures.append(make(_AXES.get(type(actuator))))
    return tuple(measures)


def names() -> tuple[str, ...]:
    """Return the names of all measures that a study file can ask for, in the order of the documentation."""
    return tuple(_MEASURES)
