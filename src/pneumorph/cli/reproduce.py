"""`pneumorph reproduce NAME`: rebuild a published system and compare it with what was reported."""

from __future__ import annotations

import shlex
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
        str | None, typer.Option(help="Part of a system; soft-wheel: limb, rigid, reduced, granular.")
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
            if isinstance(item, reproductions.SystemInParts):
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
    given: dict[str, object] = {"part": part, "video": video, "terrain": terrain, "relief": relief}
    given |= {"beds": beds, "wheels": wheels, "radius": radius}
    by_sweep = isinstance(chosen, reproductions.SystemBySweep)
    for option, value in (given if by_sweep else given | {"scheduler": scheduler}).items():
        if value is not None:
            raise InputError(f"--{option}: {name} has no parts, so it does not take this option")
    if isinstance(chosen, reproductions.SystemBySweep):
        from pneumorph.cli.skins import reproduce_skin

        reproduce_skin(quick, out, resume, scheduler=scheduler)
        return

    from pneumorph.cli.reporting import report_reproduction
    from pneumorph.cli.solving import solve_and_report

    study = chosen.study(quick)
    folder = out or Path("runs") / (f"{name}-quick" if quick else name)
    command = shlex.join(["pneumorph", "reproduce", name, *(["--quick"] if quick else []), "--out", str(folder)])
    solve_and_report(
        study,
        folder,
        resume,
        command,
        lambda solution: report_reproduction(solution, chosen, study),
        about={"reproduction": name, "source": chosen.source},
    )


def _refuse(given: Mapping[str, object], part: str) -> None:
    """Raise InputError for an option of another part."""
    for option, value in given.items():
        if value is not None:
            raise InputError(f"--{option}: the part '{part}' does not take this option")
