"""The JSON schema of study files, with which editors check and complete them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pneumorph.errors import StorageError
from pneumorph.materials import library
from pneumorph.studies.measuring import names as measure_names
from pneumorph.studies.measuring import names_by_domain
from pneumorph.studies.schema import LibraryMaterial, StudyFile

DIALECT = "https://json-schema.org/draft/2020-12/schema"
# beside study files that `pneumorph new --schema` writes
SCHEMA_FILE = "pneumorph.schema.json"


def study_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a study file as plain data.

    Every section refuses unknown keys; quantities are text with a unit; `default` is the value of a key that is left
    out. What depends on the actuator (face and domain names, whether dimensions fit) is checked by `load_study` alone.
    """
    schema = StudyFile.model_json_schema(mode="validation")
    by_domain = {"type": "string", "pattern": f"^({'|'.join(names_by_domain())}):.+$"}
    schema["properties"]["measures"]["items"] = {"anyOf": [{"enum": list(measure_names())}, by_domain]}
    # upper and lower case are alike, so the names are offered, not prescribed
    name = schema["$defs"][LibraryMaterial.__name__]["properties"]["name"]
    name |= {"anyOf": [{"enum": list(library.names())}, {"type": "string"}]}
    return {"$schema": DIALECT, **schema, "title": "pneumorph study"}


def schema_text() -> str:
    """Return the JSON schema as the text of a file."""
    return json.dumps(study_schema(), indent=2, ensure_ascii=False) + "\n"


def write_schema(path: Path) -> None:
    """Write the JSON schema into a file, whatever it held before. Raises StorageError."""
    try:
        path.write_text(schema_text(), encoding="utf-8")
    except OSError as error:
        raise StorageError(f"'{path}': cannot write ({error.strerror or error})") from error
