"""How a solve steps and when it is content."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pneumorph.errors import InputError

# setting -> lowest value, highest, whether the lowest is allowed
_ALLOWED = {
    "tolerance": (0.0, 1e-2, False),
    "iterations": (1, np.inf, True),
    "contact_iterations": (1, np.inf, True),
    "rounds": (0, np.inf, True),
    "largest_step": (0.0, np.inf, False),
    "growth": (1.0, np.inf, True),
    "few": (0, np.inf, True),
    "cut": (0.0, 1.0, False),
    "viscosity": (0.0, np.inf, True),
    "relaxations": (1, np.inf, True),
    "flow_accuracy": (0.0, np.inf, False),
}


@dataclass(frozen=True)
class Settings:
    """How a solve steps and when it is content.

    tolerance:     residual force over the largest of applied forces and reactions.
    iterations:    iterations before an increment is given up.
    largest_step:  cap on a nodal displacement in one iteration, as a fraction of the body's size.
    growth, few:   an increment that took at most `few` iterations is followed by one `growth` times larger.
    cut:           factor on an increment that failed.
    contact_iterations: iterations where there is contact.
    rounds:        how often friction takes up the normal forces of the present place before those of the last stay.
    viscosity:     first coefficient of the viscous regularisation that is tried where increments fail, in units of
                   mu / size2 (see `continuation`); 0 switches it off for good.
    relaxations:   viscous steps before an increment is given up.
    flow_accuracy: error in a cavity's mass of gas that the time integration of flow may make in an increment, as a
                   share of that mass.
    """

    tolerance: float = 1e-8
    iterations: int = 16
    contact_iterations: int = 60
    rounds: int = 3
    largest_step: float = 0.05
    growth: float = 1.5
    few: int = 7
    cut: float = 0.4
    viscosity: float = 100.0
    relaxations: int = 60
    flow_accuracy: float = 1e-4

    def __post_init__(self) -> None:
        for name, (least, most, included) in _ALLOWED.items():
            value = getattr(self, name)
            if not (least < value < most or (included and value == least)):  # nan is in no range
                limits = f"{least:g} or more" if included else f"more than {least:g}"
                limits += f", less than {most:g}" if most < np.inf else ""
                raise InputError(f"solver: {name} = {value!r}, allowed: {limits}")
