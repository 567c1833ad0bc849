"""Which report a run gets: that of a study, or that of a reproduction with its comparison.

What is reported with is imported when it is needed: drawing libraries take seconds to load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
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
    """Write the report of a reproduction with its comparison, and that of its parts; return its path."""
    from pneumorph.report import write_report
    from pneumorph.report.comparison import read_comparison

    rows, notes = list(chosen.compare(solution, study)), list(chosen.notes)
    for label, name in chosen.parts.items():
        if name != chosen.name and solution.folder is not None:
            own = read_comparison(solution.folder / label)
            rows += [replace(row, quantity=f"{label}: {row.quantity}") for row in own]
            notes.append(f"{reproduction(name).title}: see {label}/report.html in the folder of this run.")
    return write_report(
        solution,
        comparison=rows,
        reported=chosen.curves(study),
        profiles=chosen.profiles(solution, study),
        source=chosen.source,
        notes=notes,
    )


def report_folder(folder: Path) -> Path:
    """Write the report of a run folder anew; return its path. Raises StorageError for a folder without a run."""
    from pneumorph.cli.designing import is_design, report_design
    from pneumorph.cli.granular import is_granular, report_granular
    from pneumorph.cli.limb import is_limb, report_limb
    from pneumorph.cli.reduced import is_reduced, report_reduced
    from pneumorph.cli.rolling import is_rolling, report_rolling
    from pneumorph.cli.shapes import is_shapes, report_shapes
    from pneumorph.cli.skins import is_skins, report_skins
    from pneumorph.cli.sweeping import is_sweep, report_sweep
    from pneumorph.cli.tension import is_tension, report_tension

    kinds: tuple[tuple[Callable[[Path], bool], Callable[[Path], Path]], ...] = (
        (is_limb, report_limb), (is_reduced, report_reduced), (is_granular, report_granular),
        (is_rolling, report_rolling), (is_shapes, report_shapes), (is_tension, report_tension),
        (is_skins, report_skins), (is_design, report_design), (is_sweep, report_sweep),
    )  # fmt: skip
    for holds, written in kinds:  # a folder of skins is one of a sweep, too: the special ones first
        if holds(folder):
            return written(folder)
    solution = Solution.open(folder)
    name = solution.about.get("reproduction")
    if name is None:
        return report_study(solution)
    chosen = reproduction(name) if name in names() else None
    if not isinstance(chosen, Reproduction):
        raise StorageError(f"'{folder}' is a run of the reproduction '{name}', which this version does not know")
    study = study_from(solution.about["study"], solution.about["name"])
    return report_reproduction(solution, chosen, study)
