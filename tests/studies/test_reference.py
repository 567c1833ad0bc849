"""docs/studies.md lists every key of a study file, as the program has them now."""

import runpy
from pathlib import Path

from pneumorph.studies.json_schema import study_schema

DOCS = Path(__file__).parents[2] / "docs"


def test_the_list_of_keys_is_that_of_the_program():
    made = runpy.run_path(str(DOCS / "drawings" / "studies.py"))["keys_text"]()
    page = (DOCS / "studies.md").read_text(encoding="utf-8")
    assert made in page, "run python docs/drawings/studies.py"


def test_every_key_is_mentioned():
    page = (DOCS / "studies.md").read_text(encoding="utf-8")
    schema = study_schema()
    for table in (schema, *(table for table in schema["$defs"].values() if "properties" in table)):
        for key in table["properties"]:
            assert f"`{key}" in page or f"[{key}]" in page, key
