"""Which report a run gets: that of a study, or that of a reproduction with its comparison.

What is reported with is imported when it is needed: drawing libraries take seconds to load.
"""

from __future__ import annotations

from pathlib import Path

from pneumorph.errors import StorageError
from pneumorph.solution import Solution
from pneumorph.studies import Study, study_from
from pneumorph.studies.reproductions import Reproduction, names, reproduction


def report_study(solution: Solution) -> Path:
    """Write the report of a study into its run folder; return its path."""
    from pneumorph.report import write_report

    return write_report(solution)


def report_reproduction(solution: Solution, chosen: Reproduction, study: Study) -> Path:
    """Write the report of a reproduction with its comparison; return its path."""
    from pneumorph.report import write_report

    return write_report(
        solution,
        comparison=chosen.compare(solution, study),
        reported=chosen.curves(study),
        profiles=chosen.profiles(solution, study),
        source=chosen.source,
        notes=chosen.notes,
    )


def report_folder(folder: Path) -> Path:
    """Write the report of a run folder anew; return its path. Raises StorageError for a folder without a run."""
    from pneumorph.cli.granular import is_granular, report_granular
    from pneumorph.cli.limb import is_limb, report_limb
    from pneumorph.cli.reduced import is_reduced, report_reduced
    from pneumorph.cli.rolling import is_rolling, report_rolling

    if is_limb(folder):
        return report_limb(folder)
    if is_reduced(folder):
        return report_reduced(folder)
    if is_granular(folder):
        return report_granular(folder)
    if is_rolling(folder):
        return report_rolling(folder)
    solution = Solution.open(folder)
    name = solution.about.get("reproduction")
    if name is None:
        return report_study(solution)
    chosen = reproduction(name) if name in names() else None
    if not isinstance(chosen, Reproduction):
        raise StorageError(f"'{folder}' is a run of the reproduction '{name}', which this version does not know")
    study = study_from(solution.about["study"], solution.about["name"])
    return report_reproduction(solution, chosen, study)
