import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneumorph.studies.writing import to_toml

KEYS = st.text(st.characters(codec="utf-8", exclude_categories=("Cs",)), min_size=1, max_size=8)
NUMBERS = st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False, allow_infinity=False)
PLAIN = st.booleans() | NUMBERS | st.text(st.characters(codec="utf-8", exclude_categories=("Cs",)))
VALUES = PLAIN | st.lists(PLAIN, max_size=3) | st.dictionaries(KEYS, PLAIN, max_size=3)
TABLES = st.dictionaries(KEYS, VALUES | st.lists(st.dictionaries(KEYS, VALUES, max_size=3), max_size=3), max_size=4)


@given(st.dictionaries(KEYS, PLAIN | TABLES, max_size=4))
def test_what_is_written_reads_back_equal(table):
    assert tomllib.loads(to_toml(table)) == table


def test_tables_and_arrays_of_tables_stand_on_their_own():
    text = to_toml({"title": "x", "mesh": {"size": "1 mm", "none": None}, "phase": [{"targets": {"a": "1 kPa"}}]})
    assert text == 'title = "x"\n\n[mesh]\nsize = "1 mm"\n\n[[phase]]\ntargets = { a = "1 kPa" }\n'


def test_what_toml_cannot_hold_is_a_type_error():
    with pytest.raises(TypeError, match="no TOML for"):
        to_toml({"a": object()})
