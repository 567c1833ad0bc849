import csv

import pytest

from pneumorph.errors import StorageError
from pneumorph.report import read_at, read_comparison, write_comparison
from pneumorph.report.comparison import comparison_table
from pneumorph.solution import Column, History
from pneumorph.studies.comparison import Comparison

ROWS = (
    Comparison("angle", "40 kPa", 5.5, 5.6, "deg", "a, \"quoted\" note"),
    Comparison("angle", "80 kPa", 10.0, 11.0, "deg"),
    Comparison("angle", "120 kPa", 10.0, 30.0, "deg"),
    Comparison("angle", "160 kPa", 10.0, None, "deg", "not reached"),
)  # fmt: skip
HISTORY = History(
    [Column("p", "pressure", "pressure"), Column("a", "angle", "angle")],
    [{"p": 0.0, "a": 0.0}, {"p": 0.04, "a": 0.1}, {"p": 0.08, "a": 0.3}],
)


def test_comparison_csv_has_exactly_the_agreed_columns_and_comes_back(tmp_path):
    path = write_comparison(ROWS, tmp_path)
    head, *lines = list(csv.reader(path.open()))
    assert head == ["quantity", "condition", "reported", "computed", "unit", "relative_difference", "note"]
    assert float(lines[1][5]) == pytest.approx(0.1)
    assert lines[3][3] == lines[3][5] == ""
    assert read_comparison(tmp_path) == ROWS


def test_a_folder_without_a_comparison_has_no_rows(tmp_path):
    assert read_comparison(tmp_path) == ()


@pytest.mark.parametrize("text", ["a,b\n1,2\n", "quantity,condition\n", "\x00"])
def test_a_damaged_comparison_is_refused_with_its_path(tmp_path, text):
    (tmp_path / "comparison.csv").write_text(text)
    with pytest.raises(StorageError, match=r"comparison\.csv"):
        read_comparison(tmp_path)


def test_every_row_is_shown_whatever_its_difference():
    rows = comparison_table(ROWS).rows
    assert [row[5].tone for row in rows] == ["good", "fair", "off", "none"]
    assert rows[2][5].text == "+200.0 %"
    assert rows[3][3].text == "not reached"


def test_a_value_at_a_state_is_taken_as_it_is():
    assert read_at(HISTORY, "a", "p", 0.04) == read_at(HISTORY, "a", "p", 0.04 * (1 + 1e-12))
    assert read_at(HISTORY, "a", "p", 0.04).value == 0.1
    assert read_at(HISTORY, "a", "p", 0.04).note == ""


def test_a_value_between_states_is_interpolated_and_says_so():
    reading = read_at(HISTORY, "a", "p", 0.06)
    assert reading.value == pytest.approx(0.2)
    assert reading.note == "interpolated between the states at 40 kPa and 80 kPa"


def test_a_value_beyond_the_states_is_not_made_up():
    reading = read_at(HISTORY, "a", "p", 0.1)
    assert reading.value is None
    assert reading.note == "not reached: the run covers 0 kPa to 80 kPa"
