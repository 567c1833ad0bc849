"""The record of a run folder: what it holds, so that it is resumed by the same run only and can be reported anew."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pneumorph.errors import StorageError
from pneumorph.solution.files import make_folder, write_atomically


def keep_record(path: Path, record: Mapping[str, Any], keys: tuple[str, ...], resume: bool) -> None:
    """Write the record of a new folder; check by some of its keys that a folder that is resumed holds the same run.

    Raises StorageError for a folder that holds a run already and is not resumed, or that holds another one.
    """
    if not path.exists():
        make_folder(path.parent)
        text = json.dumps(record, indent=1, ensure_ascii=False) + "\n"
        write_atomically(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
        return
    if not resume:
        raise StorageError(f"'{path.parent}' already holds a run: resume it (--resume) or choose another folder")
    stored, wanted = read_record(path), json.loads(json.dumps(dict(record)))
    if any(stored.get(key) != wanted.get(key) for key in keys):
        raise StorageError(
            f"'{path.parent}' holds another run of this part, see its {path.name}: choose another folder"
        )


def read_record(path: Path) -> dict[str, Any]:
    """Return a record; raises StorageError where it is missing or damaged."""
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError) as error:
        raise StorageError(f"{path} cannot be read: {error}") from error
