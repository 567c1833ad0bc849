import csv

import pytest

from pneumorph.errors import StorageError
from pneumorph.studies.run_table import RunTable


@pytest.fixture
def table(tmp_path):
    return RunTable(tmp_path / "runs.csv", ("distance [m]", "note"))


def test_rows_come_back_by_run_and_missing_values_are_empty(table):
    assert table.rows() == {}
    table.append({"run": "a", "status": "done", "distance [m]": 1.25})
    table.append({"run": "b, c", "status": "failed", "reason": 'it said "no"\nand stopped'})
    assert table.rows()["a"] == {"run": "a", "status": "done", "reason": "", "distance [m]": "1.25", "note": ""}
    assert table.rows()["b, c"]["reason"] == 'it said "no" and stopped'
    with table.path.open(newline="") as file:
        assert len(list(csv.reader(file))) == 3


def test_a_line_that_a_kill_cut_short_is_dropped_and_written_over(table):
    table.append({"run": "a", "status": "done", "note": "ä"})
    whole = table.path.read_bytes()
    table.append({"run": "b", "status": "done", "note": "ö"})
    for end in range(len(whole), len(table.path.read_bytes())):
        table.path.write_bytes(table.path.read_bytes()[:end] if end > len(whole) else whole)
        assert list(table.rows()) == ["a"]
    table.path.write_bytes(whole + "b,done,,1.0,\u00f6".encode()[:-1])
    table.append({"run": "c", "status": "done"})
    assert list(table.rows()) == ["a", "c"]
    assert table.path.read_bytes().startswith(whole)


def test_a_run_that_is_tried_again_has_its_last_row(table):
    table.append({"run": "a", "status": "failed", "reason": "once"})
    table.append({"run": "a", "status": "done"})
    assert table.rows()["a"]["status"] == "done"


def test_a_column_that_the_table_does_not_have_is_a_slip_of_the_program(table):
    with pytest.raises(KeyError, match="no such columns: mass"):
        table.append({"run": "a", "mass": 1})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("run,status\n", "has the columns run, status; expected run, status, reason, distance"),
        ("run,status,reason,distance [m],note\na,done\n", "is damaged: line 2 is no row"),
        ("run,status,reason,distance [m],note\na,perhaps,,,\n", "is damaged: line 2 is no row"),
    ],
)
def test_a_damaged_table_is_refused(table, text, message):
    table.path.write_text(text)
    with pytest.raises(StorageError, match=message):
        table.rows()


def test_a_table_that_is_no_text_or_cannot_be_written_is_refused(table):
    table.path.write_bytes(b"\xff\xfe\n")
    with pytest.raises(StorageError, match="cannot be read"):
        table.rows()
    with pytest.raises(StorageError, match="cannot be written"):
        RunTable(table.path.parent / "none" / "runs.csv", ()).append({"run": "a"})
