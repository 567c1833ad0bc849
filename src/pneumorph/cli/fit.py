"""`pneumorph fit DATA.csv`: constants of laws from test data."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

ALL = "all"


def fit(
    data: Annotated[list[Path], typer.Argument(help="Files of test data (CSV with a header and units).")],
    model: Annotated[str, typer.Option(help="A law such as yeoh, ogden-3, gent, or all of them.")] = ALL,
    test: Annotated[
        str | None, typer.Option(help="uniaxial, equibiaxial or planar, for files that do not say it.")
    ] = None,
    stress: Annotated[
        str | None, typer.Option(help="engineering (the default) or true, for files that do not say it.")
    ] = None,
    strain_unit: Annotated[str | None, typer.Option(help="- or %, for a strain without a unit.")] = None,
    stress_unit: Annotated[str | None, typer.Option(help="Such as kPa, for a stress without a unit.")] = None,
    area: Annotated[str | None, typer.Option(help="Undeformed cross-section for a force, such as '24 mm2'.")] = None,
    length: Annotated[str | None, typer.Option(help="Gauge length for a displacement, such as '25 mm'.")] = None,
    branch: Annotated[
        str, typer.Option(help="Of cycles: last-loading, first-loading, mean (of loading and unloading) or all.")
    ] = "last-loading",
    weights: Annotated[
        str, typer.Option(help="equal, or relative to each stress, which favours small strains.")
    ] = "equal",
    keep_offset: Annotated[bool, typer.Option("--keep-offset", help="Leave the zero of strain as recorded.")] = False,
    out: Annotated[Path | None, typer.Option(help="Folder. Default: runs/fit-<name of the first file>.")] = None,
) -> None:
    """Fit laws to one or several tests together, rank them, and write a figure and a [material] for study files."""
    from importlib.metadata import version

    from pneumorph.cli.fitting import busy, findings, fitted, heading, print_ranking
    from pneumorph.cli.output import complain, console
    from pneumorph.materials.fitting import MODELS, ReadOptions, prepare, read_tests
    from pneumorph.materials.fitting import model as named
    from pneumorph.report.fit_files import FILES, write_fit
    from pneumorph.units import parse

    models = MODELS if model.strip().lower() == ALL else (named(model),)
    options = ReadOptions(
        mode=test,
        stress=stress,
        strain_unit=strain_unit,
        stress_unit=stress_unit,
        area=None if area is None else parse(area, "area", "--area"),
        length=None if length is None else parse(length, "length", "--length"),
    )
    terminal = console()
    with busy(terminal, "reading"):
        tests = tuple(prepare(item, branch, keep_offset) for item in read_tests(data, options))
    for line in heading(tests):
        terminal.print(line, markup=False)
    ranking = fitted(terminal, tests, models, weights)
    print_ranking(terminal, tests, ranking)
    for line in findings(tests, ranking):
        complain(line)
    folder = out or Path("runs") / f"fit-{data[0].stem}"
    about = {
        "command": shlex.join(["pneumorph", *sys.argv[1:]]) if sys.argv[1:2] == ["fit"] else None,
        "files": [str(path) for path in data],
        "options": {
            "model": model, "test": test, "stress": stress, "strain_unit": strain_unit, "stress_unit": stress_unit,
            "area": area, "length": length, "branch": branch, "weights": weights, "keep_offset": keep_offset,
        },
        "versions": {name: version(name) for name in ("pneumorph", "numpy", "scipy")},
    }  # fmt: skip
    write_fit(folder, tests, ranking, about)
    terminal.print(f"{folder}: {', '.join(FILES)}; paste fit.toml into a study file", markup=False)
