"""What the tests of sweeps share: a small study, a sweep of twelve designs, workers that solve nothing."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from pneumorph.solution import Column, History
from pneumorph.studies.sweeps import Workers
from pneumorph.studies.sweeps.compute import Record

# one small increment: a second for each design
SPHERE = """
title = "Octant of a sphere"
[actuator]
template = "thick-sphere"
octant = true
[material]
law = "neo-hookean"
mu = "100 kPa"
[mesh]
size = "coarse"
[[phase]]
name = "inflate"
targets = { cavity = "2 kPa" }
first_increment = 1.0
largest_increment = 1.0
"""
TWELVE = """
study = "sphere.toml"
[parameters]
actuator.outer_radius = { low = "13 mm", high = "16 mm", steps = 4 }
"material.mu" = ["80 kPa", "100 kPa", "0.12 MPa"]
"""


COLUMNS = [
    Column("phase", "phase", "text"),
    Column("time", "time", "number"),
    Column("pressure:cavity", "gauge pressure in cavity", "pressure"),
    Column("added_volume:cavity", "volume added to cavity", "volume"),
]


def history(*states: tuple[str, float, float, float]) -> History:
    """Return a history of states (phase, time, pressure, added volume)."""
    return History(COLUMNS, [dict(zip([c.key for c in COLUMNS], state, strict=True)) for state in states])


@dataclass(frozen=True)
class Pretend(Workers):
    """Workers that solve nothing: outcomes by number of the call, a plain history for the others."""

    outcomes: dict[int, object] = field(default_factory=dict)
    asked: list[object] = field(default_factory=list)

    def compute(self, function, calls: Sequence[tuple]):
        self.asked.extend(calls)
        plain = Record("done", history=history(("", 0.0, 0.0, 0.0), ("inflate", 1.0, 0.002, 7.0))).plain()
        for number in range(len(calls)):
            outcome = self.outcomes.get(number, plain)
            if outcome is KeyboardInterrupt:
                raise KeyboardInterrupt
            yield number, outcome
