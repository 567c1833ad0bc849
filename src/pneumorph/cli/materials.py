"""`pneumorph materials`: list, show and draw the materials of the library."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from pneumorph.materials.entry import LibraryEntry

# of tables that go to a file or another program
_WIDTH = 140
_LABELS = {"modulus_100": "stress at 100 %", "elongation": "elongation at break", "valid_to": "holds up to stretch"}
_READ = {
    "original": "its own text or data were read",
    "transcript": "as copied or cited by others",
    "quoted": "quoted, not read again: check before you rely on it",
}


def materials(
    names: Annotated[list[str] | None, typer.Argument(help="Names; without one the whole library is listed.")] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", help="Draw the curves of the named materials: .png, .svg or .pdf.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print as JSON.")] = False,
) -> None:
    """List the library of materials, or show, compare and draw the named ones with the source of each number."""
    from pneumorph.cli.output import console
    from pneumorph.errors import InputError
    from pneumorph.materials import library

    wanted = [library.entry(name) for name in dict.fromkeys(names or ())]
    if plot is not None and not wanted:
        raise InputError("--plot needs the names of the materials to draw")
    drawn = None if plot is None else _draw(wanted, plot)
    shown = wanted or [library.entry(name) for name in library.names()]
    if as_json:
        typer.echo(json.dumps([_plain(entry) for entry in shown], indent=2, ensure_ascii=False))
        return
    out = console()
    if not out.is_terminal:
        out.width = _WIDTH
    if len(wanted) != 1:
        out.print(_list(shown))
    for entry in wanted:
        _show(out, entry)
    if drawn is not None:
        typer.echo(f"curves: {drawn}")


def _draw(entries: list[LibraryEntry], path: Path) -> Path:
    """Write the curves; raises InputError for another kind of file, StorageError where it cannot be written."""
    from pneumorph.errors import InputError, StorageError
    from pneumorph.report.material_figure import FORMATS, material_figure

    form = next((form for form in FORMATS if path.suffix.lower() == f".{form}"), None)
    if form is None:
        raise InputError(f"--plot = '{path}', allowed: a file that ends in {', '.join(f'.{form}' for form in FORMATS)}")
    picture = material_figure(entries, form)
    try:
        path.write_bytes(picture)
    except OSError as error:
        raise StorageError(f"cannot write '{path}': {error.strerror or error}") from error
    return path


def _young(entry: LibraryEntry) -> float:
    """Return the initial Young's modulus, MPa."""
    return 2.0 * entry.material.shear_modulus * (1.0 + entry.material.poisson_ratio)


def _law(entry: LibraryEntry) -> str:
    from pneumorph.materials.laws import law_name

    return str(law_name(entry.material))


def _list(entries: list[LibraryEntry]) -> Any:
    from rich.markup import escape
    from rich.table import Table

    from pneumorph.units import printed_unit, to_printed

    def cell(value: float | None, kind: str) -> str:
        return "" if value is None else f"{to_printed(value, kind):.4g}"

    stress, density = printed_unit("stress"), printed_unit("density")
    table = Table(box=None, pad_edge=False)
    table.add_column("name", no_wrap=True)
    for head in ("law", "hardness"):
        table.add_column(head)
    for head in (
        f"shear\nmodulus\n[{stress}]",
        f"Young's\nmodulus\n[{stress}]",
        f"density\n\n[{density}]",
        f"strength\n\n[{stress}]",
        "elongation\nat break\n[%]",
    ):
        table.add_column(escape(head), justify="right", no_wrap=True)
    table.add_column("source of\nthe constants")
    for entry in entries:
        table.add_row(
            entry.name,
            _law(entry),
            entry.hardness or "",
            cell(entry.material.shear_modulus, "stress"),
            cell(_young(entry), "stress"),
            cell(entry.material.density, "density"),
            cell(entry.tensile_strength, "stress"),
            "" if entry.elongation is None else f"{100.0 * entry.elongation:.4g}",
            entry.sources[0].short,
        )
    return table


def _show(out: Any, entry: LibraryEntry) -> None:
    from rich.table import Table

    from pneumorph.units import show

    sources = list(entry.sources)
    out.print(f"\n{entry.name}", style="bold", markup=False)
    out.print(entry.note, markup=False)
    out.print(
        f"law {_law(entry)}, initial shear modulus {show(entry.material.shear_modulus, 'stress')}, Young's modulus "
        f"{show(_young(entry), 'stress')}, Poisson's ratio {entry.material.poisson_ratio:.5g}\n",
        markup=False,
    )
    table = Table("number", "value", "origin", "source", "how", box=None, pad_edge=False)
    for name, number in entry.numbers.items():
        cited = "" if number.source is None else f"({sources.index(number.source) + 1})"
        table.add_row(_LABELS.get(name, name.replace("_", " ")), number.text(), number.origin, cited, number.how)
    out.print(table)
    for place, source in enumerate(sources, start=1):
        out.print(f"({place}) {source.cite} [{_READ[source.read]}]", markup=False)
    out.print(f"\nIn a study file:\n\n{fragment(entry)}", markup=False)


def fragment(entry: LibraryEntry) -> str:
    """Return the table of a study file: by name, and below it, commented out, with all constants."""
    from pneumorph.studies.fragment import material_fragment

    own = material_fragment(entry.material).strip().splitlines()
    lines = ["[material]", f'name = "{entry.name}"', "", "# the same with its constants:"]
    return "\n".join([*lines, *(f"# {line}" for line in own)])


def _plain(entry: LibraryEntry) -> dict[str, Any]:
    from pneumorph.units import printed_unit, to_printed

    numbers = {}
    for name, number in entry.numbers.items():
        value: Any = number.value
        unit = "" if value is None or number.kind in ("text", "strain") else printed_unit(number.kind)
        if unit:
            many = isinstance(value, tuple)
            printed = [float(f"{to_printed(one, number.kind):.12g}") for one in (value if many else (value,))]
            value = printed if many else printed[0]
        numbers[name] = {
            "value": value,
            "unit": unit,
            "origin": number.origin,
            "how": number.how,
            "source": None if number.source is None else number.source.cite,
            "read": None if number.source is None else number.source.read,
        }
    return {"name": entry.name, "about": entry.note, "law": _law(entry), "numbers": numbers}
