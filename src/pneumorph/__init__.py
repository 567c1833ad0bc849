"""pneumorph: soft pneumatic actuators from parameters to inflated shape.

The public nouns and the verb `solve` can be imported from here; each loads its part of the package when it is first
used, so that `import pneumorph` itself is quick.

>>> from pneumorph import Yeoh
>>> Yeoh(0.11, 0.02).shear_modulus
0.22
"""

from __future__ import annotations

import contextlib
from importlib import import_module
from typing import TYPE_CHECKING, Any

from pneumorph.errors import InputError
from pneumorph.threads import limit_libraries

# before any numerical library is loaded; a wrong PNEUMORPH_THREADS is refused where threads are first asked for
with contextlib.suppress(InputError):
    limit_libraries()

# module -> its nouns
_PUBLIC = {
    "errors": ("InputError", "NotConvergedError", "PneumorphError", "StorageError"),
    "units": ("parse", "show"),
    "materials": ("Material", "NeoHookean", "Yeoh", "library"),
    "geometry": (
        "Actuator", "BendingSkin", "Finger", "HexagonalPrism", "PipeRobot", "PlaneCrawler", "PneuNet", "Quadruped",
        "SoftLimb", "ThickSphere", "ThickTube", "export",
    ),
    "mesh": ("Imported", "Mesh", "MeshSize", "Selector", "generate", "inspect"),
    "mechanics": (
        "Atmosphere", "Cavity", "Clamp", "FlowSupply", "Force", "GasSupply", "Gravity", "Model", "Phase", "Prescribed",
        "PressureSupply", "Programme", "Roller", "SealedSupply", "Settings", "State", "Symmetry", "Traction", "Tube",
        "VolumeSupply",
    ),
    "solution": ("Solution", "Status", "solve"),
    "measures": ("ChordAngle", "TipRotation"),
    "gaits": ("Gait", "locomotion"),
    "studies": ("Study", "load_study", "run_study"),
}  # fmt: skip
_HOME = {name: module for module, names in _PUBLIC.items() for name in names}

__all__ = [*_HOME, "__version__"]


def __getattr__(name: str) -> Any:
    """Load the part of the package that a public name lives in (PEP 562)."""
    if name == "__version__":
        from importlib.metadata import version

        return version("pneumorph")
    if name not in _HOME:
        raise AttributeError(f"module 'pneumorph' has no attribute {name!r}")
    return getattr(import_module(f"pneumorph.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


if TYPE_CHECKING:  # what type checkers and editors see
    __version__: str
    from pneumorph.errors import NotConvergedError as NotConvergedError
    from pneumorph.errors import PneumorphError as PneumorphError
    from pneumorph.errors import StorageError as StorageError
    from pneumorph.gaits import Gait as Gait
    from pneumorph.gaits import locomotion as locomotion
    from pneumorph.geometry import Actuator as Actuator
    from pneumorph.geometry import BendingSkin as BendingSkin
    from pneumorph.geometry import Finger as Finger
    from pneumorph.geometry import HexagonalPrism as HexagonalPrism
    from pneumorph.geometry import PipeRobot as PipeRobot
    from pneumorph.geometry import PlaneCrawler as PlaneCrawler
    from pneumorph.geometry import PneuNet as PneuNet
    from pneumorph.geometry import Quadruped as Quadruped
    from pneumorph.geometry import SoftLimb as SoftLimb
    from pneumorph.geometry import ThickSphere as ThickSphere
    from pneumorph.geometry import ThickTube as ThickTube
    from pneumorph.geometry import export as export
    from pneumorph.materials import Material as Material
    from pneumorph.materials import NeoHookean as NeoHookean
    from pneumorph.materials import Yeoh as Yeoh
    from pneumorph.materials import library as library
    from pneumorph.measures import ChordAngle as ChordAngle
    from pneumorph.measures import TipRotation as TipRotation
    from pneumorph.mechanics import Atmosphere as Atmosphere
    from pneumorph.mechanics import Cavity as Cavity
    from pneumorph.mechanics import Clamp as Clamp
    from pneumorph.mechanics import FlowSupply as FlowSupply
    from pneumorph.mechanics import Force as Force
    from pneumorph.mechanics import GasSupply as GasSupply
    from pneumorph.mechanics import Gravity as Gravity
    from pneumorph.mechanics import Model as Model
    from pneumorph.mechanics import Phase as Phase
    from pneumorph.mechanics import Prescribed as Prescribed
    from pneumorph.mechanics import PressureSupply as PressureSupply
    from pneumorph.mechanics import Programme as Programme
    from pneumorph.mechanics import Roller as Roller
    from pneumorph.mechanics import SealedSupply as SealedSupply
    from pneumorph.mechanics import Settings as Settings
    from pneumorph.mechanics import State as State
    from pneumorph.mechanics import Symmetry as Symmetry
    from pneumorph.mechanics import Traction as Traction
    from pneumorph.mechanics import Tube as Tube
    from pneumorph.mechanics import VolumeSupply as VolumeSupply
    from pneumorph.mesh import Imported as Imported
    from pneumorph.mesh import Mesh as Mesh
    from pneumorph.mesh import MeshSize as MeshSize
    from pneumorph.mesh import Selector as Selector
    from pneumorph.mesh import generate as generate
    from pneumorph.mesh import inspect as inspect
    from pneumorph.solution import Solution as Solution
    from pneumorph.solution import Status as Status
    from pneumorph.solution import solve as solve  # type: ignore[no-redef]
    from pneumorph.studies import Study as Study
    from pneumorph.studies import load_study as load_study
    from pneumorph.studies import run_study as run_study
    from pneumorph.units import parse as parse
    from pneumorph.units import show as show
