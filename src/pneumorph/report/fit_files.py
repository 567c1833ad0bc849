"""What a fit leaves behind: a figure, a fragment for study files, tables as CSV, and how they came about."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from pneumorph.materials.fitting import Fit, Ranking, SpecimenTest
from pneumorph.materials.fitting.specimen import nominal_stress
from pneumorph.materials.stability import Instability
from pneumorph.report.figure_file import FORMATS
from pneumorph.report.fit_figure import fit_figure
from pneumorph.solution.files import make_folder, write_atomically
from pneumorph.studies.fragment import material_fragment

FILES = ("fit.toml", "laws.csv", "curves.csv", *(f"fit.{form}" for form in FORMATS), "fit.json")


def write_fit(folder: Path, tests: Sequence[SpecimenTest], ranking: Ranking, about: Mapping[str, object]) -> None:
    """Write the files of a fit into a folder, in place of those of an earlier one.

    fit.toml: the recommended law as [material] of a study file, the others below it as comments.
    laws.csv: constants, R², errors and stability of each law. curves.csv: each point fitted to, with each law's stress.
    fit.svg, fit.png: the figure. fit.json: `about` (inputs, options, versions) and what was done to each record.

    Raises StorageError where the folder cannot be written.
    """
    make_folder(folder)
    contents = {
        "fit.toml": fragment(tests, ranking).encode(),
        "laws.csv": _laws(tests, ranking.fits).encode(),
        "curves.csv": _curves(tests, ranking.fits).encode(),
        "fit.json": (json.dumps({**about, "tests": _history(tests)}, indent=2, ensure_ascii=False) + "\n").encode(),
    }
    contents |= {f"fit.{form}": fit_figure(tests, ranking.fits, form) for form in FORMATS}
    for name in FILES:
        _write(folder / name, contents[name])


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda temporary: temporary.write_bytes(content))


def unstable_text(found: Sequence[Instability]) -> str:
    """Return where a law is unstable in words: 'uniaxial over 5.39, planar under 0.43'."""
    return ", ".join(
        f"{item.mode} {'over' if item.stretch > 1.0 else 'under'} stretch {item.stretch:.3g}" for item in found
    )


def fragment(tests: Sequence[SpecimenTest], ranking: Ranking) -> str:
    """Return the contents of fit.toml."""
    best = ranking.recommended
    lines = ["# Fitted by pneumorph to:"]
    lines += [f"#   {test.mode}, {test.source}, {len(test.stretch)} points" for test in tests]
    lines += [f"# {_headline(best)}", "# Paste into a study file; bulk and density may be added.", ""]
    lines += [material_fragment(best.material).strip()]
    for fit in ranking.fits:
        if fit is not best:
            lines += ["", f"# {_headline(fit)}"]
            lines += [f"# {line}" for line in material_fragment(fit.material).strip().splitlines()]
    return "\n".join(lines) + "\n"


def _headline(fit: Fit) -> str:
    where = unstable_text((*fit.inside, *fit.outside))
    return f"{fit.model}: R2 = {fit.r2:.5f}, " + (f"unstable: {where}" if where else "stable")


def _csv(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return buffer.getvalue()


def _laws(tests: Sequence[SpecimenTest], fits: Sequence[Fit]) -> str:
    head = ["model", "constants", "points", "R2 [-]", *(f"R2 {test.mode} {test.source} [-]" for test in tests)]
    head += ["AICc [-]", "largest error [MPa]", "its test", "its stretch [-]", "largest relative error [-]"]
    head += ["its test", "its stretch [-]", "unstable inside the fit", "unstable outside the fit"]
    rows = [
        [
            fit.model,
            "; ".join(fit.constants_shown(9)),
            fit.points,
            f"{fit.r2:.6f}",
            *(f"{value:.6f}" for value in fit.r2_of),
            f"{fit.aicc:.2f}",
            *(f"{v:.6g}" if isinstance(v, float) else v for v in fit.largest_error),
            *(f"{v:.6g}" if isinstance(v, float) else v for v in fit.largest_relative_error),
            unstable_text(fit.inside),
            unstable_text(fit.outside),
        ]
        for fit in fits
    ]
    return _csv(head, rows)


def _curves(tests: Sequence[SpecimenTest], fits: Sequence[Fit]) -> str:
    head = ["test", "source", "line", "stretch [-]", "nominal stress [MPa]", *(f"{fit.model} [MPa]" for fit in fits)]
    rows = []
    for test in tests:
        curves = [nominal_stress(fit.material, test.mode, test.stretch) for fit in fits]
        for place, line in enumerate(test.lines.tolist()):
            values = (test.stretch[place], test.stress[place], *(curve[place] for curve in curves))
            rows.append([test.mode, test.source, line or "", *(f"{value:.8g}" for value in values)])
    return _csv(head, rows)


def _history(tests: Sequence[SpecimenTest]) -> list[dict[str, object]]:
    return [
        {
            "test": test.mode,
            "source": test.source,
            "points": len(test.stretch),
            "stretch": [float(test.stretch.min()), float(test.stretch.max())],
            "notes": list(test.notes),
        }
        for test in tests
    ]
