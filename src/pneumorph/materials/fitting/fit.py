"""Least squares: the constants with which a law comes closest to the tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, lsq_linear, nnls

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.materials.fitting.models import Model, model
from pneumorph.materials.fitting.result import Fit, judge
from pneumorph.materials.fitting.specimen import SpecimenTest, nominal_stress
from pneumorph.materials.tension import principal_stretches

Array = NDArray[np.float64]

WEIGHTS = ("equal", "relative")

# stresses under this part of the largest one of their test do not count for more than it, with relative weights
_SMALL = 0.05
# how many of the best starts are searched from
_SEARCHED = 5


def fit(tests: Sequence[SpecimenTest], law: str | Model, weights: str = "equal") -> Fit:
    """Return the constants of a law with the least squared errors of the nominal stress, each test counting the same.

    law: a model or its name.
    weights: "equal" takes the errors of a test over the root mean square of its stresses, "relative" each error over
        its own stress (at least 5 % of the largest one of the test), which favours small strains.

    The tests are taken as they are; see `prepare`. Starts are the same every time, so the result is. Raises
    NameNotFoundError for an unknown law or weighting, InputError for no tests or too few points, and where no constants
    that the law allows follow the tests.
    """
    chosen = model(law) if isinstance(law, str) else law
    problem = _problem(tests, weights)
    least = chosen.constants + 3  # the fewest that the criterion of the ranking is defined for
    if len(problem.target) < least:
        raise InputError(
            f"{chosen.name} has {chosen.constants} constants, the tests {len(problem.target)} points, "
            f"allowed: at least {least} points"
        )
    found = [best for start in _best_starts(chosen, problem) if (best := _searched(chosen, problem, start)) is not None]
    for misfit, moduli, shapes in sorted(found, key=lambda item: item[0]):
        try:
            material = chosen.make(moduli, shapes, problem.most)
        except InputError:
            continue
        return judge(chosen.name, material, chosen.constants, misfit, tests)
    raise InputError(f"{chosen.name}: no constants that the law allows follow the tests")


@dataclass(frozen=True, eq=False)
class _Problem:
    """The weighted stresses (n,) of all tests in a row; weights such that the squares sum up to the misfit."""

    tests: tuple[SpecimenTest, ...]
    weight: Array
    target: Array
    most: float

    def stresses(self, chosen: Model, moduli: Array, shapes: Array) -> Array:
        """Return the weighted stresses (n,) of a law."""
        material = chosen.make(moduli, shapes, self.most)
        return self.weight * np.concatenate([nominal_stress(material, test.mode, test.stretch) for test in self.tests])


def _problem(tests: Sequence[SpecimenTest], weights: str) -> _Problem:
    if not tests:
        raise InputError("no tests to fit to, expected one or more")
    if weights not in WEIGHTS:
        raise NameNotFoundError(unknown_name("weighting", weights, WEIGHTS))
    parts = []
    for test in tests:
        size = np.abs(test.stress)
        if not size.any():
            raise InputError(f"{test.where(0)}: the stress is 0 in every row, allowed: a test that was loaded")
        scale = np.maximum(size, _SMALL * size.max()) if weights == "relative" else np.sqrt((size**2).mean())
        parts.append(1.0 / (scale * np.sqrt(len(size) * len(tests))) * np.ones_like(size))
    weight = np.concatenate(parts)
    squares = [(principal_stretches(test.mode, test.stretch) ** 2).sum(axis=-1) for test in tests]
    most = max(float(np.concatenate(squares).max()) - 3.0, 1e-6)
    return _Problem(tuple(tests), weight, weight * np.concatenate([test.stress for test in tests]), most)


def _moduli(chosen: Model, problem: _Problem, shapes: Array) -> tuple[Array, Array]:
    """Return the best moduli (m,) for given shapes and the weighted errors (n,); nan where the law has no state."""
    base = chosen.base(shapes)
    at_base = problem.stresses(chosen, base, shapes)
    columns = np.empty((len(at_base), len(base)))
    for number, value in enumerate(base):
        step = value or 1.0
        moved = base.copy()
        moved[number] += step
        columns[:, number] = (problem.stresses(chosen, moved, shapes) - at_base) / step
    signs = np.where(base < 0.0, -1.0, 1.0)
    size = np.linalg.norm(columns, axis=0)
    if not (np.isfinite(columns).all() and (size > 0.0).all()):
        return base, np.full(len(at_base), np.nan)
    scaled = columns * signs / size
    if chosen.positive == len(base) > 1:
        found = nnls(scaled, problem.target)[0]
    else:
        found = np.linalg.lstsq(scaled, problem.target, rcond=1e-12)[0]
        if (found[: chosen.positive] <= 0.0).any():
            least = np.where(np.arange(len(base)) < chosen.positive, 1e-6 * np.linalg.norm(problem.target), -np.inf)
            found = lsq_linear(scaled, problem.target, (least, np.inf)).x
    return found * signs / size, scaled @ found - problem.target


def _best_starts(chosen: Model, problem: _Problem) -> list[Array]:
    starts = chosen.starts
    misfits = [float((_moduli(chosen, problem, start)[1] ** 2).sum()) for start in starts]
    order = np.argsort(misfits, kind="stable")  # nan last
    return [starts[place] for place in order[:_SEARCHED] if np.isfinite(misfits[place])]


def _searched(chosen: Model, problem: _Problem, start: Array) -> tuple[float, Array, Array] | None:
    """Return misfit, moduli and shapes of the least near a start, None where the search leaves what the law allows."""
    shapes = start
    if len(start):
        low, high = chosen.bounds(start)
        try:
            shapes = least_squares(
                lambda x: _moduli(chosen, problem, x)[1], start, bounds=(low, high), x_scale="jac", xtol=1e-10
            ).x
        except ValueError:  # an error that is not finite
            return None
    moduli, errors = _moduli(chosen, problem, shapes)
    misfit = float((errors**2).sum())
    return (misfit, moduli, shapes) if np.isfinite(misfit) else None
