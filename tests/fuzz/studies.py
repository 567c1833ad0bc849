"""Study files: valid ones with changes, random tables of known and unknown keys, and text that is hardly TOML."""

from __future__ import annotations

import copy
import functools
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from tests.fuzz.answers import Reader
from tests.fuzz.changes import changed_bytes

from pneumorph.studies import load_study, study_from
from pneumorph.studies.json_schema import study_schema
from pneumorph.studies.schema import TEMPLATES
from pneumorph.studies.starting import starter

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXTS = tuple(path.read_bytes() for path in sorted(EXAMPLES.glob("*.toml")))


@functools.cache
def bases() -> tuple[dict[str, Any], ...]:
    """Return valid studies: the examples, and complete ones with every default written out."""
    complete = [starter(name).resolved() for name in TEMPLATES]
    return (*(tomllib.loads(text.decode()) for text in TEXTS), *complete)


@functools.cache
def known_keys() -> tuple[str, ...]:
    schema = study_schema()
    tables = [schema, *(table for table in schema["$defs"].values() if "properties" in table)]
    return tuple(sorted({key for table in tables for key in table["properties"]}))


UNITS = ("mm", "kPa", "MPa", "mL", "N", "kg/m3", "m/s2", "s", "deg", "K", "", "furlong", "mm**-1", "%", "mm^3", "µm")
NUMBERS = st.one_of(
    st.integers(), st.floats(), st.sampled_from([0, 1, -1, 2, 1e-300, 1e300, 10**400, float("nan"), float("inf")])
)
QUANTITIES = st.builds("{} {}".format, NUMBERS, st.sampled_from(UNITS))
WORDS = st.sampled_from(
    ["cavity", "clamp", "tip", "outer", "body", "base", "gravity", "pressure", "volume", "coarse", "automatic", "yeoh",
     "neo-hookean", "force", "traction", "roller", "symmetry", "prescribed", "x", "-z", "lsr-finger", "symmetry_x",
     "cavity_1", "finger", "pneunet", "thick-sphere", "thick-tube", "hexagonal-prism", "tip_rotation", "diameter"]
)  # fmt: skip
# what TOML can hold: no lone surrogates
TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)
PLAIN = st.one_of(QUANTITIES, WORDS, NUMBERS, TEXT, st.booleans(), st.dates(), st.times(), st.datetimes())
KEYS = st.one_of(st.deferred(lambda: st.sampled_from(known_keys())), WORDS, TEXT)
VALUES = st.recursive(
    PLAIN,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(KEYS, inner, max_size=5)),
    max_leaves=12,
)


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of everything inside nested tables and lists."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [found for key, item in inside for found in [(*path, key), *places(item, (*path, key))]]


def _listed(value: Any) -> Any:
    """Return the same with lists in place of tuples, as TOML has them."""
    if isinstance(value, dict):
        return {key: _listed(item) for key, item in value.items()}
    return [_listed(item) for item in value] if isinstance(value, list | tuple) else value


@st.composite
def changed_studies(draw: st.DrawFn) -> dict[str, Any]:
    """Return a valid study with one to four changes: values, missing, extra, doubled and exchanged entries."""
    study = _listed(copy.deepcopy(draw(st.deferred(lambda: st.sampled_from(bases())))))
    for _ in range(draw(st.integers(1, 4))):
        paths = places(study)
        if not paths:
            break
        *parents, last = draw(st.sampled_from(paths))
        owner = functools.reduce(lambda at, key: at[key], parents, study)
        change = draw(st.sampled_from(["value", "value", "missing", "extra", "doubled", "nested", "exchanged"]))
        if change == "value":
            owner[last] = draw(VALUES)
        elif change == "missing":
            del owner[last]
        elif change == "extra" and isinstance(owner, dict):
            owner[draw(KEYS)] = draw(VALUES)
        elif change == "doubled" and isinstance(owner, list):
            owner.append(copy.deepcopy(owner[last]))
        elif change == "nested":
            owner[last] = draw(st.sampled_from([[owner[last]], {draw(KEYS): owner[last]}]))
        else:
            *others, other = draw(st.sampled_from(paths))
            source = functools.reduce(lambda at, key: at[key] if _has(at, key) else {}, others, study)
            owner[last] = copy.deepcopy(source[other]) if _has(source, other) else draw(WORDS)
    return study


def _has(owner: Any, key: Any) -> bool:
    return (isinstance(owner, dict) and key in owner) or (
        isinstance(owner, list) and isinstance(key, int) and key < len(owner)
    )


def read(table: dict[str, Any]) -> None:
    """Read a study; one that is accepted must be the same again after it was written out."""
    study = study_from(table, "fuzz")
    again = study_from(tomllib.loads(study.resolved_text()), "fuzz")
    assert again.resolved() == study.resolved()


def read_text(text: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "study.toml"
        path.write_bytes(text)
        load_study(path)


READERS = (
    Reader("study, changed", changed_studies(), read, 4),
    Reader("study, random", st.dictionaries(KEYS, VALUES, max_size=6), read, 2),
    Reader("study, text", changed_bytes(TEXTS), read_text, 2),
)
