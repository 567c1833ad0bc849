"""What supplies ask of tubes and phases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from pneumorph.errors import InputError, NameNotFoundError, unknown_name
from pneumorph.mechanics.supplies.atmosphere import Atmosphere
from pneumorph.mechanics.supplies.flow import FlowSupply
from pneumorph.mechanics.supplies.gas import GasFilled, GasSupply, SealedSupply
from pneumorph.mechanics.supplies.supply import Supply
from pneumorph.mechanics.supplies.tube import Tube
from pneumorph.units import show

if TYPE_CHECKING:
    from pneumorph.mechanics.programme import Phase


def check_tubes(tubes: Sequence[Tube], supplies: Mapping[str, Supply]) -> None:
    """Raise NameNotFoundError for a tube to an unknown cavity, InputError for one to a cavity without gas."""
    for tube in tubes:
        for name in tube.between:
            if name not in supplies:
                raise NameNotFoundError("tube: " + unknown_name("cavity", name, supplies))
            if not isinstance(supplies[name], GasFilled):
                raise InputError(
                    f"tube between {' and '.join(tube.between)}: the cavity '{name}' has a "
                    f"{type(supplies[name]).__name__}, allowed: SealedSupply, GasSupply, FlowSupply"
                )


def check_phases(
    phases: Sequence[Phase], supplies: Mapping[str, Supply], tubes: Sequence[Tube], atmosphere: Atmosphere
) -> None:
    """Raise InputError for a target below empty space, for one of a sealed cavity, and for a flow without duration.

    supplies: cavity -> supply.
    """
    flowing = [name for name, supply in supplies.items() if isinstance(supply, FlowSupply)]
    flowing += [name for tube in tubes for name in tube.between]
    for phase in phases:
        if flowing and phase.duration is None:
            raise InputError(
                f"phase '{phase.name}': duration missing; the flow of gas into cavity '{flowing[0]}' takes time"
            )
        for name, value in phase.targets.items():
            supply = supplies.get(name)
            check_driven(phase.name, name, supplies)
            if supply is not None and supply.kind == "pressure" and value < -atmosphere.pressure:
                raise InputError(
                    f"phase '{phase.name}': target {name} = {show(value, 'pressure', 6)}, "
                    f"allowed: {show(-atmosphere.pressure, 'pressure', 6)} (vacuum) or more"
                )


def check_driven(phase: str, name: str, supplies: Mapping[str, Supply]) -> None:
    """Raise InputError for a target of a sealed cavity."""
    if isinstance(supplies.get(name), SealedSupply):
        raise InputError(
            f"phase '{phase}': target {name}: the cavity is sealed and cannot be driven; "
            "give it another supply, such as gas"
        )


def check_masses(phases: Sequence[Phase], supplies: Mapping[str, Supply], masses: Mapping[str, float]) -> None:
    """Raise InputError for a target that takes out all the gas there is at rest, or more. masses: cavity -> t."""
    for phase in phases:
        for name, value in phase.targets.items():
            if isinstance(supplies.get(name), GasSupply) and value <= -masses[name]:
                raise InputError(
                    f"phase '{phase.name}': target {name} = {show(value, 'mass')}, allowed: more than "
                    f"{show(-masses[name], 'mass')}, all the gas that it holds at rest"
                )
