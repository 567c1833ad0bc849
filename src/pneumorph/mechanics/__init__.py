"""The solver: models, programmes and the load stepping that yields converged states."""

from pneumorph.mechanics.cavity import Cavity
from pneumorph.mechanics.contact import (
    Block,
    Contact,
    Cylinder,
    FreeBody,
    HalfSpace,
    Motion,
    Pipe,
    Revolved,
    SurfaceFile,
    Touch,
)
from pneumorph.mechanics.continuation import march
from pneumorph.mechanics.loads import Force, Gravity, Traction
from pneumorph.mechanics.model import Model
from pneumorph.mechanics.programme import Phase, Programme
from pneumorph.mechanics.settings import Settings
from pneumorph.mechanics.state import Energies, State
from pneumorph.mechanics.supplies import (
    Atmosphere,
    FlowSupply,
    Gas,
    GasSupply,
    PressureSupply,
    SealedSupply,
    Supply,
    Tube,
    VolumeSupply,
)
from pneumorph.mechanics.supports import Clamp, Prescribed, Roller, Symmetry

__all__ = [
    "Atmosphere", "Block", "Cavity", "Clamp", "Contact", "Cylinder", "Energies", "FlowSupply", "Force", "FreeBody",
    "Gas", "GasSupply", "Gravity", "HalfSpace", "Model", "Motion", "Phase", "Pipe", "Prescribed", "PressureSupply",
    "Programme", "Revolved", "Roller", "SealedSupply", "Settings", "State", "Supply", "SurfaceFile", "Symmetry",
    "Touch", "Traction", "Tube", "VolumeSupply", "march",
]  # fmt: skip
