"""What fills cavities: pressure, volume and gas supplies, tubes between cavities, and the equations they all give."""

from pneumorph.mechanics.supplies.atmosphere import Atmosphere
from pneumorph.mechanics.supplies.contents import Gas
from pneumorph.mechanics.supplies.flow import FlowSupply
from pneumorph.mechanics.supplies.gas import GasFilled, GasSupply, SealedSupply
from pneumorph.mechanics.supplies.supply import PressureSupply, Supply, VolumeSupply
from pneumorph.mechanics.supplies.tube import Tube

__all__ = [
    "Atmosphere", "FlowSupply", "Gas", "GasFilled", "GasSupply", "PressureSupply", "SealedSupply", "Supply", "Tube",
    "VolumeSupply",
]  # fmt: skip
