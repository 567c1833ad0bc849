"""Checks of the constants of a law: each message names the owner, the constant, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real

import numpy as np

from pneumorph.errors import InputError


def check_finite(owner: str, name: str, value: object, kind: str) -> None:
    """Raise InputError unless a value is a finite number; `kind` is that of `units.KINDS`."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise InputError(f"{owner}: {name} = {value!r}, allowed: a finite {kind}")


def as_numbers(owner: str, name: str, values: object, kind: str) -> tuple[float, ...]:
    """Return a sequence of finite numbers as a tuple; raises InputError for anything else, and for an empty one."""
    if isinstance(values, str) or not isinstance(values, Sequence | np.ndarray) or len(values) == 0:
        raise InputError(f"{owner}: {name} = {values!r}, allowed: a list of one or more numbers")
    for number, value in enumerate(values, start=1):
        check_finite(owner, f"{name}[{number}]", value, kind)
    return tuple(map(float, values))
