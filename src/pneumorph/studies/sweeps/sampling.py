"""From parameters to designs: every combination, value by value, or samples spread between bounds."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from pneumorph.errors import StudyError
from pneumorph.studies.sweeps.parameters import Parameter
from pneumorph.studies.sweeps.schema import SAMPLED, SamplingSection

MOST = 100_000  # designs; more is a slip of the pen


def combinations(parameters: Sequence[Parameter], sampling: SamplingSection) -> list[tuple[Any, ...]]:
    """Return the values of each design, in the order of the parameters.

    Latin hypercube: McKay, Beckman and Conover, Technometrics 21 (1979); Sobol: scrambled, and balanced where the
    number of samples is a power of two. Whole numbers and lists are sampled with equal chances.
    Raises StudyError where parameters and method do not go together.
    """
    method, samples = sampling.method, sampling.samples
    if method in SAMPLED:
        for parameter in parameters:
            if parameter.bounds is not None and parameter.values:
                raise StudyError(
                    f"parameters: '{parameter.path}': steps are for a grid; method = '{method}' has samples"
                )
        if samples is None or not 1 <= samples <= MOST:
            raise StudyError(f"sampling: samples = {samples}: expected 1 to {MOST} with method = '{method}'")
        if sampling.seed < 0:
            raise StudyError(f"sampling: seed = {sampling.seed}: expected at least 0")
        shares = _shares(method, len(parameters), samples, sampling.seed)
        return [tuple(p.at(float(u)) for p, u in zip(parameters, line, strict=True)) for line in shares]
    if samples is not None:
        raise StudyError(f"sampling: samples = {samples}: only for method = {' or '.join(map(repr, SAMPLED))}")
    for parameter in parameters:
        if not parameter.values:
            raise StudyError(f"parameters: '{parameter.path}': steps missing, which method = '{method}' needs")
    lengths = [len(parameter.values) for parameter in parameters]
    if method == "list":
        if len(set(lengths)) > 1:
            said = ", ".join(f"'{p.path}' {len(p.values)}" for p in parameters)
            raise StudyError(f"parameters: method = 'list' needs as many values of each, got {said}")
        return list(zip(*(parameter.values for parameter in parameters), strict=True))
    if math.prod(lengths) > MOST:
        raise StudyError(f"parameters: the grid has {math.prod(lengths)} designs: expected at most {MOST}")
    return list(itertools.product(*(parameter.values for parameter in parameters)))


def _shares(method: str, dimensions: int, samples: int, seed: int) -> np.ndarray:
    """Return points (samples, dimensions) of the unit cube."""
    from scipy.stats import qmc  # takes a second to load

    random = np.random.default_rng(seed)
    if method == "latin-hypercube":
        return np.asarray(qmc.LatinHypercube(dimensions, seed=random).random(samples))
    # the first points of the sequence: those of the next power of two, cut
    return np.asarray(qmc.Sobol(dimensions, seed=random).random_base2(math.ceil(math.log2(samples))))[:samples]
