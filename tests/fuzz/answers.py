"""The property that every reader of files must have: it works, or refuses with one message."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from hypothesis import HealthCheck, given, seed, settings
from hypothesis.strategies import SearchStrategy

from pneumorph.errors import PneumorphError

# long enough for one complaint a wrong key, too short for a dump of the input
LONGEST = 6000


@dataclass
class Tally:
    """How many inputs a reader was given, and what became of them."""

    read: int = 0
    refused: int = 0
    messages: set[str] = field(default_factory=set)

    @property
    def inputs(self) -> int:
        return self.read + self.refused

    def __str__(self) -> str:
        return f"{self.inputs:6d} inputs: {self.read} read, {self.refused} refused"


@dataclass(frozen=True)
class Reader:
    """A way into the package: `call` reads what `inputs` draws; `weight`: its share of all inputs.

    cost: how many times fewer it gets, because each takes so much longer.
    """

    name: str
    inputs: SearchStrategy[Any]
    call: Callable[[Any], object]
    weight: int = 1
    cost: int = 1

    def count(self, total: int, weights: int) -> int:
        """Return how many of a total it gets, where all weights add up to `weights`."""
        return -(-total * self.weight // (weights * self.cost))


def check_message(error: PneumorphError) -> None:
    message = str(error)
    assert message.strip(), f"{type(error).__name__} says nothing"
    assert "\n\n" not in message, f"more than one paragraph: {message!r}"
    assert "Traceback" not in message
    assert len(message) < LONGEST, f"{len(message)} characters: {message[:300]!r}"


def fuzz(reader: Reader, count: int) -> Tally:
    """Give a reader `count` inputs, the same ones every time; any error but our own fails, with the input."""
    tally = Tally()

    @seed(20260)
    @settings(max_examples=count, deadline=None, database=None, suppress_health_check=list(HealthCheck))
    @given(reader.inputs)
    def answers(data: Any) -> None:
        try:
            reader.call(data)
        except PneumorphError as error:
            check_message(error)
            tally.refused += 1
            tally.messages.add(str(error)[:80])
        else:
            tally.read += 1

    answers()
    return tally
