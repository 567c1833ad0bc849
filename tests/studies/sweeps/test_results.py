"""What is taken from a history: ends, extremes, and the value where another column passes a mark."""

import math

import pytest
from tests.studies.sweeps.pretend import COLUMNS, history

from pneumorph.studies.sweeps.results import Result

PRESSURE, VOLUME = COLUMNS[2], COLUMNS[3]
# up to a limit point and down again, in two phases
RUN = history(
    ("", 0.0, 0.0, 0.0), ("fill", 0.5, 0.010, 1.0), ("fill", 1.0, 0.030, 2.0), ("more", 1.5, 0.020, 4.0),
    ("more", 2.0, 0.010, 5.0),
)  # fmt: skip


@pytest.mark.parametrize(
    ("result", "expected"),
    [
        (Result("r", VOLUME), 5.0),
        (Result("r", PRESSURE, "maximum"), 0.030),
        (Result("r", VOLUME, "minimum"), 0.0),
        (Result("r", VOLUME, "phase", "fill"), 2.0),
        (Result("r", VOLUME, "phase", "more"), 5.0),
        (Result("r", VOLUME, "crossing", "pressure:cavity", 0.015), 1.25),  # the first time, a quarter of the way
        (Result("r", VOLUME, "crossing", "pressure:cavity", 0.010), 1.0),
        (Result("r", PRESSURE, "crossing", "added_volume:cavity", 3.0), 0.025),
        (Result("r", VOLUME, "crossing", "pressure:cavity", 0.031), math.nan),
    ],
)
def test_a_result_of_a_run_that_is_done(result, expected):
    assert result.of_run(RUN, True) == pytest.approx(expected, nan_ok=True)


def test_a_run_that_stopped_has_what_it_reached_but_no_end_and_no_extreme():
    stopped = history(*[tuple(row.values()) for row in RUN.rows[:-1]])
    assert Result("r", VOLUME, "phase", "fill").of_run(stopped, False) == 2.0
    assert Result("r", VOLUME, "crossing", "pressure:cavity", 0.015).of_run(stopped, False) == pytest.approx(1.25)
    for where in ("end", "maximum", "minimum"):
        assert math.isnan(Result("r", VOLUME, where).of_run(stopped, False))
    assert math.isnan(Result("r", VOLUME, "phase", "more").of_run(stopped, False))


def test_a_column_that_a_run_lacks_gives_no_number():
    other = type(VOLUME)("volume:other", "other", "volume")
    assert math.isnan(Result("r", other).of_run(RUN, True))
    assert math.isnan(Result("r", VOLUME, "crossing", "volume:other", 1.0).of_run(RUN, True))
    assert math.isnan(Result("r", VOLUME).of_run(history(), True))
    unknown = history(("fill", 1.0, math.nan, 1.0))
    assert math.isnan(Result("r", PRESSURE, "maximum").of_run(unknown, True))
