"""`pneumorph reproduce NAME`: rebuild a published system and compare it with what was reported."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from pneumorph.errors import InputError


def reproduce(
    name: Annotated[str | None, typer.Argument(help="Name of the system; leave it out for a list.")] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Coarse mesh, and stops early.")] = False,
    out: Annotated[Path | None, typer.Option(help="Run folder. Default: runs/<name>, with -quick if it is.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the last state in the folder.")] = False,
    part: Annotated[
        str | None,
        typer.Option(help="Part of a system; `pneumorph reproduce` alone lists them."),
    ] = None,
    video: Annotated[str | None, typer.Option(help="Part rigid: draw a film of this run, as curved-3_ramp.")] = None,
    terrain: Annotated[Path | None, typer.Option(help="Part rigid: a further terrain, grey-scale image.")] = None,
    relief: Annotated[str | None, typer.Option(help="Height of white in that image, such as '400 mm'.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Part rigid: address of a Dask scheduler.")] = None,
    radius: Annotated[str | None, typer.Option(help="Part rigid: radius of the wheels. Default: 140 mm.")] = None,
    beds: Annotated[int | None, typer.Option(help="Part granular: beds of each sand, with other seeds.")] = None,
    wheels: Annotated[Path | None, typer.Option(help="Part granular: folder of neutral, half and full .stl.")] = None,
) -> None:
    """Rebuild a published system, solve it and compare it with the reported data."""
    from pneumorph.studies import reproductions

    if name is None:
        for known in reproductions.names():
            item = reproductions.reproduction(known)
            typer.echo(f"{known}: {item.title}. {item.source}")
            for key, meaning in item.parts.items():
                typer.echo(f"  --part {key}: {meaning}")
        return

    chosen = reproductions.reproduction(name)
    if isinstance(chosen, reproductions.SystemInParts):
        from pneumorph.cli.rolling import reproduce_rigid

        if part is None or part not in chosen.parts:
            raise InputError(f"--part: {part or 'missing'}, allowed for {name}: {', '.join(chosen.parts)}")
        of_part: dict[str, dict[str, object]] = {
            "rigid": {"radius": radius, "terrain": terrain, "relief": relief, "video": video},
            "granular": {"beds": beds, "wheels": wheels},
        }
        _refuse({key: value for name, given in of_part.items() if name != part for key, value in given.items()}, part)
        if part == "limb":
            from pneumorph.cli.limb import reproduce_limb

            _refuse({"scheduler": scheduler}, part)
            reproduce_limb(quick, out, resume)
            return
        if part == "reduced":
            from pneumorph.cli.reduced import reproduce_reduced

            _refuse({"scheduler": scheduler}, part)
            reproduce_reduced(quick, out, resume)
            return
        if part == "granular":
            from pneumorph.cli.granular import reproduce_granular

            reproduce_granular(quick, out, resume, beds=beds, wheels=wheels, scheduler=scheduler)
            return
        reproduce_rigid(
            quick, out, resume, radius=radius, image=terrain, relief=relief, video=video, scheduler=scheduler
        )
        return
    given: dict[str, object] = {"video": video, "terrain": terrain, "relief": relief}
    given |= {"beds": beds, "wheels": wheels, "radius": radius}
    if isinstance(chosen, reproductions.SystemBySweep):
        if part is None:
            from pneumorph.cli.skins import reproduce_skin

            _refuse(given, None)
            reproduce_skin(quick, out, resume, scheduler=scheduler)
            return
        from pneumorph.cli.shapes import reproduce_shapes

        if part not in chosen.parts:
            raise InputError(f"--part: {part}, allowed for {name}: {', '.join(chosen.parts)}; none for its sweep")
        _refuse(given | {"scheduler": scheduler}, part)
        reproduce_shapes(quick, out, resume)
        return
    for option, value in (given | {"scheduler": scheduler}).items():
        if value is not None:
            raise InputError(f"--{option}: {name} does not take this option")

    from pneumorph.cli.reproducing import reproduce_study

    reproduce_study(chosen, quick, out, resume, part)


def _refuse(given: Mapping[str, object], part: str | None) -> None:
    """Raise InputError for an option of another part; None: of a system by a sweep, without a part."""
    for option, value in given.items():
        if value is not None:
            owner = "the sweep" if part is None else f"the part '{part}'"
            raise InputError(f"--{option}: {owner} does not take this option")
