"""Running a study into a folder: the study with all defaults beside the states."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from pneumorph.errors import StorageError
from pneumorph.solution import Progress, Solution, solve
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.solution.storage import RunFolder
from pneumorph.studies.study import Study

STUDY_FILE = "study.toml"


def run_study(
    study: Study,
    folder: Path | str | None = None,
    *,
    resume: bool = False,
    progress: Callable[[Progress], None] | None = None,
    about: dict[str, Any] | None = None,
    raise_on_stop: bool = True,
) -> Solution:
    """Return the solution of a study; arguments and errors as in `solve`; `about` is kept beside the study.

    A folder also gets `study.toml`, the study with every default written out. A folder that holds a run is refused
    (StorageError) before the mesh is made, unless `resume` is True.
    """
    fresh = folder is not None and not RunFolder(folder).holds_run
    if folder is not None:
        if not fresh and not resume:
            raise StorageError(f"'{folder}' already holds a run: resume it (--resume) or choose another folder")
        make_folder(Path(folder))
    problem = study.build()
    if folder is not None and fresh:
        text = study.resolved_text()
        write_atomically(Path(folder) / STUDY_FILE, lambda path: path.write_text(text, encoding="utf-8") and None)
    return solve(
        problem.model,
        problem.programme,
        measures=problem.measures,
        folder=folder,
        resume=resume,
        settings=problem.settings,
        progress=progress,
        about={"title": study.title, "name": study.name, "study": study.resolved(), **(about or {})},
        raise_on_stop=raise_on_stop,
    )
