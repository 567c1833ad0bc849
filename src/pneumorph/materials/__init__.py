"""Materials: one file per stored energy, and a library of silicones with their sources."""

from pneumorph.materials import library
from pneumorph.materials.material import InvariantEnergy, InvariantMaterial, Material
from pneumorph.materials.neo_hookean import NeoHookean
from pneumorph.materials.yeoh import Yeoh

__all__ = [
    "InvariantEnergy",
    "InvariantMaterial",
    "Material",
    "NeoHookean",
    "Yeoh",
    "library",
]
