"""The reduced soft wheel from limb data: fit, static tests against the finite elements, heights, and a roll."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.studies.comparison import Comparison
from pneumorph.terrain.limb_data import LimbData
from pneumorph.terrain.limb_fit import LimbFit, fit_limb
from pneumorph.terrain.soft_rig import Stand, loaded_tip, pressed_wheel
from pneumorph.terrain.soft_wheel import SoftWheel

Array = NDArray[np.float64]

ALLOWED = 0.15  # relative difference of a static test
SMALL = 5.0  # mm: deflections below, where a force passes near the hinges, are not judged by their relative difference
NEUTRAL, INFLATED = 230.0, 280.0  # mm, heights that the study reports
WEIGHT = 1.25  # N on a wheel, given by the study
TURNED = 0.25 * pi  # beyond it a round foot has rolled so far from the load point that a tip force is another test
ROLL = 10.0  # s
SPEED = 2.0 * pi


@dataclass(frozen=True, eq=False)
class StaticTest:
    """One case of the data against MuJoCo: how a tip force moves the load point from where the pressure put it.

    pressure: MPa; force (2,): N, in the limb's axes; held_out: no fit used it; finite_elements, multibody (2,): mm;
    turn: of the finite-element tip by the force, rad.
    """

    pressure: float
    force: Array
    held_out: bool
    finite_elements: Array
    multibody: Array
    turn: float

    @property
    def difference(self) -> float:
        """Size of the MuJoCo deflection over that of the finite elements, less 1."""
        return float(np.linalg.norm(self.multibody) / np.linalg.norm(self.finite_elements) - 1.0)

    @property
    def judged(self) -> bool:
        """Whether the finite-element deflection is large enough to judge by `difference`."""
        return float(np.linalg.norm(self.finite_elements)) >= SMALL

    @property
    def apart(self) -> float:
        """Length of the difference of both deflections over that of the finite elements."""
        return float(np.linalg.norm(self.multibody - self.finite_elements) / np.linalg.norm(self.finite_elements))


@dataclass(frozen=True, eq=False)
class Roll:
    """A roll over level ground with a schedule of pressures, at n moments.

    time (n,), s; pressure (n,), MPa, of all wheels; centre (n, 3), mm; height (n,), mm, of the centre over the ground;
    bending (n,), rad, mean over all limbs.
    """

    time: Array
    pressure: Array
    centre: Array
    height: Array
    bending: Array


@dataclass(frozen=True, eq=False)
class ReducedWheel:
    """All that comes from limb data; at pressures (k,): heights (k,) of the unloaded wheel, stands under 1.25 N."""

    fit: LimbFit
    wheel: SoftWheel
    tests: tuple[StaticTest, ...]
    pressures: Array
    heights: Array
    stands: tuple[Stand, ...]
    roll: Roll


def reduce_wheel(data: LimbData, duration: float = ROLL) -> ReducedWheel:
    """Return the reduced wheel of limb data with its tests; raises InputError and EngineError as the parts do."""
    fit = fit_limb(data)
    wheel = SoftWheel(fit.limb)
    pressures = np.linspace(0.0, fit.limb.pressures[1], 7)
    inwards = inwards_of(data)
    return ReducedWheel(
        fit,
        wheel,
        static_tests(data, wheel),
        pressures,
        np.array([wheel.height(p) for p in pressures]),
        tuple(pressed_wheel(wheel, p, WEIGHT, inwards) for p in pressures),
        roll(wheel, ramps(fit.limb.pressures[1], duration), duration),
    )


def inwards_of(data: LimbData) -> float:
    """Return the direction, rad in the limb's axes, from the load point of the unloaded limb to the axle."""
    x, y, angle = data.mount
    axle = -np.array([np.cos(angle) * x + np.sin(angle) * y, -np.sin(angle) * x + np.cos(angle) * y])
    return float(np.arctan2(*(axle - data.load_point)[::-1]))


def static_tests(data: LimbData, wheel: SoftWheel) -> tuple[StaticTest, ...]:
    """Return a test for each loaded case at a pressure at which the data has an unloaded one too."""
    loaded = np.linalg.norm(data.forces, axis=1) > 1e-9
    tests = []
    for pressure in np.unique(data.pressures[~loaded]):
        same = np.isclose(data.pressures, pressure, rtol=0.0, atol=1e-9)
        unloaded = int(np.flatnonzero(same & ~loaded)[0])
        start, _ = loaded_tip(wheel, pressure, (0.0, 0.0))
        for case in np.flatnonzero(same & loaded):
            end, _ = loaded_tip(wheel, pressure, tuple(data.forces[case]))
            tests.append(
                StaticTest(
                    float(pressure),
                    data.forces[case],
                    bool(data.held_out[case]),
                    data.load_points[case] - data.load_points[unloaded],
                    end - start,
                    float(data.rotations[case, -1] - data.rotations[unloaded, -1]),
                )
            )
    return tuple(tests)


def ramps(highest: float, duration: float) -> Callable[[float], float]:
    """Return a schedule: no pressure, up from a fifth of the time to two fifths, held, down from four fifths on."""
    return lambda time: highest * float(np.interp(time / duration, [0.2, 0.4, 0.7, 0.9], [0.0, 1.0, 1.0, 0.0]))


def roll(wheel: SoftWheel, schedule: Callable[[float], float], duration: float, speed: float = SPEED) -> Roll:
    """Return a roll over level ground; schedule: pressure of all wheels, MPa, at a time, s.

    Raises EngineError where an extra is missing, or the simulation gets unstable.
    """
    from pneumorph.terrain.environment import INTERVAL, SoftRover

    robot = SoftRover(wheel, duration=duration)
    observed, info = robot.reset(seed=5)
    bending = np.array([name.startswith("bending") for name in robot.observation_names])
    rows: list[tuple[Any, ...]] = []
    ended = False
    while True:
        time = len(rows) * INTERVAL
        rows.append((time, info["pressures"].mean(), info["place"], info["height"], observed[bending].mean()))
        if ended:
            break
        observed, _, over, late, info = robot.step(robot.action(schedule(time), speed))
        ended = over or late
    return Roll(*(np.array(column) for column in zip(*rows, strict=True)))


def comparison(result: ReducedWheel, data: LimbData) -> tuple[Comparison, ...]:
    """Return the rows of comparison.csv: heights against the study, static tests against the finite elements.

    Of the tests those under the weight of the wheel or held out, and not small; of the stands those where only feet
    touch, and turn little.
    """
    highest = result.fit.limb.pressures[1]
    rows = [
        Comparison("height of the wheel", "0 kPa", NEUTRAL, float(result.heights[0]), "mm", "circle around the links"),
        Comparison(
            "height of the wheel",
            f"{1e3 * highest:g} kPa",
            INFLATED,
            float(result.heights[-1]),
            "mm",
            "circle around the links; inflated at the highest pressure of the fit",
        ),
    ]
    for test in result.tests:
        size = float(np.linalg.norm(test.force))
        if not test.judged or not (test.held_out or abs(size - WEIGHT) < 1e-3):
            continue
        note = "reported: the finite elements of this run; computed: MuJoCo" + (
            "; held out" if test.held_out else "; fitted"
        )
        rows.append(
            Comparison(
                "tip deflection",
                f"{1e3 * test.pressure:g} kPa, {size:.3g} N at {_degrees(test.force):.0f} deg",
                float(np.linalg.norm(test.finite_elements)),
                float(np.linalg.norm(test.multibody)),
                "mm",
                note,
            )
        )
    for pressure, stand in zip(result.pressures, result.stands, strict=True):
        pushed = _pushed(result, data, pressure)
        if pushed is not None and stand.on_foot:
            rows.append(
                Comparison(
                    "sinking of the axle, wheel pressed on the ground",
                    f"{1e3 * pressure:g} kPa, {WEIGHT} N",
                    pushed,
                    stand.sink,
                    "mm",
                    "reported: the finite elements of this run, tip force; computed: MuJoCo, contact with the ground",
                )
            )
    return tuple(rows)


def _pushed(result: ReducedWheel, data: LimbData, pressure: float) -> float | None:
    """Return how far the finite-element tip gives way along a force of the wheel's weight towards the axle, mm."""
    inwards = inwards_of(data)
    along = np.array([np.cos(inwards), np.sin(inwards)])
    for test in result.tests:
        same = abs(test.pressure - pressure) < 1e-9 and np.allclose(test.force, WEIGHT * along, atol=1e-3)
        if same and abs(test.turn) <= TURNED:
            return float(test.finite_elements @ along)
    return None


def worst(tests: Sequence[StaticTest], held_out: bool) -> StaticTest | None:
    """Return the judged test with the largest difference among those held out or fitted; None where there is none."""
    chosen = [test for test in tests if test.held_out is held_out and test.judged]
    return max(chosen, key=lambda test: abs(test.difference)) if chosen else None


def _degrees(force: Array) -> float:
    return float(np.degrees(np.arctan2(force[1], force[0])))
