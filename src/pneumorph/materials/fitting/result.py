"""What a fit found, and how good it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pneumorph.materials.fitting.specimen import SpecimenTest, nominal_stress
from pneumorph.materials.material import Material
from pneumorph.materials.stability import Instability, instabilities, stability_limit
from pneumorph.units import show

Array = NDArray[np.float64]

# relative errors are looked at where the stress is over this part of the largest one of its test
_NOT_SMALL = 0.05
# stability is looked at from this stretch, and at least up to that one, in all three tests
_SMALLEST, _AT_LEAST = 0.4, 2.0


class LargestError(NamedTuple):
    """The error that is largest: `value` is MPa or, of the relative error, a fraction of the measured stress."""

    value: float
    mode: str
    stretch: float


@dataclass(frozen=True)
class Fit:
    """A law with fitted constants.

    model:     name of the model; `material` is the law itself.
    constants: how many were fitted.
    points:    how many points they were fitted to.
    misfit:    mean over the tests of the mean squared weighted error, what the fit makes small.
    r2:        1 - sum of squared errors/sum of squared differences of the stresses from their mean, all points.
    r2_of:     the same for each test, in the order of the tests.
    largest_error, largest_relative_error: model minus measured; the latter where the stress is over 5 % of its largest.
    inside:    where the law is unstable within the stretches of the tests it was fitted to.
    outside:   where else it is, in all three tests from stretch 0.4 to the largest one of all tests.
    """

    model: str
    material: Material
    constants: int
    points: int
    misfit: float
    r2: float
    r2_of: tuple[float, ...]
    largest_error: LargestError
    largest_relative_error: LargestError
    inside: tuple[Instability, ...]
    outside: tuple[Instability, ...]

    @property
    def aicc(self) -> float:
        """Akaike's information criterion, corrected for few points; the variance of the errors counts as a constant.

        Less is better, by 2 a constant that is not needed. Source: Hurvich, Tsai, Biometrika 76 (1989) 297.
        """
        k = self.constants + 1
        return self.points * log(max(self.misfit, 1e-300)) + 2.0 * k + 2.0 * k * (k + 1) / (self.points - k - 1)

    @property
    def stable(self) -> bool:
        """Whether the law is stable inside and outside its fit, as far as was looked."""
        return not (self.inside or self.outside)

    def constants_shown(self, digits: int = 4) -> tuple[str, ...]:
        """Return the constants as text with units: 'c10 = 0.16 MPa'. Those that were not fitted are left out."""
        shown = []
        for item in fields(self.material):
            value = getattr(self.material, item.name)
            if value == item.default:
                continue
            kind = item.metadata["kind"]
            texts = [show(one, kind, digits) for one in (value if isinstance(value, tuple) else (value,))]
            unit = texts[0].partition(" ")[2]
            numbers = ", ".join(text.partition(" ")[0] for text in texts)
            shown.append(f"{item.name} = {numbers} {unit}".rstrip())
        return tuple(shown)


def judge(name: str, material: Material, constants: int, misfit: float, tests: Sequence[SpecimenTest]) -> Fit:
    """Return the fit with all that is told about it."""
    errors = [nominal_stress(material, test.mode, test.stretch) - test.stress for test in tests]
    relative = []
    for test, error in zip(tests, errors, strict=True):
        clear = np.abs(test.stress) > _NOT_SMALL * np.abs(test.stress).max()
        relative.append(np.divide(error, test.stress, out=np.zeros_like(error), where=clear))
    stresses = [test.stress for test in tests]
    ends = [(test.mode, float(end)) for test in tests for end in (test.stretch.min(), test.stretch.max())]
    ends = [(mode, end) for mode, end in ends if end != 1.0]
    limits = ((mode, stability_limit(material, mode, end)) for mode, end in ends)
    inside = tuple(dict.fromkeys(Instability(mode, limit) for mode, limit in limits if limit is not None))
    largest = max(_AT_LEAST, *(float(test.stretch.max()) for test in tests))
    outside = tuple(
        found
        for found in instabilities(material, _SMALLEST, largest)
        if not any(known.mode == found.mode and (known.stretch > 1.0) == (found.stretch > 1.0) for known in inside)
    )
    return Fit(
        name,
        material,
        constants,
        sum(len(test.stress) for test in tests),
        misfit,
        _r2(np.concatenate(errors), np.concatenate(stresses)),
        tuple(_r2(error, stress) for error, stress in zip(errors, stresses, strict=True)),
        _largest(errors, tests),
        _largest(relative, tests),
        inside,
        outside,
    )


def _r2(error: Array, stress: Array) -> float:
    return float(1.0 - (error**2).sum() / ((stress - stress.mean()) ** 2).sum())


def _largest(errors: Sequence[Array], tests: Sequence[SpecimenTest]) -> LargestError:
    places = [int(np.argmax(np.abs(error))) for error in errors]
    number = max(range(len(tests)), key=lambda item: abs(errors[item][places[item]]))
    test, place = tests[number], places[number]
    return LargestError(float(errors[number][place]), test.mode, float(test.stretch[place]))
