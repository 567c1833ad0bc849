"""Whatever a file holds, its reader works or refuses it with one message.

A few hundred inputs by default; all of them with `python -m tests.fuzz` from the folder of the project.
"""

import pytest
from tests.fuzz import meshes
from tests.fuzz.answers import Tally, check_message, fuzz
from tests.fuzz.readers import READERS, TOTAL

from pneumorph.errors import PneumorphError

FEW = 150
WEIGHT = sum(reader.weight for reader in READERS)


@pytest.mark.parametrize("reader", READERS, ids=lambda reader: reader.name)
def test_a_reader_works_or_refuses_with_one_message(reader):
    count = reader.count(FEW * len(READERS), WEIGHT)
    assert fuzz(reader, count).inputs == count


@pytest.mark.slow
def test_ten_thousand_inputs_leave_no_traceback(capsys):
    tallies: dict[str, Tally] = {}
    for reader in READERS:
        tallies[reader.name] = fuzz(reader, reader.count(TOTAL, WEIGHT))
        with capsys.disabled():
            print(f"\n{reader.name:>24}: {tallies[reader.name]}", end="")
    total = sum(tally.inputs for tally in tallies.values())
    with capsys.disabled():
        print(f"\n{'all':>24}: {total:6d} inputs without a traceback")
    assert total >= 10_000
    assert all(tally.refused > 0 for tally in tallies.values())


@pytest.mark.parametrize(
    ("suffix", "good", "bad"),
    [
        (".msh", b"\n1 0.0000000000000000e+00", b"\n1 1e999"),
        (".inp", b"\n1, 0, 0, 0\n", b"\n99999999999999999999999, 0, 0, 0\n"),
        (".inp", b"GENERATE\n1, 9, 1\n", b"GENERATE\n1, 9, 0\n"),
    ],
)
def test_what_once_broke_a_reader_is_refused(suffix, good, bad):
    file = {".msh": meshes.msh_files, ".inp": meshes.inp_files}[suffix]()[0]
    assert file.count(good) == 1
    meshes.imported(suffix)(file)
    with pytest.raises(PneumorphError) as caught:
        meshes.imported(suffix)(file.replace(good, bad))
    check_message(caught.value)


def test_a_message_that_says_nothing_or_too_much_would_be_found():
    from pneumorph.errors import InputError

    check_message(InputError("wall = 0 mm: expected a length greater than 0"))
    for message in ("", " ", "one\n\ntwo", "Traceback (most recent call last)", "x" * 10_000):
        with pytest.raises(AssertionError):
            check_message(InputError(message))


def test_another_error_would_be_found():
    from hypothesis import strategies as st
    from tests.fuzz.answers import Reader

    with pytest.raises(ZeroDivisionError):
        fuzz(Reader("broken", st.integers(0, 3), lambda number: 1 / number), 20)
