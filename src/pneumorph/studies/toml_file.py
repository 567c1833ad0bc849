"""TOML files as plain data."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from pneumorph.errors import StudyError


def read_toml(path: Path, what: str) -> dict[str, Any]:
    """Return the contents of a TOML file; what: its name in messages, such as 'study file'.

    Raises StudyError for a file that is missing, not readable or not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise StudyError(f"cannot read the {what} '{path}': {error.strerror or error}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StudyError(f"'{path}' is not a TOML file: {error}") from error
